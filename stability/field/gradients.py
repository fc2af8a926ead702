"""Jets of a field (value, gradient, second gradient at every point), with an estimate of their error.

Structured grids: a parabola through three points in a row for each index, one-sided at the ends, and the chain rule
with the grid's own differences. Linear fields come out exactly on any grid, quadratic ones on uniform grids; in between
gradients err by O(h^2), second gradients by O(h^2) inside and O(h) at the ends.

Scattered points: a quadratic polynomial through the point itself, fitted to its 12 nearest neighbours with weights
1/distance: gradients err by O(h^2), second gradients by O(h).

Both are done twice, the second time over a wider stencil (every second point; 40 neighbours). Their difference over
``rho^2 - 1``, rho the ratio of the widths, estimates the error of the narrow one.

Rejected: the difference between a linear and a quadratic fit, which on these stencils estimates the error of the linear
one, 10 times too large; residuals of the fit, which do not see x^3 on three points.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.spatial import KDTree

from stability.errors import SceneError
from stability.field.grids import Field

NARROW, WIDE = 12, 40  # neighbours: 5 unknowns with room for irregular places; twice as far on the average
CHUNK = 2**14  # scattered points at once: 40 neighbours, 5 unknowns, some 60 MB
SINGULAR = 1e12  # condition of the normal equations in scaled coordinates; 1e2 to 1e4 on reasonable points

Jet = tuple  # value, (d_x, d_y), ((d_xx, d_xy), (d_xy, d_yy))


@dataclass(frozen=True)
class Jets:
    """The jets of every letter at every point (flat arrays), and what their error estimate needs.

    Attributes
    ----------
    narrow, wide : ``{letter: jet}`` over the two stencils
    excess : rho^2 - 1
    size : side of a cell, m: root of its area on a grid, median distance to the four nearest points elsewhere
    """

    narrow: dict[str, Jet]
    wide: dict[str, Jet]
    excess: np.ndarray
    size: np.ndarray

    def error(self, letter: str, axis: int) -> np.ndarray:
        """Return the estimated error of the first derivative of a letter along an axis."""
        with np.errstate(all="ignore"):
            return abs(self.wide[letter][1][axis] - self.narrow[letter][1][axis]) / self.excess

    def mirrored(self, index: np.ndarray) -> dict[str, Jet]:
        """Return jets at some points at the other end of their error bars: two estimated errors from the narrow ones.

        The narrow stencil errs by (wide - narrow)/(rho^2 - 1); with twice that taken off, a verdict that holds for both
        holds for what lies between them.
        """
        factor = 2 / self.excess[index]

        def beyond(one: Any, other: Any) -> Any:
            if isinstance(one, tuple):
                return tuple(beyond(a, b) for a, b in zip(one, other, strict=True))
            return one[index] + factor * (one[index] - other[index])

        return {
            n: (one[0][index], beyond(one[1], self.wide[n][1]), beyond(one[2], self.wide[n][2]))
            for n, one in self.narrow.items()
        }


def jets(field: Field) -> Jets:
    """Return the jets of every value of a field."""
    return on_grid(field) if field.structured else on_points(field)


def three_points(values: np.ndarray, axis: int, stride: int, order: int) -> np.ndarray:
    """Return the derivative by the index along an axis, of the parabola through three points a stride apart."""
    found = np.empty(values.shape)
    f, out = np.moveaxis(values, axis, 0), np.moveaxis(found, axis, 0)
    n, last = len(f), len(f) - 1 - stride
    if order == 1:
        np.subtract(f[2 * stride :], f[: n - 2 * stride], out=out[stride : last + 1])
        out[stride : last + 1] /= 2 * stride
    else:
        np.add(f[2 * stride :], f[: n - 2 * stride], out=out[stride : last + 1])
        out[stride : last + 1] -= 2 * f[stride : last + 1]
        out[stride : last + 1] /= stride**2
    for i in (*range(stride), *range(last + 1, n)):  # the ends: the parabola of the nearest inner point
        middle = stride if i < stride else last
        t = (i - middle) / stride
        weights = (t - 0.5, -2 * t, t + 0.5) if order == 1 else (1, -2, 1)
        places = (middle - stride, middle, middle + stride)
        out[i] = sum(w * f[j] for w, j in zip(weights, places, strict=True)) / stride**order
    return found


def on_grid(field: Field) -> Jets:
    """Return jets on a structured grid by the chain rule in its indices."""
    x_i, x_j, y_i, y_j = (three_points(c, axis, 1, 1) for c in (field.x, field.y) for axis in (0, 1))
    size = np.sqrt(abs(x_i * y_j - x_j * y_i)).ravel()
    if not size.all():
        raise SceneError(f"the grid is folded: {np.count_nonzero(size == 0)} of its points span no area")
    found = []
    for stride in (1, 2):

        def d(f: np.ndarray, i: int, j: int | None = None, stride: int = stride) -> np.ndarray:
            if i == j:
                return three_points(f, i, stride, 2)
            one = three_points(f, i, stride, 1)
            return one if j is None else three_points(one, j, stride, 1)

        found.append(grid_jets(field, d))
    return Jets(found[0], found[1], np.full(size.shape, 3.0), size)


def grid_jets(field: Field, d: Callable[..., np.ndarray]) -> dict[str, Jet]:
    """Return jets from derivatives by the indices: ``f_ab = f_x x_ab + f_y y_ab + x_a x_b f_xx + ...`` solved for f."""
    x, y = field.x, field.y
    x_i, x_j, y_i, y_j = d(x, 0), d(x, 1), d(y, 0), d(y, 1)
    with np.errstate(all="ignore"):
        one = 1 / (x_i * y_j - x_j * y_i)
    i_x, i_y, j_x, j_y = y_j * one, -x_j * one, -y_i * one, x_i * one
    pairs = ((0, 0), (0, 1), (1, 1))
    bends = [(d(x, a, b), d(y, a, b)) for a, b in pairs]
    found: dict[str, Jet] = {}
    for name, f in field.values.items():
        f_i, f_j = d(f, 0), d(f, 1)
        f_x, f_y = f_i * i_x + f_j * j_x, f_i * i_y + f_j * j_y
        ii, ij, jj = (
            d(f, a, b) - f_x * xab - f_y * yab for (a, b), (xab, yab) in zip(pairs, bends, strict=True)
        )  # fmt: skip
        f_xx = ii * i_x**2 + 2 * ij * i_x * j_x + jj * j_x**2
        f_xy = ii * i_x * i_y + ij * (i_x * j_y + i_y * j_x) + jj * j_x * j_y
        f_yy = ii * i_y**2 + 2 * ij * i_y * j_y + jj * j_y**2
        flat = [a.ravel() for a in (f, f_x, f_y, f_xx, f_xy, f_yy)]
        found[name] = flat[0], (flat[1], flat[2]), ((flat[3], flat[4]), (flat[4], flat[5]))
    return found


def on_points(field: Field) -> Jets:
    """Return jets at scattered points by weighted least squares."""
    places = np.stack([field.x, field.y], axis=-1)
    tree = KDTree(places)
    nearest = tree.query(places, 2)[0][:, 1]
    if not nearest.all():
        raise SceneError(
            f"{np.count_nonzero(nearest == 0)} points of the field coincide with another one: merge them first "
            "(ParaView's filter Clean to Grid does)"
        )
    n = len(places)
    excess, size = np.empty(n), np.empty(n)
    store = [{name: np.empty((6, n)) for name in field.values} for _ in range(2)]
    for part in parts(n):
        distance, index = tree.query(places[part], WIDE + 1)
        size[part] = np.median(distance[:, 1:5], axis=1)
        excess[part] = (distance[:, 1:] ** 2).mean(axis=1) / (distance[:, 1 : NARROW + 1] ** 2).mean(axis=1) - 1
        for out, count in zip(store, (NARROW, WIDE), strict=True):
            near = index[:, 1 : count + 1]
            solve = fit(places[near] - places[part][:, None], distance[:, 1 : count + 1])
            for name, f in field.values.items():
                out[name][0, part] = f[part]
                out[name][1:, part] = solve(f[near] - f[part][:, None]).T
    narrow, wide = ({name: nested(rows) for name, rows in out.items()} for out in store)
    return Jets(narrow, wide, excess, size)


def parts(n: int) -> Iterator[slice]:
    """Yield ranges of points."""
    return (slice(i, min(i + CHUNK, n)) for i in range(0, n, CHUNK))


def fit(offset: np.ndarray, distance: np.ndarray) -> Callable[[np.ndarray], np.ndarray]:
    """Return the function from differences (points, neighbours) to d_x, d_y, d_xx, d_xy, d_yy; NaN where undetermined.

    Coordinates are scaled by the stencil's width, so that the normal equations lose no more than their condition.
    """
    width = distance.mean(axis=1)[:, None]
    s, t = offset[..., 0] / width, offset[..., 1] / width
    basis = np.stack([s, t, s * s / 2, s * t, t * t / 2], axis=-1)
    weighted = basis * (width / distance)[..., None] ** 2
    G = weighted.swapaxes(1, 2) @ basis
    fine = np.abs(np.linalg.det(G)) > 0
    inverse = np.linalg.inv(np.where(fine[:, None, None], G, np.eye(5)))
    condition = np.abs(G).sum(axis=1).max(axis=1) * np.abs(inverse).sum(axis=1).max(axis=1)
    lost = ~fine | ~(condition < SINGULAR)
    unit = width ** -np.array([1.0, 1, 2, 2, 2])

    def solve(difference: np.ndarray) -> np.ndarray:
        right = np.einsum("pnk,pn->pk", weighted, difference)
        found = np.einsum("pkl,pl->pk", inverse, right) * unit
        found[lost] = np.nan
        return found

    return solve


def nested(rows: np.ndarray) -> Jet:
    """Return f, f_x, f_y, f_xx, f_xy, f_yy as a jet."""
    f, f_x, f_y, f_xx, f_xy, f_yy = rows
    return f, (f_x, f_y), ((f_xx, f_xy), (f_xy, f_yy))
