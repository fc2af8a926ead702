"""What the stepper's benchmark measures is what it says."""

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from benchmarks import stepper
from stability.timestepper.integrate import Control, State, start
from stability.timestepper.linear import direct
from stability.timestepper.problem import Problem


@pytest.fixture(scope="module")
def problem() -> Problem:
    return stepper.problem_of(100)


def test_a_watch_counts_factors_and_solves_and_changes_neither(problem):
    watch = stepper.Watch(direct())
    matrix, b = problem.matrix(problem.initial, 1e3), np.ones(problem.initial.size)
    assert_array_equal(watch(matrix)(b), direct()(matrix)(b))
    assert watch.factors > 0 and watch.solves > 0 and watch.factors + watch.solves <= watch.seconds
    watch.reset()
    assert watch.factors == watch.solves == 0


def test_shares_of_a_step_add_up(problem):
    cost = stepper.stepped(problem, start(problem, Control()), 3)
    assert cost.seconds > 0 and cost.iterations >= 2
    assert 0 < cost.assembly < 1 and 0 <= cost.factors < 1 and 0 < cost.solves < 1
    assert_allclose(cost.assembly + cost.factors + cost.solves, 1, rtol=1e-12)  # roundings of the sum


def test_a_state_is_carried_to_another_mesh_and_stepped_to_large_steps(problem):
    other = stepper.problem_of(120, "diamond")
    state = stepper.carried(problem, State(0.0, 0, 1e-4, problem.initial), other)
    assert state.dt >= stepper.DT and state.q.shape == other.initial.shape
    # A linear interpolation on some ten cells across, then 2 ms of flow: the same flow, to some per cent.
    assert abs(state.q - other.initial)[:, :2].max() < 0.2 * abs(other.initial[:, :2]).max()


def test_every_call_that_is_timed_runs_and_solves(problem):
    calls, errors = stepper.solvers(problem)
    assert {stepper.DEFAULT, stepper.DIRECT} < set(calls) and max(errors.values()) < 1e-12
    solutions = [calls[stepper.SOLVE[name]]() for name in ("default", "direct")]
    assert_allclose(*solutions, rtol=0, atol=1e-9 * abs(solutions[0]).max())  # backward errors times the condition
    for call in (calls | stepper.assembling(problem, problem.initial)).values():
        assert call() is not None
