"""The discrete balances: exact Jacobian, exact telescoping, second-order consistency."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from stability.model import Model
from stability.timestepper.constraints import NONE
from stability.timestepper.hopper import hopper_problem
from stability.timestepper.law import Law
from stability.timestepper.mesh import KINDS, Mesh, mesh_of_cells, periodic_square, points
from stability.timestepper.problem import FACE_WEIGHT, Background, Problem
from tests.conftest import HOPPER
from tests.timestepper.manufactured import orders

PERTURBED = HOPPER | {"epsilon": 1e-3}


def problem_of(closure: str, kind: str = "polar", half: bool = True, elements: int = 24, **options) -> Problem:
    parameters = PERTURBED if closure == "perturbed" else HOPPER
    return hopper_problem(
        closure, "radial_hopper", parameters, {"elements": elements, "kind": kind, "half": half}, **options
    )


def disturbed(problem: Problem, size: float = 0.3, seed: int = 0) -> np.ndarray:
    """Return the initial state with noise on all fields."""
    noise = np.random.default_rng(seed).uniform(-1, 1, problem.initial.shape)
    return problem.initial + size * noise * problem.scales


def by_complex_step(problem: Problem, q: np.ndarray, coefficient: float) -> np.ndarray:
    """Return the Jacobian of the equations, column by column."""
    h = 1e-30  # no difference is formed, so that nothing is lost by a tiny step
    columns = []
    for k in range(q.size):
        moved = q.astype(complex)
        moved.flat[k] += 1j * h
        columns.append(problem.equations(moved, coefficient * (moved - problem.initial), 0.0).imag.ravel() / h)
    return np.array(columns).T


def largest_miss(found: np.ndarray, expected: np.ndarray) -> float:
    """Return the largest difference of two matrices, relative to the entry or to a thousandth of its row's largest."""
    size = np.maximum(abs(expected), 1e-3 * abs(expected).max(axis=1, keepdims=True))
    return float((abs(found - expected) / size).max())


@pytest.mark.parametrize("closure", ["perturbed", "rigid_plastic"])
@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("half", [True, False], ids=["half", "full"])
def test_the_jacobian_is_the_derivative_of_the_equations(closure, kind, half):
    for floor, coefficient in ((4.0, 0.0), (0.0, 2e3)):
        problem = problem_of(closure, kind, half, floor=floor)
        q = disturbed(problem)
        assert problem.wall_friction > 0
        norm = problem.law.strain_rate_norm(problem.at_faces(q)[1])
        assert floor == 0 or 0.05 < np.mean(norm < floor) < 0.95, "faces lie below the floor, and above it"
        miss = largest_miss(problem.matrix(q, coefficient).toarray(), by_complex_step(problem, q, coefficient))
        # Roundings: 1e-15 of the largest entry of a row, thus up to 1e-12 of a thousandth of that. Measured 5e-13.
        assert miss < 1e-12


@pytest.mark.parametrize("closure", ["deviatoric", "viscous", "mu_i"])
def test_the_jacobian_of_other_closures_is_exact_too(closure):
    law = {"deviatoric": {"epsilon": 1e-3}, "viscous": {"kinematic_viscosity": 0.1}}.get(closure, {})
    law |= {"grain_diameter": 1e-3, "solid_fraction": 0.6, "static_friction": 0.34, "dynamic_friction": 0.56}
    law |= {"reference_inertial_number": 0.07, "friction_angle": 0.6}
    problem = problem_of("rigid_plastic")
    problem = replace(problem, law=Law(closure, law, (-9.81, 0.0), floor=2.0), constraints=NONE)
    q = disturbed(problem, 0.05)
    q[:, 2] += 1.0  # mu(I) needs a positive pressure
    assert largest_miss(problem.matrix(q).toarray(), by_complex_step(problem, q, 0.0)) < 1e-12  # as above


def test_the_jacobian_about_a_background_is_exact():
    background = Background(np.array([(1.0, 0.2), (0.0, -0.9)]), 2.0)
    mesh = periodic_square(1.0, 3)
    law = Law("perturbed", {"friction_angle": 0.6, "epsilon": 1e-2}, floor=0.05)
    q = 0.1 * np.random.default_rng(1).normal(size=(9, 3))
    problem = Problem(mesh, law, q, background=background)
    assert largest_miss(problem.matrix(q, 30.0).toarray(), by_complex_step(problem, q, 30.0)) < 1e-12  # as above


def test_the_matrix_couples_nodes_of_one_element_and_no_others():
    problem = problem_of("perturbed")
    q = disturbed(problem)
    derivative = by_complex_step(problem, q, 1.0)
    matrix = problem.matrix(q, 1.0)
    held = np.zeros(matrix.shape, dtype=bool)
    held[matrix.tocoo().coords] = True  # stored, also where the number is zero
    assert not derivative[~held].any()
    blocks = sum(len(np.unique(problem.mesh.elements[(problem.mesh.elements == i).any(axis=1)])) for i in range(len(q)))
    assert matrix.nnz == 9 * blocks


