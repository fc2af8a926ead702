"""A point of a flow with one parameter open: which waves grow at a value of it, in float64 and in balls."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from math import ceil, inf, isfinite, log10, nan, pi
from typing import Any

import numpy as np

from stability.api import eigenvalues
from stability.directions import Directions
from stability.errors import PrecisionError
from stability.field.guides import guide
from stability.field.judging import short_waves
from stability.field.search import fastest
from stability.field.waves import waves_of
from stability.judge import BITS, ball_base, well_posedness
from stability.model import Base, Model
from stability.puiseux import Numbers, clusters
from stability.verdict import Kind, Verdict

DECAYS, GROWS, ILL = 1, 3, 4  # codes of `short_waves`
SHORTEST, LONGEST = 30.0, 1e-3  # times the scale of the pencil: between them the fastest wave is looked for ...
PARTS = 2  # ... in parts of a decade: one search of it all took the plateau of long waves for the hill beside it
NEAR = 0.01  # of the bound: there the growth of the shortest waves, in float64 good to 1e-4, is taken from balls
LONGER, ALIKE = 10.0, 0.99  # a wave so much longer that grows so nearly as fast has the same cause

Wave = tuple[float, float, float]  # growth rate (inf: without bound), wavenumber (inf: the shortest), angle


@dataclass(frozen=True)
class Point:
    """The point of a flow with one parameter open."""

    closure: Any
    flow: Any
    parameters: Mapping
    point: Mapping
    parameter: str
    longest: float | None = None
    known: dict[float, Verdict] = field(default_factory=dict, compare=False, repr=False)

    def given(self, value: float) -> dict:
        """Return all parameters."""
        return {**self.parameters, self.parameter: value}

    def base(self, value: float) -> Base:
        """Return the base state."""
        return Model(self.closure, self.flow).base(self.given(value), self.point)

    def lowest(self, value: float, scale: float) -> float:
        """Return the wavenumber of the longest wave that is looked at."""
        if self.longest is not None:
            return 2 * pi / self.longest
        fields = [jet for jet in self.base(value).state if not isinstance(jet[0], tuple)]
        return max(LONGEST * scale, *(2 * pi * float(np.hypot(*slope) / abs(f)) for f, slope, _ in fields if f))

    def verdict(self, value: float) -> Verdict:
        """Return what short waves do, in ball arithmetic."""
        if value not in self.known:
            self.known[value] = well_posedness(self.closure, self.flow, self.given(value), dict(self.point))
        return self.known[value]


def decays(at: Point, value: float) -> bool:
    """Return whether no short wave grows: in float64 where that is clear, else in balls.

    Not clear are rates too small to have a sign, and growth that falls off: waves short enough for a law may be far.
    """
    base = at.base(value)
    short = short_waves(base, waves_of(base, 1), guide(base, 1))
    clear = short.code[0] in (DECAYS, ILL) or (short.code[0] == GROWS and short.exponent[0] == 0)
    return bool(short.code[0] == DECAYS) if clear else stable(at, value)


def stable(at: Point, value: float) -> bool:
    """Return whether no short wave grows, in balls."""
    return at.verdict(value).kind is Kind.STABLE


def largest(at: Point, value: float, bound: float = 0.0) -> Wave:
    """Return the fastest wave of any length; ``bound`` is the growth rate near which digits matter."""
    base = at.base(value)
    waves, hint = waves_of(base, 1), guide(base, 1)
    short = short_waves(base, waves, hint)
    angle, scale = float(np.rad2deg(short.angle[0])), float(short.scale[0])
    if short.code[0] == ILL:
        return inf, inf, angle
    low = at.lowest(value, scale)
    high = max(SHORTEST * scale, 10 * low)
    ends = np.geomspace(low, high, 1 + ceil(PARTS * log10(high / low)))
    copies = np.zeros(ends.size - 1, int)
    found = fastest(waves.take(copies), hint.take(copies), ends[:-1], ends[1:])
    best = int(np.argmax(found.growth))
    law = float(np.nan_to_num(short.coefficient[0])) if short.exponent[0] == 0 else 0.0
    if abs(law - bound) < NEAR * bound:
        law = limit(at.verdict(value), law)
    if law > found.growth[best]:
        return law, inf, angle
    return float(found.growth[best]), float(found.wavenumber[best]), float(np.rad2deg(found.angle[best]))


def limit(found: Verdict, otherwise: float = -inf) -> float:
    """Return the growth rate of the shortest waves where it tends to one, 1/s."""
    return float(found.coefficient) if found.exponent == 0 and found.coefficient is not None else otherwise


def fastest_of(found: Verdict) -> float:
    """Return the largest growth rate that a verdict knows of, 1/s; NaN if none."""
    if found.kind in (Kind.ILL_POSED, Kind.SINGULAR):
        return inf
    rate = max(found.finite[0] if found.finite else -inf, limit(found))
    return rate if rate > -inf else nan


def endless(at: Point, value: float, wave: Wave) -> bool:
    """Return whether a longer wave of that direction grows as fast, or none was looked at: no length is singled out."""
    rate, wavenumber, angle = wave
    if not isfinite(wavenumber):
        return False
    scale = float(waves_of(at.base(value), 1).scale()[0])
    if wavenumber <= at.lowest(value, scale) * (1 + 1e-9):
        return True
    longer = eigenvalues(at.closure, at.flow, at.given(value), dict(at.point), wavenumber / LONGER, angle)
    return bool(longer[0].real >= ALIKE * rate)


def exceeds(at: Point, value: float, wave: Wave, growth: float) -> bool:
    """Return whether it is certain that some wave grows faster than the bound: this one, or short ones in the end."""
    _, wavenumber, angle = wave
    if isfinite(wavenumber):
        return enclosed(at, value, wavenumber, angle) > growth
    found = at.verdict(value)
    grows = found.kind is Kind.ILL_POSED or (found.kind is Kind.BOUNDED and fastest_of(found) > growth)
    return found.certified and grows


def enclosed(at: Point, value: float, wavenumber: float, angle: float) -> float:
    """Return a certain lower bound of one wave's largest growth rate, -inf if there is none.

    From the discs that hold the roots of det(lambda E - L), so for any closure: k of them that overlap hold k roots.
    """
    base = ball_base(at.closure, at.flow, at.given(value), dict(at.point), BITS[0])
    d = Directions(base.model.evolves, base.pencil(), Numbers(base.model.arithmetic, BITS[0]))
    q = d.numbers.exactly(wavenumber)
    powers: dict[int, Any] = {}
    for (j, m, _), c in d.along(angle).items():
        powers[j] = powers.get(j, 0 * c) + c * q ** int(m)
    zero = d.numbers.complexly(d.numbers.mp.mpc(0))
    try:
        discs = d.numbers.roots([powers.get(j, zero) for j in range(max(powers) + 1)])
    except (ArithmeticError, PrecisionError):
        return -inf
    return float(max((z.real - r for z, r, _ in clusters(discs)), default=-inf))
