"""Newton's method: quadratic with fresh factors, thrifty with old ones, and honest where it fails."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from stability.errors import ConvergenceError
from stability.timestepper import newton as module
from stability.timestepper.constraints import held_at
from stability.timestepper.hopper import hopper_problem
from stability.timestepper.linear import direct
from stability.timestepper.newton import FACTORISATIONS, Factors, newton
from tests.conftest import HOPPER

DT = 1e-3


@pytest.fixture(scope="module")
def problem():
    return hopper_problem("perturbed", "radial_hopper", HOPPER | {"epsilon": 1e-3}, {"elements": 100})


def solved(problem, factors: Factors, tolerance: float = 1e-10, start=None, dt: float = DT):
    q = problem.initial
    return newton(problem, q if start is None else start, lambda new: (new - q) / dt, 1 / dt, dt, tolerance, factors)


class Counting:
    """A factorise that counts what is asked of it."""

    def __init__(self):
        self.factorised, self.solved, self.factorise = 0, 0, direct()

    def __call__(self, matrix):
        self.factorised += 1
        solve = self.factorise(matrix)

        def counted(b):
            self.solved += 1
            return solve(b)

        return counted


def test_fresh_factors_converge_quadratically(problem, monkeypatch):
    monkeypatch.setattr(module, "CONTRACTION", 0.0)  # no contraction is good enough for old factors
    near = solved(problem, Factors(direct())).q
    kick = 1e-3 * np.random.default_rng(0).uniform(-1, 1, near.shape) * problem.scales
    found = solved(problem, Factors(direct()), tolerance=1e-13, start=near + problem.constraints.free(kick))
    assert found.converged and found.factorisations >= 3
    first, second, third = np.log(found.updates[:3])
    assert first > np.log(1e-4)
    assert (third - second) / (second - first) > 1.8  # measured 3.2; 2 where the quadratic term alone is left


def test_the_solution_solves_the_equations(problem):
    found = solved(problem, Factors(direct()), tolerance=1e-12)
    left = problem.equations(found.q, (found.q - problem.initial) / DT, DT)
    size = abs(problem.mass * problem.initial / DT).max()
    assert found.converged and found.reason == ""
    assert abs(left).max() < 1e-12 * size  # Newton's tolerance in the largest term of the balance
    assert abs(problem.equations(problem.initial, 0 * found.q, DT)).max() > 1e-6 * size, "there was something to solve"


def test_factors_are_kept_while_they_serve_and_give_the_same_answer(problem):
    thrifty, keen = Counting(), Counting()
    factors = Factors(thrifty)
    one = solved(problem, factors)
    kept = thrifty.factorised
    again = solved(problem, factors, start=one.q)
    assert again.converged and again.factorisations == 0 and thrifty.factorised == kept
    other = solved(problem, Factors(keen), start=one.q)
    assert other.factorisations == keen.factorised == 1
    assert_allclose(again.q, other.q, atol=1e-9 * problem.scales.max())  # ten times the tolerance


def test_factors_of_another_step_are_not_used(problem):
    counting = Counting()
    factors = Factors(counting)
    solved(problem, factors)
    before = counting.factorised
    assert solved(problem, factors, dt=DT / 2).converged
    assert counting.factorised > before and factors.coefficient == 2 / DT


def test_a_linear_problem_takes_one_factorisation(problem):
    node = np.arange(len(problem.initial))  # all rows are held, which are linear
    wanted = problem.initial + 0.1
    found = solved(replace(problem, constraints=held_at(node, lambda time: wanted)), Factors(direct()))
    assert found.converged and found.factorisations == 1
    assert_allclose(found.q, wanted, rtol=1e-14, atol=1e-14)  # identity rows: roundings


def test_numbers_that_overflow_end_in_a_sentence(problem):
    found = solved(problem, Factors(lambda matrix: lambda b: np.full(b.shape, np.nan)))
    assert not found.converged and found.reason == "the iteration left the range of numbers"
    assert np.isfinite(found.q).all()


def test_wrong_factors_end_in_a_sentence_after_a_bounded_effort(problem):
    factorise, calls = direct(), []

    def wrong(matrix):
        calls.append(matrix)
        solve = factorise(matrix)
        return lambda b: -3 * solve(b)

    found = solved(problem, Factors(wrong))
    assert not found.converged and found.reason.startswith("no ")
    assert 0 < len(calls) == found.factorisations <= FACTORISATIONS
    assert np.isfinite(found.updates).all() and np.isfinite(found.q).all()


def test_a_linear_system_without_a_solution_is_a_reason_and_not_the_end(problem):
    def singular(matrix):
        raise ConvergenceError("the matrix is singular: row 7 is empty")

    found = solved(problem, Factors(singular))
    assert not found.converged and found.reason == "the matrix is singular: row 7 is empty"
    assert_array_equal(found.q, problem.initial)


def test_an_update_is_limited_to_half_the_scales(problem):
    far = problem.initial + 100 * problem.scales * np.sin(np.arange(len(problem.initial)))[:, None]
    seen = []
    watched = replace(problem)
    object.__setattr__(
        watched, "equations", lambda q, rate, time: (seen.append(q), problem.equations(q, rate, time))[1]
    )
    solved(watched, Factors(direct()), start=far)
    assert len(seen) > 2
    assert abs((seen[1] - seen[0]) / problem.scales).max() <= 0.5 * (1 + 1e-12)  # a rounding
