from math import pi, radians

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from stability.errors import SceneError
from stability.timestepper.mesh import KINDS, Mesh, hopper_mesh, periodic_cell, periodic_square

WEDGE = radians(15)
OUTLET, INLET = 0.5, 1.5
HOPPER = (OUTLET, INLET, WEDGE)
ROUNDING = 1e-14


@pytest.fixture(params=[(kind, half) for kind in KINDS for half in (True, False)], ids=str)
def hopper(request) -> Mesh:
    kind, half = request.param
    return hopper_mesh(*HOPPER, 1000, kind, half)


def cross(a, b):
    return a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]


def sides(mesh: Mesh) -> np.ndarray:
    return np.roll(mesh.corners, -1, axis=1) - mesh.corners


def areas(mesh: Mesh) -> np.ndarray:
    return cross(mesh.corners[:, 2] - mesh.corners[:, 0], mesh.corners[:, 3] - mesh.corners[:, 1]) / 2


def ends(mesh: Mesh, name: str) -> np.ndarray:
    element, k = mesh.boundaries[name].T
    return mesh.nodes[np.stack([mesh.elements[element, k], mesh.elements[element, (k + 1) % 4]], axis=1)]


def half_edges(mesh: Mesh) -> np.ndarray:
    """Return all edges (first node, second node) in the direction of their element, without the collapsed ones."""
    edges = np.stack([mesh.elements, np.roll(mesh.elements, -1, axis=1)], axis=-1).reshape(-1, 2)
    return edges[edges[:, 0] != edges[:, 1]]


def test_areas_sum_to_the_polygon_between_the_arcs(hopper):
    n = len(hopper.boundaries["outlet"])
    angle = WEDGE * (1 if "axis" in hopper.boundaries else 2)
    assert_allclose(areas(hopper).sum(), n / 2 * np.sin(angle / n) * (INLET**2 - OUTLET**2), rtol=ROUNDING * 10)


def test_elements_are_convex_and_counter_clockwise(hopper):
    edges = sides(hopper)
    turns = cross(edges, np.roll(edges, -1, axis=1))  # four times the Jacobian's determinant at the corner between
    assert_array_equal(turns.min(axis=1) >= 0, True)
    assert np.sort(turns, axis=1)[:, 2:].min() > 0  # a triangle has two collapsed corners of four
    assert areas(hopper).min() > 0


def test_only_diamonds_have_triangles_and_only_along_the_boundary():
    for kind in KINDS:
        mesh = hopper_mesh(*HOPPER, 1000, kind)
        collapsed = np.flatnonzero(mesh.elements[:, 2] == mesh.elements[:, 3])
        along = np.sort(np.concatenate([b[:, 0] for b in mesh.boundaries.values()]))
        assert_array_equal(collapsed, along if kind == "diamond" else [])


@pytest.mark.parametrize("geometry", [HOPPER, (0.1, 0.3, WEDGE), (0.5, 0.6, 1.2), (0.01, 5.0, 0.3)], ids=str)
@pytest.mark.parametrize("half", [True, False])
@pytest.mark.parametrize("kind", KINDS)
def test_the_wanted_number_of_elements_is_met_within_five_per_cent(kind, half, geometry):
    for wanted in (500, 777, 1000, 4000):
        assert_allclose(len(hopper_mesh(*geometry, wanted, kind, half).elements), wanted, rtol=0.05)


