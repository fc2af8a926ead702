"""The short waves of mu(I) over its parameters: growth, the neutral directions and the neutral inertial numbers.

``lambda = |xi|^2 n/d`` with n and d the corner coefficients of the closure's characteristic polynomial, forms in the
direction. n is even in both components (X, Y); on the unit circle it is a parabola in C = cos 2 phi, and a wedge opens
where its discriminant vanishes. That is where the verdict changes.
"""

import numpy as np
from scipy.optimize import brentq, minimize_scalar

from stability import polynomials
from stability.model import Model

MODEL = Model("mu_i", "uniform_strain")
GLASS = {"static_friction": np.tan(np.radians(20.9)), "dynamic_friction": np.tan(np.radians(32.76))}
RISE = GLASS["dynamic_friction"] - GLASS["static_friction"]  # mu_2 - mu_s
REFERENCE = 0.279  # I_0
LOWEST, HIGHEST = -16.0, 5.0  # log10 of the inertial numbers between which neutral ones are sought


def state(I: float, static: float = GLASS["static_friction"]) -> dict:
    """Return the parameters of a flow of inertial number I: I = sqrt(2) d ||V||/sqrt(solid_fraction p)."""
    grains = {"grain_diameter": 1.0, "solid_fraction": 0.5, "pressure": 2.0, "strain_rate": I / 2**0.5, "delta": 0.0}
    return grains | {
        "static_friction": static, "dynamic_friction": static + RISE, "reference_inertial_number": REFERENCE
    }  # fmt: skip


def friction(I: float, static: float = GLASS["static_friction"]) -> tuple[float, float]:
    """Return mu and nu = I mu'/mu."""
    mu = static + RISE * I / (REFERENCE + I)
    return mu, RISE * I * REFERENCE / (REFERENCE + I) ** 2 / mu


def printed(I: float, static: float = GLASS["static_friction"]) -> float:
    """Return the printed condition, well-posed where it is not positive."""
    mu, nu = friction(I, static)
    return 4 * nu**2 - 4 * nu + mu**2 * (1 - nu / 2) ** 2


def corners(I: float, static: float = GLASS["static_friction"]) -> tuple[np.ndarray, np.ndarray]:
    """Return the coefficients of n and d as polynomials in C, the constant term first."""
    found = polynomials.symbol(MODEL.evolves, MODEL.base(state(I, static), {}).pencil())
    x4, x2y2, y4 = (found[0, 4, k] for k in (0, 2, 4))
    x2, y2 = (found[1, 2, k] for k in (0, 2))
    # X^2 = (1 + C)/2, Y^2 = (1 - C)/2; s^4 = |xi|^4 and s^2 = -|xi|^2
    quartic = np.array([x4 + x2y2 + y4, 2 * (x4 - y4), x4 - x2y2 + y4]) / 4
    return quartic, np.array([x2 + y2, x2 - y2]) / 2


def growth(I: float, wave_angle: np.ndarray, static: float = GLASS["static_friction"]) -> np.ndarray:
    """Return Re lambda/(eta |xi|^2) of short waves, eta = mu p/||D||."""
    n, d = corners(I, static)
    C = np.cos(2 * np.radians(wave_angle))
    eta = friction(I, static)[0] * 2 / (I / 2)
    return np.polynomial.Polynomial(n)(C) / np.polynomial.Polynomial(d)(C) / eta


def discriminant(I: float, static: float = GLASS["static_friction"]) -> float:
    """Return the discriminant of n over the square of its middle coefficient: positive where a wedge is open."""
    a, b, c = corners(I, static)[0]
    return 1 - 4 * a * c / b**2


def wedge(I: float, static: float = GLASS["static_friction"]) -> tuple[float, float]:
    """Return the directions (degrees) between which waves grow."""
    a, b, c = corners(I, static)[0]
    root = np.sqrt(max(b * b - 4 * a * c, 0.0))
    low = (abs(b) + root) / 2  # of the two roots the one without cancellation
    first, second = sorted((low / abs(c), abs(a) / low))
    return tuple(np.degrees(np.arccos(np.clip((second, first), -1, 1))) / 2)


def most_stable(static: float) -> tuple[float, float]:
    """Return log10 of the inertial number at which the discriminant is least, and its value."""
    found = minimize_scalar(
        lambda x: discriminant(10**x, static), bounds=(-3, 1), method="bounded", options={"xatol": 1e-9}
    )
    return found.x, found.fun


def neutral(static: float = GLASS["static_friction"], condition=discriminant) -> tuple[float, float] | None:
    """Return the inertial numbers between which the rheology is well-posed, None where it never is."""
    middle, least = most_stable(static)
    if least > 0:
        return None
    return tuple(
        10 ** brentq(lambda x: condition(10**x, static), *sorted((middle, end)), xtol=1e-15, rtol=1e-15)
        for end in (LOWEST, HIGHEST)
    )


def tip() -> tuple[float, float]:
    """Return (mu_s, I) at which the well-posed region closes."""
    static = brentq(lambda s: most_stable(s)[1], 0.3, 0.8, xtol=1e-14)
    return static, 10 ** most_stable(static)[0]
