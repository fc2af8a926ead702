"""Neutral curves by polynomial roots against contours of growth maps on the same directions."""

from collections.abc import Callable, Iterator
from functools import cache, partial

import numpy as np
from contourpy import contour_generator
from mpmath import MPContext

import stability as st
from benchmarks.accuracy import exactly
from benchmarks.cases import PERTURBED, POINT, Case
from benchmarks.maps import package
from benchmarks.rows import Group, Limit, Row, timed
from benchmarks.timing import interleaved
from stability import spectrum
from stability.arithmetic import multiprecision
from stability.model import Model

RANGE = (1.0, 10**4.5)  # 1/m
STRIDE = 8  # every eighth direction has its roots worked out in 50 digits
CURVE, ROOTS = "neutral_curve", "numpy.roots in a loop"


def waves(directions: int, wavenumbers: int) -> Case:
    """Return a grid over all directions; offset, so that no direction is an axis of symmetry."""
    angle = np.linspace(0, 360, directions, endpoint=False) + 0.0123
    return Case(np.geomspace(*RANGE, wavenumbers), angle, PERTURBED, POINT)


def curve(case: Case) -> np.ndarray:
    """Return ln of the neutral wavenumbers (directions, crossings), NaN-padded, by the package."""
    found = st.neutral_curve(*case.question, case.wave_angle, wavenumber_range=RANGE)
    return np.log(found.neutral_wavenumber.values)


def contour(case: Case, growth: Callable[[], np.ndarray]) -> np.ndarray:
    """Return the same from the zero contour of a growth map: its vertices on the grid's rows."""
    log = np.log(case.wavenumber)
    lines = contour_generator(log, np.arange(case.wave_angle.size), growth()).lines(0)
    points = np.concatenate([np.empty((0, 2)), *lines])
    return by_direction(points[points[:, 1] == np.round(points[:, 1])], case.wave_angle.size)


def by_direction(points: np.ndarray, directions: int) -> np.ndarray:
    """Return points (ln q, direction's index) as rows of increasing ln q, NaN-padded."""
    points = np.unique(points[:, ::-1], axis=0)
    row = points[:, 0].astype(int)
    place = np.arange(row.size) - np.searchsorted(row, row)
    found = np.full((directions, place.max(initial=-1) + 1), np.nan)
    found[row, place] = points[:, 1]
    return found


def roots_loop(case: Case) -> np.ndarray:
    """Return the same from `numpy.roots`, direction by direction, without a polish."""
    form = Model(case.closure, case.flow).base(case.parameters, case.point).form(case.wave_angle)
    polynomial = spectrum.stability_polynomial(form.filled(case.wave_angle.size).coefficients)
    table = np.stack([polynomial[n] for n in sorted(polynomial, reverse=True)], axis=1)
    points = []
    for i, row in enumerate(table):
        w = np.roots(row)
        q = np.sqrt(w[(w.imag == 0) & (w.real > 0)].real)
        q = q[(q > RANGE[0]) & (q < RANGE[1])]
        trace = spectrum.values(form.rows(i).coefficients["trace"], q)[0]
        points += [(np.log(value), i) for value in q[trace < 0]]
    return by_direction(np.array(points), case.wave_angle.size)


@cache
def exact_roots(directions: int) -> list[list[float]]:
    """Return ln of the neutral wavenumbers of every `STRIDE`-th direction, from all roots in 50 digits."""
    case = waves(directions, 2)
    arithmetic, mp = multiprecision(60), MPContext()
    mp.dps = 50
    base = Model(case.closure, case.flow, arithmetic).base(case.parameters, case.point)
    found = []
    for angle in exactly(case.wave_angle[::STRIDE]):
        form = base.form(arithmetic.number(angle)).coefficients
        polynomial = spectrum.stability_polynomial(form)
        roots = mp.polyroots(
            [mp.mpf(polynomial[n]) for n in sorted(polynomial, reverse=True)], maxsteps=500, extraprec=400
        )
        waves_ = [mp.sqrt(w.real) for w in roots if abs(w.imag) < mp.mpf(10) ** -30 * abs(w) and w.real > 0]
        kept = [q for q in waves_ if RANGE[0] < q < RANGE[1] and spectrum.values(form["trace"], q)[0] < 0]
        found.append(sorted(float(mp.log(q)) for q in kept))
    return found


def judged(found: np.ndarray, exact: list[list[float]]) -> tuple[np.ndarray, int]:
    """Return the errors in ln q of the curves found, and how many exact crossings were missed or invented."""
    errors, missed = [], 0
    for row, truth in zip(found[::STRIDE], exact, strict=True):
        row = row[np.isfinite(row)]
        missed += abs(row.size - len(truth))
        if row.size:
            errors += [np.abs(row - t).min() for t in truth]
    return np.array(errors), missed


def measure(quick: bool) -> Iterator[Group]:
    """Yield the comparison at 2,000 and at 3,200 directions; the targets are about the latter."""
    for n in (400,) if quick else (2000, 3200):
        yield compared(n, targets=n == 3200, rounds=3 if quick else 7)


def compared(n: int, targets: bool, rounds: int) -> Group:
    """Return the comparison of roots in n directions with a contour of n x n samples."""
    case, exact = waves(n, n), exact_roots(n)
    grid = f"{n} x {n} growth_map + contour"
    calls = {
        grid: partial(contour, case, package(case, frequency=False)),
        CURVE: partial(curve, case),
        ROOTS: partial(roots_loop, case),
    }
    judgement = {name: judged(call(), exact) for name, call in calls.items()}
    medians = {name: float(np.median(errors)) for name, (errors, _) in judgement.items()}
    roots = sum(map(len, exact))
    text = (
        f"{n:,} directions, {RANGE[0]:g} to {RANGE[1]:.3g} /m; error: median of |Δ ln q|, {roots} roots in 50 digits."
    )
    group = Group(f"neutral-curve-{n}", text, "ms", 1e3)
    limits = {(CURVE, grid): Limit(round(1 / 6, 4))} if targets else {}
    group.rows += timed(interleaved(calls, rounds), grid, medians, limits)
    gain = Limit(1e4, at_least=True) if targets else None
    group.rows.append(
        Row("median error, contour over neutral_curve", measured=medians[grid] / medians[CURVE], limit=gain)
    )
    for name, (errors, missed) in judgement.items():
        none = Limit(0) if name == CURVE else None
        group.rows.append(Row(f"{name}: crossings missed or invented", measured=float(missed), limit=none))
        group.rows.append(Row(f"{name}: largest error", error=float(errors.max())))
    return group
