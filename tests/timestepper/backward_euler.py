"""A matrix like that of a backward Euler step, from bilinear finite elements: same blocks and sparsity, no stepper."""

import numpy as np
from scipy.sparse import csr_array

from stability.timestepper.mesh import Mesh

POINTS = np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)]) / np.sqrt(3)
SIGNS = np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)])
DELTA, A = np.eye(2), np.diag([1, -1]) / np.sqrt(2)
K = np.sqrt(2) * np.sin(np.deg2rad(34))


def shape_functions(corners: np.ndarray, point: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return N (4,), its gradients (m, 4, 2) and the Jacobian's determinant (m,) at a point of the reference square."""
    N = np.prod(1 + SIGNS * point, axis=1) / 4
    local = SIGNS * (1 + SIGNS * point)[:, ::-1] / 4
    J = np.einsum("ai,maj->mij", local, corners)
    return N, np.einsum("mji,ai->maj", np.linalg.inv(J), local), np.linalg.det(J)


def backward_euler_matrix(
    mesh: Mesh, dt: float = 5e-4, viscosity: float = 1.5, epsilon: float = 1e-4, p_free: bool = False
) -> csr_array:
    """Return the matrix (3n, 3n) of du/dt = -div(p I - k p A - viscous stress), div u = epsilon Lap p, rows by node."""
    m = len(mesh.elements)
    block = np.zeros((m, 4, 3, 4, 3))
    M = (np.einsum("il,jk->ijkl", DELTA, DELTA) + np.einsum("ik,jl->ijkl", DELTA, DELTA)) / 2
    M = viscosity * (M - np.einsum("ij,kl->ijkl", A, A))
    for point in POINTS:
        N, G, det = shape_functions(mesh.corners, point)
        block[:, :, :2, :, :2] += np.einsum("maj,mbl,ijkl,m->maibk", G, G, M, det)
        block[:, :, :2, :, 2] -= np.einsum("maj,ij,b,m->maib", G, DELTA - K * A, N, det)
        block[:, :, 2, :, :2] += np.einsum("a,mbk,m->mabk", N, G, det)
        block[:, :, 2, :, 2] += epsilon * np.einsum("maj,mbj,m->mab", G, G, det)
        for a in range(4):
            block[:, a, [0, 1], a, [0, 1]] += (N[a] * det / dt)[:, None]  # lumped
    dof = (3 * mesh.elements[:, :, None] + np.arange(3)).reshape(m, 12)
    rows, columns = np.broadcast_arrays(dof[:, :, None], dof[:, None, :])
    size = 3 * len(mesh.nodes)
    matrix = csr_array((block.ravel(), (rows.ravel(), columns.ravel())), shape=(size, size))
    fixed = [] if p_free else [3 * arc(mesh, name) + 2 for name in ("outlet", "inlet") if name in mesh.boundaries]
    fixed += [3 * arc(mesh, name) + 1 for name in ("wall", "axis") if name in mesh.boundaries]
    keep = np.ones(size)
    keep[np.concatenate(fixed) if fixed else []] = 0
    matrix.data *= np.repeat(keep, np.diff(matrix.indptr))  # the rows stay in the pattern, as in a stepper
    diagonal = matrix.diagonal()
    matrix.setdiag(np.where(keep == 0, 1.0, diagonal))
    matrix.sum_duplicates()
    return matrix


def arc(mesh: Mesh, name: str) -> np.ndarray:
    """Return the nodes of a named boundary."""
    element, k = mesh.boundaries[name].T
    return np.unique([mesh.elements[element, k], mesh.elements[element, (k + 1) % 4]])
