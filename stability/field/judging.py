"""The verdict on many base states at once, the fastest wave of each, and the fastest of the mesh's shortest waves.

Stage 1  the leading symbol over all directions: does growth rise without bound, as |xi|^n with n > 0?
Stage 2  elsewhere the growth of waves far beyond the scale at which lower orders matter, null directions included
Stage 3  the fastest wave of any length from the field's size down to that scale
Stage 4  the fastest wave of the length that the mesh resolves least

In float64 and over samples: `stability.well_posedness` decides single points in certified arithmetic.
"""

from dataclasses import dataclass, fields
from typing import Any

import numpy as np

from stability import polynomials
from stability.field.guides import Guide, guide
from stability.field.search import SPARSE, fan, fastest
from stability.field.waves import Closed, Waves, waves_of
from stability.finite import leading
from stability.model import Base
from stability.symbolmap import of_base

ROUNDING = 1e-9  # of the leading symbol's entries: a growing coefficient below this is rounding, as in `symbolmap`
SHORT, SHORTER = 100.0, 1000.0  # times the scale: corrections to the law of short waves are then 1e-4 and 1e-6
# Times the scale: the search for the fastest wave ends there. At delta = 0 it lies at 0.8, and growth that approaches
# a bound is within 1e-3 of it.
REACH = 30.0
NOISE = {True: 1e-13, False: 1e-11}  # of mu q^2: a sign below it is undecided; closed forms and `eigvals`
CODES = ("masked", "stable", "finite", "bounded", "ill-posed", "undecided")


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
    found.grid_growth[:] = exact(base, np.arange(count), mesh.angle, finest, mesh.growth)
    found.grid_angle[:] = np.rad2deg(mesh.angle)
    for name in ("code", "exponent", "coefficient"):
        getattr(found, name)[:] = getattr(short, name)
    ill = short.code == 4
    found.growth[ill], found.wavelength[ill], found.angle[ill] = np.inf, 0.0, np.rad2deg(short.angle[ill])
    some = np.flatnonzero(~ill)
    if some.size:
        high = np.fmax(np.fmax(REACH * short.scale[some], finest[some]), 10 * low[some])
        best = fastest(waves.take(some), hint.take(some), low[some], high)
        growth = exact(base, some, best.angle, best.wavenumber, best.growth)
        shortest = (short.exponent[some] == 0) & (short.coefficient[some] >= growth)
        found.growth[some] = np.where(shortest, short.coefficient[some], growth)
        found.wavelength[some] = np.where(shortest, 0.0, 2 * np.pi / best.wavenumber)
        found.angle[some] = np.rad2deg(np.where(shortest, short.angle[some], best.angle))
        found.code[some] = np.where((short.code[some] == 1) & (found.growth[some] > 0), 2, short.code[some])
    lost = ~np.isfinite(found.grid_growth) | np.isnan(found.growth) | (found.growth == -np.inf)
    found.code[lost] = CODES.index("undecided")
    return found


def exact(base: Base, index: np.ndarray, angle: np.ndarray, wavenumber: np.ndarray, search: np.ndarray) -> np.ndarray:
    """Return the growth rates of single waves as `stability.eigenvalues` computes them."""
    if not base.model.closed:
        return search
    form = base.at(index).form(np.rad2deg(angle)).filled(index.size)
    with np.errstate(all="ignore"):
        return leading(form.eigenvalues(wavenumber))


def short_waves(base: Base, waves: Waves, hint: Guide) -> Short:
    """Return what short waves do at every point: stages 1 and 2."""
    count, one = waves.count, np.ones(waves.count)
    if isinstance(waves, Closed):
        size = np.abs(waves.tensors.C[2]).max(axis=1)
        exponent, coefficient, angle = 2 * one, 0 * one, 0 * one
        if not hint.never:
            first = fastest(waves.leading(), hint.leading(), one, one)
            coefficient, angle = first.growth, first.angle
        ill = coefficient > ROUNDING * size
        scale = one if ill.all() else waves.scale(np.broadcast_to(fan(SPARSE), (count, SPARSE)))
    else:
        symbol = of_base(base, (count,))
        exponent, coefficient, angle = symbol.exponent, symbol.coefficient, np.deg2rad(symbol.wave_angle)
        ill = (symbol.exponent > 0) & (symbol.coefficient > 0)
        scale, size = balance(base, count), 0 * one
    found = Short(np.where(ill, 4, 1), np.where(ill, exponent, np.nan), np.where(ill, coefficient, np.nan),
                  angle.copy(), scale)  # fmt: skip
    some = np.flatnonzero(~ill)
    if not some.size:
        return found
    near, q = hint.take(some), SHORT * scale[some]
    best = fastest(waves.take(some), near, q, q, watch=False)
    one_ = exact(base, some, best.angle, q, best.growth)
    rough = NOISE[base.model.closed] * size[some] * q**2
    grows, two = one_ > rough, np.full(some.size, np.nan)
    if grows.any():  # the law of those that grow, from a second wavenumber
        again, q_two = some[grows], SHORTER * scale[some[grows]]
        other = fastest(waves.take(again), near.take(grows), q_two, q_two, watch=False)
        two[grows] = exact(base, again, other.angle, q_two, other.growth)
    with np.errstate(all="ignore"):
        n = np.round(np.log(two / one_) / np.log(SHORTER / SHORT)) + 0.0  # no negative zero
    found.code[some] = np.where(grows, 3, np.where(one_ > -rough, 5, 1))
    found.code[some[~np.isfinite(one_)]] = 5
    found.exponent[some] = np.where(grows & (two > 0), n, np.nan)
    with np.errstate(all="ignore"):
        found.coefficient[some] = np.where(grows & (two > 0), one_ * q**-n, np.nan)
    found.angle[some] = best.angle
    return found


def balance(base: Base, count: int) -> np.ndarray:
    """Return the largest wavenumber (point,) at which a term of det(lambda E - L) balances the highest of its power.

    Only the highest: others may be roundings of zero, and two of those balance anywhere.
    """
    sizes: dict[tuple[int, int], np.ndarray] = {}
    for (j, m, _), c in polynomials.symbol(base.model.evolves, base.resting()[0].pencil()).items():
        sizes[j, m] = np.maximum(sizes.get((j, m), np.zeros(count)), np.abs(c))
    found = np.zeros(count)
    with np.errstate(all="ignore"):
        for (j, m), a in sizes.items():
            n = max(k for i, k in sizes if i == j)
            if n > m:
                ratio = (a / sizes[j, n]) ** (1 / (n - m))
                found = np.fmax(found, np.where(np.isfinite(ratio), ratio, 0))
    return np.where(found > 0, found, 1.0)
