"""The compressible mu(I), Phi(I) rheology with a bulk friction.

Source: Heyman, Delannay, Tabuteau & Valance, J. Fluid Mech. 830, 2017. The volume fraction phi evolves with the mass
balance; Phi(I) = phi_m - a I, read backwards, gives the pressure as a function of phi and of the rate of shear, ``p =
(2 d ||D||/I)^2`` with ``I = (phi_m - phi)/a`` and p over the density of the grains. Friction mu(I) then depends on phi
alone, and the bulk friction adds the pressure ``-mu_b p div u/||D||``.

Well-posed iff ``mu_b > 1 - 7 mu/6`` where D is the deviator of a three-dimensional flow, as published, and iff ``mu_b
> 1 - mu`` where it is that of a two-dimensional one. The registered closure is the former: plane strain, with D_zz =
-div u/3.
"""

from math import inf

from sympy import Expr, ImmutableMatrix, Rational, eye, sqrt

from stability.closures.base import Closure
from stability.closures.dilatant_flow import GRAIN_DIAMETER, d, momentum_over_fraction, phi
from stability.closures.dilatant_flow import rate as plane_rate
from stability.closures.plane_flow import V, velocity
from stability.parameters import Parameter
from stability.symbols import symbol, u, v

SOURCE = "Heyman, Delannay, Tabuteau & Valance, J. Fluid Mech. 830, 2017"

mu_s, mu_2, I_0, a, phi_m, mu_b = (symbol(n) for n in ("mu_s", "mu_2", "I_0", "a", "phi_m", "mu_b"))

I = (phi_m - phi) / a  # Phi(I) read backwards
friction = mu_s + (mu_2 - mu_s) * I / (I_0 + I)


def bulk_frictional(dimensions: int) -> dict:
    """Return fields, E, F and S of plane strain with the deviator of a flow in 2 or 3 dimensions."""
    expansion = V.trace()
    D = V - expansion / dimensions * eye(2)
    # Half the square of the deviator: that of the plane one, and of what D_zz = -div u/3 adds in three dimensions.
    rate: Expr = sqrt(plane_rate**2 + Rational(dimensions - 2, 12) * expansion**2)
    p = (2 * d * rate / I) ** 2
    flux, supply = momentum_over_fraction((p - mu_b * p * expansion / rate) * eye(2) - friction * p * D / rate)
    return {
        "fields": ((u, v), phi),
        "evolves": (1, 1, 1),
        "flux": ImmutableMatrix(flux.col_join(phi * velocity.T)),
        "supply": ImmutableMatrix([*supply, 0]),
    }


PARAMETERS = (
    GRAIN_DIAMETER,
    Parameter("static_friction", "mu_s", "1", 0, inf, "friction coefficient at I = 0", SOURCE),
    Parameter("dynamic_friction", "mu_2", "1", 0, inf, "friction coefficient at large I", SOURCE),
    Parameter("reference_inertial_number", "I_0", "1", 0, inf, "inertial number half way between the two", SOURCE),
    Parameter("dilation_slope", "a", "1", 0, inf, "decrease of the volume fraction with I", SOURCE),
    Parameter("maximum_fraction", "phi_m", "1", 0, 1, "volume fraction at I = 0", SOURCE),
    Parameter("bulk_friction", "mu_b", "1", 0, inf, "friction coefficient of a change of volume", SOURCE),
)

MU_I_PHI_I = Closure(
    name="mu_i_phi_i",
    title="Compressible mu(I), Phi(I) rheology with bulk friction",
    source=SOURCE,
    **bulk_frictional(3),
    parameters=PARAMETERS,
)
