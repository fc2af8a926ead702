from math import radians
from types import SimpleNamespace

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from scipy.sparse import csr_array, diags_array, vstack
from scipy.sparse.linalg import splu

from stability.errors import ConvergenceError, SceneError
from stability.timestepper import linear
from stability.timestepper.linear import Factors, Permutation, default_splu, direct, equilibrated, iterative
from stability.timestepper.mesh import KINDS, hopper_mesh
from stability.timestepper.ordering import nested_dissection
from tests.timestepper.backward_euler import backward_euler_matrix

MESHES = {kind: hopper_mesh(0.5, 1.5, radians(15), 500, kind) for kind in KINDS}
MATRICES = {kind: backward_euler_matrix(mesh) for kind, mesh in MESHES.items()}
ORDERS = {kind: nested_dissection(mesh.logical, mesh.elements) for kind, mesh in MESHES.items()}


def right_hand_side(matrix, seed=0) -> np.ndarray:
    return np.random.default_rng(seed).standard_normal(matrix.shape[0])


@pytest.fixture(params=KINDS)
def kind(request) -> str:
    return request.param


def test_tuned_and_default_solutions_agree(kind):
    matrix = MATRICES[kind]
    rhs = right_hand_side(matrix)
    expected = default_splu()(matrix)(rhs)
    for order in (ORDERS[kind], None):
        solve = direct(order)(matrix)
        assert_allclose(solve(rhs), expected, rtol=0, atol=1e-9 * abs(expected).max())
        assert solve.failures == [] and solve.backward_error < 1e-14


def test_a_known_solution_is_found():
    matrix = MATRICES["polar"]
    x = right_hand_side(matrix)
    solved = direct(ORDERS["polar"])(matrix)(matrix @ x)
    assert_allclose(solved, x, rtol=0, atol=1e-10)  # the condition number costs five digits of sixteen


def entries(matrix, order) -> int:
    """Return the entries of L and U, of SciPy's default where there is no order."""
    scaled, *_ = equilibrated(matrix)
    if order is None:
        return splu(scaled.tocsc()).nnz
    p = Permutation.of(scaled, order)
    permuted = scaled[p.unknowns][:, p.unknowns].tocsc()
    return splu(permuted, permc_spec="NATURAL", diag_pivot_thresh=linear.PIVOT, options={"SymmetricMode": True}).nnz


def test_the_order_saves_entries_of_the_factors():
    # Measured in the hopper's first step with 1,000, 4,000, 16,000 elements: 0.76, 0.56, 0.31 of COLAMD's; here 0.51.
    mesh = hopper_mesh(0.5, 1.5, radians(15), 4000)
    matrix = backward_euler_matrix(mesh)
    assert entries(matrix, nested_dissection(mesh.logical, mesh.elements)) <= 0.6 * entries(matrix, None)


def test_the_same_input_gives_the_same_bits(kind):
    matrix = MATRICES[kind]
    rhs = right_hand_side(matrix)
    factorise = direct(ORDERS[kind])
    first = factorise(matrix)(rhs)
    assert_array_equal(factorise(matrix)(rhs), first)  # the pattern is known now
    assert_array_equal(direct(ORDERS[kind])(matrix.copy())(rhs), first)


def test_a_new_pattern_is_noticed():
    factorise = direct(ORDERS["polar"])
    matrix = MATRICES["polar"]
    rhs = right_hand_side(matrix)
    factorise(matrix)
    other = csr_array(matrix + diags_array([1e-4], offsets=[7], shape=matrix.shape))
    assert_allclose(factorise(other)(rhs), default_splu()(other)(rhs), rtol=0, atol=1e-9)


def test_factors_survive_that_the_matrix_is_overwritten():
    matrix = MATRICES["polar"].copy()
    rhs = right_hand_side(matrix)
    solve = direct(ORDERS["polar"])(matrix)
    first = solve(rhs)
    matrix.data[:] = 0
    assert_array_equal(solve(rhs), first)


def test_duplicate_entries_are_added():
    matrix = MATRICES["polar"]
    twice = csr_array(
        (np.repeat(matrix.data, 2) / 2, np.repeat(matrix.indices, 2), 2 * matrix.indptr), shape=matrix.shape
    )
    rhs = right_hand_side(matrix)
    assert_array_equal(direct(ORDERS["polar"])(twice)(rhs), direct(ORDERS["polar"])(matrix)(rhs))
    assert twice.nnz == 2 * matrix.nnz  # the caller's matrix is left alone


def test_rows_are_scaled_by_powers_of_two_to_between_a_half_and_one():
    scaled, scale, norm = equilibrated(MATRICES["polar"])
    largest = abs(scaled).max(axis=1).toarray()
    assert largest.min() >= 0.5 and largest.max() < 1
    assert_array_equal(np.frexp(scale)[0], 0.5)
    assert_allclose(norm, abs(scaled).sum(axis=1).max(), rtol=1e-14)


