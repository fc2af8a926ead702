"""How far a cheaper matrix or a lower precision is from D in float64: bounds, and a probe of a map's waves.

The error of a wave is |growth rate - that of D| over the largest growth rate, or over its own rate where it decays
faster than that: what a picture shows in either case.
"""

from dataclasses import dataclass, replace

import numpy as np

from stability import spectrum
from stability.model import Base, Form

SEED = 34  # of the random part of the probe: a plan is a function of its scene
SAFETY = 3.0  # times the error on the probe: on the whole maps of the hopper it was up to 1.6 times that on the probe
CONFIRMED, DIGITS = 5, 30  # waves at which multiprecision checks that float64 may serve as the truth
UNIT32 = 2.0**-24
ROUNDINGS = 16.0  # of float32 in a polynomial of at most six terms and in the passes after it


@dataclass(frozen=True)
class Probe:
    """Waves of the requested grid (their indices), the growth rates of D there, and the largest of all."""

    rows: np.ndarray
    columns: np.ndarray
    truth: np.ndarray
    scale: float

    def error(self, size: np.ndarray) -> float:
        """Return the largest of absolute errors or bounds, relative as said at the top."""
        return float(np.max(size / np.maximum(self.scale, np.abs(self.truth))))


def growth(form: Form, wavenumber: np.ndarray) -> np.ndarray:
    """Return the largest growth rate of each wave."""
    return np.max([value.real for value in form.eigenvalues(wavenumber)], axis=0)


def probe(base: Base, wave_angle: np.ndarray, wavenumber: np.ndarray) -> Probe:
    """Return waves of a grid that show its errors: spread, random, beside the neutral curve, and about the largest."""
    n, m = wave_angle.size, wavenumber.size

    def every(size: int, count: int, low: int = 0, high: int | None = None) -> np.ndarray:
        return np.unique(np.linspace(max(low, 0), min(size if high is None else high, size) - 1, count).astype(int))

    def rates(index: np.ndarray) -> np.ndarray:
        return growth(base.form(wave_angle[index // m]).filled(index.size), wavenumber[index % m])

    def crossed(rows: np.ndarray, columns: np.ndarray) -> np.ndarray:
        return (rows[:, None] * m + columns).ravel()

    random = np.random.default_rng(SEED)
    rows, columns = every(n, 16), every(m, 128)
    form = base.form(wave_angle[rows]).filled(rows.size).column()
    unstable = spectrum.margin(form.coefficients, wavenumber[columns]) < 0
    row, edge = np.nonzero(unstable[:, 1:] != unstable[:, :-1])
    beside = np.concatenate([rows[row] * m + columns[edge + side] for side in (0, 1)])
    found = np.unique(np.concatenate([crossed(rows, every(m, 16)), random.integers(0, n * m, 128), beside]))
    truth = rates(found)
    height, width = n // 15 + 1, m // 15 + 1
    while height > 1 or width > 1:  # climb: finer and finer windows about the largest so far
        i, j = divmod(int(found[truth.argmax()]), m)
        window = crossed(every(n, 5, i - height, i + height + 1), every(m, 5, j - width, j + width + 1))
        window = np.setdiff1d(window, found)
        found, truth = np.concatenate([found, window]), np.concatenate([truth, rates(window)])
        height, width = max(1, height // 2), max(1, width // 2)
    scale = abs(truth.max()) or np.abs(truth).max() or 1.0
    return Probe(found // m, found % m, truth, float(scale))


def matrix_error(full: Form, cheap: Form, wavenumber: np.ndarray, waves: Probe, allowed: float) -> tuple[float, str]:
    """Return the error of a cheaper matrix on the probe and its kind: the bound where that suffices."""
    bound = waves.error(perturbation(full, cheap, wavenumber)) if "trace" in full.coefficients else np.inf
    if allowed is not None and bound <= allowed:
        return bound, "bound"
    return SAFETY * waves.error(np.abs(growth(cheap, wavenumber) - waves.truth)), "measured"


def confirmed(
    closure: str, flow: str, parameters: dict, point: dict, waves: Probe, wave_angle: np.ndarray, wavenumber: np.ndarray
) -> float:
    """Return how far float64 is from multiprecision at a few waves of the probe, the fastest growing one among them."""
    from stability.precise import eigenvalues  # mpmath: only where there is a tolerance to hold

    at = np.unique([waves.truth.argmax(), *np.linspace(0, waves.truth.size - 1, CONFIRMED - 1).astype(int)])
    q, angle = wavenumber[waves.columns[at]], wave_angle[waves.rows[at]]
    found = eigenvalues(closure, flow, parameters, point, q, angle, "full", DIGITS)
    exact = np.array([float(value.real) for value in found[:, 0]])
    return replace(waves, rows=at, columns=at, truth=exact).error(np.abs(waves.truth[at] - exact))


def perturbation(full: Form, cheap: Form, wavenumber: np.ndarray) -> np.ndarray:
    """Return a bound of the difference between the leading growth rates of two 2 x 2 matrices.

    An eigenvalue x of the cheap one misses the characteristic equation of the full one by f, with slope g there: some
    root is within 2 |f|/|g| and within the root of |f|; the other one follows from the trace. Bauer and Fike's bound by
    the condition of the eigenvectors is larger, and infinite where two directions of the map meet a double root.
    """
    trace, determinant = (spectrum.values(full.coefficients[part], wavenumber) for part in ("trace", "determinant"))
    one, other = spectrum.pair(cheap.coefficients, wavenumber)
    leading = spectrum.leading_first(one, other)[0]
    f_r, f_i, g_r, g_i = spectrum.characteristic(trace, determinant, leading.real, leading.imag)
    miss, slope = np.hypot(f_r, f_i), np.hypot(g_r, g_i)
    with np.errstate(divide="ignore", invalid="ignore"):
        near = np.fmin(2 * miss / slope, np.sqrt(miss))
    return near + np.abs(trace[0] - spectrum.values(cheap.coefficients["trace"], wavenumber)[0])


def rounding(form: Form, wavenumber: np.ndarray) -> np.ndarray:
    """Return a bound of the error of a growth rate that float32 evaluates, from the moduli of everything added up."""
    c, each = form.coefficients, ROUNDINGS * UNIT32
    if "trace" not in c:
        (r, _), (a, b), (down, across) = (
            spectrum.moduli(c[p], wavenumber) for p in ("regular", "numerator", "denominator")
        )
        below = sum(part * part for part in spectrum.values(c["denominator"], wavenumber))
        return each * (r * (down * down + across * across) + a * down + b * across) / below
    gap = sum(spectrum.moduli(c["discriminant"], wavenumber))
    root = np.sqrt(np.hypot(*spectrum.values(c["discriminant"], wavenumber)))
    with np.errstate(divide="ignore"):
        return each * spectrum.moduli(c["trace"], wavenumber)[0] / 2 + np.fmin(each * gap / root, np.sqrt(each * gap))
