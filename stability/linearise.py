"""Closure -> moduli along a base state -> plane-wave pencil ``lambda E a = L(xi) a``.

Stage 1  `moduli`: the derivatives dF/dq, dF/dg, dS/dq, dS/dg, written in the closure's letters
Stage 2  `along`: their gradients along the base state, by the chain rule on letters and fields
Stage 3  `pencil`: a disturbance ``a exp(lambda t + i xi.x)`` turns them into L2, L1 and L0, where
         ``L(xi) = sum_ab (i xi_a)(i xi_b) L2[a][b] + sum_a (i xi_a) L1[a] + L0``

Exact about any smooth background: every gradient of the base state is kept. With the powers of i xi set apart,
the matrices are real.
"""

from dataclasses import dataclass
from functools import cache

from sympy import Expr, I, ImmutableMatrix, Matrix, Symbol, diag, expand, solve, zeros

from stability.closures.base import Closure
from stability.symbols import gradient, hessian


@dataclass(frozen=True)
class Moduli:
    """Derivatives of flux and supply; ``Fq[a]``, ``Sq`` and ``Sg[b]`` are n x n, ``Fg[a][b]`` too."""

    Fq: tuple
    Fg: tuple
    Sq: Matrix
    Sg: tuple


@dataclass(frozen=True)
class Pencil:
    """``E`` and the real coefficient matrices of ``L(xi)`` in powers of i xi, all n x n."""

    E: ImmutableMatrix
    L2: tuple
    L1: tuple
    L0: ImmutableMatrix

    def series(self, direction: tuple) -> dict[int, Matrix]:
        """Return ``{n: coefficient of (i|xi|)^n}`` for waves along the given direction."""
        two = sum((direction[a] * direction[b] * self.L2[a][b] for a in (0, 1) for b in (0, 1)), zeros(*self.E.shape))
        one = sum((direction[a] * self.L1[a] for a in (0, 1)), zeros(*self.E.shape))
        return {2: two, 1: one, 0: Matrix(self.L0)}

    def L(self, xi: tuple) -> Matrix:
        """Return the matrix L for the wavevector xi."""
        return sum((I**n * matrix for n, matrix in self.series(xi).items()), zeros(*self.E.shape))


def state_letters(closure: Closure) -> list[Symbol]:
    """Return the letters that vary along a base state, in order of definition (k, for one, does not)."""
    varying = {*closure.q, *closure.g}
    found = []
    for letter, definition in closure.letters.items():
        if definition.free_symbols & varying:
            varying.add(letter)
            found.append(letter)
    return found


class Letters:
    """Rewrites derivatives of the raw state in the closure's letters, which keeps them short."""

    def __init__(self, closure: Closure):
        self.raw = {*closure.q, *closure.g}
        self.patterns, equations = [], []
        for letter in state_letters(closure):
            definition = closure.letters[letter]
            if definition.is_rational_function(*self.raw):  # such as A = V/||V||: solved for the raw state below
                equations.append(letter - definition)
            else:  # such as ||V||, a square root: replaced wherever it stands
                self.patterns.append((definition, letter))
        # Any solution will do: where the letters do not fix the raw state, `rewritten` must not depend on the rest.
        solved = solve(equations, [s for s in (*closure.q, *closure.g) if s in self.raw], dict=True)
        self.solution = solved[0] if solved else {}

    def rewritten(self, expression: Expr) -> Expr:
        """Return a derivative in letters where that is shorter than the raw state."""
        short = expression.subs(self.patterns)
        if short.is_polynomial(*self.raw):  # such as -u_x, the moduli of inertia: short as it is, in the paper's grad u
            if not {s for _, s in self.patterns} & short.free_symbols:
                return short
        return expand(short.subs(self.solution))


@cache
def moduli(closure: Closure) -> Moduli:
    """Return the derivatives of flux and supply in the closure's letters."""
    letters = Letters(closure)
    q = Matrix(closure.q)
    g = [Matrix([gradient(c)[b] for c in closure.q]) for b in (0, 1)]

    def derivative(column: Matrix, by: Matrix) -> ImmutableMatrix:
        return ImmutableMatrix(column.jacobian(by).applyfunc(letters.rewritten))

    F = [closure.flux[:, a] for a in (0, 1)]
    return Moduli(
        Fq=tuple(derivative(F[a], q) for a in (0, 1)),
        Fg=tuple(tuple(derivative(F[a], g[b]) for b in (0, 1)) for a in (0, 1)),
        Sq=derivative(closure.supply, q),
        Sg=tuple(derivative(closure.supply, g[b]) for b in (0, 1)),
    )


@cache
def derivatives(closure: Closure) -> dict[Symbol, tuple[Symbol, Symbol]]:
    """Return, for every quantity that varies along a base state, the symbols of its two derivatives."""
    table = {c: gradient(c) for c in closure.q}
    table |= {gradient(c)[a]: hessian(c)[a] for c in closure.q for a in (0, 1)}
    return table | {letter: gradient(letter) for letter in state_letters(closure)}


def along(closure: Closure, expression: Expr, axis: int) -> Expr:
    """Return the derivative of an expression along the base state, by the chain rule."""
    table = derivatives(closure)
    varying = sorted(expression.free_symbols & table.keys(), key=str)
    return sum((expression.diff(s) * table[s][axis] for s in varying), 0 * expression)


@cache
def letter_gradients(closure: Closure) -> dict[Symbol, Expr]:
    """Return ``{symbol of d letter/dx_a: expression}`` in the letters and the second gradients of the state."""
    letters = Letters(closure)
    return {
        gradient(letter)[a]: along(closure, closure.letters[letter], a).subs(letters.patterns)
        for letter in state_letters(closure)
        for a in (0, 1)
    }


@cache
def pencil(closure: Closure) -> Pencil:
    """Return the plane-wave pencil of the closure, linearised about any smooth base state."""
    m = moduli(closure)

    def divergence(matrices: tuple) -> Matrix:
        return sum(
            (matrices[a].applyfunc(lambda e, a=a: along(closure, e, a)) for a in (0, 1)), zeros(*matrices[0].shape)
        )

    return Pencil(
        E=ImmutableMatrix(diag(*closure.evolves)),
        L2=tuple(tuple(-m.Fg[a][b] for b in (0, 1)) for a in (0, 1)),
        L1=tuple(ImmutableMatrix(m.Sg[b] - m.Fq[b] - divergence(tuple(m.Fg[a][b] for a in (0, 1)))) for b in (0, 1)),
        L0=ImmutableMatrix(m.Sq - divergence(m.Fq)),
    )


@cache
def imbalance(closure: Closure) -> ImmutableMatrix:
    """Return div F - S of a steady base state: zero where it satisfies the closure's equations."""
    div = [
        sum(
            (closure.flux[i, a].diff(s) * derivatives(closure)[s][a] for a in (0, 1) for s in (*closure.q, *closure.g)),
            0,
        )
        for i in range(len(closure.q))
    ]
    return ImmutableMatrix([d - s for d, s in zip(div, closure.supply, strict=True)])
