"""The theory's side of the cross-check is that of the package's own eigenvalues."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

import stability as st
from stability.crosscheck.theory import plane_wave, tangent, uniform, unit, wave_matrix
from stability.model import Model
from tests.crosscheck.given import CELL, EPSILON


@pytest.fixture
def base(perturbed_hopper):
    return Model("perturbed", "radial_hopper").base(perturbed_hopper, {"r": 0.8, "theta": 5})


def test_leading_eigenvalue_is_that_of_the_full_tangent_matrix(base, perturbed_hopper):
    for q, angle in ((30.0, 40.0), (200.0, -35.0), (500.0, 80.0)):
        wave = plane_wave(base, q * unit(angle))
        place = {"r": 0.8, "theta": 5}
        found = st.eigenvalues("perturbed", "radial_hopper", perturbed_hopper, place, q, angle)
        # QZ errs by roundings of the largest entry, 1e5 times larger than the slow eigenvalue.
        assert_allclose(wave.eigenvalue, found[0], rtol=1e-9)


def test_rigid_plastic_waves_keep_their_only_mode(hopper):
    base = Model("rigid_plastic", "radial_hopper").base(hopper, {"r": 0.8, "theta": 5})
    found = st.eigenvalues("rigid_plastic", "radial_hopper", hopper, {"r": 0.8, "theta": 5}, 100.0, 37.0)
    assert_allclose(plane_wave(base, 100 * unit(37)).eigenvalue, found[0], rtol=1e-9)  # roundings, as above


def test_dual_vector_measures_one_mode_and_no_other(base):
    xi = 100 * unit(40)
    wave = plane_wave(base, xi)
    D = tangent(wave_matrix(base, xi), base.model.evolves)
    values, modes = np.linalg.eig(D)
    other = modes[:, np.argmin(values.real)]
    assert_allclose(wave.dual @ wave.field, 1, rtol=1e-12)
    assert abs(wave.dual[:2] @ other) < 1e-10 * np.linalg.norm(wave.dual)  # roundings of the eigenvectors


def test_drifting_cell_is_a_simple_shear_along_its_streamlines():
    parameters = CELL | {"delta": 0.3, "epsilon": EPSILON}
    still, drifting = uniform("perturbed", parameters), uniform("perturbed", parameters, 1.5)
    velocity, gradient, _ = drifting.state[0]
    assert_allclose(np.hypot(*velocity), 1.5, rtol=1e-15)
    assert_allclose(np.array(gradient) @ velocity, 0, atol=1e-15 * 10)  # a steady flow; roundings of some 3 m/s2
    for letter in ("N", "A_xx", "A_xy", "A_yy", "mu"):
        assert_allclose(drifting.letters()[letter], still.letters()[letter], rtol=1e-15, atol=1e-16)
