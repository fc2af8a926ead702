"""The gate: a path is timed only if it agrees with 50 digits on samples drawn from the very map that is timed."""

from dataclasses import dataclass
from decimal import Decimal
from typing import Any

import numpy as np

import stability as st
from benchmarks import baselines
from benchmarks.cases import Case
from stability.arithmetic import multiprecision
from stability.model import Base, Model

FLOAT64, FLOAT32 = 4e-15, 1e-6  # largest error over ||D||: some 20 roundings, and single precision likewise
SAMPLES = 200
DIGITS = 50


@dataclass(frozen=True)
class Truth:
    """Growth rates to 50 digits at some samples of a map, and the norms of D there."""

    index: tuple[np.ndarray, ...]
    growth: np.ndarray
    norm: np.ndarray

    def errors(self, growth: np.ndarray) -> np.ndarray:
        """Return the errors of a map of growth rates at the samples, over ||D||."""
        found = growth[self.index]
        return np.array([float(abs(e - float(f))) for e, f in zip(self.growth, found, strict=True)]) / self.norm


def exactly(values: np.ndarray) -> np.ndarray:
    """Return float64 numbers as the decimals that they are: a float would stand for the decimal that it prints as."""
    return np.array([Decimal(float(v)) for v in values], dtype=object)


def truth(case: Case, samples: int = SAMPLES) -> Truth:
    """Return the truth at random samples of a map.

    At one position it starts from the parameters' decimals. At many, where some base states are ill-conditioned (near
    an arc, where the pressure is a difference), it starts from the float64 base states that every path shares.
    """
    rng = np.random.default_rng(7)
    index = tuple(rng.integers(0, n, samples) for n in case.shape)
    angle, q = exactly(case.wave_angle[index[-2]]), exactly(case.wavenumber[index[-1]])
    if len(index) == 2:
        found = [e[0] for e in st.eigenvalues(*case.question, q, angle, digits=DIGITS)]
    else:
        base, number = exact_base(case), multiprecision(2 * DIGITS).number
        waves = zip(index[0], map(number, q), map(number, angle), strict=True)
        found = [max(base.at(i).form(a).eigenvalues(k), key=lambda e: e.real) for i, k, a in waves]
    return Truth(index, np.array([e.real for e in found], dtype=object), norms(case, index))


def exact_base(case: Case) -> Base:
    """Return the float64 base states of many positions, and the constants, as mpmath numbers."""
    arithmetic = multiprecision(2 * DIGITS)
    base = Model(case.closure, case.flow).base(case.parameters, case.point)

    def exact(value: Any) -> Any:
        if isinstance(value, tuple):
            return tuple(map(exact, value))
        found = [arithmetic.number(v) for v in exactly(np.ravel(value))]
        return np.array(found, dtype=object) if np.ndim(value) else found[0]

    constants = {word: exact(value) for word, value in base.parameters.items()}
    return Base(Model(case.closure, case.flow, arithmetic), constants, exact(base.state), (), {})


def norms(case: Case, index: tuple[np.ndarray, ...]) -> np.ndarray:
    """Return ||D|| at samples of a map."""
    compute, names = baselines.lambdified(case.closure)
    values = baselines.letter_values(case)
    given = [v[index[0], 0, 0] if np.ndim(v) else v for v in (values[n] for n in names)]
    angle, q = np.deg2rad(case.wave_angle[index[-2]]), case.wavenumber[index[-1]]
    return baselines.norms(compute(q * np.cos(angle), q * np.sin(angle), *given))
