"""The wedge hopper: its initial state, its boundary conditions, its symmetry, and where waves grow."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from scipy.sparse.linalg import LinearOperator, eigs

from stability.errors import SceneError
from stability.model import Model
from stability.timestepper.constraints import boundary_nodes
from stability.timestepper.hopper import hopper_problem, radial_state
from stability.timestepper.integrate import Control, State, start, steps
from stability.timestepper.linear import solver_named
from stability.timestepper.mesh import KINDS, Mesh, mesh_of_cells, points
from stability.timestepper.problem import Problem
from tests.conftest import HOPPER

PERTURBED = HOPPER | {"epsilon": 1e-3}


def problem_of(
    kind: str = "polar", half: bool = True, elements: int = 100, closure: str = "perturbed", **more
) -> Problem:
    parameters = (HOPPER if closure == "rigid_plastic" else PERTURBED) | more
    return hopper_problem(closure, "radial_hopper", parameters, {"elements": elements, "kind": kind, "half": half})


def last(problem: Problem, end: float, control: Control) -> State:
    """Return the state at the end of a run."""
    run = steps(problem, start(problem, control), control, [end], solver_named("direct", problem))
    return list(run)[-1][0]


@pytest.mark.parametrize("kind, half", [(k, h) for k in KINDS for h in (True, False)])
def test_the_radial_state_flows_to_the_apex_and_carries_no_stress_on_arcs(kind, half):
    problem = problem_of(kind, half)
    u, v, p = problem.initial.T
    x, y = problem.mesh.nodes.T
    assert_allclose(x * v - y * u, 0, atol=1e-15)  # radial: roundings of speeds of a few m/s
    assert (x * u + y * v < 0).all()
    arcs = np.union1d(boundary_nodes(problem.mesh, "inlet"), boundary_nodes(problem.mesh, "outlet"))
    assert_allclose(p[arcs], 0, atol=1e-14)  # rounding of g r_0 = 5 m2/s2
    inside = np.setdiff1d(np.arange(len(p)), arcs)
    assert p[inside].min() > 0
    theta = np.arctan2(y, x)
    on_axis = abs(y) < 1e-15
    assert on_axis.any() and abs(theta).max() <= np.deg2rad(15) * (1 + 1e-15)
    # Speeds fall as 1/r along each ray (R9): exact up to rounding.
    assert_allclose(u[on_axis] * x[on_axis], u[on_axis][0] * x[on_axis][0], rtol=1e-14)


def test_the_radial_state_is_the_model_s():
    problem = problem_of(half=False)
    node = problem.mesh.grid[4, 1]
    r, theta = np.hypot(*problem.mesh.nodes[node]), np.arctan2(*problem.mesh.nodes[node][::-1])
    base = Model("perturbed", "radial_hopper").base(PERTURBED, {"r": r, "theta": np.rad2deg(theta)})
    ((speed, across), *_), (pressure, *_) = base.state
    found = radial_state("radial_hopper", problem.law.parameters, problem.mesh)[node]
    assert_allclose(found, [speed * np.cos(theta), speed * np.sin(theta), pressure], rtol=1e-13)  # roundings
    assert across == 0


def test_a_mesh_can_be_given_and_is_used_as_it_is():
    mesh = mesh_of_cells(points(np.linspace(0.5, 1.5, 6), np.linspace(0, np.deg2rad(15), 4), True), True)
    problem = hopper_problem("perturbed", "radial_hopper", PERTURBED, mesh, floor=0.2)
    assert problem.mesh is mesh and problem.law.floor == 0.2 and isinstance(mesh, Mesh)
    assert problem.law.body_force == (-9.81, 0.0)
    assert_allclose(problem.wall_friction, np.tan(np.deg2rad(9)), rtol=1e-15)  # rounding
    assert_allclose(problem.scales, [np.sqrt(9.81 / 2), np.sqrt(9.81 / 2), 9.81 / 2], rtol=1e-15)  # rounding


@pytest.mark.parametrize(
    "change, words",
    [
        ({"epsilon": None}, "epsilon is missing"),
        ({"inlet_radius": 0.4}, "outlet_radius must be less than inlet_radius"),
        ({"wall_friction_angle": 40}, "must not exceed friction_angle"),
        ({"gravity": -9.81}, "gravity = -9.81 m/s2 lies outside"),
    ],
)
def test_wrong_parameters_are_refused_in_words(change, words):
    parameters = {w: v for w, v in (PERTURBED | change).items() if v is not None}
    with pytest.raises(SceneError, match=words):
        hopper_problem("perturbed", "radial_hopper", parameters, {"elements": 50})


@pytest.mark.parametrize("kind, half", [(k, h) for k in KINDS for h in (True, False)])
def test_material_slides_along_walls_and_leaves_arcs_without_pressure(kind, half):
    problem = problem_of(kind, half)
    q = last(problem, 3e-3, Control(1e-4, 1e-3)).q
    assert abs(q - problem.initial).max() > 0.1, "it has moved"
    x, y = problem.mesh.nodes.T
    for name in ("wall", "axis") if half else ("wall",):
        on = boundary_nodes(problem.mesh, name)
        assert_allclose(x[on] * q[on, 1] - y[on] * q[on, 0], 0, atol=1e-14)  # a linear row: roundings of a few m/s
    for name in ("inlet", "outlet"):
        assert_allclose(q[boundary_nodes(problem.mesh, name), 2], 0, atol=1e-14)  # as above, of 5 m2/s2


def node_at(mesh: Mesh, places: np.ndarray) -> np.ndarray:
    """Return the nodes at some places."""
    table = {(round(x, 10), round(y, 10) + 0.0): i for i, (x, y) in enumerate(mesh.nodes)}
    return np.array([table[round(x, 10), round(y, 10) + 0.0] for x, y in places])


@pytest.mark.parametrize("kind", KINDS)
def test_the_whole_wedge_stays_mirror_symmetric(kind):
    problem = problem_of(kind, half=False, elements=200)
    mirror = node_at(problem.mesh, problem.mesh.nodes * [1, -1])
    assert_array_equal(problem.mesh.nodes[mirror], problem.mesh.nodes * [1, -1])
    q = last(problem, 1e-2, Control(1e-4, 1e-3)).q
    # The order of elimination is not symmetric, so that roundings are not: 2e-14 measured after 16 steps with fields of
    # order five. The elimination may lose a digit and each step's growth is below 1.1: 50 roundings of five.
    assert_allclose(q, q[mirror] * [1, -1, 1], atol=5e-14)
    assert abs(q[:, 1]).max() > 0.1


@pytest.mark.parametrize(
    "kind", ["polar", "graded"]
)  # "diamond" has triangles along the axis of the half, not the whole
def test_the_half_wedge_is_half_of_the_whole(kind):
    half, whole = problem_of(kind, True, 100), problem_of(kind, False, 200)
    same = node_at(whole.mesh, half.mesh.nodes)
    control = Control(1e-4, 1e-3, tolerance=1e-10)
    one, two = (last(problem, 1e-2, control) for problem in (half, whole))
    assert one.step == two.step > 10
    # Newton's tolerance, relative to sqrt(g r_0) and g r_0, in each of some sixteen steps.
    assert_allclose(one.q, two.q[same], atol=16 * 1e-10 * half.scales.max())
    assert np.unique(same).size == len(half.mesh.nodes) < len(whole.mesh.nodes)


def test_an_uneven_start_does_not_become_even():
    problem = problem_of("polar", half=False)
    mirror = node_at(problem.mesh, problem.mesh.nodes * [1, -1])
    kick = 1e-3 * np.random.default_rng(0).uniform(-1, 1, problem.initial.shape) * [1, 1, 0]
    q = last(replace(problem, initial=problem.initial + problem.constraints.free(kick)), 2e-3, Control(1e-4, 1e-3)).q
    assert abs(q - q[mirror] * [1, -1, 1]).max() > 1e-5


def test_meshes_agree_the_better_the_finer_they_are():
    # No exact answer is known: successive meshes must agree better and better.
    found = []
    for n in (4, 8, 16):
        mesh = mesh_of_cells(
            points(np.linspace(0.5, 1.5, 3 * n + 1), np.linspace(0, np.deg2rad(15), n + 1), True), True
        )
        problem = hopper_problem("perturbed", "radial_hopper", PERTURBED | {"epsilon": 1e-2}, mesh)
        coarse = mesh.grid[:: n // 4 * 3, :: n // 4]
        found.append(last(problem, 1e-2, Control(1e-3, 1e-3)).q[coarse])
    first, second = (abs(b - a).mean(axis=(0, 1)) for a, b in zip(found, found[1:], strict=False))
    # Arcs and the inlet's corner are less smooth than the inside: measured 2.2, 1.9 and 4.7 times better.
    assert (second < first / 1.6).all(), (first, second)


def leading_growth(problem: Problem, shift: float) -> float:
    """Return the largest growth rate (1/s) of disturbances of the initial state, of the twelve nearest to a shift."""
    solve = solver_named("direct", problem)(problem.matrix(problem.initial, shift))

    def inverse(w: np.ndarray) -> np.ndarray:
        return solve(problem.constraints.free(problem.mass * w.reshape(-1, 3)).ravel())

    size = problem.initial.size
    operator = LinearOperator((size, size), matvec=inverse, dtype=float)
    found = eigs(operator, k=12, v0=np.ones(size), return_eigenvectors=False)
    return float((shift - 1 / found).real.max())


def test_rigid_plastic_waves_grow_the_faster_the_finer_the_mesh():
    # The paper, before (P1): "grid-dependent due to the wedge of short wavelength instabilities". Growth is mu |xi|^2
    # times a number (Schaeffer), up to |xi| of order 1/h, where the mesh and its smoothing end it: twice the elements,
    # twice the growth. Measured 43, 116, 263 and, with 6400 elements, 575 1/s.
    growth = [leading_growth(problem_of(elements=n, closure="rigid_plastic"), s) for n, s in ((800, 60), (1600, 120))]
    assert growth[0] > 20 and growth[1] > 1.8 * growth[0], growth


@pytest.mark.slow
def test_waves_have_a_bounded_growth_with_epsilon_and_none_without():
    cells = ((800, 60), (1600, 120), (3200, 270))
    without = [leading_growth(problem_of(elements=n, closure="rigid_plastic"), s) for n, s in cells]
    bounded = [max(leading_growth(problem_of(elements=n, epsilon=2e-4), s) for s in (30, 100, 300)) for n, _ in cells]
    assert all(b > 1.8 * a for a, b in zip(without, without[1:], strict=False)), without
    # Measured 16.4, 17.9 and 17.5 1/s: resolved from 1,600 elements on, within what h^2 leaves.
    assert_allclose(bounded[1], bounded[2], rtol=0.05)


@pytest.mark.parametrize("kind", KINDS)
def test_rigid_plastic_flow_runs(kind):
    problem = problem_of(kind, elements=200, closure="rigid_plastic")
    control = Control(first=1e-3, largest=1e-3, smallest=5e-4)
    rows = [row for _, row in steps(problem, start(problem, control), control, [0.01], solver_named("direct", problem))]
    assert len(rows) >= 10 and rows[-1].time == 0.01
    assert max(row.mass_budget for row in rows) < 1e-14  # (I7.1), without epsilon: roundings


RHEOLOGIES = {
    "perturbed": {"epsilon": 1e-3},
    "deviatoric": {"epsilon": 1e-3},
    "rigid_plastic": {},
    "viscous": {"kinematic_viscosity": 0.05},
    "mu_i": {
        "static_friction": 0.38,
        "dynamic_friction": 0.64,
        "reference_inertial_number": 0.279,
        "grain_diameter": 1e-3,
        "solid_fraction": 0.6,
    },
}


@pytest.mark.parametrize("closure", RHEOLOGIES)
def test_closures_of_velocity_and_pressure_are_marched_by_name(closure):
    problem = hopper_problem(closure, "radial_hopper", HOPPER | RHEOLOGIES[closure], {"elements": 100})
    state = last(problem, 2e-3, Control(first=1e-5, largest=5e-4))
    assert np.all(np.isfinite(state.q)) and abs(state.q - problem.initial).max() > 1e-3


def test_the_jacobian_is_exact_where_mu_i_sees_the_least_pressure():
    problem = hopper_problem("mu_i", "radial_hopper", HOPPER | RHEOLOGIES["mu_i"], {"elements": 60}, floor=3.0)
    q = problem.initial + np.random.default_rng(0).normal(0, 0.3, problem.initial.shape)
    assert problem.law.bounds_pressure and (q[:, 2] < 0).any()
    direction = np.random.default_rng(1).normal(size=q.shape)
    found = problem.matrix(q, 3.0) @ direction.ravel()
    step = q + 1e-30j * direction
    exact = problem.equations(step, 3.0 * step, 0.0).imag.ravel() / 1e-30
    assert_allclose(found, exact, atol=1e-13 * abs(exact).max())  # roundings of some 100 terms a row
