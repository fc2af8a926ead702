"""Exact neutral curves: per direction, the positive roots of the stability polynomial in the wavenumber.

The Routh-Hurwitz quantity of `spectrum.stability_polynomial` is a polynomial of degree at most five in |xi|^2 for the
perturbed closure and two for the rigid-plastic one. Its companion eigenvalues only propose where signs may change;
each change is then bracketed and polished on the product form `spectrum.margin`, whose terms have not been multiplied
out. A root without a change of sign, such as a double one, is dropped. No grid in the wavenumber can miss a curve
here.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np

from stability import results, spectrum
from stability.model import Form, Model, check_waves

POLISH_STEPS = (
    80  # bisection alone reaches two neighbouring floats from a factor of 1e6 within 80 halvings of the logarithm
)
SMALLEST_STEP = 1e-10  # degrees: near a null direction of M the tip of the curve is that sharp
WHOLE_RANGE = (1e-6, 1e12)  # 1/m: from longer than any vessel to shorter than any atom


def candidates(polynomial: spectrum.Polynomial, size: int) -> np.ndarray:
    """Return moduli (size, degree) at which the polynomial may change sign, padded with NaN."""
    lowest, highest = min(polynomial), max(polynomial)
    table = np.stack([np.broadcast_to(polynomial.get(n, 0.0), size) for n in range(lowest, highest + 1, 2)], axis=-1)
    # Rows are scaled to leading coefficient of modulus one in t = s/sigma, sigma the geometric mean of the roots'
    # moduli: the companion matrix then has balanced entries whatever the units.
    found = np.full((size, table.shape[1] - 1), np.nan)
    present = table != 0
    degree = (
        table.shape[1] - 1 - np.argmax(present[:, ::-1], axis=1)
    )  # a vanishing leading coefficient lowers the degree
    trail = np.where(present.any(axis=1), np.argmax(present, axis=1), degree)  # roots at q = 0
    for d, low in {(int(a), int(b)) for a, b in zip(degree, trail, strict=True)}:
        order = d - low
        rows = np.flatnonzero((degree == d) & (trail == low))
        if order <= 0:  # a single power has no positive root; a row of zeros is neutral at every wavenumber
            continue
        c = table[rows, low : d + 1]
        sigma = np.abs(c[:, 0] / c[:, -1]) ** (1 / order)
        monic = c / c[:, -1:] * sigma[:, None] ** (np.arange(order + 1) - order)
        companion = np.zeros((rows.size, order, order))
        companion[:, np.arange(1, order), np.arange(order - 1)] = 1
        companion[:, :, -1] = -monic[:, :-1]
        roots = np.linalg.eigvals(companion)
        near = np.where(roots.real > 0, np.abs(roots), np.nan)  # a nearly double root may come out as a complex pair
        found[rows, :order] = np.sqrt(near * sigma[:, None])
    return np.sort(found, axis=1)


def polished(form: Form, low: np.ndarray, high: np.ndarray, low_unstable: np.ndarray) -> np.ndarray:
    """Return the roots of the margin between ``low`` and ``high``, to rounding.

    Two Illinois steps and a halving of ln q in turn: the bracket is never lost, and about ten steps suffice.
    """
    a, b = np.log(low), np.log(high)
    fa, fb = (spectrum.margin(form.coefficients, np.exp(t)) for t in (a, b))
    for step in range(POLISH_STEPS):
        width = b - a
        with np.errstate(divide="ignore", invalid="ignore"):
            secant = a - fa * width / (fb - fa)
        middle = 0.5 * (a + b)
        t = np.where((step % 3 == 2) | ~((secant > a) & (secant < b)), middle, secant)
        f = spectrum.margin(form.coefficients, np.exp(t))
        left = (f < 0) == low_unstable
        fb = np.where(left, np.where(step % 3 == 2, fb, fb / 2), f)
        fa = np.where(left, f, np.where(step % 3 == 2, fa, fa / 2))
        a, b = np.where(left, t, a), np.where(left, b, t)
        if np.all(b - a <= 2**-51 * np.maximum(1, np.abs(a))):
            break
    return np.exp(0.5 * (a + b))


@dataclass(frozen=True)
class Crossings:
    """Neutral wavenumbers (wave_angle, k), NaN-padded, the verdict above each, and those at both ends of the range."""

    wave_angle: np.ndarray
    wavenumber: np.ndarray
    unstable_above: np.ndarray
    unstable_ends: np.ndarray

    def merged(self, other: "Crossings") -> "Crossings":
        """Return the crossings of both sets of directions, in order of direction."""
        order = np.argsort(np.concatenate([self.wave_angle, other.wave_angle]), kind="stable")
        width = max(self.wavenumber.shape[1], other.wavenumber.shape[1])

        def joined(name: str, padding: float) -> np.ndarray:
            parts = [getattr(part, name) for part in (self, other)]
            wide = [np.pad(p, ((0, 0), (0, width - p.shape[1])), constant_values=padding) for p in parts]
            return np.concatenate(wide)[order]

        return Crossings(
            np.concatenate([self.wave_angle, other.wave_angle])[order],
            joined("wavenumber", np.nan),
            joined("unstable_above", False),
            np.concatenate([self.unstable_ends, other.unstable_ends])[order],
        )


def crossings(form: Form, wave_angle: np.ndarray, wavenumber_range: tuple[float, float]) -> Crossings:
    """Return every change of sign of the margin within the range, per direction."""
    low, high = wavenumber_range
    size = wave_angle.size
    near = candidates(spectrum.stability_polynomial(form.coefficients), size)
    near = np.where((near > low) & (near < high), near, high)  # those outside, and the padding, fall onto the end
    edges = np.sort(np.concatenate([np.full((size, 1), low), near, np.full((size, 1), high)], axis=1), axis=1)
    # Between neighbouring candidates no sign changes, so one sample in each gap decides it.
    stations = np.concatenate([edges[:, :1], np.sqrt(edges[:, :-1] * edges[:, 1:]), edges[:, -1:]], axis=1)
    unstable = spectrum.margin(form.column().coefficients, stations) < 0
    change = unstable[:, :-1] != unstable[:, 1:]
    found = np.full(change.shape, np.nan)
    row, gap = np.nonzero(change)
    if row.size:
        ends = stations[row, gap], stations[row, gap + 1]
        found[row, gap] = polished(form.rows(row), *ends, unstable[row, gap])
    order = np.argsort(found, axis=1)[:, : max(1, change.sum(axis=1).max())]
    return Crossings(
        wave_angle,
        np.take_along_axis(found, order, 1),
        np.take_along_axis(change & unstable[:, 1:], order, 1),
        unstable[:, [0, -1]],
    )


def inserted(found: Crossings, resolve: float) -> np.ndarray:
    """Return angles halfway between neighbours whose crossings differ by more than ``resolve`` in ln q."""
    level = np.log(found.wavenumber)
    count = np.isfinite(level).sum(axis=1)
    jump = np.abs(np.diff(level, axis=0))
    same = count[1:] == count[:-1]
    far = same & (np.nan_to_num(jump).max(axis=1) > resolve)
    # Where a pair of crossings is born, the gap between the two is what remains to be resolved.
    pair = np.nan_to_num(np.diff(level, axis=1), nan=np.inf).min(axis=1, initial=np.inf)
    born = ~same & (np.where(count[1:] > count[:-1], pair[1:], pair[:-1]) > resolve)
    middle = 0.5 * (found.wave_angle[1:] + found.wave_angle[:-1])
    return middle[(far | born) & (np.diff(found.wave_angle) > SMALLEST_STEP)]


def neutral_curve(
    closure: Any,
    flow: Any,
    parameters: dict,
    point: dict,
    wave_angle: Any,
    matrix: str = "full",
    wavenumber_range: tuple[float, float] = WHOLE_RANGE,
    resolve: float | None = None,
) -> "results.xr.Dataset":
    """Return the wavenumbers at which the leading growth rate changes sign, per direction.

    Parameters
    ----------
    closure, flow, parameters, point : as in `growth_map`; one point
    wave_angle : 1-D, degrees from the flow's axis
    matrix : "full" (D), "truncated" (D', P7) or "leading" (M, P4)
    wavenumber_range : 1/m, the open range in which to look
    resolve : insert directions until neighbouring crossings differ by less than this in ln q, also at the tips where
        two of them meet; None keeps the directions as given

    Returns
    -------
    Dataset with ``neutral_wavenumber`` (wave_angle, crossing), increasing and padded with NaN; ``unstable_above``, 1
    where waves just shorter than it grow; ``unstable_longest`` and ``unstable_shortest``, the verdicts at the ends of
    the range; and ``neutral_margin``, the stability polynomial at the root over the sum of its terms' moduli (some
    1e-16: rounding).

    Raises
    ------
    SceneError : a parameter, a point or a wave outside its range
    """
    wave_angle = np.atleast_1d(np.asarray(wave_angle, float))
    check_waves(np.asarray(wavenumber_range, float), wave_angle)
    model = Model(closure, flow)
    base = model.base(parameters, point)
    variables, coordinates, attributes = results.of_model(model, parameters, point, base, matrix)

    def solved(angles: np.ndarray) -> Crossings:
        return crossings(base.form(angles, matrix).filled(angles.size), angles, wavenumber_range)

    found = solved(wave_angle)
    while resolve is not None and (new := inserted(found, resolve)).size:
        found = found.merged(solved(new))
    form = base.form(found.wave_angle, matrix).filled(found.wave_angle.size)
    with np.errstate(invalid="ignore"):
        margin = spectrum.margin(form.column().coefficients, found.wavenumber)
    dims = ("wave_angle", "crossing")
    variables |= {
        "neutral_wavenumber": (dims, found.wavenumber),
        "neutral_margin": (dims, margin),
        "unstable_above": (dims, found.unstable_above.astype(np.int8)),
        "unstable_longest": ("wave_angle", found.unstable_ends[:, 0].astype(np.int8)),
        "unstable_shortest": ("wave_angle", found.unstable_ends[:, 1].astype(np.int8)),
    }
    attributes["wavenumber_range"] = list(wavenumber_range)
    return results.dataset(variables, coordinates | {"wave_angle": found.wave_angle}, **attributes)
