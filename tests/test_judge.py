"""Verdicts against closed forms: the paper's systems (mathematics in `derivations`), and toys solved by hand."""

from fractions import Fraction
from math import inf, pi, sin, sqrt, tan

import numpy as np
import pytest
from numpy.testing import assert_allclose

import stability as st
from stability import balls
from stability.errors import SceneError
from tests import toys
from tests.conftest import HOPPER

K = sqrt(2) * sin(34 * pi / 180)
EPSILON = 0.01


def strained(delta: float, **more: float) -> dict:
    return {"friction_angle": 34, "delta": delta, "strain_rate": 1.0, "pressure": 1.0} | more


def of_paper(delta: float, matrix: str = "full", **more: float):
    parameters = strained(delta, epsilon=EPSILON, **more)
    return st.well_posedness("perturbed", "uniform_strain", parameters, {}, matrix)


@pytest.fixture(scope="module")
def coulomb():
    return st.well_posedness("rigid_plastic", "uniform_strain", strained(0.0), {})


def test_incompressible_coulomb_flow_is_ill_posed_with_exponent_2(coulomb):
    assert coulomb.kind == "ill-posed" and coulomb.exponent == 2 and coulomb.certified


def test_the_wedges_lie_between_the_characteristics(coulomb):
    # 45 < phi < 45 + 17 degrees from the major principal stress axis, which is y
    expected = [(28, 45), (135, 152), (208, 225), (315, 332)]
    assert_allclose(coulomb.wedge, expected, rtol=0, atol=1e-12)


def test_the_largest_growth_of_coulomb_flow_has_its_closed_form(coulomb):
    # exact: (mu/2) tan^2(varphi/2) at cos 2 phi = -tan(varphi/2)
    assert_allclose(coulomb.coefficient, 0.0467356247925884 * K, rtol=1e-12)
    assert_allclose(coulomb.coefficient, K / 2 * tan(17 * pi / 180) ** 2, rtol=1e-14)
    assert_allclose(coulomb.worst_angle, 36.0989355774566, rtol=1e-12)


def test_the_slowest_decay_of_a_stable_flow_is_that_of_its_worst_direction():
    found = st.well_posedness("viscous", "uniform_strain", strained(0.0, kinematic_viscosity=0.1), {})
    assert found.kind == "stable"
    # exact: (mu/2) tan^2(varphi/2) - nu, where Coulomb flow grows fastest
    assert_allclose(found.coefficient, K / 2 * tan(17 * pi / 180) ** 2 - 0.1, rtol=1e-14)
    assert_allclose(found.worst_angle, 36.0989355774566, rtol=1e-9)


def test_the_stress_moduli_cause_it(coulomb):
    assert coulomb.cause == ("the response of the flux to the gradient of (u, v) in the balance of (u, v)",)


def test_the_hopper_has_the_same_wedges_about_its_own_axes():
    found = st.well_posedness("rigid_plastic", "radial_hopper", HOPPER, {"r": 1.0, "theta": 0.0})
    assert found.exponent == 2
    assert_allclose(found.wedge[0], (28, 45), rtol=0, atol=1e-12)
    assert_allclose(found.coefficient, 0.0467356247925884 * 1.510780887070834, rtol=1e-12)  # mu(1, 0), computed


@pytest.mark.parametrize("delta", [0.1, 0.3, 0.7])
def test_dilation_below_k_makes_short_waves_grow_at_a_bounded_rate(delta):
    # epsilon lambda -> delta (k - delta)/(2 - delta^2) for D', less delta ||V|| for D, in the null direction of M
    limit = delta * (K - delta) / (2 - delta**2)
    for matrix, background in (("truncated", 0), ("full", delta)):
        found = of_paper(delta, matrix)
        assert (found.kind, found.exponent, found.width, found.certified) == ("unstable, bounded", 0, 1, True)
        assert_allclose(found.coefficient, limit / EPSILON - background, rtol=1e-12)
        assert all(low == high for low, high in found.wedge) and len(found.wedge) == 4


def test_without_dilation_growth_decays_as_the_wave_gets_shorter():
    # k^2/(16 L epsilon), L = mu q^2 epsilon/2
    found = of_paper(0.0, "truncated")
    assert (found.kind, found.exponent, found.width) == ("unstable, bounded", -2, 2)
    assert_allclose(found.coefficient, K**2 / (8 * K * EPSILON**2), rtol=1e-12)
    # the fastest wave of all: the root of (P8T) and half of (P8D), maximised by Nelder and Mead's method to ten digits
    growth, wavenumber, angle = found.finite
    assert_allclose(growth * EPSILON, 0.01388390260, rtol=1e-9)
    assert_allclose((90 - angle, K * wavenumber**2 * EPSILON / 2), (49.9719086, 0.65353425), rtol=1e-5)


def test_the_background_changes_the_next_order_only():
    found = of_paper(0.0)
    assert found.exponent == -2 and 0.9 < found.coefficient / (K / (8 * EPSILON**2)) < 1