@pytest.mark.parametrize("kind", KINDS)
def test_volumes_fill_the_wedge_and_mass_is_theirs(kind):
    problem = problem_of("perturbed", kind, elements=200)
    angle = np.deg2rad(HOPPER["wedge_angle"])
    chord = angle / problem.mesh.grid.shape[1] ** 2  # a polygon lies inside its arc: h^2 times an angle
    assert_allclose(problem.volume.sum(), angle * (1.5**2 - 0.5**2) / 2, rtol=chord)
    assert_array_equal(problem.mass[:, :2], np.repeat(problem.volume[:, None], 2, axis=1))
    assert_array_equal(problem.mass[:, 2], 0)


@pytest.mark.parametrize("kind, half", [(k, h) for k in KINDS for h in (True, False)])
def test_fluxes_between_control_volumes_cancel_in_the_sum(kind, half):
    # What is left is gravity, advection and the friction of the walls: none of them is a difference of fluxes.
    problem = problem_of("perturbed", kind, half)
    q = disturbed(problem)
    at_parts = problem._at_parts(problem._corner(q))
    supplied = [(value * problem.volumes.volume).sum() for value in problem.law.supply(*at_parts).values()]
    left = problem.balance(q).sum(axis=0) + supplied
    size = abs(problem.balance(q)).sum(axis=0)
    friction = replace(problem, wall_friction=0.0).balance(q).sum(axis=0) - problem.balance(q).sum(axis=0)
    assert_allclose(left + friction, 0, atol=1e-14 * size.max())  # roundings of a sum over all cells
    assert abs(friction[:2]).max() > 1e-3 * size.max() and friction[2] == 0


def test_gravity_pulls_on_every_control_volume_alike():
    problem = problem_of("perturbed")
    still = replace(problem, law=replace(problem.law, body_force=(0.0, 0.0)))
    q = disturbed(problem)
    weight = problem.balance(q) - still.balance(q)
    # A difference of balances: roundings of those.
    assert_allclose(weight, problem.volume[:, None] * [9.81, 0, 0], atol=1e-14 * abs(still.balance(q)).max())


def test_a_source_acts_per_unit_of_volume():
    problem = problem_of("perturbed")
    driven = replace(problem, source=lambda time: np.array([time, 2 * time, -time]))
    q = disturbed(problem)
    added = problem.balance(q, 3.0) - driven.balance(q, 3.0)
    # A difference of balances: roundings of those.
    assert_allclose(added, problem.volume[:, None] * [3, 6, -3], atol=1e-14 * abs(problem.balance(q)).max())


UNIFORM = np.array([(-1.0, 0.3), (0.1, 0.8)])  # d u_i/d x_j


def uniform(problem: Problem, pressure: float = 2.0) -> np.ndarray:
    """Return a state of uniform strain and pressure."""
    return np.column_stack([problem.mesh.nodes @ UNIFORM.T, np.full(len(problem.mesh.nodes), pressure)])


@pytest.mark.parametrize("kind, half", [(k, h) for k in KINDS for h in (True, False)])
def test_friction_is_tan_phi_w_times_the_normal_stress_along_the_wall_against_the_flow(kind, half):
    problem = problem_of("perturbed", kind, half, floor=0.0)
    q, angle = uniform(problem), np.deg2rad(HOPPER["wedge_angle"])
    traction = (problem.balance(q) - replace(problem, wall_friction=0.0).balance(q)).sum(axis=0)
    V = (UNIFORM + UNIFORM.T) / 2
    expected = np.zeros(3)
    for side in (1,) if half else (1, -1):
        normal = np.array([-np.sin(angle), side * np.cos(angle)])
        apex = -np.array([np.cos(angle), side * np.sin(angle)])
        k = np.sqrt(2) * np.sin(np.deg2rad(HOPPER["friction_angle"]))  # (I2)
        pressing = 2.0 * (1 - k * normal @ V @ normal / np.linalg.norm(V))  # (I5), over density
        # The outflow of momentum points to the apex: what slides there is held back (I6). The wall is 1 m long.
        expected[:2] += np.tan(np.deg2rad(HOPPER["wall_friction_angle"])) * pressing * apex
    assert_allclose(traction, expected, rtol=1e-12, atol=1e-13)  # a uniform stress is exact on any mesh: roundings
    assert traction[:2] @ [-1.0, 0] > 0


