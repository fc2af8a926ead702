"""The inertial number I, and the stress of an isotropic rheology whose friction depends on it.

I = 2 d ||D||/sqrt(P/rho_*) with ||D|| = sqrt(D:D/2) = ||V||/sqrt 2, P the pressure, rho_* the density of the grains and
d their diameter (Barker, Schaeffer, Bohorquez & Gray, J. Fluid Mech. 779, 2015). The package's p is P over the density
of the medium, solid_fraction rho_*, hence P/rho_* = solid_fraction p.
"""

from math import inf

from sympy import Expr, Matrix, eye, sqrt

from stability.closures.base import norm
from stability.closures.plane_flow import V
from stability.parameters import Parameter
from stability.symbols import p, symbol

LITERATURE = "Barker, Schaeffer, Bohorquez & Gray, J. Fluid Mech. 779, 2015"

d, phi_s, mu_s, mu_2, I_0 = (symbol(name) for name in ("d", "phi_s", "mu_s", "mu_2", "I_0"))

INERTIAL_NUMBER = sqrt(2) * d * norm(V) / sqrt(phi_s * p)

GRAINS = (
    Parameter("grain_diameter", "d", "m", 0, inf, "diameter of the grains", LITERATURE),
    Parameter("solid_fraction", "phi_s", "1", 0, 1, "volume fraction of the grains, constant", LITERATURE),
)
FRICTION = (
    Parameter("static_friction", "mu_s", "1", 0, inf, "friction coefficient at I = 0", LITERATURE),
    Parameter("dynamic_friction", "mu_2", "1", 0, inf, "friction coefficient at large I", LITERATURE),
    Parameter("reference_inertial_number", "I_0", "1", 0, inf, "inertial number half way between the two", LITERATURE),
)


def isotropic_stress(friction: Expr) -> Matrix:
    """Return ``p - mu p D/||D||`` over density, positive in compression."""
    return p * eye(2) - sqrt(2) * friction * p * V / norm(V)
