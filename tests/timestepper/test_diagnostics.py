"""What a run says about itself: counts on states made for them, and balances checked from outside."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from stability.timestepper.constraints import boundary_nodes
from stability.timestepper.diagnostics import backward, budgets, counts
from stability.timestepper.hopper import hopper_problem
from stability.timestepper.integrate import SCHEMES, Control, differences, start, steps
from stability.timestepper.law import Law
from stability.timestepper.linear import solver_named
from stability.timestepper.mesh import periodic_square
from stability.timestepper.problem import Background, Problem
from stability.timestepper.volumes import edges
from tests.conftest import HOPPER

TOLERANCE = 1e-10
K = np.sqrt(2) * np.sin(np.deg2rad(HOPPER["friction_angle"]))  # (I2)


def problem_of(kind: str = "polar", half: bool = True, elements: int = 80) -> Problem:
    mesh = {"elements": elements, "kind": kind, "half": half}
    return hopper_problem("perturbed", "radial_hopper", HOPPER | {"epsilon": 1e-3}, mesh)


def test_the_base_state_is_within_the_range_of_the_closure():
    problem = problem_of()
    assert set(counts(problem, problem.initial).values()) == {0}


def test_cells_below_the_floor_are_counted():
    problem = problem_of()
    q = problem.initial.copy()
    node = problem.mesh.grid[3, 2]
    around = (problem.mesh.elements == node).any(axis=1)
    q[np.unique(problem.mesh.elements[around])] = [-1.0, 0.0, 1.0]  # a rigid patch
    assert counts(problem, q)["cells_below_floor"] == around.sum() == 4
    q[:] = [-1.0, 0.0, 1.0]
    assert counts(problem, q)["cells_below_floor"] == len(problem.mesh.elements)
    assert counts(replace(problem, law=replace(problem.law, floor=0.0)), q)["cells_below_floor"] == 0


def test_nodes_without_pressure_are_counted_where_none_is_held():
    problem = problem_of()
    q = problem.initial.copy()
    q[problem.mesh.grid[3, :2], 2] = -1.0, 0.0
    assert counts(problem, q)["nodes_without_pressure"] == 2
    q[:, 2] = -1.0
    arcs = problem.mesh.grid[[0, -1]].size
    assert counts(problem, q)["nodes_without_pressure"] == len(q) - arcs


def test_a_background_has_a_share_in_the_pressure():
    law = Law("perturbed", {"friction_angle": 0.6, "epsilon": 0.1}, floor=0.5)
    cell = Problem(periodic_square(1.0, 3), law, np.zeros((9, 3)), background=Background(np.diag([1.0, -1]), 2.0))
    q = np.zeros((9, 3))
    q[[1, 5], 2] = -1.0, -2.0
    assert counts(cell, q) == {"cells_below_floor": 0, "nodes_without_pressure": 1, "backward_wall_nodes": 0}


@pytest.mark.parametrize("half", [True, False])
def test_backward_sliding_is_counted_at_walls_alone(half):
    problem = problem_of(half=half)
    q = problem.initial.copy()
    wall = boundary_nodes(problem.mesh, "wall")
    assert not backward(problem, q).any()
    q[wall[3]] *= -1
    assert counts(problem, q)["backward_wall_nodes"] == 1
    assert_array_equal(wall[backward(problem, q)], [wall[3]])
    q = -problem.initial
    assert counts(problem, q)["backward_wall_nodes"] == len(wall)
    assert backward(replace(problem, wall_friction=0.0), q).size == 0


def test_budgets_measure_what_a_balance_misses():
    problem = problem_of()
    q, rate = problem.initial, np.zeros_like(problem.initial)
    size = np.sqrt(problem.volume.sum())
    speed, _, pressure = problem.scales
    node = problem.mesh.grid[4, 3]
    for row, unit in ((0, pressure * size), (2, speed * size)):
        source = problem.balance(q) / problem.volume[:, None]  # nothing is missed ...
        held = replace(problem, source=lambda time, s=source: s)
        assert_allclose(budgets(held, q, rate, 0.0), 0, atol=1e-14)  # roundings
        source[node, row] += 0.5 * unit / problem.volume[node]  # ... but for half the unit
        found = budgets(held, q, rate, 0.0)
        assert_allclose(found[0] if row == 2 else found[1], 0.5, rtol=1e-12)  # roundings, as above


@pytest.fixture(
    scope="module", params=[(k, h, s) for k in ("polar", "diamond") for h in (True, False) for s in SCHEMES]
)
def run(request) -> tuple:
    """Some steps of a run: problem, and (state before, state, row, rate) of each."""
    kind, half, scheme = request.param
    problem, control = problem_of(kind, half), Control(1e-4, 1e-3, scheme=scheme, tolerance=TOLERANCE)
    state, found = start(problem, control), []
    for after, row in steps(problem, state, control, [5e-3], solver_named("direct", problem)):
        _, rate = differences(state, row.dt, scheme)
        found.append((state, after, row, rate(after.q)))
        state = after
    assert len(found) > 6
    return problem, found


def size_of_momentum(problem: Problem) -> float:
    """Return the unit that a momentum budget is relative to."""
    return problem.scales[2] * np.sqrt(problem.volume.sum())


def test_each_step_reports_balances_that_close(run):
    problem, found = run
    for _, _, row, _ in found:
        assert row.mass_budget < 1e-14  # the mass row is linear: roundings
        # Newton's last update, divided by the step: inertia is the largest term of the balance.
        assert row.momentum_budget < TOLERANCE * np.sqrt(problem.volume.sum()) / problem.scales[0] / row.dt


def by_hand(problem: Problem, q: np.ndarray) -> np.ndarray:
    """Return the outflow of momentum by advection and friction less gravity, without the fluxes between volumes."""
    corner = q[problem.mesh.elements]  # (elements, 4, 3)
    gradient = np.moveaxis(problem.volumes.part.gradients(corner.T), 0, 1)[:2]  # (component, axis, corner, elements)
    still = np.isin(problem.mesh.elements.T, boundary_nodes(problem.mesh, "inlet"))  # nothing is advected in there
    advected = np.where(still, 0, np.einsum("cbse,sbe->cse", gradient, corner[..., :2].transpose(1, 2, 0)))
    total = (advected * problem.volumes.volume).sum(axis=(1, 2)) + [9.81 * problem.volume.sum(), 0]
    for half in edges(problem.mesh.corners, problem.mesh.boundaries["wall"]):
        own = corner[half.elements].T
        g = half.point.gradients(own)[:, :2, 0]
        V, normal = (g + g.transpose(1, 0, 2)) / 2, half.area / np.hypot(*half.area)
        norm = np.sqrt((V**2).sum(axis=(0, 1)))
        norm = np.where(norm > problem.law.floor, norm, (norm**2 / problem.law.floor + problem.law.floor) / 2)
        pressing = half.point.values(own)[2, 0] * (1 - K * np.einsum("ae,abe,be->e", normal, V, normal) / norm)
        apex = -half.position / np.hypot(*half.position)
        along = apex - normal * (apex * normal).sum(axis=0)
        along /= np.hypot(*along)
        total = total + problem.wall_friction * (pressing * np.hypot(*half.area) * along).sum(axis=1)
    return total


def replaced(problem: Problem, left: np.ndarray) -> np.ndarray:
    """Return the same in Cartesian components: the part of each replaced row along its own direction."""
    c, found = problem.constraints, np.zeros_like(left)
    turned = np.where(c.held, np.einsum("kij,kj->ki", c.turn, left[c.node]), 0)
    found[c.node] = np.einsum("kji,kj->ki", c.turn, turned)
    return found


def test_momentum_changes_by_gravity_friction_advection_and_the_reaction_of_the_walls(run):
    problem, found = run
    for _, state, row, rate in found:
        change = (problem.volume[:, None] * rate[:, :2]).sum(axis=0)
        left = problem.mass * rate + problem.balance(state.q, state.time)
        reaction = replaced(problem, left)[:, :2].sum(axis=0)
        miss = change + by_hand(problem, state.q) - reaction
        # As the reported budget: Newton's last update through inertia.
        limit = TOLERANCE * np.sqrt(problem.volume.sum()) / problem.scales[0] / row.dt * size_of_momentum(problem)
        assert_allclose(miss, 0, atol=10 * limit)
        assert abs(by_hand(problem, state.q)).max() > 1e-2 * size_of_momentum(problem)


def test_what_flows_in_through_the_inlet_flows_out_through_the_outlet(run):
    problem, found = run
    for _, state, _, _ in found:
        left = problem.balance(state.q, state.time)[:, 2]
        inflow = left[boundary_nodes(problem.mesh, "inlet")].sum()
        outflow = -left[boundary_nodes(problem.mesh, "outlet")].sum()
        assert_allclose(inflow, outflow, rtol=1e-12)  # the mass row is linear: roundings
    # The initial flow rate u r theta_w, times two on the whole wedge, which the first steps change little.
    middle = np.flatnonzero(abs(problem.mesh.nodes[:, 1]) < 1e-12)
    theta = np.deg2rad(HOPPER["wedge_angle"]) * (1 if "axis" in problem.mesh.boundaries else 2)
    scale = abs(problem.initial[middle, 0] * problem.mesh.nodes[middle, 0])[0] * theta
    assert 0.5 * scale < abs(outflow) < scale, "slower towards the walls than on the axis"


def test_walls_react_with_the_normal_stress(run):
    problem, found = run
    _, state, _, rate = found[-1]
    left = replaced(problem, problem.mass * rate + problem.balance(state.q, state.time))
    wall = boundary_nodes(problem.mesh, "wall")
    normal_force = np.hypot(*left[wall, :2].T).sum()
    own = 0.0
    for half in edges(problem.mesh.corners, problem.mesh.boundaries["wall"]):
        corner = state.q[problem.mesh.elements[half.elements]].T
        q, g = half.point.values(corner)[:, 0], half.point.gradients(corner)[:, :, 0]
        flux = problem.law.flux(q, g, half.area)
        own += (sum(flux[(i,)] * half.area[i] for i in (0, 1)) / np.hypot(*half.area)).sum()
    # The stress at the wall and the stress that the balance asks for there differ by the error of cells of 8 cm.
    assert_allclose(normal_force, own, rtol=0.1)
