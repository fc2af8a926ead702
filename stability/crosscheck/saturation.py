"""What becomes of the fastest wave in a periodic cell once it is no longer small.

It stops to grow and ends as a steady band, which takes up most of the shear of the cell, between regions that are
stable. How thin the band is follows from the shortest waves inside: they grow until ||V|| is large enough.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from stability.crosscheck.cell import row_of
from stability.crosscheck.theory import PlaneWave, plane_wave, uniform, unit
from stability.crosscheck.waves import fastest, of_wave
from stability.errors import ConvergenceError
from stability.model import Base
from stability.timestepper.constraints import Constraints
from stability.timestepper.integrate import Control, start, steps
from stability.timestepper.law import Law
from stability.timestepper.linear import direct
from stability.timestepper.ordering import nested_dissection
from stability.timestepper.problem import Background, Problem

CELLS, STEPS = (32, 64, 128, 256), 150
DURATION = 700.0  # epsilon: ten times what the fastest wave needs to grow by e at delta = 0
SEED = 1e-2  # strain rate of the wave at the start, relative to that of the cell
FLOOR = 0.05  # 1/s


# Of the largest ||V|| in the cell: what lies above belongs to the band. Between bands ||V|| is a tenth of it or less.
BAND = 0.25

# Numbers of a run's course: unit and meaning.
NUMBERS = {
    "amplitude": ("m/s", "half the range of the velocity along the fronts"),
    "across": ("m/s", "half the range of the velocity across the fronts"),
    "thickness": ("m", "of the band: where ||V|| exceeds a quarter of its largest value"),
    "band_jump": ("m/s", "jump of the velocity along the fronts over the band"),
    "band_rate": ("1/s", "mean of ||V|| over the band"),
    "band_delta": ("1", "mean of delta over the band"),
    "trough_delta": ("1", "delta where the pressure is least"),
    "largest_delta": ("1", "largest delta in the cell"),
    "least_delta": ("1", "least delta in the cell"),
    "stable_share": ("1", "share of the cell with delta below -k/(2(1 + sqrt 2)), where no uniform flow is unstable"),
    "least_pressure": ("1", "least pressure over its mean"),
    "largest_pressure": ("1", "largest pressure over its mean"),
    "least_rate": ("1/s", "least ||V|| in the cell"),
    "below_floor": ("1", "share of the cell with ||V|| below the floor"),
}


@dataclass(frozen=True, eq=False)
class Course:
    """The course of one run, a row for each step kept.

    Attributes
    ----------
    cells, floor : in a wavelength; least ||V|| (1/s)
    wavelength : m
    time : (steps,) in s
    rows : (steps,) of each of `NUMBERS`
    profile : the last fields over ``x`` (m): velocity along and across the fronts, pressure at nodes, ||V||, delta
        between them
    ended : why the run ended before its time, or ""
    """

    cells: int
    floor: float
    wavelength: float
    time: np.ndarray
    rows: dict[str, np.ndarray]
    profile: dict[str, np.ndarray]
    ended: str


def stable_delta(k: float) -> float:
    """Return the delta below which D' of a uniform flow has no unstable wave."""
    return -k / (2 * (1 + np.sqrt(2)))


def band_rate(k: float, epsilon: float, delta: float) -> float:
    """Return the ||V|| (1/s) at which the shortest waves stop to grow in a uniform flow with 0 < delta < k.

    Their growth rate is ``delta (k - delta)/(epsilon (2 - delta^2)) - delta ||V||``, whose second part comes from the
    term -grad u of D, which D' leaves out.
    """
    return (k - delta) / (epsilon * (2 - delta**2))


def band_thickness(k: float, epsilon: float, delta: float, jump: float) -> float:
    """Return the thickness (m) of a band of that ||V|| with a given jump (m/s) of the velocity along it.

    In the band the flow along the fronts has no strain: ``||V||^2 = V_nn^2 + 2 V_nt^2`` with ``V_nn = delta ||V||``.
    """
    slope = 2 * np.sqrt((1 - delta**2) / 2) * band_rate(k, epsilon, delta)
    return jump / slope


class Level:
    """The pressure at the first node that keeps the mean over the cell at zero, known from the step before."""

    def __init__(self, value: float) -> None:
        self.value = value

    def __call__(self, time: float) -> np.ndarray:
        """Return the values that a constraint prescribes."""
        return np.array([0.0, 0.0, self.value])

    def follow(self, q: np.ndarray) -> None:
        """Take the mean of a state off."""
        self.value = float(q[0, 2] - q[:, 2].mean())


