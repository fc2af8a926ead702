"""Uniform strain rate and pressure with a given delta = tr A: what phase diagrams walk over.

Extension along x, major principal stress along y. The pressure Laplacian that (P1.1) needs for delta != 0 does
not enter the tangent matrix; leaving it out shows up as the mass residual of the result.
"""

from math import inf
from math import sqrt as root

from sympy import Integer, sqrt

from stability.flows.base import Flow
from stability.parameters import Parameter
from stability.symbols import p, symbol, u, v, x, y

delta, strain, pressure = symbol("delta"), symbol("strain_rate"), symbol("pressure")
s = sqrt(2 - delta**2)  # A = diag(delta + s, delta - s)/2 has trace delta and A:A = 1

# What further closures ask for and uniform strain fixes: no Laplacian of the velocity, no spin, and the director of the
# major principal stress along y.
AT_REST = {
    symbol(name): Integer(value) for name, value in {"lap_u": 0, "lap_v": 0, "spin": 0, "n1": 0, "n2": 1}.items()
}

UNIFORM_STRAIN = Flow(
    name="uniform_strain",
    title="Uniform plane strain",
    source="paper, (P4.5) to (P6)",
    fields={u: strain * (delta + s) / 2 * x, v: strain * (delta - s) / 2 * y, p: pressure} | AT_REST,
    body_force=(Integer(0), Integer(0)),
    point=(),
    parameters=(
        Parameter("delta", "delta", "1", -root(2), root(2), "rate of dilation tr V/||V||", "paper, P4.5"),
        Parameter("strain_rate", "strain_rate", "1/s", 0, inf, "norm ||V|| of the strain rate", "paper, after I5"),
        Parameter("pressure", "pressure", "m2/s2", 0, inf, "average stress over density", "paper, after I7.1"),
    ),
    axis="the x axis (extension)",
)
