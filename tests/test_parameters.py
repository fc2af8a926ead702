import numpy as np
import pytest

from stability.errors import SceneError
from stability.parameters import EPSILON, FRICTION_ANGLE, Parameter, merged, problems, to_si


def test_a_problem_names_word_value_range_meaning_and_source():
    sentence = FRICTION_ANGLE.problem(134, "[parameters]")
    for part in ("[parameters] friction_angle = 134 deg", "(0, 90) deg", "internal angle of friction", "paper, I2"):
        assert part in sentence


@pytest.mark.parametrize("value", [0, 90, -1, float("nan"), float("inf"), "steep", None, True])
def test_the_range_is_open_and_only_finite_numbers_pass(value):
    assert FRICTION_ANGLE.problem(value)


@pytest.mark.parametrize("value", [34, 34.5, "34", 1e-300, 89.999])
def test_numbers_and_decimals_inside_the_range_pass(value):
    assert FRICTION_ANGLE.problem(value) is None


def test_every_problem_is_reported_at_once():
    found = problems(merged([FRICTION_ANGLE, EPSILON]), {"friction_angle": -3, "epsilom": 1})
    assert len(found) == 3
    assert any("epsilon is missing" in p for p in found) and any("epsilom is unknown" in p for p in found)


def test_degrees_become_radians_once_and_only_for_angles():
    assert to_si(merged([FRICTION_ANGLE, EPSILON]), {"friction_angle": 90 / 2, "epsilon": 2e-5}) == {
        "friction_angle": pytest.approx(0.7853981633974483, rel=2**-52),  # pi/4 to one rounding
        "epsilon": 2e-5,
    }


def test_a_word_with_two_records_is_refused():
    other = Parameter("epsilon", "epsilon", "m", 0, 1, "something else", "nowhere")
    with pytest.raises(SceneError, match="epsilon is declared twice"):
        merged([EPSILON], [other])


@pytest.mark.parametrize("ends", [(None, 1), ("0", "1"), (1, 1), (2, 1), (float("nan"), 1)])
def test_a_parameter_without_a_range_is_refused(ends):
    with pytest.raises(ValueError, match="^parameter word has no range: low and high must be numbers and low < high"):
        Parameter("word", "w", "1", *ends, "meaning", "source")


def test_a_range_of_numpy_numbers_is_one_of_plain_numbers():
    assert repr(Parameter("word", "w", "1", np.float64(0), np.float64(2), "a", "b")).count("low=0.0, high=2.0") == 1
