"""The least value of a regularising parameter that cures a point of a flow, between two values that were evaluated."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from math import inf, isfinite, sqrt
from typing import Any

import numpy as np

from stability.api import eigenvalues
from stability.errors import SceneError
from stability.field.guides import guide
from stability.field.judging import short_waves
from stability.field.search import fastest
from stability.field.waves import waves_of
from stability.judge import well_posedness
from stability.model import Base, Model
from stability.verdict import Kind

SCAN = 61  # values tried between the ends of the bracket, for the first one from which all larger ones cure
RANGE = (1e-15, 1e15)  # of an open range without a bound
CERTIFY_RTOL = 1e-9  # of the one eigenvalue that shows growth at the lower end
UNKNOWN = (float("nan"), float("nan"), float("nan"))
SHORTEST, LONGEST = 30.0, 1e-3  # times the scale of the pencil: between them the fastest wave is looked for


@dataclass(frozen=True)
class Cure:
    """A regularising parameter at the edge of what cures.

    Attributes
    ----------
    parameter, unit : which one
    below, above : it does not cure at ``below`` and does at ``above``; they differ by ``rtol`` at most
    growth_below, growth_above : largest growth rates there, 1/s; inf where short waves grow without bound
    wavenumber, wave_angle, band_width : the fastest wave at ``above``, 1/m and degrees, and its length in m; None where
        no wave was found to grow
    certified : (below, above): which end was decided in ball arithmetic
    notes : what the rest rests on
    """

    parameter: str
    unit: str
    below: float
    above: float
    growth_below: float
    growth_above: float
    wavenumber: float | None
    wave_angle: float | None
    band_width: float | None
    certified: tuple[bool, bool]
    notes: tuple[str, ...]

    def __str__(self) -> str:
        """Return the cure as sentences."""
        text = f"{self.parameter} >= {self.above:.10g} {self.unit} cures, {self.below:.10g} does not"
        if self.band_width is not None:
            text += f"; bands of {self.band_width:.4g} m remain, growing at {self.growth_above:.4g} 1/s"
        ends = " and ".join(w for w, on in zip(("lower", "upper"), self.certified, strict=True) if on)
        return f"{text}. Certified: {f'the {ends} end' if ends else 'neither end'}. {' '.join(self.notes)}".rstrip()


@dataclass(frozen=True)
class Point:
    """The point of a flow with one parameter open."""

    closure: Any
    flow: Any
    parameters: Mapping
    point: Mapping
    parameter: str

    def given(self, value: float) -> dict:
        """Return all parameters."""
        return {**self.parameters, self.parameter: value}

    def base(self, value: float) -> Base:
        """Return the base state."""
        return Model(self.closure, self.flow).base(self.given(value), self.point)


def smallest_cure(
    closure: Any,
    flow: Any,
    parameters: Mapping,
    point: Mapping,
    parameter: str = "epsilon",
    growth: float = 0.0,
    rtol: float = 1e-6,
    bracket: tuple[float, float] | None = None,
) -> Cure:
    """Return the least value of a parameter that makes a point stable to short waves, or bounds the growth of all.

    Parameters
    ----------
    closure, flow, parameters, point : as in `stability.well_posedness`; ``parameters`` without the open one
    parameter : word of the closure's parameter that regularises: ``epsilon``, ``kinematic_viscosity``,
        ``hyperviscosity``, ...
    growth : 1/s. 0: no short wave may grow, which ball arithmetic decides. More: no wave of any length may grow faster
    rtol : how close the two ends of the answer are, relative
    bracket : values between which to look; None: the parameter's range

    Returns
    -------
    `Cure`. With ``growth`` 0 both ends are certified where the verdict is. Else the lower end is: one wave that grows
    faster, enclosed in balls; the upper end is a search over all waves, which is not a proof.

    Raises
    ------
    SceneError : no such parameter, no value that cures, or every value cures
    """
    model = Model(closure, flow)
    record = model.parameters.get(parameter)
    if record is None:
        raise SceneError(f"parameter {parameter} is unknown here; known are {', '.join(sorted(model.parameters))}")
    if not (isfinite(growth) and growth >= 0):
        raise SceneError(f"growth = {growth!r} 1/s lies outside [0, inf) 1/s")
    if not 1e-14 <= rtol < 1:
        raise SceneError(f"rtol = {rtol!r} lies outside [1e-14, 1): float64 holds no more digits")
    if bracket is None:
        bracket = max(record.low, RANGE[0]), min(record.high, RANGE[1]) * (1 - 1e-12)
    if not 0 < bracket[0] < bracket[1]:
        raise SceneError(f"bracket = {bracket!r}: give two increasing positive numbers")
    at = Point(closure, flow, parameters, point, parameter)
    at.base(sqrt(bracket[0] * bracket[1]))  # everything that is wrong with the question is said here

    def cures(value: float) -> bool:
        return largest(at, value, growth > 0)[0] <= growth

    low, high = edge(cures, *bracket, record.described, growth)
    if low:
        low, high = halved(cures, low, high, rtol)
    if growth == 0:
        return decided(at, low, high, rtol, record.unit)
    below, above = largest(at, low, True) if low else UNKNOWN, largest(at, high, True)
    proved = bool(low) and proves(at, low, below, growth)
    note = "The upper end is a search over all waves in float64, not a proof."
    q = above[1] if above[0] > 0 else None
    return Cure(parameter, record.unit, low, high, below[0], above[0], q, above[2] if q else None,
                2 * np.pi / q if q else None, (proved, False), (note,))  # fmt: skip


def largest(at: Point, value: float, every: bool) -> tuple[float, float, float]:
    """Return growth rate (inf: without bound), wavenumber and angle of the fastest wave; of short ones unless every."""
    base = at.base(value)
    waves, hint = waves_of(base, 1), guide(base, 1)
    short = short_waves(base, waves, hint)
    if short.code[0] == 4:
        return inf, inf, float(np.rad2deg(short.angle[0]))
    law = float(np.nan_to_num(short.coefficient[0])) if short.exponent[0] == 0 else 0.0
    if not every:
        return (1.0 if short.code[0] == 3 else -1.0), inf, float(np.rad2deg(short.angle[0]))
    scale = short.scale
    best = fastest(waves, hint, LONGEST * scale, SHORTEST * scale)
    if law > best.growth[0]:
        return law, inf, float(np.rad2deg(short.angle[0]))
    return float(best.growth[0]), float(best.wavenumber[0]), float(np.rad2deg(best.angle[0]))


def edge(cures: Callable, low: float, high: float, described: str, growth: float) -> tuple[float, float]:
    """Return two neighbours of a scan, the last value that does not cure and the next one; 0 where all do."""
    values = np.geomspace(low, high, SCAN)
    cured = [cures(float(v)) for v in values]
    if not cured[-1]:
        what = "makes short waves decay" if growth == 0 else f"keeps the growth of every wave within {growth:g} 1/s"
        raise SceneError(f"no value from {low:g} to {high:g} of {described} {what}")
    failing = [i for i, on in enumerate(cured) if not on]
    return (float(values[failing[-1]]), float(values[failing[-1] + 1])) if failing else (0.0, low)


def halved(cures: Callable, low: float, high: float, rtol: float) -> tuple[float, float]:
    """Return the ends of the bracket after bisection in the logarithm."""
    while high / low - 1 > rtol:
        middle = sqrt(low) * sqrt(high)
        if not low < middle < high:
            break
        low, high = (low, middle) if cures(middle) else (middle, high)
    return low, high


def decided(at: Point, low: float, high: float, rtol: float, unit: str) -> Cure:
    """Return the cure of short waves with both ends decided by `well_posedness`, from a bracket found in float64.

    Where float64 was wrong about an end, that end gives way by twice as much each time, and balls bisect.
    """
    notes = []

    def verdict(value: float) -> Any:
        return well_posedness(at.closure, at.flow, at.given(value), dict(at.point))

    below, above = verdict(low) if low else None, verdict(high)
    step = rtol
    while below is not None and below.kind is Kind.STABLE:
        low *= 1 - step
        below, step = verdict(low), 2 * step
        if step > 0.5:
            raise SceneError(f"{at.parameter}: float64 and balls disagree about where short waves start to grow")
    step = rtol
    while above.kind is not Kind.STABLE:
        high *= 1 + step
        above, step = verdict(high), 2 * step
        if step > 0.5:
            raise SceneError(f"{at.parameter}: at {high:g} {unit} short waves are {above.kind}, in balls: no cure")
    while below is not None and high / low - 1 > 2 * rtol:
        middle = sqrt(low) * sqrt(high)
        found = verdict(middle)
        if found.kind is Kind.STABLE:
            high, above = middle, found
        else:
            low, below = middle, found
    if below is None:
        notes.append(f"Every value from {high:g} {unit} on cures: short waves need some of it, not how much.")
    finite = above.finite if above.finite and above.finite[0] > 0 else None
    if finite and finite[0] <= strain_rate(at.base(high)):
        notes.append("What still grows does so no faster than ||V||: the kinematics of the longest waves.")
        finite = None
    growth_below = UNKNOWN[0] if below is None else inf if below.kind is Kind.ILL_POSED else float(below.coefficient)
    return Cure(
        at.parameter, unit, low, high, growth_below, above.finite[0] if above.finite else 0.0,
        finite[1] if finite else None, finite[2] if finite else None, 2 * np.pi / finite[1] if finite else None,
        (below is not None and below.certified, above.certified), tuple(notes),
    )  # fmt: skip


def strain_rate(base: Base) -> float:
    """Return ||V||."""
    ((u_x, u_y), (v_x, v_y)) = base.state[0][1]
    return float(sqrt(u_x**2 + v_y**2 + (u_y + v_x) ** 2 / 2))


def proves(at: Point, value: float, wave: tuple[float, float, float], growth: float) -> bool:
    """Return whether one wave's enclosed growth rate exceeds the bound: then no smaller bound holds at that value."""
    _, wavenumber, angle = wave
    if not isfinite(wavenumber):
        return well_posedness(at.closure, at.flow, at.given(value), dict(at.point)).certified
    if not Model(at.closure, at.flow).closed:
        return False
    found = eigenvalues(at.closure, at.flow, at.given(value), dict(at.point), wavenumber, angle, rtol=CERTIFY_RTOL)
    return bool(found[0].real * (1 - CERTIFY_RTOL) > growth)