def test_where_diagonal_pivots_lose_the_digits_the_default_takes_over():
    # A first pivot of 1e-9: without exchange of rows nine of sixteen digits are lost, and more with the next ones.
    n = 30
    rng = np.random.default_rng(1)
    dense = rng.standard_normal((n, n))
    dense[np.arange(n), np.arange(n)] = 1e-9
    matrix, rhs = csr_array(dense), rng.standard_normal(n)

    def without_pivots(scaled):
        return splu(scaled.tocsc(), permc_spec="NATURAL", diag_pivot_thresh=0.0, options={"SymmetricMode": True}).solve

    solve = Factors(matrix, [("no pivots", without_pivots, 1e-30), linear.DEFAULT])
    assert_allclose(solve(rhs), np.linalg.solve(dense, rhs), rtol=1e-9)
    assert solve.method == "SuperLU by default" and "no pivots: backward error" in solve.failures[0]


def test_one_refinement_brings_back_digits():
    matrix = MATRICES["polar"]

    def rough(scaled):
        factors = splu(scaled.tocsc())
        return lambda b: factors.solve(b) * (1 + 1e-8)

    solve = Factors(matrix, [("rough", rough, linear.ACCEPTED)])
    x = right_hand_side(matrix)
    assert_allclose(solve(matrix @ x), x, rtol=0, atol=1e-9)
    assert solve.method == "rough" and solve.backward_error < 1e-14


def test_singular_matrices_are_refused_in_words():
    empty = csr_array((np.ones(2), np.array([0, 1]), np.array([0, 1, 2, 2])), shape=(3, 3))
    with pytest.raises(ConvergenceError, match="row 2 of its matrix is empty"):
        direct()(empty)
    dense = np.array([[1.0, 2, 3], [2, 4, 6], [1, 1, 1]])
    for factorise in (direct(), direct(np.array([0])), default_splu()):
        with pytest.raises(ConvergenceError, match="singular"):
            factorise(csr_array(dense))(np.array([1.0, 0, 0]))
    with pytest.raises(ConvergenceError, match="row 0 of its matrix is not finite"):
        direct()(csr_array(dense * np.nan))


def test_two_equal_rows_are_noticed():
    matrix = MATRICES["polar"]
    with pytest.raises(ConvergenceError, match="singular or nearly so"):
        direct(ORDERS["polar"])(csr_array(vstack([matrix[:-1], matrix[[-2]]])))(right_hand_side(matrix))


def test_right_hand_sides_are_checked():
    solve = direct(ORDERS["polar"])(MATRICES["polar"])
    rhs = right_hand_side(MATRICES["polar"])
    assert_array_equal(solve(0 * rhs), 0)
    rhs[3] = np.inf
    with pytest.raises(ConvergenceError, match="right-hand side is not finite in row 3"):
        solve(rhs)


def test_an_order_for_another_mesh_is_refused():
    with pytest.raises(ValueError, match="no multiple of the"):
        direct(ORDERS["polar"][:-1])(MATRICES["polar"])


def test_solvers_have_names():
    problem = SimpleNamespace(mesh=MESHES["polar"])
    rhs = right_hand_side(MATRICES["polar"])
    solve = linear.solver_named("direct", problem)(MATRICES["polar"])
    assert_array_equal(solve(rhs), direct(ORDERS["polar"])(MATRICES["polar"])(rhs))
    with pytest.raises(SceneError, match="one of direct, iterative, default"):
        linear.solver_named("magic", problem)


def test_without_pyamg_the_way_to_install_it_is_said(monkeypatch):
    monkeypatch.setattr(linear, "find_spec", lambda name: None)
    with pytest.raises(SceneError, match=r"pip install granular-stability\[multigrid\]"):
        iterative()


@pytest.mark.parametrize("viscosity", [1.5, 0.01], ids=["viscous", "dominated by inertia, as near the arcs"])
def test_multigrid_converges_in_few_iterations(kind, viscosity, monkeypatch):
    pytest.importorskip("pyamg")
    # Computed: 5 to 10 iterations; with inertia none in 100 unless the momentum is taken off the mass rows.
    matrix = backward_euler_matrix(MESHES[kind], viscosity=viscosity)
    x = right_hand_side(matrix)
    solve = iterative(ORDERS[kind], iterations=15)(matrix)
    assert_allclose(solve(matrix @ x), x, rtol=0, atol=1e-6)  # 1e-10 times the condition number
    assert solve.method == "BiCGSTAB with multigrid", solve.failures
    assert_array_equal(iterative(ORDERS[kind])(matrix)(matrix @ x), solve(matrix @ x))  # no random numbers


def test_the_direct_solver_takes_over_from_multigrid():
    pytest.importorskip("pyamg")
    matrix, rhs = MATRICES["polar"], right_hand_side(MATRICES["polar"])
    solve = iterative(ORDERS["polar"], iterations=1)(matrix)
    assert_array_equal(solve(rhs), direct(ORDERS["polar"])(matrix)(rhs))
    assert "after 1 iterations" in solve.failures[0]
