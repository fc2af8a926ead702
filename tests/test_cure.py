"""The least cures against closed forms, and what is certified about them."""

from math import inf

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.optimize import minimize

import stability as st
from stability.bracketing import apart, scanned
from stability.cure import Cure, smallest_cure
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
    said, proven = str(found).split("Certified: ")
    assert said.startswith("kinematic_viscosity = 36.959382") and " cures: no short wave grows; 36.9593" in said
    assert proven.startswith(f"{found.below:.10g} m2/s does not cure, {found.above:.10g} m2/s cures")
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

    assert found.certified == (True, False), "a closure without closed forms: enclosed by its pencil"


def test_a_band_beside_the_plateau_of_long_waves_is_not_missed():
    rate, bound = 1.0, 1.0  # of the same order: the hill is small beside the range of wavenumbers
    state = STATE | {"strain_rate": rate}
    found = smallest_cure("hyperstress", "uniform_strain", state, {}, "hyperviscosity", growth=bound, rtol=1e-4)
    # computed by SciPy's Nelder-Mead on `eigenvalues`, from the top of the parabola on
    top = minimize(
        lambda w: (
            -st.eigenvalues(
                "hyperstress", "uniform_strain", state | {"hyperviscosity": found.above}, {}, np.exp(w[0]), w[1]
            )[0].real
        ),
        [np.log(np.sqrt(STRENGTH * 1e-3 / found.above / 2)), 36.0],
        method="Nelder-Mead",
        options={"xatol": 1e-6, "fatol": 1e-10},
    )
    assert_allclose(-top.fun, bound, rtol=5e-4)  # the slope of growth over the parameter is about 1, rtol is 1e-4
    assert_allclose(found.wavenumber, np.exp(top.x[0]), rtol=1e-3)


def test_any_hyperstress_tried_makes_short_waves_decay_and_nothing_is_said_of_others():
    found = smallest_cure("hyperstress", "uniform_strain", STATE, {}, "hyperviscosity", bracket=(1e-6, 1e6))
    assert (found.below, found.above, found.last, found.beyond) == (None, 1e-6, 1e6, None)
    assert found.certified == (False, True) and found.certified_upper == (True, False)
    assert "= 1e-06 m4/s, the least value tried, cures" in str(found)
    assert "Of 25 values tried from 1e-06 to 1000000 m4/s, all cure." in str(found)
    assert ">=" not in str(found) and "does not" not in str(found) and np.isnan(found.growth_below)


def test_what_no_value_cures_is_said():
    # At delta = 0 short waves always grow, by ever less: exponent -2.
    with pytest.raises(SceneError, match="makes short waves decay"):
        smallest_cure("perturbed", "uniform_strain", STATE, {}, "epsilon", bracket=(1e-6, 1.0))


def test_a_dilating_flows_least_epsilon_has_no_width_left_and_its_growth_is_that_of_the_shortest_waves():
    state, k = STATE | {"delta": 0.3, "strain_rate": 1.0}, np.sqrt(2) * np.sin(np.deg2rad(34))
    found = smallest_cure("perturbed", "uniform_strain", state, {}, "epsilon", growth=10.0)
    # exact: short waves tend to delta (k - delta)/(epsilon (2 - delta^2)) - delta ||V||
    assert_allclose(found.above, 0.3 * (k - 0.3) / (2 - 0.3**2) / 10.3, rtol=2e-6)  # twice rtol
    assert found.wavenumber == inf and found.band_width is None and found.certified == (True, False)
    assert "What remains there has no width: the shorter a wave, the closer it comes to 10 1/s" in str(found)


