"""The data behind the mu(I) phase diagram, against the published limits and the verdict."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

import stability as st
from figures import A2, inertial


def verdict(I: float, static: float = inertial.GLASS["static_friction"]) -> st.Verdict:
    return st.well_posedness("mu_i", "uniform_strain", inertial.state(I, static), {})


def test_the_neutral_curves_close_at_the_published_limits():
    assert_allclose(inertial.neutral(), A2.PUBLISHED, rtol=1e-12)  # published to 15 digits


@pytest.mark.parametrize("static", [0.05, 0.2, 0.381862867419, 0.5])
def test_the_deciding_coefficient_and_the_printed_condition_vanish_at_the_same_inertial_numbers(static):
    # two paths: the closure's pencil, and the formula
    assert_allclose(inertial.neutral(static), inertial.neutral(static, inertial.printed), rtol=1e-11)


@pytest.mark.parametrize("static", [0.1, 0.381862867419, 0.5])
def test_the_verdict_changes_at_the_edges(static):
    low, high = inertial.neutral(static)
    for I, stable in ((low * (1 - 1e-9), False), (low * (1 + 1e-9), True), (high * (1 - 1e-9), True)):
        assert (verdict(I, static).kind == "stable") == stable
    assert verdict(high * (1 + 1e-9), static).kind == "ill-posed"


@pytest.mark.parametrize("I", [1e-3, 0.01, 2.0, 50.0])
def test_the_wedge_is_that_of_the_verdict(I):
    assert_allclose(inertial.wedge(I), verdict(I).wedge[0], rtol=0, atol=1e-10)


def test_the_growth_at_a_low_inertial_number_is_the_published_one():
    assert_allclose(inertial.growth(1e-3, np.array([39.26912])), 0.0184797007567, rtol=1e-11)  # published to 12 digits


def test_growth_is_the_coefficient_of_the_verdict():
    I = 3.0
    found = verdict(I)
    eta = inertial.friction(I)[0] * 2 / (I / 2)
    assert_allclose(inertial.growth(I, np.array([found.worst_angle])) * eta, found.coefficient, rtol=1e-12)


def test_the_well_posed_region_closes_at_a_static_friction_of_0_5277():
    static, number = inertial.tip()
    assert_allclose((static, number), (0.5277022107916152, 0.1533707), rtol=1e-6)  # computed, November 2026
    assert inertial.neutral(static + 1e-9) is None and inertial.neutral(static - 1e-9) is not None
    assert verdict(number, static - 1e-6).kind == "stable" and verdict(number, static + 1e-6).kind == "ill-posed"


def test_the_outline_of_a_growing_region_has_its_tip_at_the_neutral_number():
    angle, number = A2.outline(1e-4, A2.PUBLISHED[0])
    top = number.argmax()
    assert number[top] == pytest.approx(A2.PUBLISHED[0], rel=1e-14)
    # At the tip the edges meet as the square root of what is left of the number: 1e-14 of it is 1e-7 of the angle.
    assert abs(angle[top] - angle[top + 1]) < 1e-3 and np.ptp(angle) > 10


def test_no_growth_exceeds_the_largest_level_of_the_colours():
    ends = 10.0 ** np.array(A2.RANGE)
    found = [inertial.growth(I, A2.ALL_DIRECTIONS, s).max() for I in ends for s in A2.FRICTIONS[[0, -1]]]
    assert 0.08 < max(found) < A2.LEVELS[-1]
