"""The phase diagram of D' in (delta, Lambda epsilon): exact boundaries, confirmed by a search over directions.

Det D' < 0 for some direction is the whole question (Tr D' >= 0 implies Det D' <= 0). In the wave's frame, with
L = Lambda epsilon,

    Det D' = (L/epsilon^2) [(1 + 2L) d^2 + a^2 - k a],   a + d = delta,   |a - d| <= s = sqrt(2 - delta^2)

so D' is unstable iff ``1 + 2L < a (k - a)/(delta - a)^2`` for some admissible a. `critical` maximises the right-hand
side.
"""

from collections.abc import Callable
from typing import Any

import numpy as np

from stability import results
from stability.errors import SceneError
from stability.model import Model
from stability.parameters import FRICTION_ANGLE, radians

# Directions of the search: a grid over a quadrant (D' is even in phi and in 90 - phi about the axes), refined about
# its best.
DIRECTIONS = 181
REFINEMENTS = 6


def stress_ratio(friction_angle: float) -> float:
    """Return k = sqrt(2) sin(friction angle) (I2), the angle in degrees."""
    return np.sqrt(2) * np.sin(radians(friction_angle))


def critical(delta: Any, k: float) -> np.ndarray:
    """Return L*, the scaled wavenumber Lambda epsilon below which D' is unstable: 0 where never, inf where always.

    The stationary point is ``a = k delta/(2 delta - k)``, with ``L* = (k^2 - 4 delta (delta - k))/(8 delta (delta -
    k))``; where it lies outside the admissible directions the extremum is on the minor stress axis, with ``L* = (k (s
    + delta) - 2)/(delta - s)^2`` (friction angles above 49.94 degrees only).
    """
    delta = np.asarray(delta, float)
    s = np.sqrt(np.maximum(0, 2 - delta * delta))
    with np.errstate(divide="ignore", invalid="ignore"):
        a = k * delta / (2 * delta - k)
        product = delta * (delta - k)
        inside = (k * k - 4 * product) / (8 * product)
        edge = (k * (s + delta) - 2) / (delta - s) ** 2
        threshold = np.where((2 * a - delta <= s) & (delta - 2 * a <= s), inside, edge)
    always = (delta >= 0) & (delta <= min(k, 1.0))  # d = 0 is admissible there, with a = delta in [0, k]
    return np.where(always, np.inf, np.maximum(0, np.nan_to_num(threshold)))


def unstable_range(k: float) -> tuple[float, float]:
    """Return the open range of delta in which some wavelength is unstable."""
    high = k * (1 + np.sqrt(2)) / 2 if k <= np.sqrt(2 * (2 - np.sqrt(2))) else 1 / k + np.sqrt(1 - 1 / k**2)
    return -k / (2 * (1 + np.sqrt(2))), high


def largest_growth(friction_angle: float, delta: float, scaled_wavenumber: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the largest growth rate of D' over directions, times epsilon, and where it is.

    The direction is measured from the major stress axis. A search on the compiled D', with no use of the formulas
    above: it is what confirms them. The units are chosen such that mu = epsilon = ||V|| = 1, hence
    Lambda epsilon = |xi|^2/2.
    """
    parameters = {
        "friction_angle": friction_angle, "epsilon": 1.0, "delta": delta,
        "strain_rate": 1.0, "pressure": 1 / stress_ratio(friction_angle),
    }  # fmt: skip
    base = Model("perturbed", "uniform_strain").base(parameters, {})
    wavenumber = np.sqrt(2 * scaled_wavenumber)

    def growth(phi: np.ndarray) -> np.ndarray:
        found = base.form(90 - phi, "truncated").eigenvalues(wavenumber)  # the major stress axis is y
        return np.maximum(found[0].real, found[1].real)

    phi = np.linspace(0, 90, DIRECTIONS)[:, None] + 0 * wavenumber
    step = phi[1, 0]
    value = growth(phi)
    best = phi[value.argmax(axis=0), np.arange(wavenumber.size)]
    for _ in range(REFINEMENTS):
        phi = np.clip(best + np.linspace(-step, step, 21)[:, None], 0, 90)
        value = growth(phi)
        best = phi[value.argmax(axis=0), np.arange(wavenumber.size)]
        step /= 10
    return value.max(axis=0), best


def phase_diagram(
    friction_angle: float,
    delta: Any,
    scaled_wavenumber: Any,
    progress: Callable[[int, int], None] | None = None,
    growth: bool = True,
) -> "results.xr.Dataset":
    """Return where D' is stable, unstable, or unstable at every wavelength, and its largest growth rate.

    Parameters
    ----------
    friction_angle : degrees
    delta : 1-D, within (-sqrt 2, sqrt 2)
    scaled_wavenumber : 1-D, Lambda epsilon = mu |xi|^2 epsilon/2, positive
    progress : called with (columns done, columns in all)
    growth : whether to search the directions for the growth rate; the regions alone need no sample

    Returns
    -------
    Dataset with ``region`` and, with ``growth``, ``scaled_growth_rate`` and ``worst_angle`` (delta,
    scaled_wavenumber), and the exact boundary ``critical_scaled_wavenumber`` (delta). The attribute ``disagreements``
    counts samples whose searched sign differs from the exact region; a search can only miss a wedge narrower than its
    finest step.

    Raises
    ------
    SceneError : a value outside its range
    """
    delta, scaled = (np.atleast_1d(np.asarray(v, float)) for v in (delta, scaled_wavenumber))
    found = [FRICTION_ANGLE.problem(friction_angle)]
    if not np.all(np.abs(delta) < np.sqrt(2)):
        found.append("delta lies outside (-sqrt 2, sqrt 2): it is tr V/||V|| (paper, P1.3)")
    if not np.all(np.isfinite(scaled) & (scaled > 0)):
        found.append("scaled_wavenumber lies outside (0, inf): it is Lambda epsilon = mu |xi|^2 epsilon/2")
    if any(found):
        raise SceneError(*filter(None, found))
    k = stress_ratio(friction_angle)
    boundary = critical(delta, k)
    region = np.where(np.isinf(boundary)[:, None], 2, np.where(scaled < boundary[:, None], 1, 0)).astype(np.int8)
    dims = ("delta", "scaled_wavenumber")
    variables: dict = {"region": (dims, region), "critical_scaled_wavenumber": ("delta", boundary)}
    confirmed = {}
    if growth:
        rate, angle = searched(friction_angle, delta, scaled, progress)
        variables |= {"scaled_growth_rate": (dims, rate), "worst_angle": (dims, angle)}
        confirmed["disagreements"] = int(((rate > 0) != (region > 0)).sum())
    return results.dataset(
        variables,
        {"delta": delta, "scaled_wavenumber": scaled},
        closure="perturbed", flow="uniform_strain", matrix="truncated",
        parameters={"friction_angle": friction_angle},
        stress_ratio=k, unstable_range=unstable_range(k), always_unstable_range=(0.0, min(k, 1.0)), **confirmed,
    )  # fmt: skip


def searched(friction_angle: float, delta: np.ndarray, scaled: np.ndarray, progress: Any) -> tuple:
    """Return growth rate and worst angle (delta, scaled_wavenumber) of `largest_growth`."""
    found = np.empty((2, delta.size, scaled.size))
    for i, value in enumerate(delta):
        found[:, i] = largest_growth(friction_angle, float(value), scaled)
        if progress:
            progress(i + 1, delta.size)
    return found[0], found[1]
