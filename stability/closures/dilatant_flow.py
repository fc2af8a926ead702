"""Balance laws of a compressible plane flow (u, v, p, phi): a yield stress Y and a rate of dilation f.

    D(phi)/Dt + phi div u = 0        div u = 2 f ||D||        phi Du/Dt = phi g - div(p - Y D/||D||)

with D the deviator of the strain rate and ||D|| = sqrt(D:D/2), in the form of Pitman & Schaeffer (Commun. Pure Appl.
Math. 40, 1987) and of Barker, Schaeffer, Shearer & Gray (Proc. R. Soc. A 473, 2017). The density of the medium varies,
so p and Y are pressure and stress over the density of the *grains*. Momentum over phi is a divergence and a source,
``(1/phi) div s = div(s/phi) + s.grad phi/phi^2``, which is exact.
"""

from math import inf

from sympy import Expr, ImmutableMatrix, Matrix, eye, sqrt

from stability.closures.plane_flow import V, grad_u, velocity
from stability.parameters import Parameter
from stability.symbols import body_force, gradient, p, symbol, u, v

(u_x, u_y), (v_x, v_y) = gradient(u), gradient(v)
phi = symbol("phi")  # the volume fraction of the grains, a field; the angle of the paper's (P5) has no symbol
deviator = V - V.trace() / 2 * eye(2)
rate = sqrt((u_x - v_y) ** 2 + (u_y + v_x) ** 2) / 2  # ||D||, shorter than norm(deviator)/sqrt 2
d = symbol("d")
INERTIAL_NUMBER = 2 * d * rate / sqrt(p)  # p is pressure over the density of the grains
GRAIN_DIAMETER = Parameter(
    "grain_diameter",
    "d",
    "m",
    0,
    inf,
    "diameter of the grains",
    "Barker, Schaeffer, Bohorquez & Gray, J. Fluid Mech. 779, 2015",
)


def momentum_over_fraction(stress: Matrix) -> tuple[Matrix, Matrix]:
    """Return flux and supply of ``phi Du/Dt = phi g - div stress`` divided by phi; stress over the grains' density."""
    slope = Matrix(gradient(phi))
    supply = Matrix(body_force.tolist()) - grad_u * velocity - stress * slope / phi**2
    return stress / phi, supply


def dilatant(Y: Expr, f: Expr) -> dict:
    """Return fields, E, F and S of the flow with yield stress Y and rate of dilation f."""
    flux, supply = momentum_over_fraction(p * eye(2) - Y * deviator / rate)
    return {
        "fields": ((u, v), p, phi),
        "evolves": (1, 1, 0, 1),
        "flux": ImmutableMatrix(flux.col_join(velocity.T).col_join(phi * velocity.T)),
        "supply": ImmutableMatrix([*supply, 2 * f * rate, 0]),
    }
