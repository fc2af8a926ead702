"""What becomes of a wave: it stops to grow, its jump is a band as thin as the mesh, down to a limit."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

import stability as st
from stability.crosscheck.saturation import NUMBERS, band_rate, band_thickness, saturation, stable_delta
from tests.crosscheck.given import CELL, EPSILON

K = np.sqrt(2) * np.sin(np.radians(CELL["friction_angle"]))


@pytest.fixture(scope="module")
def coarse():
    return saturation("perturbed", CELL, epsilon=EPSILON, cells=(32, 64))


def last(course, name):
    return course.rows[name][-1]


def test_growth_ends_at_an_amplitude_that_the_mesh_hardly_changes(coarse):
    one, other = coarse
    for course in coarse:
        amplitude = course.rows["amplitude"]
        assert course.ended == "" and amplitude[-1] > 100 * amplitude[0]
        assert_allclose(amplitude[-15:], amplitude[-1], rtol=2e-3)  # steady for the last tenth of the run
    assert_allclose(last(one, "amplitude"), last(other, "amplitude"), rtol=0.05)  # measured 3 %, then 2 %, then 1 %


def test_jump_is_two_cells_thick_on_coarse_meshes(coarse):
    for course in coarse:
        assert_allclose(last(course, "thickness") / course.wavelength, 2 / course.cells, rtol=1e-12)  # exact


def test_first_growth_is_that_of_the_linear_theory(coarse):
    course = coarse[1]
    early = slice(5, 15)
    slope = np.polyfit(course.time[early], np.log(course.rows["amplitude"][early]), 1)[0]
    dt = course.time[1]
    assert_allclose((1 - np.exp(-slope * dt)) / dt, 138.58, rtol=0.02)  # st.eigenvalues; cells 0.3 %, amplitude 1 %


def test_delta_is_positive_in_the_band_and_stable_between_bands(coarse):
    for course in coarse:
        assert last(course, "band_delta") > 0.05
        # The trough lies in the band, whose two cells are mirror images up to Newton's tolerance.
        assert_allclose(last(course, "trough_delta"), last(course, "band_delta"), rtol=1e-6)
        assert last(course, "least_delta") < stable_delta(K) and last(course, "stable_share") > 0.7
        assert last(course, "below_floor") == 0


def test_shortest_waves_neither_grow_nor_decay_at_the_bands_rate():
    delta = 0.08
    angle = 90 - np.degrees(np.arccos(-delta / np.sqrt(2 - delta**2))) / 2  # from extension; there Det M = 0 (P6)
    given = CELL | {"delta": delta, "epsilon": EPSILON, "strain_rate": band_rate(K, EPSILON, delta)}
    found = st.eigenvalues("perturbed", "uniform_strain", given, {}, 1e6, angle, digits=40)[0].real
    scale = delta * (K - delta) / (EPSILON * (2 - delta**2))
    assert abs(float(found)) < 1e-2 * scale  # the limit q -> inf is reached as q^-2; mu is 1e3 times smaller here


def test_thickness_of_a_band_is_its_jump_over_its_slope():
    rate, thickness = band_rate(K, EPSILON, 0.0), band_thickness(K, EPSILON, 0.0, 0.1)
    assert_allclose(rate, K / 2 / EPSILON, rtol=1e-15)
    assert_allclose(thickness, 0.1 / (np.sqrt(2) * rate), rtol=1e-15)  # ||V|| = slope/sqrt 2 in simple shear


def test_every_number_of_a_course_is_described(coarse):
    assert set(coarse[0].rows) == set(NUMBERS)
    assert all(np.shape(v) == coarse[0].time.shape for v in coarse[0].rows.values())


@pytest.mark.slow
def test_thickness_does_not_follow_the_mesh_below_its_limit():
    found = saturation("perturbed", CELL, epsilon=4e-3, cells=(128, 256, 512))
    thickness = np.array([last(c, "thickness") for c in found])
    limit = [band_thickness(K, 4e-3, last(c, "band_delta"), last(c, "band_jump")) for c in found]
    assert_allclose(thickness, limit, rtol=0.12)  # a whole number of cells; measured 6 to 10 % above
    assert last(found[2], "thickness") > 7 * found[2].wavelength / found[2].cells


@pytest.mark.slow
def test_floor_changes_nothing_while_it_lies_below_the_least_rate():
    free, low = (saturation("perturbed", CELL, epsilon=EPSILON, cells=(64,), floor=f)[0] for f in (0.0, 0.5))
    assert_allclose(free.rows["amplitude"], low.rows["amplitude"], rtol=1e-12)  # least rate 0.55 1/s
