"""The first waves in the hopper: what is seen of a field, and the fastest wave of the theory."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

import stability as st
from stability.crosscheck.first_waves import (
    Pair,
    growth_of,
    inner_nodes,
    largest_local,
    largest_on_mesh,
    local_wave,
    seen,
)
from stability.crosscheck.theory import unit
from stability.timestepper.hopper import hopper_problem
from tests.conftest import HOPPER

GIVEN = HOPPER | {"epsilon": 1e-4}
ARGS = "perturbed", "radial_hopper", GIVEN


@pytest.fixture(scope="module")
def problem():
    return hopper_problem(*ARGS, {"elements": 4000, "kind": "polar"})


@pytest.mark.parametrize("angle", [-38.0, 52.0])
@pytest.mark.parametrize("whole", [True, False])
def test_place_length_and_direction_of_a_wave_packet_are_seen(problem, angle, whole):
    length, q, centre = 0.0125, 80.0, 1.1 * unit(7.0)
    xi = q * unit(7.0 + angle)
    offset = problem.mesh.nodes - centre
    packet = np.exp(1j * offset @ xi - (offset**2).sum(axis=1) / (2 * 0.06**2))
    field = packet[:, None] * np.array([1.0, -0.5, 0.0])
    r, theta, wavenumber, wave_angle = seen(problem, field if whole else field.real, length)
    assert np.hypot(*(r * unit(theta) - centre)) < 0.04  # half a wavelength, over which a real wave has one maximum
    assert_allclose(wavenumber, q, rtol=0.1)  # the grid's step is 7 %
    assert_allclose(wave_angle, angle, atol=2)  # the grid's step


def test_fastest_local_wave_is_that_of_largest_growth():
    found = local_wave(*ARGS, 1.0)
    q, angle = np.geomspace(20, 250, 100), np.arange(-90, 90, 1.0)
    ds = st.largest_growth(*ARGS, {"r": 1.0, "theta": 0.0}, q, angle)
    assert_allclose(found.growth, ds.largest_growth_rate, rtol=0.01)  # two grids near a flat top
    assert_allclose(abs(found.wave_angle), abs(ds.wave_angle), atol=2)


def test_growth_is_largest_where_viscosity_is():
    found = largest_local(*ARGS, np.array([0.0]), 20)
    assert found.growth >= local_wave(*ARGS, 0.7).growth


def test_mesh_has_waves_at_least_four_cells_long_inside_the_hopper(problem):
    found = largest_on_mesh(problem, *ARGS)
    nearest = np.argmin(abs(np.hypot(*problem.mesh.nodes.T) - found.r))
    assert found.wavenumber * np.sqrt(problem.volume[nearest]) < 1.1 * np.pi / 2  # cells differ a little along an arc
    assert 0.5 < found.r < 1.5 and found.growth > 0
    assert len(inner_nodes(problem)) > 2000  # of 4,000, the rest within 3 cm of a boundary


def test_growth_is_that_of_the_fastest_part():
    time = np.linspace(0.001, 0.05, 50)
    size = np.exp(np.where(time < 0.03, 10 * time, 0.3 + 80 * (time - 0.03)))
    assert_allclose(growth_of(Pair(time, size, np.zeros((1, 3)))), 80, rtol=1e-9)  # exact, a straight line
