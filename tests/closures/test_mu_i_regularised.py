"""The partially regularised mu(I) against Barker & Gray, J. Fluid Mech. 828, 2017, and where their condition misses."""

import pytest
from mpmath import findroot, mp, mpf

from tests.closures.benchmarks import GLASS
from tests.closures.evaluate import Waves

I_1 = "0.0039717826838072"  # the lower neutral number of mu(I) for these constants
PRINTED_FAILS, TRULY_FAILS = "16.9918747418162", "17.9066600426969"  # computed: roots to 15 digits


def waves(I, branch: str = "mu_i_regularised", digits: int = 150) -> Waves:
    """Return the waves of a branch at an inertial number."""
    given = {"high_rate_friction": "0.05", "low_rate_exponent": "1.9", "branch_inertial_number": I_1}
    return Waves(branch, "uniform_strain", GLASS | given | {"strain_rate": mpf(I) / mp.sqrt(2)}, digits)


def high(I) -> tuple[mpf, mpf]:
    """Return mu and nu = I mu'/mu on the high branch."""
    mu_s, mu_2, mu_inf, I_0 = map(mpf, ("0.342", "0.557", "0.05", "0.069"))
    top, bottom = mu_s * I_0 + mu_2 * I + mu_inf * I**2, I_0 + I
    return top / bottom, I * ((mu_2 + 2 * mu_inf * I) / top - 1 / bottom)


def printed(I) -> mpf:
    """Return the printed condition, well-posed where it is not positive."""
    mu, nu = high(I)
    return 4 * nu**2 - 4 * nu + mu**2 * (1 - nu / 2) ** 2


def slope(I) -> mpf:
    """Return d(mu p)/dp = mu (1 - nu/2)."""
    mu, nu = high(I)
    return mu * (1 - nu / 2)


@pytest.mark.parametrize("I", ["1e-300", "1e-30", "1e-3", I_1])
def test_the_low_branch_is_stable_down_to_the_slowest_flow(I):
    assert waves(I, "mu_i_regularised_low", digits=700).worst(count=19)[1] < 0  # the viscosity is 1e300


def test_both_branches_meet_with_one_friction():
    # lambda = -eta/2 at 45 degrees times nu: compare instead p's own column, the flux of the pressure, at 0 degrees
    low, high_ = (waves(I_1, name) for name in ("mu_i_regularised_low", "mu_i_regularised"))
    # along the extension axis (c = 1) lambda = -eta/2, whatever nu is
    assert abs(low.growth(0) / high_.growth(0) - 1) < 1e-15


def test_the_printed_condition_fails_where_it_says():
    assert abs(findroot(printed, mpf("16.99")) / mpf(PRINTED_FAILS) - 1) < 1e-14
    assert abs(findroot(lambda I: slope(I) - 1, mpf("17.9")) / mpf(TRULY_FAILS) - 1) < 1e-14


@pytest.mark.parametrize("I", ["1", PRINTED_FAILS, "17.5", "17.90666004269"])
def test_every_direction_is_stable_until_the_slope_of_mu_p_is_one(I):
    found = waves(I)
    assert found.worst()[1] < 0
    for angle in ("0", "1e-9", "1e-6", "1e-3", "0.1"):  # where 1 - K c is least
        assert found.growth(angle) < 0


def test_the_roots_that_the_printed_condition_counts_are_no_directions():
    for I in ("17", "17.5", "17.9"):
        mu, nu = high(mpf(I))
        assert printed(mpf(I)) > 0
        assert (slope(mpf(I)) - mp.sqrt(printed(mpf(I)))) / (2 * (1 - nu)) > 1  # the smaller root, in c = cos 2phi


@pytest.mark.parametrize("factor", ["1.000000000001", "1.01", "2"])
def test_beyond_slope_one_a_direction_grows_without_bound(factor):
    I = mpf(TRULY_FAILS) * mpf(factor)
    c = 1 / slope(I) * (1 - mpf(10) ** -20)  # just short of the direction where 1 - K c vanishes
    mu = high(I)[0]
    eta = mu * 2 / (I / 2)
    assert waves(I).growth(mp.degrees(mp.acos(c) / 2)) > 1000 * eta
