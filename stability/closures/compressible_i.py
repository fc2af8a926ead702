"""Compressible rheology that depends on the inertial number, well-posed by construction.

Source: Barker, Schaeffer, Shearer & Gray, Proc. R. Soc. A 473, 2017. Yield stress Y(p, phi, I) and rate of dilation
f(p, phi, I) make a well-posed flow if, with I = 2 d ||D||/sqrt(p) and p over the density of the grains,

    Y_p - (I/2p) Y_I = f + I f_I,        Y_I > 0,        f_p - (I/2p) f_I < 0

The first makes the leading matrix symmetric; the others give its two parts their signs. Here ``Y = alpha(I) p -
p^2/C(phi)`` and ``f = beta(I) - 2 p/C(phi)``, for which the first condition reads ``(I beta)' = alpha - I alpha'/2``;
for ``alpha = alpha_1 + (alpha_2 - alpha_1) I/(I_0 + I)`` its regular solution is below.
"""

from math import inf

from sympy import exp, log

from stability.closures.base import Closure
from stability.closures.dilatant_flow import GRAIN_DIAMETER, INERTIAL_NUMBER, dilatant, phi
from stability.parameters import Parameter
from stability.symbols import p, symbol

SOURCE = "Barker, Schaeffer, Shearer & Gray, Proc. R. Soc. A 473, 2017"

alpha_1, alpha_2, I_0, C_0, h, phi_c = (symbol(n) for n in ("alpha_1", "alpha_2", "I_0", "C_0", "h", "phi_c"))

C = C_0 * exp(h * (phi - phi_c))


def alpha(I):
    """Return the friction of the yield stress at vanishing pressure."""
    return alpha_1 + (alpha_2 - alpha_1) * I / (I_0 + I)


def beta(I):
    """Return (3/2I) times the integral of alpha from 0 to I, less alpha/2."""
    mean = alpha_1 + (alpha_2 - alpha_1) * (1 - I_0 / I * log(1 + I / I_0))
    return (3 * mean - alpha(I)) / 2


def laws(I) -> tuple:
    """Return (Y, f)."""
    return alpha(I) * p - p**2 / C, beta(I) - 2 * p / C


COMPRESSIBLE_I = Closure(
    name="compressible_i",
    title="Compressible rheology that depends on the inertial number",
    source=SOURCE,
    **dilatant(*laws(INERTIAL_NUMBER)),
    parameters=(
        GRAIN_DIAMETER,
        Parameter("static_strength", "alpha_1", "1", 0, inf, "alpha at I = 0", SOURCE),
        Parameter("dynamic_strength", "alpha_2", "1", 0, inf, "alpha at large I", SOURCE),
        Parameter("reference_inertial_number", "I_0", "1", 0, inf, "inertial number half way between the two", SOURCE),
        Parameter("critical_pressure", "C_0", "m2/s2", 0, inf, "compaction pressure at critical_fraction", SOURCE),
        Parameter("hardening", "h", "1", 0, inf, "slope of ln C in the volume fraction", SOURCE),
        Parameter("critical_fraction", "phi_c", "1", 0, 1, "volume fraction at which C = critical_pressure", SOURCE),
    ),
)
