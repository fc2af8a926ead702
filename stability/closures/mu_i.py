"""The incompressible mu(I) rheology.

Source: Jop, Forterre & Pouliquen, Nature 441, 2006; well-posedness in Barker, Schaeffer, Bohorquez & Gray, J. Fluid
Mech. 779, 2015: well-posed iff ``4 nu^2 - 4 nu + mu^2 (1 - nu/2)^2 <= 0`` with nu = I mu'/mu, which the closure's own
pencil reproduces.
"""

from stability.closures.base import Closure
from stability.closures.inertial_number import (
    FRICTION,
    GRAINS,
    I_0,
    INERTIAL_NUMBER,
    isotropic_stress,
    mu_2,
    mu_s,
)
from stability.closures.plane_flow import momentum_and_mass, velocity


def friction(I):
    """Return mu(I) = mu_s + (mu_2 - mu_s)/(1 + I_0/I)."""
    return mu_s + (mu_2 - mu_s) * I / (I_0 + I)


MU_I = Closure(
    name="mu_i",
    title="Incompressible mu(I) rheology",
    source="Barker, Schaeffer, Bohorquez & Gray, J. Fluid Mech. 779, 2015",
    **momentum_and_mass(isotropic_stress(friction(INERTIAL_NUMBER)), velocity),
    parameters=(*GRAINS, *FRICTION),
)
