"""The fastest growing wave of any length about a base state, in float64: a search, not a proof."""

from typing import Any

import numpy as np

from stability import spectrum
from stability.directions import Directions
from stability.model import Base
from stability.realroots import middle

DIRECTIONS, WAVENUMBERS = 90, 97
ZOOMS, WINDOW, SHRINK = 40, 9, 3  # windows of so many directions and wavenumbers, and how fast they shrink
FAN = 12  # directions; twice as many distances from each special one, on either side
SHORT = 1e3  # times the largest wavenumber at which two terms balance: corrections to the laws are then small
SLACK = 1.05
LOOK = 160  # bits of the roots of that independent look: slow modes beside fast ones take digits
RISE = 1e-3  # relative: a plateau of growth towards long waves has rounding on it, no hump
BEYOND = 1e3  # how far past the outermost balance of two terms the search goes


def scales(d: Directions) -> tuple[float, float]:
    """Return the least and the largest wavenumber at which two terms of the characteristic polynomial balance."""
    mp, found = d.numbers.mp, []
    sizes = {key: max(abs(middle(c, mp)) for c in form.values()) for key, form in d.forms.items()}
    for (j, m), a in sizes.items():
        for (i, n), b in sizes.items():
            if i == j and n > m and a and b:
                found.append(float((a / b) ** (mp.mpf(1) / (n - m))))
    return (min(found), max(found)) if found else (1.0, 1.0)


def largest(base: Base, d: Directions, matrix: str) -> tuple[tuple[float, float, float] | None, bool]:
    """Return ((growth rate, wavenumber, wave_angle) of the fastest wave found, whether that is the longest tried).

    A grid first, then windows about the best wave, which shrink while it lies inside: ridges are followed. The longest
    waves grow by the gradients of the base state alone, often faster than all others: a wave that grows and is faster
    than some longer one is preferred. None where float64 cannot hold the waves of this state.
    """
    low, high = scales(d)
    low, high = low / BEYOND, high * BEYOND
    angles, q = np.linspace(0, 180, DIRECTIONS, endpoint=False), np.geomspace(low, high, WAVENUMBERS)
    growth = rates(base, angles, q, matrix)
    if not np.isfinite(growth).any():
        return None, False
    rising = humps(growth.max(axis=0))
    longest = not rising.any()
    i, j = np.unravel_index(np.argmax(growth if longest else np.where(rising, growth, -np.inf)), growth.shape)
    best = float(growth[i, j]), float(q[j]), float(angles[i])
    turn, stretch, unit = 180 / DIRECTIONS, np.log(high / low) / (WAVENUMBERS - 1), np.linspace(-1, 1, WINDOW)
    for _ in range(ZOOMS):
        angles = best[2] + turn * unit
        q = np.clip(best[1] * np.exp(stretch * unit), low, high)
        growth = rates(base, angles, q, matrix)
        i, j = np.unravel_index(np.argmax(growth), growth.shape)
        if growth[i, j] > best[0]:
            best = float(growth[i, j]), float(q[j]), float(angles[i])
        if 0 < i < WINDOW - 1 and (0 < j < WINDOW - 1 or q[j] in (low, high)):
            turn, stretch = turn / SHRINK, stretch / SHRINK
    return (best[0], best[1], best[2] % 180), bool(best[0] > 0 and (longest or best[1] == low))


def rates(base: Base, angles: np.ndarray, q: np.ndarray, matrix: str) -> np.ndarray:
    """Return the largest growth rate of each wave (direction, wavenumber); -inf where float64 does not hold it."""
    with np.errstate(all="ignore"):
        growth = leading(base.form(angles, matrix).filled(angles.size).column().eigenvalues(q))
    return np.where(np.isfinite(growth), growth, -np.inf)


def humps(growth: np.ndarray) -> np.ndarray:
    """Return where growth, over rising wavenumbers, is positive and above that of some longer wave."""
    least = np.minimum.accumulate(np.where(np.isfinite(growth), growth, np.inf))
    return (growth > 0) & (growth - least > RISE * growth)


def excess(d: Directions, exponent: Any, coefficient: Any) -> str:
    """Return a sentence if some short wave grows faster than the law found allows, else "".

    An independent look at what laws cannot promise, that they hold uniformly: the characteristic polynomial is solved
    at one short wavelength in multiprecision, along a fan of directions and ever closer to the special ones.
    """
    mp = d.numbers.mp
    q = mp.mpf(scales(d)[1] * SHORT)
    fan = [2.0 + 180 / FAN * i for i in range(FAN)]
    fan += [
        s.angle + side * float(gap) for s in d.special for side in (-1, 1) for gap in np.geomspace(1e-8, 3, 2 * FAN)
    ]
    growth, angle = max((growth_at(d, a, q), a) for a in fan)
    allowed = coefficient * q ** mp.mpf(float(exponent)) if coefficient else 0
    if growth <= allowed * SLACK + mp.mpf(10) ** -12 * q ** mp.mpf(min(0, float(exponent))):
        return ""
    return (
        f"a wave of {float(q):.4g} 1/m at {angle:.6g} deg grows at {float(growth):.6g} 1/s, "
        f"more than the law's {float(allowed):.6g}"
    )


def growth_at(d: Directions, angle: float, q: Any) -> Any:
    """Return the largest growth rate of a wave, in multiprecision."""
    mp = d.numbers.mp
    c: dict[int, Any] = {}
    for (j, m, _), value in d.along(angle).items():
        c[j] = c.get(j, mp.mpc(0)) + d.numbers.centre(value) * q ** int(m)
    with mp.workprec(LOOK):
        if max(c) == 2:
            half = c.get(1, 0) / (2 * c[2])
            root = mp.sqrt(half * half - c.get(0, 0) / c[2])
            return max((root - half).real, (-root - half).real)
        found = mp.polyroots([c.get(j, mp.mpc(0)) for j in range(max(c), -1, -1)], 200, extraprec=LOOK, error=False)
    return max((z.real for z in found), default=-mp.inf)


def strain_rate(base: Base) -> float | None:
    """Return ||V|| of a base state, or None where it has no velocity."""
    if ("u", "v") not in base.model.fields:
        return None
    (u_x, u_y), (v_x, v_y) = base.state[base.model.fields.index(("u", "v"))][1]
    shear = (u_y + v_x) / 2
    a = base.model.arithmetic
    return float(a.centre(a.sqrt(u_x * u_x + v_y * v_y + 2 * shear * shear)))


def leading(found: tuple[Any, ...]) -> np.ndarray:
    """Return the largest real part."""
    return (spectrum.leading_first(*found)[0] if len(found) == 2 else found[0]).real
