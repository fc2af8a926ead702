"""The paper's matrices as reductions of the plane-wave pencil: D, its truncation D', and its leading part M.

Unknowns under a constraint (E = 0, here the pressure) are eliminated. Where the constraint sees them (P1.1) this is
the Schur complement, D = C - i B xi^T/(epsilon xi^2)  (P3). Where it does not (I7.1) it is the projection
D = (1 - B xi^T/(B.xi)) C  (L3.1), whose zero eigenvalue belongs to no disturbance.

Numbers are not computed from those 2 x 2 entries. `Pair` and `Single` hold what the eigenvalues need in powers of
s = i|xi|, for a wave along the x axis of its own frame (chi, tau): closures are frame-indifferent, so the base state is
turned instead. There A = [[a, b], [b, d]], and identities such as A:A = 1 are applied *before* two terms can cancel in
floating point: Det M comes out as mu^2 d^2/2 |xi|^4 and not as a difference.

D' and M freeze the moduli: they take dF/dq, dF/dg, dS/dq and dS/dg as they are at the point, pressure and strain rate
included, and leave out how these vary along the base state, and inertia. What is left of D for the paper's closure is
(P7). M is its part of second order in the wavenumber.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache

from sympy import Expr, ImmutableMatrix, Integer, Matrix, Rational, expand, eye, fraction, rem, together, zeros
from sympy import factor as factored

from stability.closures.base import Closure
from stability.errors import SceneError
from stability.flows.base import Flow
from stability.linearise import Pencil, letter_gradients, letters, moduli, pencil
from stability.structure import frame_indifferent, galilean
from stability.symbols import gradient

WAVE = (1, 0)  # the direction of the wave in its own frame
Series = dict[int, Expr]  # {n: coefficient of s^n}, s = i|xi|
ZERO: Series = {0: Integer(0)}


class NoClosedFormError(SceneError):
    """A closure whose eigenvalues are those of its pencil and of nothing shorter."""


@dataclass(frozen=True)
class Pair:
    """Two modes: trace, determinant and discriminant ((D11 - D22)/2)^2 + D12 D21 of D."""

    trace: Series
    determinant: Series
    discriminant: Series


@dataclass(frozen=True)
class Single:
    """One mode: ``lambda = regular(s) - numerator(s)/denominator(s)``, the denominator linear in s."""

    regular: Series
    numerator: Series
    denominator: Series


def blocks(closure: Closure, matrix: Matrix) -> tuple[Matrix, Matrix, Matrix, Matrix]:
    """Return C, B, row and corner of ``L = [[C, B], [row, corner]]``: evolving fields first, constrained ones last."""
    e = [i for i, on in enumerate(closure.evolves) if on]
    c = [i for i, on in enumerate(closure.evolves) if not on]
    return matrix[e, e], matrix[e, c], matrix[c, e], matrix[c, c]


def depends_on(matrices: tuple, components: tuple, named: dict) -> bool:
    """Return whether an entry of some matrix, or a letter in one, holds a component."""
    found = set().union(*(m.free_symbols for m in matrices))
    for letter, definition in reversed(named.items()):
        found |= definition.free_symbols if letter in found else set()
    return not found.isdisjoint(components)


@cache
def truncated(closure: Closure) -> Pencil:
    """Return the pencil whose reduction is D' (P7): moduli frozen, without inertia."""
    m, n = moduli(closure), len(closure.q)
    velocity = next((f for f in closure.fields if isinstance(f, tuple)), ())
    rows = [closure.q.index(c) for c in velocity]
    Sq, Sg = zeros(n, n), (zeros(n, n), zeros(n, n))  # those of inertia, S = -(u.grad) u
    for i in rows:
        for b, j in enumerate(rows):
            Sq[i, j], Sg[b][i, i] = -gradient(closure.q[i])[b], -velocity[b]
    for part in (0, 1):  # a closure without inertia (slow flow) has nothing to lose
        first = tuple(ImmutableMatrix(m.Sg[b] - part * Sg[b] - m.Fq[b]) for b in (0, 1))
        found = Pencil(pencil(closure).E, pencil(closure).L2, first, ImmutableMatrix(m.Sq - part * Sq))
        if not depends_on((*first, found.L0, *(L for row in found.L2 for L in row)), velocity, m.letters):
            return found
    raise NoClosedFormError(
        f"closure {closure.name} has no D': the velocity enters it by more than inertia, (u.grad) u"
    )


