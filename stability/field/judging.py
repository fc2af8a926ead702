"""The verdict on many base states at once, the fastest wave of each, and the fastest of the mesh's shortest waves.

Stage 1  the leading symbol over all directions: does growth rise without bound, as |xi|^n with n > 0?
Stage 2  elsewhere the growth of waves far beyond the scale at which lower orders matter, null directions included: the
         law of two such wavelengths
Stage 3  the fastest wave of any length from the field's size down to that scale
Stage 4  the fastest wave of the length that the mesh resolves least

A point is undecided where no sign can be told from rounding, and where a constraint leaves a wave undetermined (a pole
of the growth rate, which a search runs into or misses by chance).

In float64 and over samples: `stability.well_posedness` decides single points in certified arithmetic.
"""

from dataclasses import dataclass, fields
from typing import Any

import numpy as np

from stability.field.guides import Guide, guide
from stability.field.search import Fastest, fastest
from stability.field.waves import Waves, waves_of
from stability.finite import leading
from stability.model import Base

ROUNDING = 1e-9  # of the largest root: a growing coefficient below this is rounding, as in `symbolmap`
# Times the scale: corrections to the law of short waves are then 1e-4 and 1e-6, or 1e-2 and 1e-3 where they are linear.
SHORT, SHORTER = 100.0, 1000.0
# Times the scale: the search for the fastest wave ends there. At delta = 0 it lies at 0.8, and growth that approaches
# a bound is within 1e-3 of it.
REACH = 30.0
NEAR = 1e-7  # of the largest eigenvalue: the roundings of a search, 1e-15 or so of it, are then 1e-8 of a growth rate
NOISE = {True: 1e-13, False: 1e-11}  # of the largest eigenvalue: a sign below it is undecided; computed again, or not
CODES = ("masked", "stable", "finite", "bounded", "ill-posed", "undecided")
_, STABLE, FINITE, BOUNDED, ILL, UNDECIDED = range(len(CODES))
SIXTH = 6  # exponents are fractions with denominators up to the number of modes or so


@dataclass(frozen=True)
class Judged:
    """What is found at each point, arrays of one length.

    Attributes
    ----------
    code : index into `CODES`: nothing grows; waves of finite length only; short waves at a bounded rate; without bound
    exponent, coefficient : of ``sup Re lambda ~ coefficient |xi|^exponent`` over short waves that grow, else NaN
    growth, wavelength, angle : the fastest wave of all, 1/s, m and degrees; inf and 0 where growth has no bound
    grid_growth, grid_angle : the fastest wave of the mesh's shortest length
    """

    code: np.ndarray
    exponent: np.ndarray
    coefficient: np.ndarray
    growth: np.ndarray
    wavelength: np.ndarray
    angle: np.ndarray
    grid_growth: np.ndarray
    grid_angle: np.ndarray

    @classmethod
    def empty(cls, size: int) -> "Judged":
        """Return room for that many points, masked."""
        nan = (np.full(size, np.nan) for _ in range(len(fields(cls)) - 1))
        return cls(np.zeros(size, np.int8), *nan)

    def put(self, index: Any, other: "Judged") -> None:
        """Copy results to some points."""
        for f in fields(self):
            getattr(self, f.name)[index] = getattr(other, f.name)


@dataclass(frozen=True)
class Short:
    """What short waves do: code (3 to 5, 1 where none grows), the law, its direction in radians, and the scale."""

    code: np.ndarray
    exponent: np.ndarray
    coefficient: np.ndarray
    angle: np.ndarray
    scale: np.ndarray


