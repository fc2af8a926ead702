"""What a flow is: a smooth base state, written in local Cartesian coordinates about the point where it is frozen."""

from collections.abc import Mapping
from dataclasses import dataclass, field

from sympy import Expr, Symbol

from stability.parameters import Parameter
from stability.symbols import gradient, hessian, x, y


@dataclass(frozen=True, eq=False)  # compared and hashed by identity: the letters are a dict
class Flow:
    """A base state.

    Attributes
    ----------
    name, title, source : the word in scenes, one sentence, paper label or citation
    fields : ``{field: expression}`` in the local coordinates `symbols.x`, `symbols.y`, which vanish at the
        point, the point's own coordinates, letters and parameters
    body_force : gravity in the same local frame
    point : records of the coordinates that choose the point; empty for a uniform flow
    parameters : records of every constant
    letters : named intermediate constants ``{symbol: definition}``, reported with every result
    conditions : ``(relation that must hold, sentence)``; the sentence says what the user broke
    axis : what wave angle 0 means
    """

    name: str
    title: str
    source: str
    fields: Mapping[Symbol, Expr]
    body_force: tuple[Expr, Expr]
    point: tuple[Parameter, ...]
    parameters: tuple[Parameter, ...]
    letters: Mapping[Symbol, Expr] = field(default_factory=dict)
    conditions: tuple[tuple[Expr, str], ...] = ()
    axis: str = "e_x"

    def jet(self) -> dict[Symbol, Expr]:
        """Return ``{symbol: expression}`` of every field, gradient and second gradient at the point."""
        here, found = {x: 0, y: 0}, {}
        for name, e in self.fields.items():
            found[name] = e.subs(here)
            found |= {gradient(name)[a]: e.diff(X).subs(here) for a, X in enumerate((x, y))}
            second = ((a, b, e.diff(X, Y)) for a, X in enumerate((x, y)) for b, Y in enumerate((x, y)) if a <= b)
            found |= {hessian(name)[a][b]: d.subs(here) for a, b, d in second}
        return found
