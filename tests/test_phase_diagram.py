"""The phase diagram: exact boundaries against a search over directions that does not know them."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

import stability as st
from stability.analyses.phase_diagram import critical, largest_growth, stress_ratio, unstable_range
from stability.errors import SceneError

K = stress_ratio(34.0)


@pytest.mark.parametrize("friction_angle", [5.0, 34.0, 45.0, 49.9, 50.0, 60.0, 85.0])
def test_the_search_confirms_the_exact_regions(friction_angle):
    delta = np.linspace(-0.4, 1.41, 60)
    ds = st.phase_diagram(friction_angle, delta, np.geomspace(1e-2, 1e2, 25))
    assert int(ds.attrs["disagreements"]) == 0


def test_the_boundary_is_met_to_ten_digits():
    for friction_angle, delta in ((34.0, -0.1), (34.0, 0.85), (60.0, 1.1), (80.0, 1.3)):
        threshold = float(critical(delta, stress_ratio(friction_angle)))
        assert 0 < threshold < np.inf
        around = threshold * np.array([1 - 1e-9, 1 + 1e-9])
        growth, _ = largest_growth(friction_angle, delta, around)
        # Det D' is of order 1e-9 there: far above rounding, and far below what a wrong formula would leave
        assert growth[0] > 0 > growth[1]


def test_the_limits_of_delta_are_those_of_the_theory():
    low, high = unstable_range(K)
    assert_allclose([low, high], [-K / (2 * (1 + np.sqrt(2))), K * (1 + np.sqrt(2)) / 2], rtol=1e-15)
    for edge, inside in ((low, 1), (high, -1)):
        assert critical(edge + inside * 1e-9, K) > 0 == critical(edge - inside * 1e-9, K)
    steep = stress_ratio(60.0)
    assert_allclose(unstable_range(steep)[1], 1 / steep + np.sqrt(1 - 1 / steep**2), rtol=1e-15)
    assert critical(unstable_range(steep)[1] - 1e-7, steep) > 0 == critical(unstable_range(steep)[1] + 1e-7, steep)


def test_between_zero_and_k_every_wavelength_is_unstable():
    assert np.all(np.isinf(critical([0.0, 0.3, K], K)))
    assert np.isfinite(critical(1.05, stress_ratio(60.0)))  # k > 1: only up to delta = 1
    growth, _ = largest_growth(34.0, 0.3, np.array([1e-3, 1.0, 1e3, 1e6]))
    assert np.all(growth > 0)
    # epsilon lambda -> delta (k - delta)/(2 - delta^2), with an error O(1/L)
    assert_allclose(growth[-1], 0.3 * (K - 0.3) / (2 - 0.09), rtol=1e-4)


def test_without_dilation_the_fastest_wave_is_the_known_one():
    scaled = np.linspace(0.6, 0.7, 1001)
    growth, angle = largest_growth(34.0, 1e-13, scaled)
    best = growth.argmax()
    # exact to these digits by the stationarity conditions (derivations, D' at delta = 0); the grid is 1e-4 in L
    assert_allclose(growth[best], 0.0138839026, rtol=1e-8)
    assert_allclose(scaled[best], 0.653534, atol=2e-4)
    assert_allclose(angle[best], 49.9719, atol=1e-3)


def test_growth_never_exceeds_its_bound():
    ds = st.phase_diagram(34.0, np.linspace(-1, 1.3, 24), np.geomspace(1e-3, 1e3, 20))
    assert ds.scaled_growth_rate.max() <= K**2 / 4  # Re lambda(D') <= k^2/(4 epsilon)


REFUSALS = [((95.0, [0.0], [1.0]), "friction_angle = 95"), ((34.0, [1.5], [1.0]), "delta lies outside"),
            ((34.0, [0.0], [0.0]), "scaled_wavenumber lies outside")]  # fmt: skip


@pytest.mark.parametrize(("ask", "sentence"), REFUSALS)
def test_values_outside_their_range_are_refused(ask, sentence):
    with pytest.raises(SceneError, match=sentence):
        st.phase_diagram(*ask)
