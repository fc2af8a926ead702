"""From tensors per position to coefficients per direction, by small matrix products.

`Base.form` turns the jet of every position into every direction and evaluates some 480 operations there: 1 us a row of
a map, 30 ns a sample at 32 wavenumbers. Here the pencil, 45 numbers a position, is contracted with directions: 0.2 us.
Its coefficients miss those of `Base.form` by roundings of the largest entry over all directions. That is enough for
a growth rate to roundings of ||D||, and not for the sign of one far smaller: `sweep` asks `Base.form` for those.

Rejected: interpolating the forms themselves in the angle. Where M has a double eigenvalue (along the axes of A) the
discriminant is the square of a rounding, and an interpolated one cost half the digits.
"""

from dataclasses import dataclass, replace

import numpy as np

from stability.model import Base
from stability.spectrum import Series

ORDERS = 4  # -1, 0, 1, 2 in powers of i|xi|: those of D


@dataclass(frozen=True)
class Tensors:
    """The pencil of P positions, one row each: (P, 16), (P, 8) or (P, 4) for C, half or a quarter of that for B."""

    C: tuple[np.ndarray, ...]
    B: tuple[np.ndarray, ...]
    row: np.ndarray
    corner: np.ndarray
    velocity: np.ndarray

    def at(self, positions: slice) -> "Tensors":
        """Return the tensors of some positions."""
        return Tensors(
            tuple(part[positions] for part in self.C),
            tuple(part[positions] for part in self.B),
            *(part[positions] for part in (self.row, self.corner, self.velocity)),
        )


def tensors(base: Base, positions: int) -> Tensors:
    """Return the pencil at every position, for an observer who moves with the flow.

    The velocity only shifts the frequency (`tangent.frame_series` refuses a closure where it does more); left in, its
    roundings would be those of the growth rate too.
    """
    (velocity, *slopes), *others = base.state
    resting = replace(base, state=((tuple(0.0 for _ in velocity), *slopes), *others))
    second, first, zeroth = resting.pencil()
    evolves = base.model.evolves
    e, c = [i for i, on in enumerate(evolves) if on], evolves.index(0)
    axes = (0, 1)

    def filled(components: list) -> np.ndarray:
        found = np.empty((positions, len(components)))
        for i, component in enumerate(components):
            found[:, i] = component
        return found

    return Tensors(
        C=(
            filled([zeroth[i][j] for i in e for j in e]),
            filled([first[a][i][j] for a in axes for i in e for j in e]),
            filled([second[a][b][i][j] for a in axes for b in axes for i in e for j in e]),
        ),
        B=(
            filled([zeroth[i][c] for i in e]),
            filled([first[a][i][c] for a in axes for i in e]),
            filled([second[a][b][i][c] for a in axes for b in axes for i in e]),
        ),
        row=filled([first[a][c][j] for a in axes for j in e]),
        corner=filled([second[a][b][c][c] for a in axes for b in axes]),
        velocity=filled(list(velocity)),
    )


@dataclass(frozen=True)
class Directions:
    """What tensors are contracted with: matrices of components by directions."""

    C: tuple[np.ndarray, ...]
    B: tuple[np.ndarray, ...]
    chi: np.ndarray
    square: np.ndarray


def directions(cosine: np.ndarray, sine: np.ndarray) -> Directions:
    """Return the products of the wave's direction and of its frame's axes (chi, tau), one column a direction."""
    n = cosine.size
    chi = np.stack([cosine, sine])
    R = np.stack([chi, np.stack([-sine, cosine])])
    RR = R[:, None, :, None] * R[None, :, None, :]  # [p, q, i, j]: the entry (p, q) in the frame of the wave
    square = chi[:, None] * chi
    powers = (np.ones(n), chi, square.reshape(4, n))
    return Directions(
        C=tuple((RR[:, :, None] * x.reshape(-1, 1, 1, n)).reshape(2, 2, -1, n) for x in powers),
        B=tuple((R[:, None] * x.reshape(-1, 1, n)).reshape(2, -1, n) for x in powers),
        chi=chi,
        square=powers[2],
    )


def coefficients(t: Tensors, d: Directions, modes: int) -> tuple[dict[str, Series], np.ndarray]:
    """Return the series of `tangent.Pair` (without its determinant) or `tangent.Single`, and the speed along the wave.

    Parameters
    ----------
    t, d : tensors of P positions and n directions
    modes : 2 or 1

    Returns
    -------
    ({part: {order: array (P n,)}}, array (P n,)), positions first
    """
    shape = len(t.velocity), d.chi.shape[1]
    rows = shape[0] * shape[1]
    C, B = np.empty((ORDERS, 2, 2, *shape)), np.empty((3, 2, *shape))  # orders -1 .. 2, and 0 .. 2
    C[0] = 0
    for n in range(3):
        np.matmul(t.C[n], d.C[n], out=C[n + 1])
        np.matmul(t.B[n], d.B[n], out=B[n])
    D, b = C.reshape(ORDERS, 2, 2, rows), B.reshape(3, 2, rows)
    speed = np.matmul(t.velocity, d.chi).reshape(rows)
    if modes == 1:
        return single(D[1:], b), speed
    along = np.matmul(t.row, d.square).reshape(rows)  # chi.row.chi; across chi it vanishes: a divergence
    D[:3, :, 0] -= b * (along / np.matmul(t.corner, d.square).reshape(rows))
    return pair(D), speed


def product(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Return the product of two series given as arrays of coefficients by increasing order."""
    found = np.empty((len(a) + len(b) - 1, *a.shape[1:]))
    np.multiply(a[0], b, out=found[: len(b)])
    found[len(b) :] = 0
    for i in range(1, len(a)):
        found[i : i + len(b)] += a[i] * b
    return found


def pair(D: np.ndarray) -> dict[str, Series]:
    """Return trace and discriminant of D = C - B row/corner, as `tangent.pair` does with symbols."""
    half_gap = (D[:, 0, 0] - D[:, 1, 1]) / 2
    discriminant = product(half_gap, half_gap)
    discriminant[1:] += product(D[1:, 0, 1], D[:, 1, 0])  # the second column alone meets no constraint: no order -1
    return {
        "trace": dict(enumerate(D[:, 0, 0] + D[:, 1, 1], -1)),
        "discriminant": dict(enumerate(discriminant, -2)),
    }


def single(C: np.ndarray, B: np.ndarray) -> dict[str, Series]:
    """Return the parts of ``C_tt - (B_t/B_c) C_ct``, as `tangent.single` does with symbols."""
    limit = B[1, 1] / B[1, 0]
    return {
        "regular": dict(enumerate(C[:, 1, 1] - limit * C[:, 0, 1])),
        "numerator": dict(enumerate((B[0, 1] - limit * B[0, 0]) * C[:, 0, 1])),
        "denominator": dict(enumerate(B[:2, 0])),
    }
