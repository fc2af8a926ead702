"""A growth map from a tenth of its samples: piecewise polynomials, refined where they miss and where the sign changes.

The grid is covered by blocks. A block is known at 5 x 5 of its samples, which a polynomial of degree four in direction
and ln q joins. It is split where that polynomial misses samples halfway between them, or has another sign than the
neutral polynomial (`spectrum.stability_polynomial`), which is exact in every direction: no tongue is too thin for it.
Bilinear interpolation at the same tolerance was rejected: its error falls with the square of the step, not the fifth
power, and at 1e-3 it would need most of the samples inside the unstable region.

A few columns are sampled in every direction (`GUIDES`): a ridge of one direction, such as that in which Det M vanishes,
lies between the samples of a coarse block and need not change the sign.

It pays where a sample is dear: in multiprecision. In float64 the full grid costs less than this bookkeeping.
"""

from collections.abc import Callable
from functools import cache
from typing import Any

import numpy as np

from stability import results, spectrum
from stability.arithmetic import NUMPY, multiprecision
from stability.model import Base, Form, Model, check_waves
from stability.precise import GUARD_DIGITS

NODES = 5  # samples of a block along an axis: a polynomial of degree 4
SPAN = 64  # samples along an axis that a first block covers, at most
# ln q between two columns that are sampled in every direction, and the length of a first block: the growth rate is made
# of powers of q, so that along a ray nothing is narrower than a factor of e or so.
GUIDES = 2.0
SAFETY = 0.5  # of the tolerance is allowed at the test samples: then 60 random maps used at most 0.85 of it elsewhere
DOUBT = 1e-10  # |neutral polynomial| over its terms' moduli below which the growth rate itself is asked for its sign
REPORT = 256  # samples in multiprecision between two reports of progress: about a tenth of a second

Ends = tuple[int, int]  # the first and the last index of a block along an axis


def leading(found: tuple, xp: Any = np) -> Any:
    """Return the eigenvalue of largest real part."""
    return found[0] if len(found) == 1 else spectrum.leading_first(found[0], found[1], xp)[0]


def certain(polynomial: spectrum.Polynomial, wavenumber: np.ndarray) -> np.ndarray:
    """Return the signs (direction, wavenumber) of a polynomial, 0 where it nearly cancels."""
    order = np.array([n - min(polynomial) for n in polynomial], float)
    longest = wavenumber.max()
    table = np.stack(list(polynomial.values()), axis=1) * longest**order  # powers of q/max q stay within range
    powers = (wavenumber / longest) ** order[:, None]
    value = table @ powers
    return (np.sign(value) * (np.abs(value) > DOUBT * (np.abs(table) @ powers))).astype(np.int8)


class Samples:
    """The samples of a map that have been evaluated, in float64 or from a base state in multiprecision."""

    def __init__(self, base: Base, matrix: str, wavenumber: np.ndarray, wave_angle: np.ndarray, progress: Any = None):
        self.wavenumber, self.wave_angle, self.progress = wavenumber, wave_angle, progress
        self.done = np.zeros((wave_angle.size, wavenumber.size), bool)
        self.growth, self.frequency = np.full((2, *self.done.shape), np.nan)
        self.arithmetic = a = base.model.arithmetic
        self.rows: list[Form] = []  # one per direction, in multiprecision only
        if a is NUMPY:
            form = base.form(wave_angle, matrix).filled(wave_angle.size)
        else:
            self.rows = [base.form(a.number(float(angle)), matrix) for angle in wave_angle]
            parts = {
                part: {n: np.array([float(row.coefficients[part][n]) for row in self.rows]) for n in series}
                for part, series in self.rows[0].coefficients.items()
            }
            form = Form(parts, np.array([float(row.speed) for row in self.rows]))
        self.form = form  # every direction, in float64

    def evaluate(self, wanted: np.ndarray) -> None:
        """Evaluate those wanted samples that are not known yet."""
        index = np.nonzero(wanted & ~self.done)
        self.done |= wanted
        if self.arithmetic is NUMPY:
            found = leading(self.form.rows(index[0]).eigenvalues(self.wavenumber[index[1]]))
            self.growth[index], self.frequency[index] = found.real, found.imag
            return
        a = self.arithmetic
        for count, (i, j) in enumerate(zip(*index, strict=True)):
            value = leading(self.rows[i].eigenvalues(a.number(float(self.wavenumber[j]))), a)
            self.growth[i, j], self.frequency[i, j] = float(value.real), float(value.imag)
            if self.progress and count % REPORT == 0:
                self.progress(int(np.isfinite(self.growth).sum()), self.done.size)

    @property
    def scale(self) -> float:
        """The largest growth rate so far; where nothing grows, the slowest decay."""
        return abs(np.nanmax(self.growth)) or np.nanmax(np.abs(self.growth)) or 1.0

    def signs(self) -> np.ndarray:
        """Return the sign of every growth rate by the neutral polynomial, 0 where rounding would decide.

        Two small matrix products, a nanosecond or two per sample; no eigenvalue is evaluated.
        """
        coefficients = self.form.coefficients
        value = certain(spectrum.stability_polynomial(coefficients), self.wavenumber)
        if "trace" not in coefficients:
            return -value
        trace = certain(spectrum.real_imaginary(coefficients["trace"])[0], self.wavenumber)
        return np.where((value < 0) | (trace > 0), 1, np.where(trace < 0, -value, 0)).astype(np.int8)


