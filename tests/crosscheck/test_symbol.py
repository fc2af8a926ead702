"""The discrete symbol of the hopper's meshes tends to D, background gradients included, at second order."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from stability.crosscheck.orders import observed
from stability.crosscheck.symbol import discrete_symbol, node_matrix, patch
from stability.crosscheck.theory import unit
from stability.timestepper.hopper import hopper_problem
from tests.conftest import HOPPER

GIVEN = HOPPER | {"epsilon": 1e-4}
WAVES = ((80.0, 40.0), (40.0, 130.0))


@pytest.mark.parametrize("kind", ["polar", "graded", "diamond"])
def test_symbol_tends_to_d_at_second_order_and_within_one_per_cent(kind):
    elements = (4000, 16000, 64000, 256000)
    found = discrete_symbol("perturbed", "radial_hopper", GIVEN, WAVES, elements=elements, kind=kind)
    for i, j in np.ndindex(3, 2):
        levels = [mesh[i][j] for mesh in found]
        size = [s.size for s in levels]
        assert levels[-1].matrix_error < 0.01 and levels[-1].eigenvalue_error < 0.01  # issue: 1 % on the finest mesh
        assert_allclose(observed(size, [s.matrix_error for s in levels]), 2, atol=0.1)  # next term, (q h)^2 = 0.006
        # Single eigenvalues change sign of their error between meshes; those that do not, show the order too.
        assert levels[-1].eigenvalue_error < levels[-2].eigenvalue_error < levels[-3].eigenvalue_error


def test_rows_of_a_patch_are_those_of_the_whole_mesh():
    whole = hopper_problem("perturbed", "radial_hopper", GIVEN, {"elements": 500})
    part, node = patch(whole.mesh, 1.0, 5.0)
    small = hopper_problem("perturbed", "radial_hopper", GIVEN, part)
    same = int(np.argmin(np.hypot(*(whole.mesh.nodes - part.nodes[node]).T)))
    xi = 80 * unit(40)
    one = node_matrix(whole, whole.jacobian_blocks(whole.initial), same, xi)
    other = node_matrix(small, small.jacobian_blocks(small.initial), node, xi)
    assert_allclose(one, other, rtol=1e-11, atol=1e-11 * abs(one).max())  # the same sums in another order
