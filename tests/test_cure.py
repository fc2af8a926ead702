"""The least cures against closed forms, and what is certified about them."""

from math import inf

import numpy as np
import pytest
from numpy.testing import assert_allclose

import stability as st
from stability.cure import smallest_cure
from stability.errors import SceneError

# A strain rate far below every growth rate: the kinematics of long waves, of order ||V||, does not show.
STATE = {"friction_angle": 34, "delta": 0.0, "strain_rate": 1e-3, "pressure": 1.0}
VISCOSITY = np.sqrt(2) * np.sin(np.deg2rad(34)) / 1e-3
STRENGTH = VISCOSITY / 2 * np.tan(np.deg2rad(17)) ** 2  # Coulomb flow grows by STRENGTH q^2 at most, exact


def test_the_least_viscosity_is_half_mu_times_tan_squared_and_both_ends_are_certified():
    found = smallest_cure("viscous", "uniform_strain", STATE, {}, "kinematic_viscosity", rtol=1e-8)
    assert found.below < STRENGTH <= found.above * (1 + 1e-15)
    assert found.above / found.below - 1 < 4e-8  # ends that float64 had on the wrong side gave way
    assert found.certified == (True, True) and found.growth_below == inf and found.band_width is None
    assert "kinematic_viscosity >=" in str(found) and "the lower and upper end" in str(found)
    kinds = [
        st.well_posedness("viscous", "uniform_strain", STATE | {"kinematic_viscosity": v}, {}).kind
        for v in (found.below, found.above)
    ]
    assert kinds == ["ill-posed", "stable"]


def test_growth_of_the_perturbed_system_is_bounded_by_epsilon_at_the_papers_wave():
    found = smallest_cure("perturbed", "uniform_strain", STATE, {}, "epsilon", growth=100.0)
    # computed at delta = 0, by SciPy's Nelder-Mead on the truncated matrix: growth 0.0138839026/epsilon at a
    # wavenumber of 1.14327/sqrt(mu epsilon); ||V|| = 1e-3 1/s adds 1e-5 of 100, and a top is flat: the
    # wavenumber has half the digits
    assert_allclose(found.above, 0.0138839026 / 100, rtol=2e-5)
    assert_allclose(found.wavenumber, 1.14327 / np.sqrt(VISCOSITY * found.above), rtol=1e-3)
    assert found.growth_above <= 100 < found.growth_below and found.above / found.below - 1 < 1e-6
    assert found.certified == (True, False) and "not a proof" in str(found)
    assert_allclose(found.band_width, 2 * np.pi / found.wavenumber)


def test_a_hyperstress_bounds_growth_by_its_parabola_in_the_square_of_the_wavenumber():
    found = smallest_cure("hyperstress", "uniform_strain", STATE, {}, "hyperviscosity", growth=50.0, rtol=1e-5)
    # STRENGTH q^2 - eta q^4 has the maximum STRENGTH^2/(4 eta); ||V|| = 1e-3 1/s adds 2e-5 of it
    assert_allclose(found.above, STRENGTH**2 / 200, rtol=1e-4)
    assert_allclose(found.wavenumber, np.sqrt(STRENGTH / found.above / 2), rtol=1e-3)


def test_any_hyperstress_makes_short_waves_decay():
    found = smallest_cure("hyperstress", "uniform_strain", STATE, {}, "hyperviscosity", bracket=(1e-6, 1e6))
    assert (found.below, found.above) == (0.0, 1e-6) and "Every value" in str(found)


def test_what_no_value_cures_is_said():
    # At delta = 0 short waves always grow, by ever less: exponent -2.
    with pytest.raises(SceneError, match="makes short waves decay"):
        smallest_cure("perturbed", "uniform_strain", STATE, {}, "epsilon", bracket=(1e-6, 1.0))


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"parameter": "viscosity"}, "known are .*epsilon"),
        ({"growth": -1.0}, "growth = -1.0"),
        ({"rtol": 0.0}, "rtol = 0.0"),
        ({"bracket": (2.0, 1.0)}, "two increasing positive numbers"),
    ],
)
def test_a_question_without_meaning_is_refused(options, words):
    with pytest.raises(SceneError, match=words):
        smallest_cure("perturbed", "uniform_strain", STATE, {}, **options)
