"""Directions and wavenumbers at which something vanishes, to 50 digits: samples are taken beside them."""

import numpy as np
from mpmath import mp

from stability import spectrum
from stability.arithmetic import multiprecision

EXACT = multiprecision(50)


def directions(base, wanted: str) -> list:
    """Return the angles in degrees at which the direction chi has chi.A.chi or tau.A.tau of a wanted value.

    ``null``: tau.A.tau = 0, where Det M = 0 (P6); ``velocity``: chi.A.chi = 0 and ``stress``: chi.A.chi = k/2, where
    the leading part of rigid-plastic growth, -mu q^2 a (a - k/2)/(1 - k a), vanishes (the characteristics, L5).
    """
    letters = {name: mp.mpf(value) for name, value in base.letters().items()}
    xx, xy, yy = (letters[f"A_{c}"] for c in ("xx", "xy", "yy"))
    radius, centre = mp.hypot((xx - yy) / 2, xy), (xx + yy) / 2
    target = {"null": centre, "velocity": -centre, "stress": letters["k"] / 2 - centre}[wanted] / radius
    if abs(target) > 1:
        return []
    axis, half = mp.atan2(2 * xy, xx - yy) / 2, mp.acos(target) / 2
    return [mp.degrees(axis + side * half) for side in (1, -1)]


def beside(exact, rng: np.random.Generator, count: int) -> np.ndarray:
    """Return float64 angles 1e-2 to 1e-16 degrees beside an exact one; the float64 angle is the sample."""
    offsets = 10.0 ** -rng.uniform(2, 16, count) * rng.choice([-1, 1], count)
    return np.array([float(exact + mp.mpf(float(offset))) for offset in offsets])


def around(exact, rng: np.random.Generator, count: int) -> np.ndarray:
    """Return float64 numbers 1e-2 to 1e-17 relative around an exact one."""
    offsets = 10.0 ** -rng.uniform(2, 17, count) * rng.choice([-1, 1], count)
    return np.array([float(exact * (1 + mp.mpf(float(offset)))) for offset in offsets])


def neutral_wavenumbers(form) -> list:
    """Return the wavenumbers in 1e-6 to 1e12 at which the growth rate changes sign, by bisection in log q."""
    polynomial = spectrum.stability_polynomial(form.coefficients)
    return changes(lambda q: spectrum.evaluate(polynomial, q))


def double_wavenumbers(form) -> list:
    """Return the wavenumbers in 1e-6 to 1e12 at which a real discriminant, quadratic in q^2, vanishes."""
    real, _ = spectrum.real_imaginary(form.coefficients["discriminant"])
    c, b, a = (mp.mpf(real.get(n, 0)) for n in (0, 2, 4))
    inner = b * b - 4 * a * c
    squares = [] if inner < 0 else [(-b + side * mp.sqrt(inner)) / (2 * a) for side in (1, -1)]
    return [mp.sqrt(s) for s in squares if 1e-12 < s < 1e24]


def changes(function) -> list:
    """Return where a function changes sign on a logarithmic scale."""
    grid = [mp.mpf(10) ** (mp.mpf(n) / 2) for n in range(-12, 25)]
    positive = [function(q) > 0 for q in grid]
    found = []
    for i in range(len(grid) - 1):
        low, high = grid[i], grid[i + 1]
        if positive[i] == positive[i + 1]:
            continue
        for _ in range(120):  # 1e-36 relative
            middle = mp.sqrt(low * high)
            low, high = (middle, high) if (function(middle) > 0) == positive[i] else (low, middle)
        found.append(low)
    return found
