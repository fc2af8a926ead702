"""Every method on the same samples: leading growth rates or signs, and what the toolkit says about how it got them."""

from contextlib import suppress
from dataclasses import dataclass

import numpy as np

import stability as st
from stability.certified import Certifier, Tally
from stability.errors import PrecisionError
from stability.guaranteed import guaranteed
from tests.extremes import peers, truth
from tests.extremes.case import Case

RTOL = 1e-11  # what the guaranteed path is asked for
TOOLKIT = ("float64", "guaranteed", "certified signs")
PEERS = ("eigvals", "quadratic formula", "lambdified D on the flow")


@dataclass
class Measured:
    """Samples of one family: truth (sign, nearest float, rest) and what each method gave, nan where nothing."""

    cases: list[Case]
    sign: np.ndarray
    high: np.ndarray
    low: np.ndarray
    found: dict[str, np.ndarray]
    tallies: dict[str, Tally]

    def error(self, method: str) -> np.ndarray:
        """Return the relative errors of the leading growth rate, inf where there is no value."""
        value = self.found[method]
        with np.errstate(all="ignore"):
            error = np.abs(((value - self.high) - self.low) / self.high)
        return np.where(np.isfinite(value) & (self.sign != 0), error, np.inf)

    def wrong(self, method: str) -> np.ndarray:
        """Return which signs are wrong; no value and undecided are not."""
        sign = np.nan_to_num(np.sign(self.found[method]))
        return (sign != 0) & (sign != self.sign)

    def missing(self, method: str) -> np.ndarray:
        """Return which samples got no value, or no sign."""
        value = self.found[method]
        return ~np.isfinite(value) | (value == 0)

    def place(self, n: int) -> tuple[Case, int, int]:
        """Return case, direction and wavenumber of a sample."""
        for case in self.cases:
            if n < (size := case.shape[0] * case.shape[1]):
                return case, *divmod(n, case.shape[1])
            n -= size
        raise IndexError(n)


def waves(case: Case) -> tuple[np.ndarray, np.ndarray]:
    """Return wavenumber and angle of every sample."""
    angle, q = np.broadcast_arrays(case.wave_angle[:, None], case.wavenumber)
    return q.ravel(), angle.ravel()


def plain_growth(case: Case) -> np.ndarray:
    """Return the growth rates of `stability.eigenvalues`, nan where it refuses a sample."""
    q, angle = waves(case)
    try:
        return st.eigenvalues(*case.question, q, angle)[:, 0].real
    except PrecisionError:
        found = np.full(q.size, np.nan)
        for i in range(q.size):
            with suppress(PrecisionError):
                found[i] = st.eigenvalues(*case.question, q[i], angle[i])[0].real
        return found


def toolkit(case: Case, tallies: dict[str, Tally]) -> dict[str, np.ndarray]:
    """Return what the toolkit's three paths give."""
    plain = plain_growth(case)
    try:
        sure, tally = guaranteed(*case.question, *waves(case), "full", RTOL)
        for name, count in tally.by.items():
            tallies["guaranteed"].add(name, count)
        sure = np.where([w in tally.undecided for w in zip(*waves(case)[::-1], strict=True)], np.nan, sure[:, 0].real)
    except PrecisionError:
        sure = np.full(plain.shape, np.nan)
        tallies["guaranteed"].add("refused", plain.size)
    signs = Certifier(*case.question).signs(case.wavenumber, case.wave_angle, tallies["certified signs"])
    return dict(zip(TOOLKIT, (plain, sure, signs.ravel().astype(float)), strict=True))


def competitors(case: Case) -> dict[str, np.ndarray]:
    """Return what a user would get without the toolkit."""
    D, constrained = peers.matrices(case), case.closure == "rigid_plastic"
    on_flow = peers.matrices_on_flow(case)
    results = peers.lapack(D, constrained), peers.quadratic(D, constrained), peers.lapack(on_flow, constrained)
    return dict(zip(PEERS, results, strict=True))


def measure(cases: list[Case], compare: bool = False) -> Measured:
    """Return truth and results of every sample; the peers too if asked."""
    tallies = {"guaranteed": Tally(), "certified signs": Tally()}
    found: dict[str, list] = {}
    exact: list = []
    with np.errstate(all="ignore"):  # overflow is one of the extremes: it shows as a missing value
        for case in cases:
            exact.append(truth.as_floats(truth.by_balls(case)))
            for method, value in (toolkit(case, tallies) | (competitors(case) if compare else {})).items():
                found.setdefault(method, []).append(value)
    sign, high, low = (np.concatenate(part) for part in zip(*exact, strict=True))
    return Measured(cases, sign, high, low, {m: np.concatenate(v) for m, v in found.items()}, tallies)