def leading(closure: Closure) -> Pencil:
    """Return the pencil of which M (P4) is made: the highest order of each block of D'."""
    P = truncated(closure)
    mixed = ImmutableMatrix(*P.E.shape, lambda i, j: int(closure.evolves[i] != closure.evolves[j]))
    return Pencil(P.E, P.L2, tuple(L.multiply_elementwise(mixed) for L in P.L1), 0 * P.L0)


PENCILS: dict[str, Callable[[Closure], Pencil]] = {"full": pencil, "truncated": truncated, "leading": leading}
MATRICES = tuple(PENCILS)  # D, D', M


def tangent(closure: Closure, xi: tuple, matrix: str = "full") -> ImmutableMatrix:
    """Return D (L3.1, P3), D' (P7) or M (P4) for the wavevector ``xi``, in the closure's letters.

    Nothing is expanded: the entries stay as short as the reduction makes them. Without a constraint D is L itself.
    """
    constraints = closure.evolves.count(0)
    if constraints > 1 or (matrix != "full" and (constraints, len(closure.evolves)) != (1, 3)):
        raise SceneError(
            f"closure {closure.name} has no matrix of that kind: D is derived for one constraint or none, "
            "D' and M for two velocities and one constraint; its pencil is that of stability.linearise"
        )
    L = PENCILS[matrix](closure).L(xi)
    if not constraints:
        return L
    C, B, row, corner = blocks(closure, L)
    if corner.is_zero_matrix:
        return ImmutableMatrix((eye(C.rows) - B * row / (row * B)[0]) * C)  # (L3.1)
    if matrix == "leading":
        return ImmutableMatrix(C)  # (P4): the constraint acts at O(1)
    return ImmutableMatrix(C - B * row / corner[0].factor())  # (P3)


def on_flow(closure: Closure, flow: Flow, matrix: ImmutableMatrix) -> ImmutableMatrix:
    """Return a tangent matrix with every letter written out on a flow: long, and not meant for evaluation."""
    named = {**letters(closure), **letter_gradients(closure)}
    for definitions in (named, flow.jet(), flow.letters):
        for letter, definition in reversed(list(definitions.items())):
            matrix = matrix.subs(letter, definition)
    return matrix


def product(one: Series, other: Series) -> Series:
    """Return the product of two series."""
    result: Series = {}
    for i, a in one.items():
        for j, b in other.items():
            result[i + j] = result.get(i + j, 0) + a * b
    return result


def combined(*terms: tuple[Expr, Series]) -> Series:
    """Return the linear combination of series, without the coefficients that vanish."""
    result: Series = {}
    for factor, series in terms:
        for n, coefficient in series.items():
            result[n] = result.get(n, 0) + factor * coefficient
    return {n: c for n, c in result.items() if c != 0}


def entry(series: dict[int, Matrix], i: int, j: int) -> Series:
    """Return one entry of a series of matrices."""
    return {n: m[i, j] for n, m in series.items() if m[i, j] != 0}


def frame_series(closure: Closure, matrix: str) -> dict[int, Matrix]:
    """Return the series of L for a wave along x in its own frame, the Doppler shift -i u.xi left out."""
    hidden = any(set(closure.q[:2]) & definition.free_symbols for definition in letters(closure).values())
    if hidden or not galilean(closure):
        raise NoClosedFormError(
            f"closure {closure.name} is not Galilean invariant: -i u.xi does not merely shift the frequency"
        )
    rest = dict.fromkeys(closure.q[:2], 0)
    return {n: m.subs(rest) for n, m in PENCILS[matrix](closure).series(WAVE).items()}


@cache
def reduced_form(closure: Closure, matrix: str = "full") -> Pair | Single:
    """Return what the eigenvalues of D, D' or M need, in powers of s = i|xi|, or raise `NoClosedFormError`."""
    if closure.evolves != (1, 1, 0) or not isinstance(closure.fields[0], tuple):
        raise NoClosedFormError(f"closure {closure.name}: closed forms exist for two velocities and one constraint")
    C, B, row, corner = block_series(closure, frame_series(closure, matrix))
    if set(row) != {1} or row[1][1] != 0 or set(B) - {0, 1} or corner.keys() - {2}:
        raise NoClosedFormError(
            f"closure {closure.name}: closed forms exist for div u = 0 and for div u = the Laplacian of the unknown"
        )
    if not frame_indifferent(closure):
        raise NoClosedFormError(f"closure {closure.name} prefers a direction: its waves have no frame of their own")

    def reduced(expression: Expr) -> Expr:
        numerator, denominator = fraction(together(expression))
        for letter, vanishing in closure.relations:
            numerator = rem(expand(numerator), vanishing, letter)
        return factored(numerator / denominator)

    if not corner:
        return single(C, B, reduced)
    return pair(eliminated(closure, frame_series(closure, matrix), matrix), reduced)


