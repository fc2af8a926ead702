"""Multigrid for the matrices of an implicit step, velocities and pressure together; needs pyamg (extra ``multigrid``).

By nodes, such a matrix is [F G; D E]: F for the momentum, E = epsilon times a Laplacian. Pressure enters the momentum
by centred differences, so that a sweep which solves node by node does not see that pressure drives the velocity there.
It overshoots where dt is above epsilon and viscosity is small, as it is near the arcs: more sweeps make it worse. So
D X times the momentum rows is taken off the mass rows, with X the inverse of the 2 by 2 diagonal blocks of F, and E
becomes E - D X G, which holds the missing Laplacian.

Iterations of BiCGSTAB to 1e-10, first step in the paper's hopper (epsilon = 1e-4, dt = 5e-4 s, half wedge, 1,000, 4,000
and 16,000 elements): 8, 12, 22; "diamond" 9, 17, 39; 2,000 elements with bands at 0.12 s: 21. GMRES 16 and 22. Without
taking off: BiCGSTAB none in 200, GMRES 119 and 120, with two sweeps for one 214 and 215. Pyamg by default, which takes
the matrix for symmetric, breaks down in the first iteration.
"""

from collections.abc import Callable

import numpy as np
from scipy.sparse import bsr_array, csr_array, eye_array
from scipy.sparse.linalg import LinearOperator

FIELDS = 3  # unknowns of a node, next to each other; the pressure is the last

# Aggregates of nodes are smoothed with local weights: by a spectral radius, which pyamg estimates with random numbers
# and four times the work, the gain was one iteration in ten.
SMOOTHING = ("jacobi", {"omega": 4 / 3, "weighting": "local"})
SWEEP = ("block_gauss_seidel", {"sweep": "symmetric"})
COARSEST = 100  # unknowns: there a dense inverse takes over


def pressure_rows(matrix: csr_array) -> csr_array:
    """Return the matrix L, from the left, that takes the momentum out of the mass rows as far as one node can.

    Raises `numpy.linalg.LinAlgError` where the momentum of a node does not determine its velocity.
    """
    size = matrix.shape[0]
    nodes = size // FIELDS
    row = np.repeat(np.arange(size), np.diff(matrix.indptr))
    node, i, j = row // FIELDS, row % FIELDS, matrix.indices % FIELDS
    own = (node == matrix.indices // FIELDS) & (i < 2) & (j < 2)
    F = np.zeros((nodes, 2, 2))
    np.add.at(F, (node[own], i[own], j[own]), matrix.data[own])
    X = np.zeros((nodes, FIELDS, FIELDS))
    X[:, :2, :2] = np.linalg.inv(F)
    D = matrix.copy()
    D.data[(i < 2) | (j == 2)] = 0
    D.eliminate_zeros()
    blocks = bsr_array((X, np.arange(nodes), np.arange(nodes + 1)), shape=matrix.shape)
    return csr_array(eye_array(size) - D @ blocks.tocsr())


def v_cycle(matrix: csr_array) -> LinearOperator:
    """Return one V-cycle for a matrix (3n, 3n), unknowns node by node: an approximation of its inverse."""
    from pyamg import smoothed_aggregation_solver

    left = pressure_rows(matrix)
    levels = smoothed_aggregation_solver(
        bsr_array(left @ matrix, blocksize=(FIELDS, FIELDS)),
        B=np.tile(np.eye(FIELDS), (matrix.shape[0] // FIELDS, 1)),  # each unknown constant
        symmetry="nonsymmetric",
        strength=("symmetric", {"theta": 0.0}),  # all neighbours alike
        smooth=SMOOTHING,
        presmoother=SWEEP,
        postsmoother=SWEEP,
        improve_candidates=None,
        max_coarse=COARSEST,
    )
    cycle = levels.aspreconditioner()
    apply: Callable[[np.ndarray], np.ndarray] = lambda b: cycle @ (left @ b)  # noqa: E731
    return LinearOperator(matrix.shape, matvec=apply, dtype=matrix.dtype)
