"""Coulomb flow and the paper's two flow rules against Schaeffer (J. Differ. Equ. 66, 1987) and the paper's limits."""

import pytest
from mpmath import mp, mpf

from tests.closures.benchmarks import COULOMB
from tests.closures.evaluate import Waves

# Exact, with 15 digits: max Re lambda/(mu q^2) = tan^2(varphi/2)/2 at cos 2phi = tan(varphi/2) from the extension axis.
SCHAEFFER = {"34": ("0.0467356247925884", "36.0989355774566")}


@pytest.mark.parametrize("friction_angle", ["5", "20", "34", "60"])
def test_coulomb_flow_grows_as_schaeffer_found(friction_angle):
    waves = Waves("rigid_plastic", "uniform_strain", COULOMB | {"friction_angle": friction_angle})
    angle, rate = waves.worst()
    t = mp.tan(mp.radians(mpf(friction_angle)) / 2)
    assert abs(rate / waves["mu"] / (t**2 / 2) - 1) < mpf(10) ** -20
    assert abs(mp.cos(2 * mp.radians(angle)) - t) < mpf(10) ** -14
    for growth, place in [SCHAEFFER[friction_angle]] if friction_angle in SCHAEFFER else []:
        assert abs(rate / waves["mu"] / mpf(growth) - 1) < 1e-14
        assert abs(angle / mpf(place) - 1) < 1e-14


def test_the_unstable_wedge_of_coulomb_flow_is_0_below_cos_2phi_below_sin_varphi():
    waves = Waves("rigid_plastic", "uniform_strain", COULOMB)
    s, tiny = mp.sin(mp.radians(mpf(34))), mpf(10) ** -12
    for c, sign in ((-tiny, -1), (tiny, 1), (s - tiny, 1), (s + tiny, -1)):
        assert mp.sign(waves.growth(mp.degrees(mp.acos(c) / 2))) == sign


@pytest.mark.parametrize("delta", ["-0.9", "-0.3", "0.01", "0.3", "0.7", "0.999"])
def test_the_deviatoric_rule_is_hadamard_ill_posed_for_every_small_delta(delta):
    waves = Waves("deviatoric", "uniform_strain", COULOMB | {"epsilon": "1e-3", "delta": delta})
    _, rate = waves.worst(low=-4, high=94)
    size = abs(mpf(delta))
    assert abs(rate / (waves["mu"] / 4 * size * (mp.sqrt(2 - size**2) - size)) - 1) < 1e-12  # Lambda = mu q^2/2


@pytest.mark.parametrize("delta", ["-1.2", "1", "1.2"])
def test_the_deviatoric_rule_has_no_growing_leading_term_beyond_delta_1(delta):
    waves = Waves("deviatoric", "uniform_strain", COULOMB | {"epsilon": "1e-3", "delta": delta})
    assert waves.worst(low=-4, high=94)[1] <= mpf(10) ** -18  # zero at delta = 1, to the next order of 1/q


def test_the_perturbed_system_grows_at_a_bounded_rate_in_the_null_direction_of_its_leading_matrix():
    # mathematics.md: delta (k - delta)/(epsilon (2 - delta^2)) - delta ||V|| for a uniform background
    delta, epsilon = mpf("0.3"), mpf("1e-3")
    waves = Waves("perturbed", "uniform_strain", COULOMB | {"epsilon": "1e-3", "delta": "0.3"})
    null = mp.degrees(mp.acos(delta / mp.sqrt(2 - delta**2)) / 2)  # cos 2phi = +delta/s from the extension axis
    with mp.workdps(60):
        expected = delta * (waves["k"] - delta) / (epsilon * (2 - delta**2)) - delta
    assert abs(waves.growth(null, exponent=0) / expected - 1) < 1e-12
