"""Steps in time: they land, shrink, grow and start again as they say, to the last bit."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from stability.errors import ConvergenceError, SceneError
from stability.timestepper.constraints import Constraints
from stability.timestepper.hopper import hopper_problem
from stability.timestepper.integrate import EASY, GROWTH, SCHEMES, Control, State, differences, start, steps
from stability.timestepper.law import Law
from stability.timestepper.linear import direct, solver_named
from stability.timestepper.mesh import periodic_cell, periodic_square
from stability.timestepper.problem import Background, Problem
from tests.conftest import HOPPER

CONTROL = Control(first=1e-4, largest=1e-3)


@pytest.fixture(scope="module")
def problem():
    return hopper_problem("perturbed", "radial_hopper", HOPPER | {"epsilon": 1e-3}, {"elements": 60})


def run(problem, stops, control=CONTROL, state=None, factorise=None) -> list:
    """Return all (state, row)."""
    factorise = factorise or solver_named("direct", problem)
    return list(steps(problem, state or start(problem, control), control, stops, factorise))


def same(a: State, b: State) -> bool:
    """Return whether two states agree to the last bit."""
    fields = (np.array_equal(a.q, b.q), np.array_equal(np.asarray(a.before), np.asarray(b.before)))
    return all(fields) and (a.time, a.step, a.dt, a.dt_before) == (b.time, b.step, b.dt, b.dt_before)


@pytest.mark.parametrize("scheme", SCHEMES)
def test_two_runs_are_the_same_to_the_last_bit(problem, scheme):
    control = replace(CONTROL, scheme=scheme)
    one, two = (run(problem, [3e-3], control) for _ in range(2))
    assert len(one) == len(two) > 5
    assert all(same(a, b) for (a, _), (b, _) in zip(one, two, strict=True))


@pytest.mark.parametrize("scheme", SCHEMES)
def test_a_run_taken_up_from_a_state_is_the_same_to_the_last_bit(problem, scheme):
    control = replace(CONTROL, scheme=scheme)
    half, end = 1.5e-3, 3e-3
    first = run(problem, [half], control)[-1][0]
    whole = run(problem, [end], control, state=first)  # a fresh call here, as whoever resumes must make
    before = None if first.before is None else first.before.copy()
    kept = replace(first, q=first.q.copy(), before=before)
    again = run(problem, [end], control, state=kept)
    assert same(whole[-1][0], again[-1][0]) and whole[-1][0].time == end
    assert (scheme == "bdf2") == (first.before is not None)
    assert whole[-1][0].step > first.step > 2


def test_bdf2_needs_the_fields_before_to_go_on(problem):
    control = replace(CONTROL, scheme="bdf2")
    first = run(problem, [1.5e-3], control)[-1][0]
    with_past = run(problem, [3e-3], control, state=first)[-1][0]
    without = run(problem, [3e-3], control, state=replace(first, before=None))[-1][0]
    assert not np.array_equal(with_past.q, without.q)


@pytest.mark.parametrize("stops", [[1e-3], [1e-4, 1.7e-4, 2e-3], [1 / 3000, 2 / 3000]])
def test_steps_land_exactly_on_stops_without_slivers(problem, stops):
    found = run(problem, stops)
    times = [row.time for _, row in found]
    assert set(stops) <= set(times) and times[-1] == stops[-1]
    assert times == sorted(set(times))
    assert_allclose(np.cumsum([row.dt for _, row in found]), times, rtol=1e-13)  # roundings of a sum
    wished = [CONTROL.first] + [state.dt for state, _ in found[:-1]]
    for dt, (_, row) in zip(wished, found, strict=True):
        assert row.dt <= dt * (1 + 1e-11)  # what the count of equal steps forgives
    for (_, before), (_, after) in zip(found, found[1:], strict=False):
        assert after.time not in stops or before.time in stops or after.dt > 0.5 * before.dt, "no sliver before a stop"


def test_stops_that_are_past_are_passed_over(problem):
    state = run(problem, [1e-3])[-1][0]
    assert run(problem, [5e-4, 1e-3], state=state) == []


def test_easy_steps_grow_to_the_largest(problem):
    found = run(problem, [2e-2])
    assert all(row.newton_iterations <= EASY and row.rejected == 0 for _, row in found)
    wished = [CONTROL.first, *(state.dt for state, _ in found)]
    for before, after in zip(wished, wished[1:], strict=False):
        assert after == min(GROWTH * before, CONTROL.largest)
    assert wished[-1] == CONTROL.largest


class Failing:
    """A factorise whose factors are useless for the first ``times`` matrices."""

    def __init__(self, times: float, useless=lambda b: np.full(b.shape, np.nan)):
        self.left, self.useless, self.factorise = times, useless, direct()

    def __call__(self, matrix):
        self.left -= 1
        return self.useless if self.left >= 0 else self.factorise(matrix)


def test_a_step_that_fails_is_halved_and_the_run_recovers(problem):
    found = run(problem, [1e-3], factorise=Failing(3))
    (state, row), rest = found[0], found[1:]
    assert row.rejected == 3 and row.dt == CONTROL.first / 8
    assert state.dt == row.dt, "a step that was hard does not grow"
    assert all(r.rejected == 0 for _, r in rest) and found[-1][0].time == 1e-3
    assert rest[0][0].dt == GROWTH * row.dt
    calm = run(problem, [1e-3])[-1][0]
    assert_allclose(found[-1][0].q, calm.q, atol=0.05)  # steps of other sizes, first order: 1 % of a pressure of four


def test_a_run_that_cannot_go_on_says_where_and_hands_back_the_last_good_state(problem):
    good = run(problem, [1e-3])[-1][0]
    control = replace(CONTROL, smallest=2e-5)
    with pytest.raises(ConvergenceError) as caught:
        run(problem, [2e-3], control, state=good, factorise=Failing(np.inf, lambda b: 0.5 - b % 1))
    error = caught.value
    assert_array_equal(error.state.q, good.q)
    assert (error.state.time, error.state.step, error.state.dt) == (good.time, good.step, control.first)
    assert len(error.history) > 0 and np.isfinite(error.history).all()
    text = str(error)
    place, advice = "Worst cell: the one around x = ", ("Raise the floor", "smaller steps")
    began = f"fails at time 0.001 s, step {good.step + 1}: tried "
    for phrase in (began, "(no ", "the smallest step allowed is 2e-05 s", place, *advice):
        assert phrase in text, text
    x, y = (float(text.split(f"{axis} = ")[1].split(" m")[0]) for axis in "xy")
    assert 0.5 <= np.hypot(x, y) <= 1.5 + 1e-3  # four digits are printed


def test_a_singular_matrix_is_a_step_that_failed(problem):
    def singular(matrix):
        raise ConvergenceError("the matrix is singular: row 7 is empty")

    with pytest.raises(ConvergenceError) as caught:
        run(problem, [1e-3], replace(CONTROL, smallest=5e-5), factorise=singular)
    assert "tried 0.0001 s (the matrix is singular: row 7 is empty), 5e-05 s (" in str(caught.value)
    assert_array_equal(caught.value.state.q, problem.initial)


def test_the_second_difference_is_exact_for_parabolas_on_unequal_steps():
    a, b, c, old, dt = 0.3, -1.1, 0.7, 0.3, 0.5
    q = {t: np.full((2, 3), a + b * t + c * t**2) for t in (-old, 0.0, dt)}
    state = State(0.0, 2, dt, q[0.0], q[-old], old)
    coefficient, rate = differences(state, dt, "bdf2")
    assert_allclose(rate(q[dt]), b + 2 * c * dt, rtol=1e-13)  # exact for parabolas: roundings
    assert_allclose(coefficient, (rate(q[dt] + 1) - rate(q[dt]))[0, 0], rtol=1e-13)  # linear: roundings
    coefficient, rate = differences(state, dt, "backward_euler")
    assert_allclose(rate(q[dt]), b + c * dt, rtol=1e-13)  # the chord
    assert coefficient == 1 / dt
    assert differences(replace(state, before=None), dt, "bdf2")[0] == 1 / dt, "the first step is of backward Euler"


def test_a_step_much_longer_than_the_one_before_is_a_step_of_backward_euler():
    q, before = np.ones((2, 3)), np.zeros((2, 3))
    new = np.full((2, 3), 3.0)
    for ratio in (2.1, 2.3):  # on either side of LARGEST_RATIO
        _, rate = differences(State(0.0, 2, ratio, q, before, 1.0), ratio, "bdf2")
        assert (abs(rate(new) - 2.0 / ratio).max() < 1e-15) == (ratio > 2.2)  # the chord, up to roundings


@pytest.mark.parametrize(
    "wrong, words",
    [
        ({"scheme": "leapfrog"}, "scheme = 'leapfrog' is unknown: use one of backward_euler, bdf2"),
        ({"first": 1.0}, "0 < smallest <= first <= largest, got 1e-09, 1 and 0.0005 s"),
        ({"smallest": 0.0}, "0 < smallest"),
        ({"smallest": 1e-3}, "0 < smallest"),
        ({"largest": float("nan")}, "0 < smallest"),
        ({"first": -1e-5}, "0 < smallest"),
    ],
)
def test_control_refuses_nonsense(wrong, words):
    with pytest.raises(SceneError, match=words.replace(".", r"\.")):
        Control(**wrong)


STRAIN = np.array([(1.3, 0.4), (-0.2, -1.1)])
ONE_PRESSURE_HELD = Constraints(np.array([0]), np.eye(3)[None], np.array([[False, False, True]]))


@pytest.mark.parametrize("mesh", [periodic_cell(1.0, 6, (0.6, 0.8)), periodic_square(0.5, 4)], ids=["cell", "square"])
@pytest.mark.parametrize("scheme", SCHEMES)
def test_uniform_strain_in_a_periodic_cell_is_exact(mesh, scheme):
    law = Law("perturbed", {"friction_angle": 0.6, "epsilon": 1e-2}, floor=0.05)
    n, control = len(mesh.nodes), Control(1e-2, 1e-2, 1e-3, scheme)
    own = Problem(mesh, law, np.zeros((n, 3)), constraints=ONE_PRESSURE_HELD, background=Background(STRAIN, 2.0))
    for state, row in run(own, [5e-2], control):
        assert_allclose(state.q, 0, atol=1e-13)  # roundings of fluxes of 2 m2/s2 that cancel, times the step
        assert row.newton_iterations == 1
    # A uniform velocity is carried along: dw/dt = -grad u w, here in the same steps by hand.
    w = [np.array([0.3, -0.2])]
    moved = replace(own, initial=np.tile([*w[0], 0.0], (n, 1)))
    for k, (state, row) in enumerate(run(moved, [5e-2], replace(control, tolerance=1e-12))):
        if scheme == "backward_euler" or k == 0:
            w.append(np.linalg.solve(np.eye(2) / row.dt + STRAIN, w[-1] / row.dt))
        else:
            w.append(np.linalg.solve(1.5 * np.eye(2) / row.dt + STRAIN, (2 * w[-1] - w[-2] / 2) / row.dt))
        assert_allclose(state.q, np.tile([*w[-1], 0.0], (n, 1)), atol=1e-12)  # Newton's tolerance
    assert abs(w[-1] - w[0]).max() > 0.01


@pytest.mark.parametrize("scheme", SCHEMES)
@pytest.mark.parametrize("kind", ["polar", "diamond"])
def test_a_base_state_held_by_a_source_stays_where_it_is(kind, scheme):
    own = hopper_problem("perturbed", "radial_hopper", HOPPER | {"epsilon": 1e-3}, {"elements": 60, "kind": kind})
    unforced = own.balance(own.initial) / own.volume[:, None]
    held = replace(own, source=lambda time: unforced)
    # The arcs' pressure is zero up to a rounding of g r_0 = 5 m2/s2, the walls' velocity along them likewise.
    for state, _ in run(held, [1e-2], replace(CONTROL, scheme=scheme)):
        assert_allclose(state.q, own.initial, atol=1e-11)
    assert abs(run(own, [1e-2])[-1][0].q - own.initial).max() > 0.1, "without the source it moves"
