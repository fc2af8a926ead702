"""Adaptive maps against the full grid: in float64, where a sample is cheap, and in multiprecision, where it is not."""

from collections.abc import Iterator
from functools import partial

import numpy as np
import xarray as xr

import stability as st
from benchmarks.accuracy import exactly
from benchmarks.cases import Case, polar
from benchmarks.maps import PACKAGE, package
from benchmarks.rows import Group, Row, timed
from benchmarks.timing import interleaved, per_sample
from stability.analyses.adaptive import adaptive_map

TOLERANCE, DIGITS, FEW = 1e-3, 30, 50
ADAPTIVE, GRID = "adaptive_map", f"every sample in {DIGITS} digits"
ADAPTIVE_DIGITS = f"adaptive_map in {DIGITS} digits"


def adaptive(case: Case, digits: int | None = None) -> xr.Dataset:
    """Return the adaptive map of a case."""
    waves = case.wavenumber, case.wave_angle
    return adaptive_map(*case.question, *waves, growth=TOLERANCE, digits=digits, frequency=False)


def error(found: np.ndarray, true: np.ndarray) -> float:
    """Return the largest error as the tolerance means it: over the largest growth rate, or the wave's own decay."""
    return float(np.max(np.abs(found - true) / np.maximum(np.abs(true.max()), np.abs(true))))


def precise(case: Case) -> np.ndarray:
    """Return eigenvalues in multiprecision at `FEW` samples of a map: all of them would take minutes."""
    waves = [exactly(v[np.linspace(0, v.size - 1, FEW).astype(int)]) for v in (case.wavenumber, case.wave_angle)]
    return st.eigenvalues(*case.question, *waves, digits=DIGITS)


def compared(case: Case, digits: int | None, rounds: int) -> Group:
    """Return the full grid against the adaptive map."""
    text = f"{case.size:,} samples to {TOLERANCE:g} of the largest growth rate; error: the largest, in these terms."
    group = Group("adaptive" if digits is None else "adaptive-digits", text, "µs/sample", 1e6)
    plain, found = package(case, frequency=False), adaptive(case)
    full, sampled, size = (PACKAGE, ADAPTIVE, case.size) if digits is None else (GRID, ADAPTIVE_DIGITS, FEW)
    calls = {full: plain if digits is None else partial(precise, case), sampled: partial(adaptive, case, digits)}
    timings = per_sample(interleaved(calls, rounds), {full: size, sampled: case.size})
    group.rows += timed(timings, full, {sampled: error(found.growth_rate.values, plain())})
    group.rows.append(Row("share of the samples evaluated", measured=float(found.attrs["samples_share"])))
    return group


def measure(quick: bool) -> Iterator[Group]:
    """Yield float64, then (unless quick) multiprecision on a smaller grid."""
    yield compared(polar(10**5 if quick else 10**6), None, 3 if quick else 7)
    if not quick:
        yield compared(polar(4 * 10**4), DIGITS, 2)
