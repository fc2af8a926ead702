"""Closure -> moduli along a base state -> plane-wave pencil ``lambda E a = L(xi) a``.

Stage 1  `moduli`: the derivatives dF/dq, dF/dg, dS/dq, dS/dg, written in the closure's letters
Stage 2  `along`: their gradients along the base state, by the chain rule on letters and fields
Stage 3  `pencil`: a disturbance ``a exp(lambda t + i xi.x)`` turns them into L2, L1 and L0, where
         ``L(xi) = sum_ab (i xi_a)(i xi_b) L2[a][b] + sum_a (i xi_a) L1[a] + L0``

Exact about any smooth background: every gradient of the base state is kept. With the powers of i xi set apart,
the matrices are real.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from itertools import count

from sympy import Expr, I, ImmutableMatrix, Matrix, Symbol, cse, diag, expand, solve, zeros

from stability.closures.base import Closure
from stability.symbols import gradient, hessian, symbol


@dataclass(frozen=True)
class Moduli:
    """Derivatives of flux and supply, ``Fq[a]``, ``Fg[a][b]``, ``Sq``, ``Sg[b]``, all n x n, and their letters."""

    Fq: tuple
    Fg: tuple
    Sq: Matrix
    Sg: tuple
    letters: dict
    patterns: tuple


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


class Rewriter:
    """Rewrites derivatives of the raw state in letters, which keeps everything that follows short.

    The closure's own letters come first. What they leave over, or everything in a closure that declares none, gets the
    letters m_0, m_1, ..., one for each different entry that is not a polynomial in the raw state, and, in
    `shared_letters`, one for each expression that these have in common: their gradients are then short too.
    """

    def __init__(self, closure: Closure):
        self.raw = {*closure.q, *closure.g}
        self.letters, self.own = dict(closure.letters), len(closure.letters)
        self.patterns, equations = [], []
        for letter in varying(closure, self.letters):
            definition = self.letters[letter]
            if definition.is_rational_function(*self.raw):  # such as A = V/||V||: solved for the raw state below
                equations.append(letter - definition)
            else:  # such as ||V||, a square root: replaced wherever it stands
                self.patterns.append((definition, letter))
        # Any solution will do: what letters can express does not depend on the part of the raw state they leave open.
        solved = solve(equations, [*closure.q, *closure.g], dict=True) if equations else []
        self.solution = solved[0] if solved else {}

    def __call__(self, derivative: Expr) -> Expr:
        """Return a derivative in letters, with a new letter where those there are cannot express it."""
        short = derivative.subs(self.patterns)
        if derivative.is_polynomial(*self.raw):  # such as -u_x, the moduli of inertia: short as it is
            return derivative
        # Expanding cancels raw symbols against each other once letters stand for some; without any it only costs.
        in_letters = expand(short.subs(self.solution)) if self.solution else short
        if not in_letters.free_symbols & self.raw:
            return in_letters
        for letter, definition in self.letters.items():
            if definition == derivative:
                return letter
        letter = symbol(f"m_{len(self.letters) - self.own}")
        self.letters[letter] = derivative
        return letter

    def shared_letters(self) -> dict[Symbol, Expr]:
        """Return all letters, those that others are defined by first."""
        own, new = (list(self.letters.items())[part] for part in (slice(self.own), slice(self.own, None)))
        names = (symbol(f"m_{i}") for i in count(len(new)))
        common, short = cse([definition for _, definition in new], symbols=names, order="none")
        return dict([*own, *common, *zip((letter for letter, _ in new), short, strict=True)])


def varying(closure: Closure, letters: Mapping[Symbol, Expr]) -> list[Symbol]:
    """Return the letters that vary along a base state, in order of definition (k, for one, does not)."""
    known = {*closure.q, *closure.g}
    found = []
    for letter, definition in letters.items():
        if definition.free_symbols & known:
            known.add(letter)
            found.append(letter)
    return found


@cache
def moduli(closure: Closure) -> Moduli:
    """Return the derivatives of flux and supply in letters."""
    rewritten = Rewriter(closure)
    q = Matrix(closure.q)
    g = [Matrix([gradient(c)[b] for c in closure.q]) for b in (0, 1)]

    def derivative(column: Matrix, by: Matrix) -> ImmutableMatrix:
        return ImmutableMatrix(column.jacobian(by).applyfunc(rewritten))

    F = [closure.flux[:, a] for a in (0, 1)]
    return Moduli(
        Fq=tuple(derivative(F[a], q) for a in (0, 1)),
        Fg=tuple(tuple(derivative(F[a], g[b]) for b in (0, 1)) for a in (0, 1)),
        Sq=derivative(closure.supply, q),
        Sg=tuple(derivative(closure.supply, g[b]) for b in (0, 1)),
        letters=rewritten.shared_letters(),
        patterns=tuple(rewritten.patterns),
    )


def letters(closure: Closure) -> dict[Symbol, Expr]:
    """Return ``{letter: definition}`` of every letter in the moduli, each in the raw state and earlier letters."""
    return moduli(closure).letters


def state_letters(closure: Closure) -> list[Symbol]:
    """Return the letters that vary along a base state."""
    return varying(closure, letters(closure))


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
    return {
        gradient(letter)[a]: along(closure, letters(closure)[letter], a).subs(moduli(closure).patterns)
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