def test_a_converging_flow_is_cured_up_to_some_epsilon_and_by_the_least_one_tried():
    state, k = STATE | {"delta": -0.1, "strain_rate": 1.0}, np.sqrt(2) * np.sin(np.deg2rad(34))
    found = smallest_cure("perturbed", "uniform_strain", state, {}, "epsilon", bracket=(1e-9, 1.0))
    assert (found.below, found.above) == (None, 1e-9) and found.again == ()
    # exact: delta (k - delta)/(epsilon (2 - delta^2)) - delta ||V|| changes its sign
    assert_allclose([found.last, found.beyond], (k + 0.1) / (2 - 0.1**2), rtol=1e-5)  # where float64 loses six digits
    assert found.last < found.beyond and found.certified_upper[0]
    assert "all larger ones do up to 0.4476" in str(found) and "nor does any beyond" in str(found)
    assert "Bands of" in str(found), "waves of finite length go on growing"
    kinds = [
        st.well_posedness("perturbed", "uniform_strain", state | {"epsilon": e}, {}).kind
        for e in (found.above, found.last, found.beyond)
    ]
    assert kinds == ["stable", "stable", "unstable, bounded"]


def test_where_every_value_tried_cures_that_is_the_answer():
    state = STATE | {"delta": -0.1, "strain_rate": 1.0}
    found = smallest_cure("perturbed", "uniform_strain", state, {}, "epsilon", bracket=(1e-9, 1e-3))
    assert (found.below, found.above, found.last, found.beyond) == (None, 1e-9, 1e-3, None)
    assert "Of 13 values tried from 1e-09 to 0.001 s, all cure." in str(found)


GRAINS = {
    "solid_fraction": 0.6,
    "static_friction": np.tan(np.deg2rad(20.9)),
    "dynamic_friction": np.tan(np.deg2rad(32.76)),
    "reference_inertial_number": 0.279,
    "delta": 0.0,
    "strain_rate": np.sqrt(2),
    "pressure": 1.0,
}
PER_GRAIN = 2 / np.sqrt(0.6)  # I over the diameter at that state


@pytest.mark.parametrize(("growth", "certified"), [(0.0, (True, True)), (5.0, (False, True))])
def test_a_cure_between_two_values_has_both_its_ends_bracketed(growth, certified):
    found = smallest_cure("mu_i", "uniform_strain", GRAINS, {}, "grain_diameter", growth=growth)
    ends = np.array([found.below, found.above, found.last, found.beyond]) * PER_GRAIN
    # published neutral inertial numbers of glass beads: Barker, Schaeffer, Bohorquez & Gray, 2015
    assert_allclose(ends, [0.0193500918873711] * 2 + [0.85226581486577] * 2, rtol=2e-6)  # twice rtol
    assert ends[0] < 0.0193500918873711 <= ends[1] and ends[2] <= 0.85226581486577 < ends[3]
    assert found.certified[0] and found.certified_upper == certified
    assert "no smaller one cures, and all larger ones do up to 0.33008" in str(found)


def test_a_bracket_that_ends_in_a_cure_says_nothing_of_larger_values():
    found = smallest_cure("mu_i", "uniform_strain", GRAINS, {}, "grain_diameter", bracket=(1e-4, 0.1))
    assert found.beyond is None and found.last == 0.1
    assert "Of 13 values tried from 0.0001 to 0.1 m, all larger ones cure and no smaller one." in str(found)


def test_values_that_cure_again_are_named_as_tried():
    found = scanned(lambda x: 1 < x < 5 or x > 50, 0.1, 1e3)[1]
    assert len(found) == 2
    told = Cure("x", "1", 0.0, (0.1, 1e3, 13), 1.0, 1.001, 4.9, 4.91, ((50.0, 1e3),), inf, -1.0, None, None, None,
                (False, False), (False, False))  # fmt: skip
    assert "4.91 does not, but those from 50 to 1000 cure again." in str(told)


def test_a_slip_of_float64_at_an_end_gives_way_to_balls_and_a_wrong_end_is_not_taken():
    good, bad = apart(lambda x: x > 2.001, 2.0, 1.99, 1e-4)
    assert good > 2.001 and bad == 1.99
    assert apart(lambda x: x > 4, 2.0, 1.99, 1e-4) is None