def judged(base: Base, count: int, longest: float, grid: np.ndarray) -> Judged:
    """Return everything about the base states of some points.

    Parameters
    ----------
    longest : m, the longest wave that is looked at
    grid : m, the wavelength at each point that the mesh resolves least
    """
    waves, hint = waves_of(base, count), guide(base, count)
    short = short_waves(base, waves, hint)
    found = Judged.empty(count)
    low, finest = np.full(count, 2 * np.pi / longest), 2 * np.pi / grid
    mesh = fastest(waves, hint, finest, finest)
    found.grid_growth[:] = settled(base, np.arange(count), mesh, waves.bound(finest))[0]
    found.grid_angle[:] = np.rad2deg(mesh.angle)
    for name in ("code", "exponent", "coefficient"):
        getattr(found, name)[:] = getattr(short, name)
    ill = short.code == ILL
    found.growth[ill], found.wavelength[ill], found.angle[ill] = np.inf, 0.0, np.rad2deg(short.angle[ill])
    some = np.flatnonzero(~ill)
    if some.size:
        high = np.fmax(np.fmax(REACH * short.scale[some], finest[some]), 10 * low[some])
        states = waves.take(some)
        best = fastest(states, hint.take(some), low[some], high)
        growth = settled(base, some, best, states.bound(best.wavenumber))[0]
        shortest = (short.exponent[some] == 0) & (short.coefficient[some] >= growth)
        found.growth[some] = np.where(shortest, short.coefficient[some], growth)
        found.wavelength[some] = np.where(shortest, 0.0, 2 * np.pi / best.wavenumber)
        found.angle[some] = np.rad2deg(np.where(shortest, short.angle[some], best.angle))
        band = (short.code[some] == STABLE) & (found.growth[some] > 0)
        found.code[some] = np.where(band, FINITE, short.code[some])
        found.growth[some[states.poles(low[some], high)]] = np.nan
    lost = ~np.isfinite(found.grid_growth) | np.isnan(found.growth) | (found.growth == -np.inf)
    found.code[lost] = UNDECIDED
    for values in (found.growth, found.wavelength, found.angle):
        values[found.code == UNDECIDED] = np.nan
    for angle in (found.angle, found.grid_angle):
        angle %= 180
    return found


def short_waves(base: Base, waves: Waves, hint: Guide) -> Short:
    """Return what short waves do at every point: stages 1 and 2."""
    count, one = waves.count, np.ones(waves.count)
    scale, nan = waves.scale(), np.full(count, np.nan)
    found = Short(np.full(count, STABLE), nan, nan.copy(), np.zeros(count), scale)
    rest = np.arange(count)
    for edge in [] if hint.never else waves.edges:
        if not rest.size:
            return found
        edged, unit = waves.along(edge).take(rest), one[rest]
        first = fastest(edged, hint.take(rest).leading(), unit, unit)
        grows = first.growth > ROUNDING * edged.bound(unit)
        some = rest[grows]
        found.code[some], found.exponent[some] = ILL, float(edge.exponent)
        found.coefficient[some], found.angle[some] = first.growth[grows], first.angle[grows]
        rest = rest[~grows]
    if rest.size:
        limits(base, waves, hint, rest, found)
    return found


def limits(base: Base, waves: Waves, hint: Guide, some: np.ndarray, found: Short) -> None:
    """Put what short waves do where no edge of the polygon makes them grow without bound: stage 2."""
    near, q = hint.take(some), SHORT * found.scale[some]
    states = waves.take(some)
    best = fastest(states, near, q, q, watch=False)
    one, rough = settled(base, some, best, states.bound(q))
    grows, two = one > rough, np.full(some.size, np.nan)
    if grows.any():  # the law of those that grow, from a second wavenumber
        some_, other, q_two = some[grows], states.take(grows), SHORTER * found.scale[some[grows]]
        shorter = fastest(other, near.take(grows), q_two, q_two, watch=False)
        two[grows] = settled(base, some_, shorter, other.bound(q_two))[0]
    with np.errstate(all="ignore"):
        n = np.log(two / one) / np.log(SHORTER / SHORT)
        n = np.round(SIXTH * n) / SIXTH + 0.0  # no negative zero
        found.exponent[some] = np.where(grows & (two > 0), n, np.nan)
        found.coefficient[some] = np.where(grows & (two > 0), two * (SHORTER * found.scale[some]) ** -n, np.nan)
    found.code[some] = np.where(grows, np.where(n > 0, ILL, BOUNDED), np.where(one > -rough, UNDECIDED, STABLE))
    found.code[some[~np.isfinite(one)]] = UNDECIDED
    found.angle[some] = best.angle


def settled(base: Base, index: np.ndarray, wave: Fastest, size: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return growth rates, computed again as `stability.eigenvalues` does where roundings count, and what they may be.

    Parameters
    ----------
    size : of the largest eigenvalue of each wave
    """
    growth = wave.growth.copy()
    if not base.model.closed:
        return growth, NOISE[False] * size
    near = np.flatnonzero(~(abs(growth) > NEAR * size))
    if near.size:
        form = base.at(index[near]).form(np.rad2deg(wave.angle[near])).filled(near.size)
        with np.errstate(all="ignore"):
            growth[near] = leading(form.eigenvalues(wave.wavenumber[near]))
    return growth, NOISE[True] * size
