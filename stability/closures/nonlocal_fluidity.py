"""Nonlocal granular fluidity: friction is shared with the neighbourhood through a fluidity field g.

Source: Kamrin & Koval, Phys. Rev. Lett. 108, 2012; Henann & Kamrin, Proc. Natl. Acad. Sci. USA 110, 2013. The stress is
``p - 2 (p/g) D``, so that friction is mu = 2||D||/g, and the fluidity obeys

    Lap g = (g - g_loc)/xi^2,      xi = A d/sqrt(mu - mu_s),      g_loc = sqrt(P/rho_*) (mu - mu_s)/(b d mu)

where mu exceeds mu_s (below, g_loc = 0 and xi has |mu - mu_s|: a closure of its own, not written here). P/rho_* is
solid_fraction p with the package's p. The law is imposed at every instant, and written multiplied by (A d)^2.

Short waves: the disturbance of g is of order 1/q, so momentum sees a Newtonian viscosity p/g and every direction decays
as q^2. Long waves see the local law mu = mu_s + b I, and with it the band of growth that this law has at low I.
"""

from math import inf

from sympy import ImmutableMatrix, Matrix, eye, sqrt

from stability.closures.base import Closure, norm
from stability.closures.plane_flow import V, momentum_and_mass, velocity
from stability.parameters import Parameter
from stability.symbols import gradient, p, symbol

SOURCE = "Henann & Kamrin, Proc. Natl. Acad. Sci. USA 110, 2013"

g = symbol("fluidity")  # g_x and g_y are gravity
d, phi_s, mu_s, b, amplitude = (symbol(name) for name in ("d", "phi_s", "mu_s", "b", "A_0"))

friction = sqrt(2) * norm(V) / g  # 2||D||/g
excess = friction - mu_s
local = sqrt(phi_s * p) * excess / (b * d * friction)

_plane = momentum_and_mass(p * eye(2) - 2 * p / g * V, velocity)

NONLOCAL = Closure(
    name="nonlocal",
    title="Nonlocal granular fluidity",
    source=SOURCE,
    fields=(*_plane["fields"], g),
    evolves=(*_plane["evolves"], 0),
    flux=ImmutableMatrix(_plane["flux"].col_join((amplitude * d) ** 2 * Matrix([gradient(g)]))),
    supply=ImmutableMatrix([*_plane["supply"], (g - local) * excess]),
    parameters=(
        Parameter("grain_diameter", "d", "m", 0, inf, "diameter of the grains", SOURCE),
        Parameter("solid_fraction", "phi_s", "1", 0, 1, "volume fraction of the grains, constant", SOURCE),
        Parameter("static_friction", "mu_s", "1", 0, inf, "friction coefficient at vanishing rate", SOURCE),
        Parameter("rate_coefficient", "b", "1", 0, inf, "slope of the local friction in I", SOURCE),
        Parameter("nonlocal_amplitude", "A_0", "1", 0, inf, "cooperativity length over diameter", SOURCE),
    ),
)
