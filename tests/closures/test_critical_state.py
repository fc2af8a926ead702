"""Critical-state plasticity against Pitman & Schaeffer 1987: growth as the first power of q when dilating."""

import pytest
from mpmath import mp, mpf

from tests.closures.benchmarks import CRITICAL
from tests.closures.evaluate import SHORT, Waves

# C = 1 and Y = s p (2 - p) at the critical volume fraction, so f = 2 s (1 - p) and Y_phi = s beta p^2.
DILATING = {"critical_friction": "0.5", "pressure": "0.8", "hardening": "3.75"}  # f = 0.2, Y_phi = 1.2


def state(given: dict, f) -> dict:
    """Return the parameters of a state that dilates at the rate f."""
    return CRITICAL | given | {"delta": f * mp.sqrt(2 / (1 + f**2))}


def test_the_slope_is_the_published_one():
    # phi = 0.6, Y_phi = 2, f = 0.2, rho = 1 -> sqrt(phi Y_phi f/rho). The closure's Y is over the density of the
    # grains, rho/phi, so its Y_phi is 2 * 0.6.
    f = mpf("0.2")
    waves = Waves("critical_state", "uniform_fraction", state(DILATING, f))
    null = mp.degrees(mp.acos(f) / 2)
    slope = waves.growth(null, exponent=1)
    assert abs(slope / mpf("0.489897948556636") - 1) < 2e-15  # the published decimals
    assert abs(slope / mp.sqrt(mpf("0.6") * 2 * f) - 1) < 1e-19


@pytest.mark.parametrize("angle", ["0", "10", "38", "41", "60", "90"])
def test_other_directions_do_not_grow_with_q(angle):
    waves = Waves("critical_state", "uniform_fraction", state(DILATING, mpf("0.2")))
    assert waves.growth(angle, exponent=1) < mpf(10) ** -15  # at most a bounded rate, seen at q = 1e20


def test_no_direction_beside_the_null_one_grows_faster():
    f = mpf("0.2")
    waves = Waves("critical_state", "uniform_fraction", state(DILATING, f))
    with mp.workdps(60):
        null = mp.degrees(mp.acos(f) / 2)
    top = waves.growth(null, 1)
    # the leading matrix takes (angle q)^2 away: the peak is q^-1/2 wide
    assert all(waves.growth(null + mpf(shift) / mp.sqrt(SHORT), 1) < top for shift in ("-10", "-1", "1", "10"))


def test_waves_travel_instead_while_the_medium_compacts():
    f = mpf("-0.2")  # p = 1.2 C
    waves = Waves("critical_state", "uniform_fraction", state(DILATING | {"pressure": "1.2"}, f))
    found = waves.eigenvalues(mp.degrees(mp.acos(f) / 2))
    frequency = mp.sqrt(mpf("0.5") * mpf("3.75") * mpf("1.2") ** 2 * -f)
    assert sorted(float(z.imag / SHORT) for z in found[:2]) == pytest.approx([-frequency, frequency], rel=1e-15)
    # a bounded rate, here -0.97 1/s at every wavenumber from 1e17 to 1e24 (computed): 1e-19 of the frequency
    assert abs(found[0].real) < 10


def test_the_null_direction_is_that_of_the_perturbed_system():
    # M of the perturbed system has one direction without decay; at the same delta critical-state flow grows with q
    # there and nowhere else.
    f = mpf("0.2")
    delta = f * mp.sqrt(2 / (1 + f**2))
    given = {"friction_angle": "34", "epsilon": "1e-3", "pressure": "1", "strain_rate": "1", "delta": delta}
    perturbed = Waves("perturbed", "uniform_strain", given)
    critical = Waves("critical_state", "uniform_fraction", state(DILATING, f))
    null, decay = perturbed.worst()
    assert (
        abs(decay) < mpf(10) ** -30
    )  # at q = 1e20 the bounded rate that is left is 1e-40 q^2, the angle errs by 1e-16
    assert max(perturbed.growth(null + 1), perturbed.growth(null - 1)) < -1e-4
    # exact: the peak is q^-1/2 = 1e-10 wide, so that an angle within 1e-16 changes it by 1e-12
    assert abs(critical.growth(null, 1) / mp.sqrt(mpf("0.6") * 2 * f) - 1) < 1e-12
    assert max(critical.growth(null + 1, 1), critical.growth(null - 1, 1)) < mpf(10) ** -15
