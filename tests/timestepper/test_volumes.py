"""Control volumes: their parts fill the elements, their faces close, and linear fields are exact on any of them."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from stability.timestepper.mesh import KINDS, hopper_mesh
from stability.timestepper.volumes import control_volumes, edges, interpolation, turned
from tests.timestepper.manufactured import square

SQUARE = np.array([[(0, 0), (1, 0), (1, 1), (0, 1)]], dtype=float)
KITE = np.array([[(0, 0), (2, 0.1), (1.5, 1.2), (-0.2, 0.8)]])
TRIANGLE = np.array([[(0, 0), (1, 0.2), (0.3, 1), (0.3, 1)]])  # collapsed: (a, b, c, c)
MESHES = {
    kind: hopper_mesh(0.5, 1.5, 0.4, 60, kind, half) for kind, half in zip(KINDS, (True, False, False), strict=True)
}
MESHES["bent"] = square(6)


def area_of(corners: np.ndarray) -> np.ndarray:
    """Return the areas of polygons (elements, corners, 2) by the shoelace formula."""
    x, y = np.moveaxis(corners, -1, 0)
    return (x * np.roll(y, -1, axis=1) - y * np.roll(x, -1, axis=1)).sum(axis=1) / 2


def boundary_of(mesh) -> np.ndarray:
    return np.concatenate(list(mesh.boundaries.values()))


@pytest.mark.parametrize("corners", [SQUARE, KITE, TRIANGLE, MESHES["diamond"].corners])
def test_parts_add_up_to_the_element(corners):
    volumes = control_volumes(corners)
    assert_allclose(volumes.volume.sum(axis=0), area_of(corners), rtol=1e-13)  # roundings of a few products
    assert (volumes.volume > 0).all()


def test_parts_and_faces_of_the_unit_square_are_known():
    volumes = control_volumes(SQUARE)
    assert_allclose(volumes.volume[:, 0], 1 / 4, rtol=1e-15)  # exact
    # The face between corners 0 and 1 runs from the middle of the lower side to the centre: 1/2 long, normal along x.
    assert_allclose(volumes.area[:, :, 0].T, [(0.5, 0), (0, 0.5), (-0.5, 0), (0, -0.5)], atol=1e-16)  # exact
    assert_allclose(volumes.face.shape[0], [3 / 8, 3 / 8, 1 / 8, 1 / 8], rtol=1e-15)  # at (1/2, 1/4): exact


@pytest.mark.parametrize("mesh", MESHES.values(), ids=MESHES)
def test_the_faces_of_a_control_volume_close(mesh):
    area = control_volumes(mesh.corners).area
    sums = np.zeros((len(mesh.nodes), 2))
    for s in range(4):
        np.add.at(sums, mesh.elements[:, s], area[:, s].T)
        np.subtract.at(sums, mesh.elements[:, (s + 1) % 4], area[:, s].T)
    open_ends = np.zeros(len(mesh.nodes), dtype=bool)
    for half in edges(mesh.corners, boundary_of(mesh)):
        node = mesh.elements[half.elements, half.corner]
        np.add.at(sums, node, half.area.T)
        open_ends[node] = True
    assert 0 < open_ends.sum() < len(mesh.nodes)
    assert_allclose(sums, 0, atol=1e-15)  # roundings of some ten vectors of 0.1 m, with the boundary's share at the rim


@pytest.mark.parametrize("corners", [KITE, TRIANGLE, MESHES["diamond"].corners, MESHES["bent"].corners])
@pytest.mark.parametrize("face_weight", [0.0, 0.1, 1.0])
def test_linear_fields_and_their_gradients_are_exact(corners, face_weight):
    slope, constant = np.array([0.7, -1.3]), 0.4
    field = (corners @ slope + constant).T[None]  # (1, 4, elements)
    volumes = control_volumes(corners, face_weight)
    middle = (corners + np.roll(corners, -1, axis=1)) / 2
    centre = corners.mean(axis=1, keepdims=True)
    for points, where in ((volumes.face, (middle + centre) / 2), (volumes.part, None)):
        gradients = points.gradients(field)
        # Small collapsed elements: 1e-16 over a size of 0.03 m.
        assert_allclose(gradients, np.broadcast_to(slope[:, None, None, None], gradients.shape), atol=1e-13)
        if where is not None:
            assert_allclose(points.values(field)[0], (where @ slope + constant).T, rtol=1e-14, atol=1e-15)  # roundings


@pytest.mark.parametrize("corners", [KITE, TRIANGLE])
def test_gradients_are_the_derivatives_of_the_interpolation(corners):
    rng = np.random.default_rng(2)
    field, point, h = rng.normal(size=(1, 4, 1)), np.array([[0.3, -0.4]]), 0.1
    gradient = interpolation(point, corners).gradients(field)[:, 0, 0, 0]
    position, value = corners.transpose(2, 1, 0), []
    for a in (0, 1):
        moved = [interpolation(point + s * h * np.eye(2)[a], corners) for s in (1, -1)]
        ahead, back = (m.values(np.concatenate([position, field]))[:, 0, 0] for m in moved)
        value.append((ahead - back) / (2 * h))
    value = np.array(value)  # by reference coordinate: dx, dy, dfield
    assert_allclose(value[:, :2] @ gradient, value[:, 2], rtol=1e-12)  # central differences of a bilinear field: exact


def test_the_weight_blends_the_face_with_the_centre_of_its_element():
    face, centre = control_volumes(KITE).face.slope, control_volumes(KITE, 0.0).face.slope
    assert_allclose(centre, np.broadcast_to(centre[:, :1], centre.shape), rtol=1e-15)  # the same at all four faces
    assert_allclose(control_volumes(KITE, 0.1).face.slope, 0.1 * face + 0.9 * centre, atol=1e-15)  # roundings
    hourglass = np.array([1.0, -1, 1, -1])[None, :, None]
    # Exact: the centre does not see the hourglass, a face does.
    assert_allclose(control_volumes(SQUARE, 0.0).face.gradients(hourglass), 0, atol=1e-15)
    assert abs(control_volumes(SQUARE, 0.1).face.gradients(hourglass)).max() > 0.05


@pytest.mark.parametrize("mesh", MESHES.values(), ids=MESHES)
def test_area_vectors_of_edges_point_outward_and_measure_the_boundary(mesh):
    halves = edges(mesh.corners, boundary_of(mesh))
    assert sum(len(h.elements) for h in halves) == 2 * len(boundary_of(mesh))
    for half in halves:
        inside = mesh.corners[half.elements].mean(axis=1).T
        assert ((half.position - inside) * half.area).sum(axis=0).min() > 0
    flux = sum((half.area * half.position).sum() for half in halves) / 2  # the divergence theorem on x/2
    assert_allclose(flux, area_of(mesh.corners).sum(), rtol=1e-13)  # midpoint rule on linear integrands: exact


def test_a_half_edge_lies_beside_its_own_corner():
    (near, far) = edges(KITE, np.array([[0, 1]]))
    a, b = KITE[0, 1], KITE[0, 2]
    assert (near.corner, far.corner) == (1, 2)
    assert_allclose(near.position[:, 0], (3 * a + b) / 4, rtol=1e-15)  # exact
    assert_allclose(far.position[:, 0], (a + 3 * b) / 4, rtol=1e-15)  # exact
    field = KITE.transpose(2, 1, 0)
    assert_allclose(near.point.values(field)[:, 0, 0], near.position[:, 0], rtol=1e-14)  # roundings
    assert_allclose(near.area[:, 0] + far.area[:, 0], turned(b - a), rtol=1e-15)  # exact


def test_no_edges_give_no_halves():
    assert edges(KITE, np.zeros((0, 2), dtype=int)) == []
