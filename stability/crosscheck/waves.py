"""Which plane waves are tried in the periodic cell, and what comes out: growth, orders, the place of neutral waves."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from scipy.optimize import brentq

from stability.crosscheck.cell import cell_growth
from stability.crosscheck.orders import extrapolated, observed
from stability.crosscheck.theory import plane_wave, uniform, unit

CELLS, STEPS = (16, 32, 64), (4, 8, 16)
ORDERS_H, ORDERS_DT = (2, 4), (1, 2)
STATES = ((-0.1, 1e-4), (0.0, 1e-4), (0.0, 2e-5), (0.2, 1e-4), (0.5, 2e-5), (0.9, 1e-3))  # delta, epsilon (s)
LONGER, SHORTEST, ASIDE = 1.5, 4.0, 25.0  # the other waves of a state: ratios of wavenumbers, and degrees
DRIFT = 1.0  # m/s

# Half of this over the growth rate of the fastest wave, 0.0138/epsilon at delta = 0, lasts a run near a neutral wave.
NEUTRAL_DURATION = 30.0  # epsilon


@dataclass(frozen=True)
class Wave:
    """A plane wave in a cell of uniform strain.

    Attributes
    ----------
    wavenumber, wave_angle : 1/m, degrees from the axis of extension
    delta, epsilon : rate of dilation; perturbation (s)
    drift : m/s, of a simple shear along its streamlines; 0 for no spin and no drift
    """

    wavenumber: float
    wave_angle: float
    delta: float
    epsilon: float
    drift: float = 0.0


@dataclass(frozen=True, eq=False)
class Growth:
    """What D says of a wave and what the time-stepper does.

    Attributes
    ----------
    wave : the wave
    predicted : growth rate + i frequency of D (1/s)
    measured : (meshes, steps) the same from runs
    limit : what those tend to
    order_h, order_dt : observed against D, the other size extrapolated to zero
    """

    wave: Wave
    predicted: complex
    measured: np.ndarray
    limit: complex
    order_h: float
    order_dt: float

    @property
    def error(self) -> float:
        """The distance of the limit from D, relative to D."""
        return abs(self.limit - self.predicted) / abs(self.predicted)


def of_wave(parameters: dict, wave: Wave) -> dict:
    """Return the parameters of a wave's cell."""
    return parameters | {"delta": wave.delta, "epsilon": wave.epsilon}


def leading(closure: Any, parameters: dict, wave: Wave) -> complex:
    """Return growth rate + i frequency by D."""
    base = uniform(closure, of_wave(parameters, wave), wave.drift)
    return plane_wave(base, wave.wavenumber * unit(wave.wave_angle)).eigenvalue


def fastest(closure: Any, parameters: dict, delta: float, epsilon: float) -> Wave:
    """Return the fastest wave of a grid, no shorter than a third of sqrt(mu epsilon)."""
    base = uniform(closure, parameters | {"delta": delta, "epsilon": epsilon})
    q = np.geomspace(0.1, 3, 60) / np.sqrt(float(base.letters()["mu"]) * epsilon)
    angle = np.arange(0.0, 90.0, 0.5)
    growth = np.max(np.real(base.form(angle[:, None]).eigenvalues(q)), axis=0)
    i, j = np.unravel_index(np.argmax(growth), growth.shape)
    return Wave(float(q[j]), float(angle[i]), delta, epsilon)


def waves(closure: Any, parameters: dict, states: Sequence[tuple[float, float]] = STATES) -> list[Wave]:
    """Return four waves of each state (delta, epsilon), and two that drift with a simple shear.

    The fastest wave of the state and a longer one grow; one beyond the end of the unstable waves of the same direction,
    if that is not too far, and one 25 degrees off are outside.
    """
    found = []
    for delta, epsilon in states:
        best = fastest(closure, parameters, delta, epsilon)
        end = neutral(closure, parameters, best)
        beyond = np.fmin(1.3 * end, SHORTEST * best.wavenumber)
        found += [
            best,
            replace(best, wavenumber=best.wavenumber / LONGER),
            replace(best, wavenumber=float(beyond)),
            replace(best, wave_angle=best.wave_angle - ASIDE),
        ]
    drifting = replace(found[4], drift=DRIFT)
    return [*found, drifting, replace(drifting, wavenumber=2 * drifting.wavenumber)]