def looked_at(problem: Problem, q: np.ndarray, normal: np.ndarray) -> tuple[dict[str, float], dict[str, np.ndarray]]:
    """Return the numbers of `Course` and the profiles of a state of a cell along a direction."""
    background = problem.background
    assert background is not None
    tangent = np.array([-normal[1], normal[0]])
    x = problem.mesh.nodes @ normal
    along, across, pressure = q[:, :2] @ tangent, q[:, :2] @ normal, background.pressure + q[:, 2]
    _, g = problem.at_faces(q)
    g = g[:, :, 0]  # faces 0 and 2 lie in the middles of the cell's edges; without slopes across all faces agree
    rate = problem.law.strain_rate_norm(g)
    delta = (g[0, 0] + g[1, 1]) / rate
    between = (pressure + np.roll(pressure, -1)) / 2
    size = problem.volume.sum() / np.ptp(problem.mesh.corners @ tangent) / x.size
    slope = np.abs(np.roll(along, -1) - along) / size
    band = rate > BAND * rate.max()
    numbers = {
        "amplitude": np.ptp(along) / 2,
        "across": np.ptp(across) / 2,
        "thickness": size * band.sum(),
        "band_jump": size * slope[band].sum(),
        "band_rate": rate[band].mean(),
        "band_delta": delta[band].mean(),
        "trough_delta": delta[np.argmin(between)],
        "largest_delta": delta.max(),
        "least_delta": delta.min(),
        "stable_share": np.mean(delta < stable_delta(np.sqrt(2) * np.sin(problem.law.parameters["friction_angle"]))),
        "least_pressure": pressure.min() / pressure.mean(),
        "largest_pressure": pressure.max() / pressure.mean(),
        "least_rate": rate.min(),
        "below_floor": np.mean(rate < problem.law.floor),
    }
    profile = {"x": x, "along": along, "across": across, "pressure": pressure, "rate": rate, "delta": delta}
    return {n: float(v) for n, v in numbers.items()}, profile


def run_from(base: Base, wave: PlaneWave, cells: int, floor: float, seed: float) -> tuple[Problem, Level]:
    """Return the problem that begins with a wave, and what keeps its mean pressure."""
    mesh = row_of(wave, cells)
    strain, q = float(base.letters()["N"]), np.hypot(*wave.wavevector)
    (_, gradient, _), (pressure, *_) = base.state
    phase = np.exp(1j * mesh.nodes @ wave.wavevector)
    initial = seed * strain / q * (phase[:, None] * wave.field).real
    level = Level(float(initial[0, 2]))
    problem = Problem(
        mesh=mesh,
        law=Law(base.model.closure, base.parameters, floor=floor),
        initial=initial,
        scales=np.array([strain / q, strain / q, float(pressure)]),
        constraints=Constraints(np.array([0]), np.eye(3)[None], np.array([[False, False, True]]), level),
        background=Background(np.array(gradient, dtype=float), float(pressure)),
    )
    return problem, level


def saturated(
    base: Base, wave: PlaneWave, cells: int, duration: float, dt: float, floor: float = FLOOR, seed: float = SEED
) -> Course:
    """Return the course of one run that begins with a wave of a base state and ends where Newton's method does."""
    problem, level = run_from(base, wave, cells, floor, seed)
    normal = wave.wavevector / np.hypot(*wave.wavevector)
    control = Control(first=dt, largest=dt, smallest=dt / 1000)
    factorise = direct(nested_dissection(problem.mesh.logical, problem.mesh.elements))
    numbers, profile = looked_at(problem, problem.initial, normal)
    kept, times, ended = [numbers], [0.0], ""
    try:
        for state, _ in steps(problem, start(problem, control), control, [duration], factorise):
            level.follow(state.q)
            numbers, profile = looked_at(problem, state.q, normal)
            kept.append(numbers)
            times.append(state.time)
    except ConvergenceError as error:
        ended = str(error)
    rows = {name: np.array([row[name] for row in kept]) for name in NUMBERS}
    return Course(cells, floor, 2 * np.pi / np.hypot(*wave.wavevector), np.array(times), rows, profile, ended)


def saturation(
    closure: Any,
    parameters: dict,
    delta: float = 0.0,
    epsilon: float = 1e-4,
    cells: Sequence[int] = CELLS,
    duration: float | None = None,
    number: int = STEPS,
    floor: float = FLOOR,
    seed: float = SEED,
    progress: Callable[[int, int], None] | None = None,
) -> list[Course]:
    """Return the courses of the fastest wave of a uniform flow on several meshes.

    Parameters
    ----------
    closure, parameters : words of the closure and of the flow "uniform_strain"
    delta, epsilon : of the uniform flow; the perturbation (s)
    cells : of each mesh, in a wavelength
    duration, number : of the run (s; `DURATION` times epsilon where it is not given), and how many steps it has
    floor, seed : least ||V|| (1/s); strain rate of the wave at the start, relative to that of the flow
    """
    found, wave = [], fastest(closure, parameters, delta, epsilon)
    base = uniform(closure, of_wave(parameters, wave))
    mode = plane_wave(base, wave.wavenumber * unit(wave.wave_angle))
    duration = DURATION * epsilon if duration is None else duration
    for i, n in enumerate(cells):
        found.append(saturated(base, mode, n, duration, duration / number, floor, seed))
        if progress:
            progress(i + 1, len(cells))
    return found
