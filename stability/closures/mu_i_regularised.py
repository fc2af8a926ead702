"""The partially regularised mu(I) rheology of Barker & Gray: two branches of one friction law.

Source: Barker & Gray, J. Fluid Mech. 828, 2017. For I <= I_1 friction is ``sqrt(alpha/ln(A/I))``, with A such that it
meets at I_1 the other branch, ``(mu_s I_0 + mu_2 I + mu_inf I^2)/(I_0 + I)``. Generated code has no branches, so each
is a closure: `mu_i_regularised` above I_1, `mu_i_regularised_low` below; the base state says which one applies.

What is printed and what is: on the high branch the printed condition ``4 nu^2 - 4 nu + mu^2 (1 - nu/2)^2 <= 0`` fails
first, at I = 16.9918747418162 for (mu_s, mu_2, mu_inf, I_0) = (0.342, 0.557, 0.05, 0.069), yet no direction is unstable
there. With c = cos 2phi from the extension axis, nu = I mu'/mu and K = d(mu p)/dp = mu (1 - nu/2) the pencil gives

    lambda = -(mu p q^2/(2 ||D||)) [nu - K c + (1 - nu) c^2]/(1 - K c)

and the printed condition is the discriminant of the bracket: that it has real roots, wherever they lie. Here they lie
beyond c = 1, so that every direction stays stable until K = 1, at I = 17.9066600426969, where 1 - K c first vanishes.
"""

from math import inf

from sympy import exp, log, sqrt

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
from stability.parameters import Parameter
from stability.symbols import symbol

SOURCE = "Barker & Gray, J. Fluid Mech. 828, 2017"

mu_inf, alpha, I_1 = symbol("mu_inf"), symbol("alpha"), symbol("I_1")


def high(I):
    """Return mu(I) for I > I_1."""
    return (mu_s * I_0 + mu_2 * I + mu_inf * I**2) / (I_0 + I)


A_low = I_1 * exp(alpha / high(I_1) ** 2)  # both branches meet at I_1


def low(I):
    """Return mu(I) for I <= I_1."""
    return sqrt(alpha / log(A_low / I))


HIGH_FRICTION = Parameter("high_rate_friction", "mu_inf", "1", 0, inf, "slope of friction in I at large I", SOURCE)

MU_I_REGULARISED = Closure(
    name="mu_i_regularised",
    title="Partially regularised mu(I) rheology, branch of high I",
    source=SOURCE,
    **momentum_and_mass(isotropic_stress(high(INERTIAL_NUMBER)), velocity),
    parameters=(*GRAINS, *FRICTION, HIGH_FRICTION),
)

MU_I_REGULARISED_LOW = Closure(
    name="mu_i_regularised_low",
    title="Partially regularised mu(I) rheology, branch of low I",
    source=SOURCE,
    **momentum_and_mass(isotropic_stress(low(INERTIAL_NUMBER)), velocity),
    parameters=(
        *GRAINS,
        *FRICTION,
        HIGH_FRICTION,
        Parameter(
            "low_rate_exponent",
            "alpha",
            "1",
            0,
            2,
            "constant of the low branch; at 2 slow flow is neutral",
            SOURCE,
        ),
        Parameter("branch_inertial_number", "I_1", "1", 0, inf, "inertial number where the branches meet", SOURCE),
    ),
)
