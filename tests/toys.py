"""Closures with a known symbol, one a question: their waves are solved by hand in the comments."""

from sympy import Expr, ImmutableMatrix, Integer

from stability.closures.base import Closure
from stability.flows.base import Flow
from stability.parameters import Parameter
from stability.symbols import gradient, symbol

a, b, c = (symbol(n) for n in "abc")
g = symbol("growth")
(a_x, a_y), (b_x, b_y), (c_x, c_y) = map(gradient, (a, b, c))
GROWTH = Parameter("growth", "growth", "1/s", -10, 10, "constant of the toy", "this test")


def toy(name: str, laws: dict, parameters: tuple = ()) -> Closure:
    """Return the closure of ``{field: (evolves, flux_x, flux_y, supply)}``."""
    rows = list(laws.values())
    return Closure(
        name=name,
        title=name,
        source="this test",
        fields=tuple(laws),
        evolves=tuple(row[0] for row in rows),
        flux=ImmutableMatrix([[row[1], row[2]] for row in rows]),
        supply=ImmutableMatrix([row[3] for row in rows]),
        parameters=parameters,
    )


def rest(*fields: Expr, **values: float) -> Flow:
    """Return a uniform flow of the fields, all zero unless told."""
    return Flow(
        name="rest",
        title="at rest",
        source="this test",
        fields={f: Integer(0) + values.get(str(f), 0) for f in fields},
        body_force=(Integer(0), Integer(0)),
        point=(),
        parameters=(),
    )


REST = rest(a, b, c)
# lambda^2 = q^2 cos^2: Laplace's equation in time
ELLIPTIC = toy("elliptic", {a: (1, -b, 0, 0), b: (1, a, 0, 0)})
# lambda^2 = i q cos
HALF = toy("half", {a: (1, 0, 0, b), b: (1, -a, 0, 0)})
# lambda^3 = -q^2 cos^2
TWO_THIRDS = toy("two_thirds", {a: (1, 0, 0, b), b: (1, 0, 0, c), c: (1, -a_x, 0, 0)})
# lambda^2 - growth lambda + q^2 cos^2 = 0: i q cos + growth/2, but growth itself along y
TELEGRAPH = toy("telegraph", {a: (1, -b, 0, 0), b: (1, -a, 0, g * b)}, (GROWTH,))
# lambda = growth X - X^2 with X = q^2 cos sin: every direction decays at last, growth^2/4 stays
FLEETING = toy("fleeting", {a: (1, -b_y, 0, g * b), b: (0, -a_y, 0, b)}, (GROWTH,))
# 0 = b^2: b is free where it vanishes
FREE = toy("free", {a: (1, 0, 0, b), b: (0, 0, 0, b**2)})
# 0 = b_x - a: lambda = 1/(i q cos)
FREE_ALONG_Y = toy("free_along_y", {a: (1, 0, 0, b), b: (0, b, 0, a)})
# b = Lap a: lambda = q^2 - q^4/10
HYPERVISCOUS = toy("hyperviscous", {a: (1, a_x + b_x / 10, a_y + b_y / 10, 0), b: (0, -a_x, -a_y, -b)})
# lambda = -growth q^2
DIFFUSION = toy("diffusion", {a: (1, -g * a_x, -g * a_y, 0)}, (GROWTH,))
