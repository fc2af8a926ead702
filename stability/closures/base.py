"""What a closure is: balance laws ``E dq/dt + div F(q, grad q) = S(q, grad q)`` as SymPy expressions."""

from collections.abc import Mapping
from dataclasses import dataclass, field

from sympy import Expr, ImmutableMatrix, Matrix, Symbol, sqrt

from stability import symbols
from stability.closures.checks import problems
from stability.errors import SceneError
from stability.parameters import Parameter


def strain_rate(grad_u: Matrix) -> Matrix:
    """Return V, the symmetric part of the velocity gradient (after I4)."""
    return (grad_u + grad_u.T) / 2


def norm(V: Matrix) -> Expr:
    """Return ||V|| = sqrt(V_ij V_ij) (after I5)."""
    return sqrt(sum(entry**2 for entry in V))


@dataclass(frozen=True, eq=False)  # compared and hashed by identity: the letters are a dict
class Closure:
    """A rheology: one balance law per field.

    Attributes
    ----------
    name, title, source : the word in scenes, one sentence, paper label or citation
    fields : the unknowns q; a pair of symbols is a vector, a single symbol a scalar
    evolves : diagonal of E, 1 for an evolution equation and 0 for a constraint, one per component of q
    flux : F, one row per component of q and one column per direction
    supply : S, one entry per component of q
    parameters : records of every constant that F and S contain
    letters : named intermediate quantities ``{symbol: definition}``, each in q, grad q and earlier letters.
        They only keep expressions short and in the paper's notation; they may be left out.
    relations : ``(letter, polynomial that vanishes)``: identities between letters, used to eliminate powers
        of that letter where two terms would otherwise cancel in floating point
    """

    name: str
    title: str
    source: str
    fields: tuple
    evolves: tuple[int, ...]
    flux: ImmutableMatrix
    supply: ImmutableMatrix
    parameters: tuple[Parameter, ...]
    letters: Mapping[Symbol, Expr] = field(default_factory=dict)
    relations: tuple[tuple[Symbol, Expr], ...] = ()

    def __post_init__(self) -> None:
        if problem := next(problems(self), None):
            raise SceneError(problem)
        # As given they may be lists or may change later: what is derived is kept under this object's identity.
        for name, kind in (("flux", ImmutableMatrix), ("supply", ImmutableMatrix), ("parameters", tuple)):
            object.__setattr__(self, name, kind(getattr(self, name)))
        object.__setattr__(self, "evolves", tuple(map(int, self.evolves)))

    @property
    def q(self) -> tuple[Symbol, ...]:
        """The components of the fields, vectors flattened."""
        return tuple(c for f in self.fields for c in (f if isinstance(f, tuple) else (f,)))

    @property
    def g(self) -> tuple[Symbol, ...]:
        """The gradients of q, component by component."""
        return tuple(d for c in self.q for d in symbols.gradient(c))
