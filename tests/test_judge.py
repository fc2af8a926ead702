"""Verdicts against closed forms: the paper's systems (mathematics in `derivations`), and toys solved by hand."""

import warnings
from fractions import Fraction
from math import inf, pi, sin, sqrt, tan

import numpy as np
import pytest
from numpy.testing import assert_allclose

import stability as st
from stability import balls
from stability.errors import SceneError
from stability.judge import siblings
from tests import toys
from tests.closures.benchmarks import GLASS
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
    assert_allclose(found.wedge, [(90, 270), (270, 90)], rtol=0, atol=1e-12)


def test_antidiffusion_grows_in_every_direction():
    found = st.well_posedness(toys.DIFFUSION, toys.REST, {"growth": -1.5}, {})
    assert (found.exponent, found.coefficient, found.wedge) == (2, 1.5, ((0, 360),))
    assert found.worst_angle is None and "alike in all directions" in str(found)
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
    assert everywhere.cause == ("the balance of b responds to nothing here",)
    somewhere = st.well_posedness(toys.FREE_ALONG_Y, toys.REST, {}, {})
    assert somewhere.kind == "singular symbol"
    assert_allclose(somewhere.wedge, [(90, 90), (270, 270)], rtol=0, atol=1e-12)
    # i q cos lambda = 1: the coefficient of lambda |xi| is that of b_x, and no wave grows or decays
    assert somewhere.vanishing == (1, 1) and somewhere.beside.coefficient == 0
    assert somewhere.cause == ("the response of first order to b in the balance of b",)


def test_beside_a_singular_direction_growth_follows_its_closed_form():
    # lambda = -(mu p q^2/(2 ||D||)) [nu - K c + (1 - nu) c^2]/(1 - K c), c = cos 2phi; K c = 1 at 9.08 degrees
    I, (mu_s, mu_2, mu_inf, I_0) = 20.0, (0.342, 0.557, 0.05, 0.069)
    given = {word: float(value) for word, value in GLASS.items()} | {"high_rate_friction": mu_inf}
    found = st.well_posedness("mu_i_regularised", "uniform_strain", given | {"strain_rate": I / sqrt(2)}, {})
    assert (found.kind, found.vanishing) == ("singular symbol", (1, 2))
    top = mu_s * I_0 + mu_2 * I + mu_inf * I**2
    mu, nu = top / (I_0 + I), I * ((mu_2 + 2 * mu_inf * I) / top - 1 / (I_0 + I))
    slope = mu * (1 - nu / 2)
    c = 1 / slope
    assert_allclose(found.wedge[0], np.rad2deg(np.arccos(c)) / 2, rtol=1e-12)
    expected = -mu * 2 / I * (nu - 1 + (1 - nu) * c**2) / (2 * slope * sqrt(1 - c**2))  # ||D|| = I/2
    assert (found.beside.exponent, found.beside.power) == (2, 1)
    assert_allclose(found.beside.coefficient, expected, rtol=1e-12)
    assert found.beside.side == (1 if found.beside.angle < 90 else -1)  # where K c < 1
    assert found.cause == (
        "the response of first order to p in the balance of (u, v)",
        "the response of first order to (u, v) in the balance of p",
    )


@pytest.mark.parametrize(
    ("closure", "other", "title"),
    [("mu_i_regularised", "mu_i_regularised_low", "branch of low I"),
     ("mu_i_regularised_low", "mu_i_regularised", "branch of high I")],
)  # fmt: skip
def test_a_branch_of_a_law_points_to_the_other_one(closure, other, title):
    (told,) = siblings(closure)
    assert told.startswith(f"{other} (") and title in told


def test_closures_that_share_a_module_or_nothing_point_nowhere():
    assert siblings("rigid_plastic") == siblings("cosserat") == siblings(toys.FREE) == ()


def test_a_state_beyond_float64_is_judged_without_a_warning():
    given = {word: float(value) for word, value in GLASS.items()}
    given |= {"high_rate_friction": 0.05, "low_rate_exponent": 1.9, "branch_inertial_number": 0.004}
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        found = st.well_posedness(
            "mu_i_regularised_low", "uniform_strain", given | {"strain_rate": 1e-300 / sqrt(2)}, {}
        )
    assert found.kind == "stable" and found.certified and found.finite is None
    assert "float64 does not hold this state" in found.notes[-1] and "found to grow" not in str(found)


def test_the_kinematics_of_the_longest_waves_is_no_instability_of_the_closure():
    found = st.well_posedness("viscous", "radial_hopper", HOPPER | {"kinematic_viscosity": 1.0}, {"r": 1, "theta": 0})
    assert found.kind == "stable" and found.longest and found.strain_rate < found.finite[0] < 10 * found.strain_rate
    assert "the base flow's own kinematics (||V|| = 2.093 1/s)" in str(found) and "grow at" not in str(found)


def test_waves_of_the_closures_own_band_are_told_although_longer_ones_grow():
    # eta q^4 against the Coulomb growth of waves of 1/q, beside ||V||: the band ends at q_c = 19.2/m
    given = strained(0.0, hyperviscosity=1e-4)
    found = st.well_posedness("hyperstress", "uniform_strain", given, {})
    assert not found.longest and found.worst_angle is None and 5 < found.finite[1] < 19.2
    assert "waves grow at 3.20023 1/s" in str(found)


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
