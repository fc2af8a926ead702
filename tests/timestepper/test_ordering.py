from math import radians

import numpy as np
import pytest
from numpy.testing import assert_array_equal
from scipy.sparse import coo_array, csr_array
from scipy.sparse.csgraph import connected_components

from stability.timestepper import ordering
from stability.timestepper.mesh import KINDS, hopper_mesh, periodic_cell, periodic_square
from stability.timestepper.ordering import nested_dissection

MESHES = {kind: hopper_mesh(0.5, 1.5, radians(15), 1000, kind) for kind in KINDS} | {
    "whole diamond": hopper_mesh(0.5, 1.5, radians(15), 1000, "diamond", half=False),
    "row": periodic_cell(1.0, 100),
    "torus": periodic_square(1.0, 30),
}


def graph(mesh) -> csr_array:
    a, b = np.broadcast_arrays(mesh.elements[:, :, None], mesh.elements[:, None, :])
    size = len(mesh.nodes)
    return coo_array((np.ones(a.size), (a.ravel(), b.ravel())), shape=(size, size)).tocsr()


@pytest.fixture(params=MESHES)
def mesh(request):
    return MESHES[request.param]


def test_every_node_is_eliminated_once(mesh):
    assert_array_equal(np.sort(nested_dissection(mesh.logical, mesh.elements)), np.arange(len(mesh.nodes)))


def test_the_last_nodes_separate_the_others_into_two_halves(mesh):
    order = nested_dissection(mesh.logical, mesh.elements)
    n = len(order)
    # The first separator is the shortest tail whose removal leaves no part with more than 60 % of the nodes.
    for tail in range(n // 3):
        rest = order[: n - tail]
        _, part = connected_components(graph(mesh)[rest][:, rest])
        if np.bincount(part).max() < 0.6 * n:
            break
    else:
        pytest.fail("no tail of the order separates the mesh")
    assert tail <= (2 if mesh is MESHES["torus"] else 1) * np.sqrt(n)  # a torus needs two cuts; others 0.2 to 0.92


def fill(pattern: csr_array, order: np.ndarray) -> int:
    """Return the number of entries in the Cholesky factor of a symmetric pattern, eliminated in an order."""
    place = np.argsort(order)
    later = [set() for _ in order]
    for a, b in zip(*pattern.nonzero(), strict=True):
        if place[a] < place[b]:
            later[place[a]].add(int(place[b]))
    for node in later:
        if node:
            first = min(node)
            later[first] |= node - {first}
    return sum(map(len, later))


def test_factors_grow_as_n_log_n(mesh):
    # Computed, over n log2 n: 1.7 to 2.1, row 0.3, torus 2.7; row by row the diamonds have 25 and the torus 6.
    n = len(mesh.nodes)
    assert fill(graph(mesh), nested_dissection(mesh.logical, mesh.elements)) <= 2.8 * n * np.log2(n)


def test_the_order_is_the_same_every_time(mesh):
    first, second = (nested_dissection(mesh.logical, mesh.elements) for _ in range(2))
    assert_array_equal(first, second)


def test_nodes_in_one_place_do_not_trap_it(monkeypatch):
    monkeypatch.setattr(ordering, "LEAF", 1)
    order = nested_dissection(np.zeros((5, 2), dtype=int), np.array([[0, 1, 2, 3], [1, 2, 3, 4]]))
    assert_array_equal(np.sort(order), np.arange(5))
    uneven = np.array([[0, 0]] * 4 + [[1, 0]])
    assert_array_equal(np.sort(nested_dissection(uneven, np.array([[0, 1, 2, 3], [1, 2, 3, 4]]))), np.arange(5))
