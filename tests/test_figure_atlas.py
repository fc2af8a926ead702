"""The data behind the atlas of symbols: one panel per closure, curves that agree with the verdicts."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

import stability as st
from figures import atlas_captions
from figures.A1 import LOWEST, SHADES, words
from figures.atlas import WAVES, by_closure, symbol
from stability.closures import CLOSURES

STATES = by_closure()


@pytest.fixture(scope="module")
def drawn():
    """Return a function from closure and number of the state to what its panel shows."""
    done: dict = {}
    return lambda name, i=0: (
        done.setdefault((name, i), symbol(STATES[name][i])) if (name, i) not in done else done[name, i]
    )


def test_every_registered_closure_has_a_panel_and_its_fastest_growth_comes_first():
    assert set(STATES) == set(CLOSURES)
    for states in STATES.values():
        exponents = [-np.inf if b.exponent is None else b.exponent for b in states]
        assert len(states) <= 2 and exponents == sorted(exponents, reverse=True)


def test_the_states_that_are_drawn_at_one_wave_are_benchmarks():
    assert set(WAVES) <= {(name, b.exponent) for name, states in STATES.items() for b in states}


@pytest.mark.parametrize("name", ["rigid_plastic", "mu_i", "mu_i_phi_i", "double_shearing"])
def test_growth_is_its_own_mirror_image_about_90_degrees(name):
    state = STATES[name][0]
    asked = state.closure, state.flow, state.parameters, {}
    angles = np.array([3.0, 17.0, 37.0, 41.0, 66.0, 88.0])
    for one, other in zip(st.short_wave(*asked, angles), st.short_wave(*asked, 180 - angles), strict=True):
        assert_allclose(one, other, rtol=1e-12, atol=0)  # balls of 256 bits; directions differ by float64 roundings


@pytest.mark.parametrize(("name", "i"), [("rigid_plastic", 0), ("viscous", 0), ("mu_i", 0), ("cosserat", 0)])
def test_the_curve_is_positive_between_the_edges_of_the_wedge_alone(name, i, drawn):
    s = drawn(name, i)
    inside = np.any([(low < s.wave_angle) & (s.wave_angle < high) for low, high in s.verdict.wedge], axis=0)
    edges = np.any(np.isclose(s.wave_angle[:, None], np.ravel(s.verdict.wedge), rtol=0, atol=1e-9), axis=1)
    assert edges.any() and np.all(s.growth[inside & ~edges] > 0) and np.all(s.growth[~inside & ~edges] <= 0)
    assert_allclose(s.growth.max(), 1, rtol=1e-12)  # at the worst direction, which is among the samples


@pytest.mark.parametrize(("name", "i", "missing"), [("perturbed", 0, 0.03), ("perturbed", 1, 0.35)])
def test_a_wave_of_the_length_in_the_panel_comes_near_the_limiting_growth(name, i, missing, drawn):
    s = drawn(name, i)
    # computed: 0.975 and about 0.75 of the limit, in the growing direction or next to it
    assert 1 - missing < s.growth.max() <= 1
    assert abs(s.wave_angle[s.growth.argmax()] - min(s.verdict.worst_angle, 180 - s.verdict.worst_angle)) < 2


def test_a_decaying_state_lies_between_0_and_minus_1(drawn):
    s = drawn("mu_i", 1)
    assert not s.unstable and s.growth.max() < 0 and s.growth.min() == -1
    assert words(s) == "decays, $n=2$"


def test_a_panel_names_its_exponent_and_wave(drawn):
    assert words(drawn("rigid_plastic")) == "$n=2$"
    assert words(drawn("perturbed")) == "$n=0$\nat 200/m"


def test_every_exponent_of_growth_over_wedges_has_a_shade():
    wide = {b.exponent for states in STATES.values() for b in states if b.exponent is not None and b.peak is None}
    assert wide <= set(SHADES)


def test_the_caption_gives_every_input_and_counts_the_certified_verdicts(drawn):
    shown = [drawn("rigid_plastic"), drawn("mu_i", 1)]
    caption = " ".join(atlas_captions.atlas(shown, LOWEST).split())
    assert "2 of the 2 verdicts are certified" in caption and "{" not in caption
    for s in shown:
        for word, value in s.benchmark.parameters.items():
            assert f"{word.replace('_', ' ')} = {float(value):.12g}" in caption
    assert "0.0369593821168 |xi|^2 at 36.09894 deg, directions 28 to 45, 135 to 152" in caption
