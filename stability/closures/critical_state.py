"""Critical-state plasticity: a yield stress that depends on pressure and volume fraction, with the normal flow rule.

Source: Pitman & Schaeffer, Commun. Pure Appl. Math. 40, 1987; Schaeffer, Int. J. Numer. Anal. Meth. Geomech. 14, 1990.
The yield stress here is the parabola ``Y = s p (2 - p/C(phi))`` with ``C = C_0 exp(beta (phi - phi_c))``; its maximum,
at p = C, is the critical state, and normality gives ``f = dY/dp = 2 s (1 - p/C)``: dilation below the critical
pressure, compaction above.

The leading matrix is never positive; it vanishes where cos 2phi = f (phi from the extension axis), and there
``lambda^2 = q^2 phi Y_phi f/rho``: in that direction waves travel while the medium compacts and grow as q while it
dilates. It is the one in which the perturbed system's leading matrix vanishes: f = delta/sqrt(2 - delta^2). Beside it
slow compaction still leaves growth at a bounded rate, and at f = 0 growth is as q^(2/3) (figure A3).
"""

from math import inf

from sympy import exp

from stability.closures.base import Closure
from stability.closures.dilatant_flow import dilatant, phi
from stability.parameters import Parameter
from stability.symbols import p, symbol

SOURCE = "Pitman & Schaeffer, Commun. Pure Appl. Math. 40, 1987"

s, C_0, beta, phi_c = (symbol(name) for name in ("s_c", "C_0", "beta", "phi_c"))

C = C_0 * exp(beta * (phi - phi_c))
Y = s * p * (2 - p / C)

CRITICAL_STATE = Closure(
    name="critical_state",
    title="Critical-state plasticity with the normal flow rule",
    source=SOURCE,
    **dilatant(Y, Y.diff(p)),
    parameters=(
        Parameter("critical_friction", "s_c", "1", 0, 1, "shear stress over pressure at the critical state", SOURCE),
        Parameter("critical_pressure", "C_0", "m2/s2", 0, inf, "critical pressure at critical_fraction", SOURCE),
        Parameter("hardening", "beta", "1", 0, inf, "slope of ln C in the volume fraction", SOURCE),
        Parameter("critical_fraction", "phi_c", "1", 0, 1, "volume fraction at which C = critical_pressure", SOURCE),
    ),
)
