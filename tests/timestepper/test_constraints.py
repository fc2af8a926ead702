"""Replaced rows: sliding along walls, no stress on arcs, held fields, and the reactions that are left out."""

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from stability.timestepper.constraints import NONE, boundary_nodes, held_at, hopper
from stability.timestepper.mesh import KINDS, hopper_mesh
from stability.timestepper.pattern import Pattern

ANGLE = 0.4
CASES = [(kind, half) for kind in KINDS for half in (True, False)]


def mesh_of(kind: str, half: bool):
    return hopper_mesh(0.5, 1.5, ANGLE, 40, kind, half)


def fields(mesh, seed: int = 0) -> np.ndarray:
    return np.random.default_rng(seed).normal(size=(len(mesh.nodes), 3))


@pytest.mark.parametrize("kind, half", CASES)
def test_boundary_nodes_are_those_that_lie_on_it(kind, half):
    mesh = mesh_of(kind, half)
    r, theta = np.hypot(*mesh.nodes.T), np.arctan2(*mesh.nodes.T[::-1])
    near = 1e-12  # roundings of a radius or an angle of order one
    places = {"outlet": abs(r - 0.5) < near, "inlet": abs(r - 1.5) < near, "wall": abs(abs(theta) - ANGLE) < near}
    if half:
        places["axis"] = abs(theta) < near
    assert places.keys() == mesh.boundaries.keys()
    for name, on in places.items():
        assert_array_equal(boundary_nodes(mesh, name), np.flatnonzero(on))


@pytest.mark.parametrize("kind, half", CASES)
def test_what_satisfies_the_constraints_slides_along_walls_and_has_no_pressure_on_arcs(kind, half):
    mesh = mesh_of(kind, half)
    c = hopper(mesh)
    assert_allclose(c.turn @ c.turn.transpose(0, 2, 1), np.tile(np.eye(3), (len(c.node), 1, 1)), atol=1e-15)  # rounding
    q = fields(mesh)
    turned = np.where(c.held, 0, np.einsum("kij,kj->ki", c.turn, q[c.node]))
    q[c.node] = np.einsum("kji,kj->ki", c.turn, turned)
    walls = np.unique(np.concatenate([boundary_nodes(mesh, n) for n in ("wall", "axis") if n in mesh.boundaries]))
    arcs = np.union1d(boundary_nodes(mesh, "outlet"), boundary_nodes(mesh, "inlet"))
    x, y = mesh.nodes[walls].T
    assert_allclose(x * q[walls, 1] - y * q[walls, 0], 0, atol=1e-15)  # roundings of numbers of order one
    assert (abs(q[walls, :2]).max(axis=1) > 0).all(), "along the wall it moves freely"
    assert_array_equal(q[arcs, 2], 0)
    assert c.held.sum() == len(walls) + len(arcs)
    assert_allclose(c.rows(0 * q, q, 0.0), 0, atol=1e-15)  # as above


def test_rows_without_a_constraint_are_the_balances():
    mesh = mesh_of("polar", True)
    balance, q = fields(mesh, 1), fields(mesh, 2)
    assert_array_equal(NONE.rows(balance, q, 0.0), balance)
    assert_array_equal(NONE.free(balance), balance)
    c = hopper(mesh)
    inside = np.setdiff1d(np.arange(len(q)), c.node)
    assert_array_equal(c.rows(balance, q, 0.0)[inside], balance[inside])
    assert_array_equal(c.free(balance)[inside], balance[inside])


def test_at_a_wall_the_momentum_along_it_is_balanced_and_the_one_across_is_not():
    mesh = mesh_of("polar", True)
    c = hopper(mesh)
    balance = fields(mesh)
    rows, free = c.rows(balance, 0 * balance, 0.0), c.free(balance)
    wall = np.setdiff1d(boundary_nodes(mesh, "wall"), [*boundary_nodes(mesh, "inlet"), *boundary_nodes(mesh, "outlet")])
    along = balance[wall, 0] * np.cos(ANGLE) + balance[wall, 1] * np.sin(ANGLE)
    assert_allclose(rows[wall], np.stack([along, 0 * along, balance[wall, 2]], axis=1), atol=1e-15)  # roundings
    assert_array_equal(free[wall], rows[wall])  # a velocity of zero satisfies what is held


def test_a_steep_wall_replaces_the_other_row():
    mesh = hopper_mesh(0.5, 1.5, 1.2, 40)  # nearer to the y axis: its normal is nearest to x
    c = hopper(mesh)
    wall = np.isin(c.node, boundary_nodes(mesh, "wall"))
    axis = np.isin(c.node, boundary_nodes(mesh, "axis"))
    assert c.held[wall, 0].all() and not c.held[wall, 1].any()
    assert c.held[axis, 1].all() and not c.held[axis, 0].any()
    diagonal = np.einsum("kii->ki", c.turn)
    assert (abs(diagonal) >= np.sqrt(0.5) - 1e-15).all(), "the diagonal stays large whatever the angle"


def test_held_nodes_have_the_values_of_the_time():
    node = np.array([1, 4])
    c = held_at(node, lambda time: np.full((2, 3), time))
    q, balance = np.full((6, 3), 7.0), np.full((6, 3), -1.0)
    rows = c.rows(balance, q, 2.0)
    assert_array_equal(rows[node], 5.0)
    assert_array_equal(rows[[0, 2, 3, 5]], -1.0)
    assert_array_equal(c.free(balance)[node], 0.0)


@pytest.mark.parametrize("kind, half", CASES)
def test_constrained_blocks_are_the_derivative_of_constrained_rows(kind, half):
    mesh = mesh_of(kind, half)
    n = len(mesh.nodes)
    pattern, c = Pattern(mesh.elements, n, 3), hopper(mesh)
    blocks = np.random.default_rng(4).normal(size=(3, 3, len(pattern.row)))
    matrix = pattern.matrix(blocks)
    q = fields(mesh)
    rows = c.rows((matrix @ q.ravel()).reshape(n, 3), q, 0.0)
    constrained = pattern.matrix(c.blocks(blocks.copy(), pattern))
    assert_allclose(constrained @ q.ravel(), rows.ravel(), rtol=1e-12, atol=1e-13)  # sums of some thirty terms
    assert abs(matrix @ q.ravel() - rows.ravel()).max() > 1, "the constraints have changed the rows"