def block_series(closure: Closure, L: dict[int, Matrix]) -> tuple:
    """Return the blocks of a series of L, each without the orders that vanish."""
    parts = {n: blocks(closure, m) for n, m in L.items()}
    return tuple({n: b[i] for n, b in parts.items() if not b[i].is_zero_matrix} for i in range(4))


def eliminated(closure: Closure, L: dict[int, Matrix], matrix: str) -> dict[int, Matrix]:
    """Return the series of D, D' or M from that of L: the Schur complement (P3), order by order."""
    C, B, row, corner = block_series(closure, L)
    if set(corner) != {2} or set(row) != {1}:
        raise ValueError(f"closure {closure.name}: the constraint must see its unknown through a Laplacian")
    D = dict(C)
    for n, b in B.items():
        if matrix != "leading":
            D[n - 1] = D.get(n - 1, zeros(*b.shape[:1] * 2)) - b * row[1] / corner[2][0]
    return D


def in_powers(closure: Closure, matrix: str = "full", direction: tuple = WAVE) -> dict[int, Matrix]:
    """Return D, D' or M along a unit direction as ``{n: real coefficient of (i|xi|)^n}``, n = 2, 1, 0, -1.

    Only where the constraint sees its unknown; the projection (L3.1) is a quotient of series, see `Single`.
    """
    return eliminated(closure, PENCILS[matrix](closure).series(direction), matrix)


def parity(series: Series, odd: int) -> Series:
    """Return the terms of odd or of even order."""
    return {n: c for n, c in series.items() if n % 2 == odd}


def pair(D: dict[int, Matrix], reduced) -> Pair:
    """Return trace, determinant and discriminant of a 2 x 2 series.

    In the determinant, even times even holds no gradient of a letter: it is short enough to expand, and it is where
    terms cancel; odd times odd is left as it stands.
    """
    D = {n: m.applyfunc(reduced) if n % 2 == 0 else m for n, m in D.items()}
    D11, D12, D21, D22 = (entry(D, i, j) for i in (0, 1) for j in (0, 1))
    determinant = [
        combined((1, product(parity(D11, i), parity(D22, j))), (-1, product(parity(D12, i), parity(D21, j))))
        for i, j in ((0, 0), (0, 1), (1, 0), (1, 1))
    ]
    determinant[0] = {n: reduced(c) for n, c in determinant[0].items()}
    half_gap = combined((Rational(1, 2), D11), (-Rational(1, 2), D22))
    return Pair(
        trace=combined((1, D11), (1, D22)) or ZERO,
        determinant=combined(*((1, part) for part in determinant)) or ZERO,
        discriminant=combined((1, product(half_gap, half_gap)), (1, product(D12, D21))) or ZERO,
    )


def single(C: dict[int, Matrix], B: dict[int, Matrix], reduced) -> Single:
    """Return ``C_tt - (B_t/B_c) C_ct`` with B_t/B_c split into its limit at large |xi| and the rest.

    The constraint leaves only disturbances along tau; the left vector (-B_t/B_c, 1) removes the pressure. This is
    Tr D (L4) without the spurious zero eigenvalue.
    """
    B_c, B_t = entry(B, 0, 0), entry(B, 1, 0)
    if 1 not in B_c:
        raise NoClosedFormError("the unknown of the constraint must act by its gradient along the wave")
    limit = B_t.get(1, Integer(0)) / B_c[1]
    C_ct, C_tt = entry(C, 0, 1), entry(C, 1, 1)
    regular = combined((1, C_tt), (-limit, C_ct))
    regular = {n: reduced(c) if n == 2 else c for n, c in regular.items()} or ZERO  # no viscosity, no inertia: none
    rest = combined((1, {0: B_t.get(0, Integer(0))}), (-limit, {0: B_c.get(0, Integer(0))}))
    return Single(regular=regular, numerator=product(rest, C_ct), denominator=B_c)