def test_growth_of_the_longest_waves_is_no_band():
    # 1.5 m of hopper: waves of kilometres grow by the kinematics of the flow
    hopper = {"friction_angle": 34, "wall_friction_angle": 9, "wedge_angle": 15, "outlet_radius": 0.5,
              "inlet_radius": 1.5, "gravity": 9.81}  # fmt: skip
    ask = ("viscous", "radial_hopper", hopper, {"r": 1.0, "theta": 0.0}, "kinematic_viscosity")
    found = smallest_cure(*ask, growth=10.0, bracket=(1e-3, 1e2))
    assert 0 < found.growth_above < 10 and found.band_width is None and found.wavenumber is None
    assert "the kinematics of the longest waves" in str(found) and "Bands" not in str(found)
    off_axis = (*ask[:3], {"r": 1.0, "theta": 5.0}, ask[4])
    found = smallest_cure(*off_axis, growth=10.0, bracket=(1e-3, 1e2), longest=100.0)
    assert "The longest waves grow fastest" in str(found) and found.band_width is None


def test_less_growth_than_the_kinematics_is_not_to_be_had():
    with pytest.raises(SceneError, match=r"within 0.1 1/s: the longest waves grow at up to \|\|V\|\| = 1 1/s"):
        smallest_cure("perturbed", "uniform_strain", STATE | {"strain_rate": 1.0}, {}, growth=0.1, bracket=(1e-6, 1e3))


def test_a_part_of_the_word_will_do_where_one_parameter_of_the_closure_has_it():
    ask = {"growth": 50.0, "rtol": 1e-2, "bracket": (1.0, 100.0)}
    found = smallest_cure("hyperstress", "uniform_strain", STATE, {}, "viscosity", **ask)
    assert found.parameter == "hyperviscosity"
    with pytest.raises(SceneError, match="friction may be static_friction or dynamic_friction: say which"):
        smallest_cure("mu_i", "uniform_strain", GRAINS, {}, "friction")


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"parameter": "viscosity"}, "parameter viscosity is unknown here; known are .*epsilon"),
        ({"longest": 0.0}, "longest = 0.0 m"),
        ({"bracket": (-1.0, 1.0)}, "two increasing positive numbers"),
        ({"parameter": "friction_angle", "bracket": (1.0, 90.0)}, "bracket friction_angle = 90.0 deg lies outside"),
        ({"growth": -1.0}, "growth = -1.0"),
        ({"rtol": 0.0}, "rtol = 0.0"),
        ({"bracket": (2.0, 1.0)}, "two increasing positive numbers"),
    ],
)
def test_a_question_without_meaning_is_refused(options, words):
    with pytest.raises(SceneError, match=words):
        smallest_cure("perturbed", "uniform_strain", STATE, {}, **options)


def test_a_bound_on_growth_is_not_kept_where_growth_closes_in_on_a_direction_without_bound():
    state = {"critical_friction": 0.5, "critical_pressure": 1, "critical_fraction": 0.6, "volume_fraction": 0.6,
             "pressure": 0.5, "strain_rate": 1, "delta": 0.6324555320336759}  # fmt: skip
    with pytest.raises(SceneError, match="no value tried"):
        smallest_cure("critical_state", "uniform_fraction", state, {}, "hardening", growth=50, bracket=(1e-3, 1e3))


def test_the_longest_wave_looked_at_is_no_band():
    state = {"friction_angle": 34, "delta": 0.0, "strain_rate": 1e-3, "pressure": 1.0}
    found = smallest_cure("perturbed", "uniform_strain", state, {}, "epsilon", growth=1.0, longest=0.1)
    assert "ands of" not in str(found) and "no width is singled out" in str(found)


@pytest.mark.parametrize("fault", [{"growth": None}, {"bracket": 1.0}, {"bracket": (1, 2, 3)}])
def test_what_is_no_number_is_refused_in_words(fault):
    state = {"friction_angle": 34, "delta": 0.0, "strain_rate": 1e-3, "pressure": 1.0}
    with pytest.raises(SceneError, match=next(iter(fault))):
        smallest_cure("perturbed", "uniform_strain", state, {}, "epsilon", **fault)
    with pytest.raises(SceneError, match="leave it out"):
        smallest_cure("perturbed", "uniform_strain", state | {"epsilon": 1e-3}, {}, "epsilon")
