"""Two cures of Coulomb flow that add dissipation at short waves: a Newtonian viscosity and a hyperstress.

Viscous: ``-2 nu_v V`` in the stress takes ``nu_v q^2`` from every growth rate, so Coulomb flow (Schaeffer, J. Differ.
Equ. 66, 1987), which grows by at most ``(mu q^2/2) tan^2(varphi/2)``, is well-posed iff nu_v >= (mu/2) tan^2(varphi/2).

Hyperstress: a stress ``eta_g grad Lap u`` (the second-gradient fluid of Fried & Gurtin, Arch. Ration. Mech. Anal. 182,
2006, is the general form) takes ``eta_g q^4`` and leaves a band q < q_c, ``q_c^2 = (mu/eta_g) tan^2(varphi/2)/2``.
Fluxes hold first gradients only, so the Laplacian of the velocity is a field of its own, w, under the constraint div
grad u = w.
"""

from math import inf

from sympy import ImmutableMatrix, Matrix

from stability.closures.base import Closure, strain_rate
from stability.closures.drucker_prager import LETTERS, RIGID_PLASTIC, stress
from stability.closures.plane_flow import V, grad_u, momentum_and_mass, velocity
from stability.parameters import FRICTION_ANGLE, Parameter
from stability.symbols import gradient, symbol

nu_v, eta_g = symbol("nu_v"), symbol("eta_g")
w = (symbol("lap_u"), symbol("lap_v"))  # the Laplacian of the velocity
grad_w = Matrix([gradient(c) for c in w])

VISCOUS = Closure(
    name="viscous",
    title="Rigid-plastic flow with a Newtonian viscosity",
    source="Schaeffer, J. Differ. Equ. 66, 1987, with a viscous stress",
    **momentum_and_mass(stress - 2 * nu_v * V, velocity),
    parameters=(
        FRICTION_ANGLE,
        Parameter("kinematic_viscosity", "nu_v", "m2/s", 0, inf, "added viscosity over density", "this package"),
    ),
    letters=LETTERS,
    relations=RIGID_PLASTIC.relations,
)

_plastic = momentum_and_mass(stress + 2 * eta_g * strain_rate(grad_w), velocity)  # div w = 0 as div u = 0

HYPERSTRESS = Closure(
    name="hyperstress",
    title="Rigid-plastic flow with a hyperstress",
    source="Schaeffer, J. Differ. Equ. 66, 1987, with a second-gradient stress (Fried & Gurtin, 2006)",
    fields=(*_plastic["fields"], w),
    evolves=(*_plastic["evolves"], 0, 0),
    flux=ImmutableMatrix(_plastic["flux"].col_join(grad_u)),  # div grad u = w
    supply=ImmutableMatrix([*_plastic["supply"], *w]),
    parameters=(
        FRICTION_ANGLE,
        Parameter("hyperviscosity", "eta_g", "m4/s", 0, inf, "hyperstress coefficient over density", "this package"),
    ),
    letters=LETTERS,
    relations=RIGID_PLASTIC.relations,
)
