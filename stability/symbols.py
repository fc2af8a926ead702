"""The one place that makes SymPy symbols: the paper's letters, and the names of their components and derivatives."""

from itertools import product

from sympy import ImmutableDenseNDimArray, Symbol

AXES = "xy"


def symbol(name: str) -> Symbol:
    """Return the real symbol of that name: no assumption on sign, so that no simplification hides one."""
    return Symbol(name, real=True)


def components(name: str, rank: int, symmetric: int = 0) -> ImmutableDenseNDimArray:
    """Return the tensor of symbols ``name_xx, name_xy, ...``; its first ``symmetric`` indices commute."""

    def component(index: tuple[int, ...]) -> Symbol:
        index = tuple(sorted(index[:symmetric])) + index[symmetric:]
        return symbol(name + "_" * bool(index) + "".join(AXES[i] for i in index))

    indices = list(product(range(2), repeat=rank))
    return ImmutableDenseNDimArray([component(i) for i in indices], (2,) * rank)


def gradient(field: Symbol) -> tuple:
    """Return the symbols of d field/dx and d field/dy."""
    return tuple(symbol(f"{field}_{a}") for a in AXES)


def hessian(field: Symbol) -> tuple:
    """Return the symbols of the second derivatives of a field; mixed ones are one symbol."""
    return tuple(tuple(symbol(f"{field}_{''.join(sorted(a + b))}") for b in AXES) for a in AXES)


x, y = (symbol(a) for a in AXES)  # local Cartesian coordinates of the point at which a flow is frozen
r, theta = Symbol("r", positive=True), symbol("theta")  # polar coordinates, theta from the hopper's axis
u, v, p = symbol("u"), symbol("v"), symbol("p")  # velocity, average stress over density (after I7.1)
body_force = components("g", 1)  # gravity in the local frame (I1)
varphi, epsilon = symbol("varphi"), symbol("epsilon")  # (I2), (P1.1)
k, mu, norm_V = symbol("k"), symbol("mu"), symbol("N")  # (I2), (I5) over density, ||V||
A = components("A", 2, symmetric=2)  # V/||V||, after (I7.1)
q = symbol("q")  # |xi|