def test_cells_are_squares_at_the_middle_radius_or_everywhere():
    for kind, half in ((k, h) for k in ("polar", "graded") for h in (True, False)):
        mesh = hopper_mesh(*HOPPER, 4000, kind, half)
        length = np.linalg.norm(sides(mesh), axis=-1).reshape(mesh.grid.shape[0] - 1, -1, 4)
        ratio = length[:, :, 0] / (length[:, :, 1] + length[:, :, 3]) * 2
        checked = ratio[len(ratio) // 2] if kind == "polar" else ratio
        assert_allclose(checked, 1, atol=0.1)  # the numbers along and across are whole


def test_diamonds_are_squares_turned_by_45_degrees():
    mesh = hopper_mesh(*HOPPER, 4000, "diamond")
    quads = mesh.elements[:, 2] != mesh.elements[:, 3]
    centre, edge = mesh.corners[quads].mean(axis=1), sides(mesh)[quads]
    length = np.linalg.norm(edge, axis=-1)
    assert_allclose(length / length.mean(axis=1, keepdims=True), 1, atol=0.05)
    cosine = abs(np.einsum("mki,mi->mk", edge, centre)) / length / np.linalg.norm(centre, axis=1)[:, None]
    assert_allclose(cosine, np.sqrt(0.5), atol=0.05)


def test_the_whole_wedge_mirrors_to_the_last_bit():
    for kind in KINDS:
        mesh = hopper_mesh(*HOPPER, 1000, kind, half=False)
        place = {tuple(node): i for i, node in enumerate(mesh.nodes)}
        image = np.array([place[x, -y] for x, y in mesh.nodes])
        # An element's mirror image has the same nodes the other way round.
        own = {frozenset(e) for e in mesh.elements.tolist()}
        assert own == {frozenset(e) for e in image[mesh.elements].tolist()}
        forward = {tuple(e) for e in half_edges(mesh).tolist()}
        assert forward == {tuple(e[::-1]) for e in image[half_edges(mesh)].tolist()}


def test_half_of_the_whole_polar_mesh_is_the_half_mesh():
    for kind in ("polar", "graded"):
        half, whole = hopper_mesh(*HOPPER, 500, kind), hopper_mesh(*HOPPER, 1000, kind, half=False)
        if half.grid.shape[1] * 2 - 1 == whole.grid.shape[1]:
            middle = whole.grid.shape[1] // 2
            assert_array_equal(whole.nodes[whole.grid[:, middle:]], half.nodes[half.grid])


def test_boundaries_are_whole_and_lie_where_their_names_say(hopper):
    half = "axis" in hopper.boundaries
    assert list(hopper.boundaries) == ["outlet", "inlet", "wall"] + ["axis"] * half
    for name, radius in (("outlet", OUTLET), ("inlet", INLET)):
        assert_allclose(np.linalg.norm(ends(hopper, name), axis=-1), radius, rtol=ROUNDING)
    angle = np.arctan2(ends(hopper, "wall")[..., 1], ends(hopper, "wall")[..., 0])
    assert_allclose(angle if half else abs(angle), WEDGE, rtol=ROUNDING)
    if half:
        assert_array_equal(ends(hopper, "axis")[..., 1], 0)
    length = np.linalg.norm(np.diff(ends(hopper, "wall"), axis=1), axis=-1).sum()
    assert_allclose(length, (INLET - OUTLET) * (1 if half else 2), rtol=ROUNDING * 10)


def test_the_domain_lies_to_the_left_of_its_boundary(hopper):
    for name, rows in hopper.boundaries.items():
        first, second = np.moveaxis(ends(hopper, name), 1, 0)
        inside = hopper.corners[rows[:, 0]].mean(axis=1)
        assert cross(second - first, inside - first).min() > 0


def test_interior_edges_are_shared_by_two_elements_and_the_others_have_a_name(hopper):
    edges = {tuple(e) for e in half_edges(hopper).tolist()}
    assert len(edges) == len(half_edges(hopper))  # none twice in one direction
    alone = {(a, b) for a, b in edges if (b, a) not in edges}
    rows = np.concatenate(list(hopper.boundaries.values()))
    named = np.stack([hopper.elements[rows[:, 0], rows[:, 1]], hopper.elements[rows[:, 0], (rows[:, 1] + 1) % 4]], 1)
    assert alone == {tuple(e) for e in named.tolist()}
    assert len(named) == len(alone)


def test_the_grid_holds_nodes_by_radius_and_angle(hopper):
    polar = hopper.nodes[hopper.grid]
    radius, angle = np.linalg.norm(polar, axis=-1), np.arctan2(polar[..., 1], polar[..., 0])
    assert_allclose(np.broadcast_to(radius[:, :1], radius.shape), radius, rtol=ROUNDING)
    assert_allclose(np.broadcast_to(angle[:1], angle.shape), angle, atol=ROUNDING)
    assert (np.diff(radius[:, 0]) > 0).all() and (np.diff(angle[0]) > 0).all()
    assert len(np.unique(hopper.grid)) == hopper.grid.size
    assert len(np.unique(hopper.elements)) == len(hopper.nodes)


def test_a_periodic_cell_is_a_ring_of_equal_cells_in_true_positions():
    direction = (0.6, 0.8)
    mesh = periodic_cell(2.0, 8, direction)
    assert_allclose(areas(mesh), 0.25**2, rtol=ROUNDING * 10)
    assert_array_equal(np.bincount(mesh.elements.ravel()), 4)  # the two sides of a node count twice
    assert mesh.boundaries == {} and mesh.grid is None
    shift = mesh.corners - mesh.nodes[mesh.elements]
    x, y = direction
    along, across = shift @ np.array([x, y]), shift @ np.array([-y, x])
    assert_allclose(along[:-1], 0, atol=ROUNDING)
    assert_allclose(along[-1], [0, 2, 2, 0], atol=ROUNDING)  # the period
    assert_allclose(across, np.tile([0, 0, 0.25, 0.25], (8, 1)), atol=ROUNDING)
    assert_allclose(areas(periodic_cell(2.0, 8, direction, width=1.0)), 0.25, rtol=ROUNDING * 10)


def test_a_periodic_square_is_closed_both_ways():
    mesh = periodic_square(3.0, 6)
    assert len(mesh.nodes) == len(mesh.elements) == 36
    assert_allclose(areas(mesh), 0.25, rtol=ROUNDING)
    edges = {tuple(e) for e in half_edges(mesh).tolist()}
    assert len(edges) == 4 * 36 and all((b, a) in edges for a, b in edges)
    shift = (mesh.corners - mesh.nodes[mesh.elements]) / 3
    assert_array_equal(shift, np.round(shift))  # whole periods


@pytest.mark.parametrize(
    "arguments, word",
    [
        ((0.0, INLET, WEDGE, 100), "outlet_radius"),
        ((OUTLET, 0.4, WEDGE, 100), "inlet_radius"),
        ((OUTLET, INLET, 15, 100), "radians"),
        ((OUTLET, INLET, pi / 2, 100), "wedge_angle"),
        ((*HOPPER, 3), "elements"),
        ((*HOPPER, 100.5), "elements"),
        ((*HOPPER, True), "elements"),
        ((*HOPPER, 100, "triangles"), "polar, graded, diamond"),
        ((float("nan"), INLET, WEDGE, 100), "outlet_radius"),
    ],
)
def test_impossible_hoppers_are_refused_with_the_reason(arguments, word):
    with pytest.raises(SceneError, match=word):
        hopper_mesh(*arguments)


@pytest.mark.parametrize(
    "arguments, word",
    [((0.0, 8), "length"), ((1.0, 2), "cells"), ((1.0, 8, (1.0, 1.0)), "unit vector"), ((1.0, 8, (1, 0), 0), "width")],
)
def test_impossible_cells_are_refused_with_the_reason(arguments, word):
    with pytest.raises(SceneError, match=word):
        periodic_cell(*arguments)


def test_the_coarsest_meshes_exist():
    for kind in KINDS:
        for half in (True, False):
            mesh = hopper_mesh(*HOPPER, 4, kind, half)
            assert areas(mesh).min() > 0
            assert mesh.grid.shape[1] >= (2 if half else 3)
