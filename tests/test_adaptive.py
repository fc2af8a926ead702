"""An adaptive map is the full map from a tenth of its samples."""

import numpy as np
import pytest
from numpy.testing import assert_array_equal

import stability as st
from stability.analyses import adaptive
from stability.analyses.adaptive import adaptive_map, lagrange
from stability.analyses.growth_map import growth_map
from tests.conftest import HOPPER

PERTURBED = ("perturbed", "radial_hopper", HOPPER | {"epsilon": 2e-5}, {"r": 1.0, "theta": 0.0})
RIGID = ("rigid_plastic", "radial_hopper", HOPPER, {"r": 1.0, "theta": 0.0})
LONG_TO_SHORT, TURN = np.geomspace(0.3, 3e4, 401), np.linspace(0, 360, 1441)  # the grid of figure P2.1


def compared(question: tuple, wavenumber: np.ndarray, wave_angle: np.ndarray, **options) -> tuple:
    """Return the adaptive map, the full one, and the largest error relative to the largest growth or own decay."""
    found = adaptive_map(*question, wavenumber, wave_angle, **options)
    full = growth_map(*question, wavenumber, wave_angle, options.get("matrix", "full"))
    true = full.growth_rate.values
    scale = np.maximum(abs(true.max()) or abs(true).max(), np.abs(true))
    return found, full, np.max(np.abs(found.growth_rate.values - true) / scale)


@pytest.mark.parametrize(
    ("question", "matrix", "tolerance"),
    [(PERTURBED, "full", 1e-3), (PERTURBED, "full", 1e-2), (PERTURBED, "truncated", 1e-3), (RIGID, "full", 1e-3)],
    ids=["perturbed", "perturbed, loose", "truncated", "rigid-plastic"],
)
def test_a_tenth_of_the_samples_gives_the_same_picture(question, matrix, tolerance):
    found, full, error = compared(question, LONG_TO_SHORT, TURN, matrix=matrix, growth=tolerance)
    assert error <= tolerance
    assert found.sampled.values.mean() <= 0.1  # measured: 0.048 to 0.085
    assert float(found.attrs["samples_share"]) == found.sampled.values.mean()
    assert_array_equal(np.sign(found.growth_rate), np.sign(full.growth_rate))


def test_a_sample_that_was_evaluated_is_that_of_the_full_map():
    found, full, _ = compared(PERTURBED, LONG_TO_SHORT[::4], TURN[::8])
    known = found.sampled.values == 1
    for name in ("growth_rate", "frequency"):
        np.testing.assert_allclose(found[name].values[known], full[name].values[known], rtol=1e-9)  # two orders of sums
    assert np.isnan(found.frequency.values[~known]).all()
    assert found.growth_rate.dims == full.growth_rate.dims and found.sizes == full.sizes


def test_a_tongue_between_the_rows_of_a_coarse_grid_is_not_missed():
    angle = np.concatenate([np.linspace(0, 44.9, 150), [44.99], np.linspace(45.1, 90, 150)])
    found, full, error = compared(PERTURBED, np.geomspace(1e3, 1e5, 201), angle, growth=1e-2)
    thin = full.sel(wave_angle=44.99).growth_rate.values
    beside = full.sel(wave_angle=45.1).growth_rate.values
    assert (thin > 0).sum() > 2 * (beside > 0).sum()  # the tongue reaches beyond its neighbours
    assert error <= 1e-2
    assert_array_equal(np.sign(found.growth_rate), np.sign(full.growth_rate))


def test_a_ridge_of_one_direction_is_not_missed():
    found, full, error = compared(PERTURBED, np.geomspace(1e4, 1e6, 101), np.linspace(0, 90, 361), growth=1e-2)
    ridge = np.flatnonzero(found.wave_angle.values == 45.0)
    assert full.growth_rate.values.max() < 0, "nothing grows, so that no sign betrays the ridge"
    np.testing.assert_allclose(found.growth_rate[ridge], full.growth_rate[ridge], rtol=1e-2)
    assert error <= 1e-2


def test_thirty_digits_are_those_of_the_precise_eigenvalues():
    question = (*PERTURBED, np.geomspace(1, 1e4, 25), np.linspace(20, 60, 21))
    found = adaptive_map(*question, growth=0.05, digits=30)
    i, j = np.argwhere(found.sampled.values == 1)[7]
    expected = st.eigenvalues(*PERTURBED, question[4][j], question[5][i], digits=30)[0].real
    assert found.growth_rate.values[i, j] == float(expected)  # both are rounded once
    assert found.attrs["digits"] == "30"


@pytest.mark.parametrize("shape", [(1, 1), (1, 9), (9, 1), (2, 3), (5, 6), (70, 11)])
def test_grids_of_any_size_are_covered(shape):
    found, full, error = compared(PERTURBED, np.geomspace(1, 1e4, shape[1]), np.linspace(10, 50, shape[0]))
    assert error <= 1e-3 and found.growth_rate.shape == shape and not found.growth_rate.isnull().any()
    assert found.growth_rate.dims == full.growth_rate.dims


def test_a_frequency_that_is_not_wanted_is_left_out():
    assert "frequency" not in adaptive_map(*PERTURBED, [1.0, 2.0], [3.0], frequency=False)


def test_progress_counts_samples_of_many_digits(monkeypatch):
    monkeypatch.setattr(adaptive, "REPORT", 8)
    seen: list[tuple[int, int]] = []
    adaptive_map(*PERTURBED, np.geomspace(1, 10, 6), [20.0, 30.0, 40.0], digits=16, progress=lambda *n: seen.append(n))
    assert seen == sorted(seen) and {total for _, total in seen} == {18}


def test_a_polynomial_of_degree_four_is_reproduced():
    x, at = np.array([0.0, 1.0, 2.5, 3.0, 7.0]), np.linspace(0, 7, 29)
    np.testing.assert_allclose(lagrange(x, at) @ x**4, at**4, atol=1e-11)  # exact but for rounding
    assert_array_equal(lagrange(x, x), np.eye(5))
