"""Modes of the discrete Jacobian grow in the time-stepper at their own rate."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from stability.crosscheck.modes import held, leading_modes, modes_near, rate_of, stepped
from stability.timestepper.hopper import hopper_problem
from tests.conftest import HOPPER

GIVEN = HOPPER | {"epsilon": 4e-4}


@pytest.fixture(scope="module")
def problem():
    return hopper_problem("perturbed", "radial_hopper", GIVEN, {"elements": 500, "kind": "diamond"})


@pytest.fixture(scope="module")
def modes(problem):
    return leading_modes(problem, 25.0, (20.0, 50.0), 3)


def test_source_holds_the_initial_state(problem):
    fixed = held(problem)
    miss = fixed.equations(fixed.initial, np.zeros_like(fixed.initial), 0.0)
    size = abs(problem.equations(problem.initial, np.zeros_like(problem.initial), 0.0)).max()
    assert abs(miss).max() < 1e-13 * size + 1e-13  # roundings of the fluxes, of p times a cell's length: 0.1 m3/s2


def test_modes_solve_the_eigenvalue_equation(modes):
    assert all(m.residual < 1e-10 for m in modes)  # Arnoldi's own tolerance
    assert modes[0].eigenvalue.real == max(m.eigenvalue.real for m in modes) > 0


def test_stepper_shows_the_growth_of_the_leading_mode_within_one_per_cent(problem, modes):
    dt = 0.05 / abs(modes[0].eigenvalue)
    found = rate_of(stepped(problem, modes[0], dt, 5), dt)
    # Issue: 1 %. Measured 1e-8: what is not linear is 1e-8 of the mode, and rounding 1e-16/1e-8, times some condition.
    assert abs(found - modes[0].eigenvalue) < 1e-5 * abs(modes[0].eigenvalue)


def test_rate_is_taken_free_of_eulers_factor():
    value, dt = 3 - 40j, 0.01
    assert_allclose(rate_of((1 / (1 - value * dt)) ** np.arange(6), dt), value, rtol=1e-12)  # exact but for roundings


def test_a_shift_finds_the_mode_next_to_it(problem, modes):
    again = modes_near(held(problem), modes[0].eigenvalue + 1, 1)[0]
    assert_allclose(again.eigenvalue, modes[0].eigenvalue, rtol=1e-8)  # Arnoldi's tolerance and some digits of the LU
