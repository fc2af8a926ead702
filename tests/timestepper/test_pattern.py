"""The sparse matrix holds every element's blocks, once, where they belong."""

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from stability.timestepper.mesh import hopper_mesh, periodic_cell, periodic_square
from stability.timestepper.pattern import Pattern, gathered

MESHES = {
    "polar": hopper_mesh(0.5, 1.5, 0.3, 12),
    "diamond": hopper_mesh(0.5, 1.5, 0.3, 20, "diamond"),
    "periodic": periodic_cell(1.0, 5),
    "square": periodic_square(1.0, 3),
}


def assembled(mesh, local: np.ndarray) -> np.ndarray:
    """Return the dense matrix, one element after another."""
    c, m = local.shape[0], len(mesh.elements)
    found = np.zeros((c * len(mesh.nodes),) * 2)
    for e, (a, b) in ((e, (a, b)) for e in range(m) for a in range(4) for b in range(4)):
        row, column = c * mesh.elements[e, a], c * mesh.elements[e, b]
        found[row : row + c, column : column + c] += local[:, :, a, b, e]
    return found


@pytest.mark.parametrize("mesh", MESHES.values(), ids=MESHES)
@pytest.mark.parametrize("c", [1, 3])
def test_the_matrix_is_the_sum_of_the_elements(mesh, c):
    local = np.random.default_rng(0).normal(size=(c, c, 4, 4, len(mesh.elements)))
    pattern = Pattern(mesh.elements, len(mesh.nodes), c)
    matrix = pattern.matrix(pattern.blocks(local))
    assert_allclose(matrix.toarray(), assembled(mesh, local), rtol=1e-13, atol=1e-14)  # sums in another order


@pytest.mark.parametrize("mesh", MESHES.values(), ids=MESHES)
def test_the_sparsity_is_that_of_nodes_which_share_an_element(mesh):
    n = len(mesh.nodes)
    pattern = Pattern(mesh.elements, n, 3)
    matrix = pattern.matrix(np.ones((3, 3, len(pattern.row))))
    neighbours = assembled(mesh, np.ones((1, 1, 4, 4, len(mesh.elements)))) > 0
    assert matrix.has_canonical_format
    assert matrix.nnz == 9 * neighbours.sum() == 9 * len(pattern.row)
    assert_array_equal(matrix.toarray() > 0, np.kron(neighbours, np.ones((3, 3))) > 0)
    assert_array_equal(pattern.row[pattern.diagonal], np.arange(n))
    assert_array_equal(pattern.column[pattern.diagonal], np.arange(n))


def test_a_node_without_elements_keeps_its_row():
    pattern = Pattern(np.array([[0, 1, 2, 3]]), 5, 1)
    blocks = pattern.blocks(np.ones((1, 1, 4, 4, 1)))
    assert_array_equal(blocks[0, 0, pattern.diagonal], [1, 1, 1, 1, 0])
    assert pattern.matrix(blocks).shape == (5, 5) and pattern.matrix(blocks).nnz == 17


def test_gathering_sums_real_and_complex_values_in_the_same_order():
    rng = np.random.default_rng(3)
    index, values = rng.integers(0, 7, 500), rng.normal(size=500) * 10.0 ** rng.integers(-8, 8, 500)
    real = gathered(index, values, 9)
    both = gathered(index, values * (1 + 2j), 9)
    assert_array_equal(both.real, real)
    assert_array_equal(both.imag, 2 * real)  # a factor of two rounds nothing
    assert_array_equal(real[7:], 0)
