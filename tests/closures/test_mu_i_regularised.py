"""The partially regularised mu(I) against Barker & Gray, J. Fluid Mech. 828, 2017, and where their condition misses."""

import pytest
from mpmath import mp, mpf

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


def bracket(I) -> tuple[mpf, mpf]:
    """Return nu and K of ``-(eta/2) [nu - K c + (1 - nu) c^2]/(1 - K c)``, read off the waves at c = -1, 0, 1/2."""
    found = waves(I)
    whole, level, half = (found.growth(angle) for angle in (90, 45, 30))  # the bracket over 1 - K c is 1 along c = -1
    nu, part = level / whole, half / whole
    return nu, 2 * (nu + (1 - nu) / 4 - part) / (1 - part)


def discriminant(I) -> mpf:
    """Return that of the bracket, the printed condition where K is mu (1 - nu/2)."""
    nu, K = bracket(I)
    return K**2 - 4 * nu * (1 - nu)


@pytest.mark.parametrize("I", ["0.1", "1", PRINTED_FAILS, TRULY_FAILS, "100"])
def test_the_waves_of_the_closure_have_the_stated_law(I):
    nu, K = bracket(I)
    # exact; at q = 1e20 what is left out is 1e-20 of the leading term, and differences of it are some 1e-2
    assert abs(nu - high(mpf(I))[1]) < 1e-17 and abs(K - slope(mpf(I))) < 1e-17


def test_the_printed_condition_fails_where_it_says():
    # computed: 15 digits of the roots, so that the signs change within 1e-14
    for stated, condition in ((PRINTED_FAILS, discriminant), (TRULY_FAILS, lambda I: bracket(I)[1] - 1)):
        below, above = (condition(mpf(stated) * (1 + side * mpf(10) ** -14)) for side in (-1, 1))
        assert below < 0 < above


@pytest.mark.parametrize("I", ["1", PRINTED_FAILS, "17.5", "17.90666004269"])
def test_every_direction_is_stable_until_the_slope_of_mu_p_is_one(I):
    found = waves(I)
    assert found.worst()[1] < 0
    for angle in ("0", "1e-9", "1e-6", "1e-3", "0.1"):  # where 1 - K c is least
        assert found.growth(angle) < 0


@pytest.mark.parametrize("I", ["17", "17.5", "17.9"])
def test_the_roots_that_the_printed_condition_counts_are_no_directions(I):
    nu, K = bracket(I)
    assert discriminant(I) > 0
    assert (K - mp.sqrt(discriminant(I))) / (2 * (1 - nu)) > 1  # the smaller root, in c = cos 2phi


@pytest.mark.parametrize("factor", ["1.000000000001", "1.01", "2"])
def test_beyond_slope_one_a_direction_grows_without_bound(factor):
    I = mpf(TRULY_FAILS) * mpf(factor)
    c = 1 / slope(I) * (1 - mpf(10) ** -20)  # just short of the direction where 1 - K c vanishes
    mu = high(I)[0]
    eta = mu * 2 / (I / 2)
    assert waves(I).growth(mp.degrees(mp.acos(c) / 2)) > 1000 * eta