def test_uniform_stress_leaves_no_force_inside():
    problem = problem_of("perturbed", "diamond", half=False, floor=0.0)
    still = replace(problem, law=replace(problem.law, body_force=(0.0, 0.0)))
    q = uniform(problem)
    inside = np.setdiff1d(np.arange(len(q)), problem.constraints.node)
    advection = q[inside, :2] @ UNIFORM.T
    balance = still.balance(q)[inside] / still.volume[inside, None]
    # Linear fields are exact: grad u at each node, div u in the mass row. Roundings of forces of 2 m2/s2 over 0.1 m.
    assert_allclose(balance, np.column_stack([advection, np.full(len(inside), np.trace(UNIFORM))]), atol=1e-12)


def test_velocity_gradients_of_a_linear_field_are_exact():
    problem = problem_of("perturbed", "diamond")
    found = problem.velocity_gradient(uniform(problem))
    assert_allclose(found, np.broadcast_to(UNIFORM, found.shape), atol=1e-13)  # roundings over a size of 0.05 m


def test_a_background_is_added_to_the_unknowns_and_their_gradients():
    mesh, background = periodic_square(1.0, 4), Background(UNIFORM, 3.0)
    problem = Problem(
        mesh, Law("perturbed", {"friction_angle": 0.6, "epsilon": 0.1}), np.zeros((16, 3)), background=background
    )
    q, g = problem.at_faces(problem.initial)
    assert_array_equal(q[2], 3.0)
    assert_array_equal(q[:2], 0.0)
    assert_array_equal(g[:, :2], np.broadcast_to(UNIFORM.T[:, :, None, None], g[:, :2].shape))  # g[b][c] = d q_c/d x_b
    assert_array_equal(g[:, 2], 0.0)
    assert_allclose(problem.velocity_gradient(problem.initial), np.tile(UNIFORM, (16, 1, 1)), rtol=1e-15)  # exact


def wedge(n: int) -> Mesh:
    """Return a full wedge mesh, 2 n elements along and 2 n across, with nodes on the axis."""
    return mesh_of_cells(points(np.linspace(0.5, 1.5, 2 * n + 1), np.linspace(0, np.deg2rad(15), n + 1), False), False)


RADII = (0.75, 1.0, 1.25)
LEVELS = (4, 8, 16, 32)
FLOWS_AND_CLOSURES = [
    ("radial_hopper", "perturbed"),
    ("radial_hopper", "rigid_plastic"),
    ("radial_hopper_compatible", "perturbed"),
]


def imbalances(flow: str, closure: str, parameters: dict, n: int, face_weight: float) -> np.ndarray:
    """Return balance over volume (radii, 3) of a radial flow at some nodes on the axis."""
    problem = replace(hopper_problem(closure, flow, parameters, wedge(n), floor=0.0), face_weight=face_weight)
    balance = problem.balance(problem.initial) / problem.volume[:, None]
    x, y = problem.mesh.nodes.T
    on_axis = [np.flatnonzero((abs(x - r) < 1e-12) & (y == 0)) for r in RADII]  # roundings of the radii
    return balance[np.concatenate(on_axis)]


def exact_imbalances(flow: str, closure: str, parameters: dict) -> np.ndarray:
    """Return div F - S on the axis (radii, 3), from the jet of the flow by SymPy's derivatives."""
    model = Model(closure, flow)
    return np.array([model.base(parameters, {"r": r, "theta": 0.0}).imbalance() for r in RADII], dtype=float)


@pytest.mark.parametrize("face_weight", [FACE_WEIGHT, 1.0])
@pytest.mark.parametrize("flow, closure", FLOWS_AND_CLOSURES)
def test_the_residual_on_the_axis_tends_to_the_exact_one_at_second_order(flow, closure, face_weight):
    parameters = HOPPER | {"epsilon": 1e-4} if closure == "perturbed" else HOPPER
    exact = exact_imbalances(flow, closure, parameters)
    # The appendix solves the momentum balance on the axis, and (I7.1), but leaves epsilon Lap p0 in (P1.1); to that end
    # the compatible flow moves the velocity by epsilon grad p0, which costs momentum of that order. Roundings of g.
    zero = {"radial_hopper": (0, 1), "radial_hopper_compatible": (1, 2)}[flow] + (2,) * (closure == "rigid_plastic")
    assert_allclose(exact[:, zero], 0, atol=1e-12)
    assert closure == "rigid_plastic" or abs(exact).max() > 1e-3
    errors = [abs(imbalances(flow, closure, parameters, n, face_weight) - exact).max(axis=0) for n in LEVELS]
    found = orders([1 / n for n in LEVELS], np.array(errors)[:, [0, 2]])
    assert (abs(found - 2) < 0.1).all(), found  # asymptotic from the first level on
    assert max(e[1] for e in errors) < 1e-10  # across the axis: mirror images cancel, up to rounding
    assert errors[-1][0] < 5e-3 and errors[-1][2] < 5e-3  # of 9.81 m/s2 and of some 4 1/s: four of 64 cells a metre