def test_strong_contraction_is_stable_at_all_wavelengths():
    edge = -K / (2 * (1 + sqrt(2)))
    found = of_paper(edge - 0.01, "truncated")
    assert found.kind == "stable" and found.finite[0] < 0
    found = of_paper(edge + 0.01, "truncated")
    assert found.kind == "stable" and found.finite[0] > 0  # only long waves grow
    assert "waves grow at" in str(found)


@pytest.mark.parametrize(
    ("closure", "exponent", "coefficient"),
    [(toys.ELLIPTIC, 1, 1), (toys.HALF, Fraction(1, 2), sqrt(0.5)), (toys.TWO_THIRDS, Fraction(2, 3), 0.5)],
)
def test_exponents_below_2_are_ill_posed_too(closure, exponent, coefficient):
    found = st.well_posedness(closure, toys.REST, {}, {})
    assert (found.kind, found.exponent, found.certified) == ("ill-posed", exponent, True)
    assert_allclose(found.coefficient, coefficient, rtol=1e-14)
    assert_allclose(min(found.worst_angle, 180 - found.worst_angle), 0, atol=1e-9)
    assert_allclose(found.wedge, [(90, 270), (270, 450)], rtol=0, atol=1e-12)


def test_antidiffusion_grows_in_every_direction():
    found = st.well_posedness(toys.DIFFUSION, toys.REST, {"growth": -1.5}, {})
    assert (found.exponent, found.coefficient, found.wedge) == (2, 1.5, ((0, 360),))
    assert st.well_posedness(toys.DIFFUSION, toys.REST, {"growth": 1.5}, {}).kind == "stable"


def test_hyperviscosity_makes_it_well_posed_with_a_band_of_growing_waves():
    found = st.well_posedness(toys.HYPERVISCOUS, toys.REST, {}, {})
    assert (found.kind, found.exponent) == ("stable", 4)
    assert_allclose(found.coefficient, -0.1, rtol=1e-14)
    assert_allclose(found.finite[:2], (2.5, sqrt(5)), rtol=1e-6)  # exact; at the top of a parabola


def test_a_direction_may_grow_twice_as_fast_as_its_neighbours():
    found = st.well_posedness(toys.TELEGRAPH, toys.REST, {"growth": 2}, {})
    assert (found.kind, found.exponent, found.coefficient) == ("unstable, bounded", 0, 2)
    assert not found.certified and "neutral leading orders" in found.notes[1]
    exponent, coefficient = st.short_wave(toys.TELEGRAPH, toys.REST, {"growth": 2}, {}, np.array([0.0, 30.0]))
    assert_allclose(exponent, 0) and assert_allclose(coefficient, 1, rtol=1e-14)


def test_growth_that_no_fixed_direction_shows_is_found():
    found = st.well_posedness(toys.FLEETING, toys.REST, {"growth": 3}, {})
    assert (found.kind, found.exponent, found.width) == ("unstable, bounded", 0, 2)
    assert_allclose(found.coefficient, 9 / 4, rtol=1e-12)


def test_constraints_that_determine_nothing_make_a_singular_symbol():
    everywhere = st.well_posedness(toys.FREE, toys.REST, {}, {})
    assert everywhere.kind == "singular symbol" and everywhere.wedge == ()
    somewhere = st.well_posedness(toys.FREE_ALONG_Y, toys.REST, {}, {})
    assert somewhere.kind == "singular symbol"
    assert_allclose(somewhere.wedge, [(90, 90), (270, 270)], rtol=0, atol=1e-12)


def test_the_law_of_each_direction_is_l5_for_coulomb_flow():
    angle = np.array([0.0, 10.0, 36.0, 60.0, 90.0])
    exponent, coefficient = st.short_wave("rigid_plastic", "uniform_strain", strained(0.0), {}, angle)
    c, s = np.cos(2 * np.deg2rad(90 - angle)), np.sin(np.deg2rad(34))
    assert_allclose(exponent, 2) and assert_allclose(coefficient, -K / 2 * c * (c + s) / (1 + s * c), rtol=1e-13)
    exponent, coefficient = st.short_wave("rigid_plastic", "uniform_strain", strained(0.0), {}, 45.0)
    assert exponent in (0, -inf) or coefficient < 0  # bounded on the velocity characteristic


def test_intervals_decide_as_balls_do(monkeypatch, coulomb):
    monkeypatch.setattr(balls, "available", lambda: False)
    found = st.well_posedness("rigid_plastic", "uniform_strain", strained(0.0), {})
    assert (found.kind, found.exponent, found.certified) == (coulomb.kind, 2, True)
    assert_allclose(found.coefficient, coulomb.coefficient, rtol=1e-14)


def test_a_verdict_is_about_one_point():
    with pytest.raises(SceneError, match="a verdict holds at one point"):
        st.well_posedness("rigid_plastic", "radial_hopper", HOPPER, {"r": np.array([1.0, 1.1]), "theta": 0.0})
