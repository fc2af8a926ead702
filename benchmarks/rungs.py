"""Error against time, every rung: what a growth rate costs, and what a neutral wavenumber costs, at each accuracy."""

from collections.abc import Callable, Iterator
from functools import partial

import numpy as np

import stability as st
from benchmarks import curves, maps
from benchmarks.accuracy import DIGITS, exactly, truth
from benchmarks.cases import Case, polar
from benchmarks.rows import Group, Row
from benchmarks.timing import Timings, interleaved, median, per_sample

SAMPLES, CURVES = "growth-rates", "neutral-wavenumbers"
PRECISE, FEW = "eigenvalues, 50 digits", 100  # the rung whose error is that of the reference itself, and its samples


def grid(case: Case, **options: object) -> Callable[[], np.ndarray]:
    """Return the call of `stability.eigenvalues` on a map."""
    waves = case.wavenumber, case.wave_angle[:, None]
    return lambda: st.eigenvalues(*case.question, *waves, **options)[..., 0].real


def precise(case: Case) -> Callable[[], np.ndarray]:
    """Return the call of `stability.eigenvalues` in `DIGITS` digits, on random samples of a map."""
    rng = np.random.default_rng(11)
    waves = [exactly(rng.choice(v, FEW)) for v in (case.wavenumber, case.wave_angle)]
    return lambda: st.eigenvalues(*case.question, *waves, digits=DIGITS)


def samples(quick: bool) -> Group:
    """Return the rungs of a growth rate; errors over ||D|| against 50 digits of the full D."""
    large, small = polar(10**5 if quick else 10**6), polar(10**4)
    fast = {
        "leading M": maps.package(large, frequency=False, matrix="leading"),
        "truncated D'": maps.package(large, frequency=False, matrix="truncated"),
        "full D, draft (float32)": maps.package(large, frequency=False, accuracy="draft"),
        "full D": maps.package(large, frequency=False),
    }
    slow = {n: call for n, call in maps.variants(small).items() if n in (maps.C, maps.FORMULA, maps.EIGVALS)}
    slow |= {"eigenvalues": grid(small), "eigenvalues, rtol = 1e-12": grid(small, rtol=1e-12)}
    errors, sizes = {PRECISE: np.array([10.0**-DIGITS])}, {PRECISE: FEW}
    for case, calls in ((large, fast), (small, slow)):
        exact = truth(case)
        errors |= {name: exact.errors(call()) for name, call in calls.items()}
        sizes |= dict.fromkeys(calls, case.size)
    timings = interleaved(fast | slow | {PRECISE: precise(small)}, 3 if quick else 7)
    text = f"Error against time, {large.size:,} samples (slow rungs: fewer); error: median of |error|/‖D‖ at 50 digits."
    return rows(Group(SAMPLES, text), per_sample(timings, sizes), errors)


def neutral(quick: bool) -> Group:
    """Return the rungs of a neutral curve; errors in ln q."""
    n = 400
    exact, sizes = curves.exact_roots(n), (100, 400) if quick else (100, 400, 1600, 6400)
    grids = {f"contour, {m} wavenumbers": curves.waves(n, m) for m in sizes}
    calls: dict = {m: partial(curves.contour, c, maps.package(c, frequency=False)) for m, c in grids.items()}
    calls |= {
        curves.CURVE: partial(curves.curve, curves.waves(n, 2)),
        curves.ROOTS: partial(curves.roots_loop, curves.waves(n, 2)),
    }
    errors = {name: curves.judged(call(), exact)[0] for name, call in calls.items()}
    text = f"Error against time for {n} directions; error: median of |Δ ln q| against 50 digits."
    timings = per_sample(interleaved(calls, 3 if quick else 7), dict.fromkeys(calls, n))
    return rows(Group(CURVES, text, "µs/direction", 1e6), timings, errors)


def rows(group: Group, timings: Timings, errors: dict[str, np.ndarray]) -> Group:
    """Fill a group with the time and the median error of each rung, fastest first."""
    for name in sorted(timings, key=partial(median, timings)):
        group.rows.append(Row(name, median(timings, name), float(np.median(errors[name]))))
    return group


def measure(quick: bool) -> Iterator[Group]:
    """Yield both panels of figure X2."""
    yield samples(quick)
    yield neutral(quick)