def neutral(closure: Any, parameters: dict, wave: Wave) -> float:
    """Return the wavenumber (1/m) beyond which waves of a direction decay (`neutral_curve`); NaN if there is none."""
    from stability.analyses.neutral_curve import neutral_curve

    ds = neutral_curve(closure, "uniform_strain", of_wave(parameters, wave), {}, [wave.wave_angle])
    ends = ds.neutral_wavenumber.values[0][ds.unstable_above.values[0] == 0]
    ends = ends[ends > wave.wavenumber]
    return float(ends[0]) if ends.size else float("nan")


def grown(
    closure: Any,
    parameters: dict,
    wave: Wave,
    cells: Sequence[int] = CELLS,
    numbers: Sequence[int] = STEPS,
    scheme: str = "backward_euler",
) -> Growth:
    """Return a wave's growth on several meshes and with several steps, against D."""
    given = of_wave(parameters, wave)
    args = closure, given, wave.wavenumber, wave.wave_angle
    found = np.array([[cell_growth(*args, c, n, drift=wave.drift, scheme=scheme) for n in numbers] for c in cells])
    predicted, h, dt = leading(closure, parameters, wave), 1 / np.array(cells), 1 / np.array(numbers)
    orders = {"backward_euler": ORDERS_DT, "bdf2": (2, 3)}[scheme][: len(numbers) - 1]
    without_dt = extrapolated(dt, found.T, orders)
    without_h = extrapolated(h, found, ORDERS_H[: len(cells) - 1])
    return Growth(
        wave=wave,
        predicted=predicted,
        measured=found,
        limit=complex(extrapolated(h, without_dt, ORDERS_H[: len(cells) - 1])),
        order_h=float(observed(h, without_dt - predicted)),
        order_dt=float(observed(dt, without_h - predicted)),
    )


def cell_table(
    closure: Any,
    parameters: dict,
    chosen: Sequence[Wave] | None = None,
    progress: Callable[[int, int], None] | None = None,
    **sizes: Any,
) -> list[Growth]:
    """Return `grown` of each wave; of those of `waves` where none are chosen."""
    chosen = waves(closure, parameters) if chosen is None else chosen
    found = []
    for i, wave in enumerate(chosen):
        found.append(grown(closure, parameters, wave, **sizes))
        if progress:
            progress(i + 1, len(chosen))
    return found


def cell_neutral(
    closure: Any, parameters: dict, wave: Wave, reach: float = 3.0, cells: Sequence[int] = CELLS, rtol: float = 1e-4
) -> float:
    """Return the wavenumber (1/m) at which a wave's growth in the time-stepper changes sign, in the wave's direction.

    Parameters
    ----------
    closure, parameters : as in `cell_table`
    wave : a growing one; the change of sign is looked for between it and waves ``reach`` times as short or shorter
    cells : in a wavelength; the growth rate is extrapolated over these and over two step sizes
    rtol : of the wavenumber
    """
    duration = NEUTRAL_DURATION * wave.epsilon
    h, numbers = 1 / np.array(cells), (2, 4)

    def growth(q: float) -> float:
        args = closure, of_wave(parameters, wave), q, wave.wave_angle
        found = np.array([[cell_growth(*args, c, n, duration, wave.drift) for n in numbers] for c in cells])
        limit = extrapolated(h, extrapolated(1 / np.array(numbers), found.T, (1,)), ORDERS_H[: len(cells) - 1])
        return float(np.real(limit))

    high = reach * wave.wavenumber
    while growth(high) > 0:
        high *= reach
    return float(brentq(growth, wave.wavenumber, high, rtol=rtol, xtol=rtol * wave.wavenumber))
