"""What the atlas of symbols shows of each registered closure: its verdicts, and growth over direction."""

from dataclasses import dataclass

import numpy as np

import stability as st
from tests.closures.benchmarks import BENCHMARKS, Benchmark

QUARTER = np.linspace(0, 90, 46)  # degrees; the states are mirror images of themselves, and so is the growth

# The wave (1/m) at which growth is drawn where it is bounded, or closes in on one direction as waves get shorter.
# Of each closure and exponent.
WAVES = {("perturbed", 0): 200.0, ("perturbed", -2): 120.0, ("critical_state", 1): 300.0, ("compressible_i", 0): 1000.0}


@dataclass(frozen=True)
class Symbol:
    """A closure at a benchmark state.

    Attributes
    ----------
    benchmark, verdict : the state, and what is said of it
    wave_angle, growth : degrees in [0, 180], and Re lambda/|xi|^n over the verdict's coefficient where waves grow, over
        the fastest decay where none does; NaN where decay is of a higher order
    wavenumber : 1/m of the wave drawn, None for the limit of short waves
    """

    benchmark: Benchmark
    verdict: st.Verdict
    wave_angle: np.ndarray
    growth: np.ndarray
    wavenumber: float | None = None

    @property
    def unstable(self) -> bool:
        """Whether some short wave grows."""
        return self.verdict.kind is not self.verdict.kind.STABLE


def by_closure() -> dict[str, list[Benchmark]]:
    """Return the benchmark states of every closure, the fastest growth first."""
    found: dict[str, list[Benchmark]] = {}
    for b in BENCHMARKS:
        found.setdefault(b.closure, []).append(b)
    return {name: sorted(bs, key=lambda b: np.inf if b.exponent is None else -b.exponent) for name, bs in found.items()}


def symbol(benchmark: Benchmark) -> Symbol:
    """Return verdict and growth of one state."""
    state = benchmark.closure, benchmark.flow, benchmark.parameters, {}
    verdict = st.well_posedness(*state)
    edges = np.array(verdict.wedge).ravel()
    angles = np.unique([*QUARTER, *edges[edges <= 90], *([] if verdict.worst_angle is None else [verdict.worst_angle])])
    angles = angles[angles <= 90]
    q = WAVES.get((benchmark.closure, benchmark.exponent))
    if q is None:
        growth = limit(state, angles)
    else:
        near = np.concatenate([edges[edges <= 90, None] + np.linspace(-6, 6, 121)]).ravel()
        angles = np.unique(np.clip([*angles, *near], 0, 90))
        growth = st.eigenvalues(*state, q, angles)[..., 0].real / q ** float(verdict.exponent)
    scale = verdict.coefficient if verdict.coefficient and verdict.coefficient > 0 else np.nanmax(np.abs(growth))
    mirrored = np.concatenate([angles, 180 - angles[-2::-1]])
    return Symbol(benchmark, verdict, mirrored, np.concatenate([growth, growth[-2::-1]]) / scale, q)


def limit(state: tuple, angles: np.ndarray) -> np.ndarray:
    """Return Re lambda/|xi|^n of short waves, n being the highest exponent of growth, or of the slowest decay."""
    exponent, coefficient = st.short_wave(*state, angles)
    grows = coefficient > 0
    n = exponent[grows].max() if grows.any() else exponent.min()
    return np.where(exponent == n, coefficient, np.where((exponent > n) & (coefficient < 0), np.nan, 0.0))
