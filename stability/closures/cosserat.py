"""Micropolar Coulomb flow: grains spin, and couples resist gradients of the spin over an internal length.

Source: in the spirit of Muhlhaus & Vardoulakis, Geotechnique 37, 1987, as a rigid-plastic flow: the yield condition
takes the antisymmetric stress and the couple stress into its norm, and the flow rule is normal to its deviatoric part,

    sigma = p - k p (V + c W)/Gamma,      m = -k p l^2 grad(spin)/Gamma,      Gamma^2 = V:V + c W:W + l^2 |grad spin|^2

with W the vorticity relative to the spin (as an antisymmetric tensor). Angular momentum: J D(spin)/Dt = -div m +
(sigma_12 - sigma_21). Where the spin follows the vorticity (long waves) this is Coulomb flow; short waves cannot spin,
and then the antisymmetric stress acts as a viscosity mu c/2: the band of growth has an upper end of order 1/l if c is
large enough.
"""

from math import inf

from sympy import ImmutableMatrix, Matrix, eye, sin, sqrt

from stability.closures.base import Closure, norm
from stability.closures.plane_flow import V, grad_u, momentum_and_mass, velocity
from stability.parameters import FRICTION_ANGLE, Parameter
from stability.symbols import gradient, p, symbol, varphi

SOURCE = "after Muhlhaus & Vardoulakis, Geotechnique 37, 1987"

spin, c, l, J = symbol("spin"), symbol("c"), symbol("l"), symbol("J")

relative = (grad_u[1, 0] - grad_u[0, 1]) / 2 - spin
W = Matrix([[0, -relative], [relative, 0]])
curvature = Matrix(gradient(spin))
Gamma = sqrt(norm(V) ** 2 + c * norm(W) ** 2 + l**2 * (curvature.T * curvature)[0])
viscosity = sqrt(2) * sin(varphi) * p / Gamma

stress = p * eye(2) - viscosity * (V + c * W)
couple = -viscosity * l**2 * curvature

_plane = momentum_and_mass(stress, velocity)

COSSERAT = Closure(
    name="cosserat",
    title="Micropolar (Cosserat) Coulomb flow",
    source=SOURCE,
    fields=(*_plane["fields"], spin),
    evolves=(*_plane["evolves"], 1),
    flux=ImmutableMatrix(_plane["flux"].col_join(couple.T / J)),
    supply=ImmutableMatrix([*_plane["supply"], (stress[0, 1] - stress[1, 0]) / J - (curvature.T * velocity)[0]]),
    parameters=(
        FRICTION_ANGLE,
        Parameter("coupling", "c", "1", 0, inf, "weight of the relative rotation in the yield condition", SOURCE),
        Parameter("internal_length", "l", "m", 0, inf, "internal length, of the order of a grain", SOURCE),
        Parameter("micro_inertia", "J", "m2", 0, inf, "moment of inertia of the grains over their mass", SOURCE),
    ),
)