@cache
def nodes(ends: Ends) -> np.ndarray:
    """Return the indices at which a block is known along one axis."""
    return np.unique(np.linspace(*ends, NODES).astype(int))


@cache
def between(ends: Ends) -> np.ndarray:
    """Return the indices halfway between neighbouring nodes, where the polynomial is tested."""
    known = nodes(ends)
    return np.setdiff1d((known[1:] + known[:-1]) // 2, known)


def halves(ends: Ends, split: bool) -> list[Ends]:
    """Return both halves, which share their middle node, or the whole."""
    middle = int(nodes(ends)[nodes(ends).size // 2])
    return [(ends[0], middle), (middle, ends[1])] if split else [ends]


def lagrange(x: np.ndarray, at: np.ndarray) -> np.ndarray:
    """Return the matrix that takes values at the nodes ``x`` to the values of their polynomial at ``at``."""
    found = np.ones((at.size, x.size))
    for i, j in ((i, j) for i in range(x.size) for j in range(x.size) if i != j):
        found[:, i] *= (at - x[j]) / (x[i] - x[j])
    return found


class Refinement:
    """The blocks of a map: (rows, columns) with both ends included, split until each holds the tolerance."""

    def __init__(self, samples: Samples, tolerance: float):
        self.samples, self.tolerance, self.signs = samples, tolerance, samples.signs()
        self.axes = samples.wave_angle, np.log(samples.wavenumber)
        self.matrices: dict[tuple[int, Ends], np.ndarray] = {}
        n, m = samples.done.shape
        step = np.abs(np.diff(self.axes[1])).max(initial=GUIDES / SPAN)
        wide = max(NODES - 1, min(SPAN, int(GUIDES / step)))
        self.guides = np.array([*range(0, m - 1, wide), m - 1])
        edges = [*range(0, n - 1, SPAN), n - 1], self.guides.tolist()
        rows, columns = (list(zip(e, e[1:], strict=False)) or [(0, 0)] for e in edges)
        self.first = [(r, c) for r in rows for c in columns]

    def matrix(self, axis: int, ends: Ends) -> np.ndarray:
        """Return the matrix from the nodes to every sample of a block along an axis."""
        if (axis, ends) not in self.matrices:
            x = self.axes[axis]
            self.matrices[axis, ends] = lagrange(x[nodes(ends)], x[ends[0] : ends[1] + 1])
        return self.matrices[axis, ends]

    def run(self) -> list[tuple[Ends, Ends, float]]:
        """Return the final blocks, each with the scale under which its polynomial holds; their nodes are evaluated."""
        wanted = np.zeros(self.samples.done.shape, bool)
        wanted[:, self.guides] = True
        leaves, open_ = [], self.first
        while open_:
            for rows, columns in open_:
                r, c = nodes(rows), nodes(columns)
                for asked in ((r, c), (between(rows), c), (r, between(columns))):
                    wanted[np.ix_(*asked)] = True
            self.samples.evaluate(wanted)
            scale, split = self.samples.scale, []
            for rows, columns in open_:
                across, along = self.verdict(rows, columns, scale)
                if across or along:
                    split += [(r, c) for r in halves(rows, across) for c in halves(columns, along)]
                else:
                    leaves.append((rows, columns, scale))
            open_ = split
        return leaves

    def verdict(self, rows: Ends, columns: Ends, scale: float) -> tuple[bool, bool]:
        """Return whether a block must be split in direction, and whether in wavenumber."""
        r, c, new_r, new_c = nodes(rows), nodes(columns), between(rows), between(columns)
        if not (new_r.size or new_c.size):
            return False, False  # every sample is a node
        values = level(self.samples.growth[np.ix_(r, c)], scale)
        down, right = self.matrix(0, rows), self.matrix(1, columns).T
        across = self.misses(down[new_r - rows[0]] @ values, np.ix_(new_r, c), scale)
        along = self.misses(values @ right[:, new_c - columns[0]], np.ix_(r, new_c), scale)
        if new_r.size and not across:
            left = np.searchsorted(self.guides, columns[0], "right") - 1
            guides = self.guides[[left, np.searchsorted(self.guides, columns[1])]]
            guided = down @ level(self.samples.growth[np.ix_(r, guides)], scale)
            across = self.misses(guided, np.ix_(np.arange(rows[0], rows[1] + 1), guides), scale)
        if not (across or along):
            filled = down @ values @ right
            wrong = self.signs[rows[0] : rows[1] + 1, columns[0] : columns[1] + 1] * filled < -self.tolerance
            return bool(wrong.any() and new_r.size), bool(wrong.any() and new_c.size)
        return across, along

    def misses(self, found: np.ndarray, index: Any, scale: float) -> bool:
        """Tell whether interpolated levels miss their samples by more than the tolerance."""
        true = self.samples.growth[index]
        with np.errstate(over="ignore"):  # a wild polynomial misses by infinity
            error = np.abs(scale * np.sinh(found) - true)
        return bool(np.any(error > SAFETY * self.tolerance * np.maximum(scale, np.abs(true))))

    def filled(self, leaves: list[tuple[Ends, Ends, float]]) -> np.ndarray:
        """Return the growth rate on the whole grid: as evaluated where it was, by the polynomials elsewhere."""
        known = self.samples.growth
        found = np.empty_like(known)
        for rows, columns, scale in leaves:
            values = level(known[np.ix_(nodes(rows), nodes(columns))], scale)
            inside = slice(rows[0], rows[1] + 1), slice(columns[0], columns[1] + 1)
            found[inside] = scale * np.sinh(self.matrix(0, rows) @ values @ self.matrix(1, columns).T)
        return np.where(self.samples.done, known, found)


def level(value: np.ndarray, scale: float) -> np.ndarray:
    """Return arsinh(value/scale): linear within the scale; beyond it a power of q is a straight line in ln q."""
    return np.arcsinh(value / scale)


def adaptive_map(
    closure: Any,
    flow: Any,
    parameters: dict,
    point: dict,
    wavenumber: Any,
    wave_angle: Any,
    matrix: str = "full",
    growth: float = 1e-3,
    digits: int | None = None,
    frequency: bool = True,
    progress: Callable[[int, int], None] | None = None,
) -> "results.xr.Dataset":
    """Return the growth map of `growth_map` with most samples interpolated.

    Parameters
    ----------
    closure, flow, parameters, point, wavenumber, wave_angle, matrix : as in `growth_map`; one point
    growth : tolerance, relative to the largest growth rate; of a wave that decays faster than that, to its own rate
    digits : None for float64; else decimal digits in which samples are evaluated, before they are rounded to float64,
        with parameters, point and waves taken as the decimals that they print as
    frequency : whether the result holds the frequency too, of evaluated samples only: it jumps where the leading mode
        changes, and no polynomial follows a jump
    progress : called with (samples evaluated, samples of the grid)

    Returns
    -------
    Dataset as of `growth_map` (but ``frequency`` is NaN where it was not evaluated), with ``sampled`` (wave_angle,
    wavenumber), 1 where the wave was evaluated and 0 where its growth rate was interpolated, and the attribute
    ``samples_share``, the share of those evaluated. No sign differs from that of
    the neutral polynomial: a sample whose polynomial would say otherwise is evaluated.

    Raises
    ------
    SceneError : a parameter, a point or a wave outside its range
    """
    wavenumber, wave_angle = np.atleast_1d(np.asarray(wavenumber, float)), np.atleast_1d(np.asarray(wave_angle, float))
    check_waves(wavenumber, wave_angle)
    model = Model(closure, flow)
    base = model.base(parameters, point)
    variables, coordinates, attributes = results.of_model(model, parameters, point, base, matrix)
    if digits is not None:
        base = Model(closure, flow, multiprecision(digits + GUARD_DIGITS)).base(parameters, point)
    samples = Samples(base, matrix, wavenumber, wave_angle, progress)
    refinement = Refinement(samples, growth)
    leaves = refinement.run()
    doubtful = (refinement.signs == 0) | (np.sign(refinement.filled(leaves)) != refinement.signs)
    samples.evaluate(doubtful & ~samples.done)
    dims = ("wave_angle", "wavenumber")
    variables["growth_rate"] = dims, refinement.filled(leaves)
    if frequency:
        variables["frequency"] = dims, samples.frequency
    coordinates |= {"wave_angle": wave_angle, "wavenumber": wavenumber}
    attributes |= {"samples_share": samples.done.mean(), "interpolation_tolerance": growth}
    attributes |= {} if digits is None else {"digits": digits}
    variables["sampled"] = dims, samples.done.astype(np.int8)
    return results.dataset(variables, coordinates, **attributes)
