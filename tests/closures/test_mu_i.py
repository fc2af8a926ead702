"""mu(I) against Barker, Schaeffer, Bohorquez & Gray, J. Fluid Mech. 779, 2015."""

import pytest
from mpmath import findroot, mp, mpf

from tests.closures.benchmarks import GLASS
from tests.closures.evaluate import Waves

BEADS = (mp.tan(mp.radians(mpf("20.9"))), mp.tan(mp.radians(mpf("32.76"))), mpf("0.279"))
CASES = {"beads": BEADS, "0.342": (mpf("0.342"), mpf("0.557"), mpf("0.069"))}
# The inertial numbers between which the rheology is well-posed: computed from the printed condition, 15 digits.
NEUTRAL = {
    "beads": ("0.0193500918873711", "0.85226581486577"),
    "0.342": ("0.0039717826838072", "0.280165773750758"),
}


def beads() -> tuple:
    """Return mu_s, mu_2, I_0 of glass beads with the digits of the moment."""
    return mp.tan(mp.radians(mpf("20.9"))), mp.tan(mp.radians(mpf("32.76"))), mpf("0.279")


def constants(case: str) -> tuple:
    """Return mu_s, mu_2 and I_0."""
    return beads() if case == "beads" else (mpf("0.342"), mpf("0.557"), mpf("0.069"))


def waves(case: str, I) -> Waves:
    """Return the waves of mu(I) at an inertial number."""
    mu_s, mu_2, I_0 = constants(case)
    given = {"static_friction": mu_s, "dynamic_friction": mu_2, "reference_inertial_number": I_0}
    # I = sqrt(2) d ||V||/sqrt(solid_fraction p), with d = 1, solid_fraction p = 1
    return Waves("mu_i", "uniform_strain", GLASS | given | {"strain_rate": mpf(I) / mp.sqrt(2)})


def friction(case: str, I) -> tuple[mpf, mpf]:
    """Return mu(I) and nu = I mu'/mu."""
    mu_s, mu_2, I_0 = constants(case)
    mu = mu_s + (mu_2 - mu_s) / (1 + I_0 / I)
    return mu, (mu_2 - mu_s) * I * I_0 / (I_0 + I) ** 2 / mu


def printed(case: str, I) -> mpf:
    """Return the printed condition, well-posed where it is not positive."""
    mu, nu = friction(case, I)
    return 4 * nu**2 - 4 * nu + mu**2 * (1 - nu / 2) ** 2


@pytest.mark.parametrize("case", NEUTRAL)
@pytest.mark.parametrize("edge", [0, 1])
def test_the_pencil_turns_neutral_where_the_printed_condition_does(case, edge):
    given = mpf(NEUTRAL[case][edge])
    assert abs(findroot(lambda I: printed(case, I), given) / given - 1) < 1e-14
    for factor in ("0.999999999999", "1.000000000001"):
        I = given * mpf(factor)
        stable = (I > given) == (edge == 0)
        assert (waves(case, I).worst()[1] < 0) == stable == (printed(case, I) < 0)


def test_growth_at_a_low_inertial_number():
    # Computed from the pencil with 40 digits; the printed angle 39.26912 is 2e-5 degrees off the maximum, which is flat
    # enough that growth there differs by 1e-11.
    I = mpf("1e-3")
    found = waves("beads", I)
    angle, rate = found.worst()
    eta = friction("beads", I)[0] * 2 / (I / 2)  # mu p/||D||, ||D|| = ||V||/sqrt 2
    assert abs(rate / eta - mpf("0.0184797007567896")) < 1e-15
    assert abs(angle - mpf("39.26910183351213")) < 1e-12
    assert abs(found.growth("39.26912") / rate - 1) < 2e-11


@pytest.mark.parametrize("I", ["1e-3", "0.1", "2"])
@pytest.mark.parametrize("angle", ["7", "38", "45", "80"])
def test_the_symbol_has_the_closed_form_whose_discriminant_is_the_printed_condition(I, angle):
    mu, nu = friction("beads", mpf(I))
    c, K = mp.cos(2 * mp.radians(mpf(angle))), mu * (1 - nu / 2)
    eta = mu * 2 / (mpf(I) / 2)
    expected = -eta / 2 * (nu - K * c + (1 - nu) * c**2) / (1 - K * c)
    assert abs(waves("beads", I).growth(angle) / expected - 1) < 1e-15
    assert abs(K**2 - 4 * nu * (1 - nu) - printed("beads", mpf(I))) < 1e-50


def test_the_coulomb_limit_is_schaeffers():
    # I -> 0: mu(I) -> mu_s is the sine of a friction angle
    found = waves("beads", "1e-30")
    s = constants("beads")[0]
    t = mp.tan(mp.asin(s) / 2)
    eta = s * 2 / (mpf("1e-30") / 2)
    assert abs(found.worst()[1] / (eta * t**2 / 2) - 1) < 1e-12
