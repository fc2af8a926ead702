"""Linear solvers for the Newton steps: ``factorise(matrix)`` returns ``solve(rhs)``.

`direct` is SciPy's SuperLU, given what it does not find out itself: the mesh's order of elimination, rows of equal size
and diagonal pivots. First step in the paper's hopper, seconds of CPU to factorise, and entries of the factors:

    nodes            1,080            4,158            16,302
    `direct`         0.02, 0.35e6     0.09, 1.8e6      0.57, 9.0e6     (+ 126 MB)
    no order given   0.02, 0.33e6     0.12, 1.8e6      0.83, 10.9e6    (+ 132 MB)
    `default_splu`   0.03, 0.46e6     0.18, 3.2e6      3.8, 29e6       (+ 342 MB)

A solve takes 2, 5, 28 ms. `iterative` is BiCGSTAB with multigrid, as in the paper: set up in 0.07, 0.22, 0.98 s, one
solve to 1e-10 in 0.08, 0.36, 2.6 s. It does not pay on meshes of this size.

A solution x of A x = b is judged by its backward error, max|b - A x| / (norm(A) max|x| + max|b|), where rows of A and b
are scaled to a largest entry of about one, and norm(A) is the largest sum of a row's absolute values.
"""

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from importlib.util import find_spec
from typing import Any

import numpy as np
from scipy.sparse import csc_array, csr_array
from scipy.sparse.linalg import bicgstab, splu

from stability.errors import ConvergenceError, SceneError
from stability.timestepper.multigrid import v_cycle
from stability.timestepper.ordering import nested_dissection

Solve = Callable[[np.ndarray], np.ndarray]
Factorise = Callable[[csr_array], Solve]
Method = tuple[str, Callable[[csr_array], Solve], float]  # its name, what it makes of a matrix, its backward error

# Backward errors: a stable elimination leaves 1e-17 to 1e-15; small pivots lose digits that one refinement brings back.
REFINED = 1e-14
ACCEPTED = 1e-11
SINGULAR = 1e13  # max|x| / max|b|: the condition number is larger, fewer than three digits of x would mean anything
PIVOT = 0.01  # part of a column's largest entry that a diagonal pivot needs: 1 costs the ordering, 0 the digits
LOST = 10  # times the tolerance: by how much BiCGSTAB's own residual may be wrong before we call it a breakdown


def equilibrated(matrix: csr_array) -> tuple[csr_array, np.ndarray, float]:
    """Return a copy with rows scaled to largest entries in [1/2, 1), the scales and the largest sum of a row.

    The scales are powers of two, so that scaling adds no rounding.
    """
    if not matrix.has_canonical_format:
        matrix = matrix.copy()
        matrix.sum_duplicates()
    count, size = np.diff(matrix.indptr), abs(matrix.data)
    largest = np.zeros(len(count), size.dtype)
    largest[count > 0] = np.maximum.reduceat(size, matrix.indptr[:-1][count > 0]) if size.size else 0
    for fault, word in ((largest == 0, "is empty"), (~np.isfinite(largest), "is not finite")):
        if fault.any():
            raise ConvergenceError(f"the linear system has no solution: row {np.argmax(fault)} of its matrix {word}")
    scale = np.ldexp(1.0, -np.frexp(largest)[1])
    data = matrix.data * np.repeat(scale, count)
    norm = np.add.reduceat(size, matrix.indptr[:-1]) * scale
    return csr_array((data, matrix.indices, matrix.indptr), shape=matrix.shape), scale, float(norm.max())


class Factors:
    """A matrix ready for solving: called with a right-hand side (3n,) it returns the solution (3n,).

    Methods are tried in turn, and the next one takes over for good where one fails.

    Attributes
    ----------
    method : str, the one in use.
    backward_error : float, of the last solution (see the module's head).
    failures : list of str, the methods that failed and why.
    """

    def __init__(self, matrix: csr_array, methods: Iterable[Method]):
        self.matrix, self.scale, self.norm = equilibrated(matrix)
        self.left, self.failures = iter(methods), list[str]()
        self.method, self.backward_error = "", 0.0
        self.advance()

    def advance(self) -> None:
        """Go to the next method that can deal with the matrix."""
        for method, prepare, accepted in self.left:
            try:
                self.raw, self.method, self.accepted = prepare(self.matrix), method, accepted
                return
            except RuntimeError as error:  # SuperLU's way to say that a pivot is exactly zero
                self.failures.append(f"{method}: {str(error).lower()}")
        tried = "; ".join(self.failures)
        raise ConvergenceError(f"the linear system could not be solved, its matrix is singular or nearly so ({tried})")

    def error_of(self, x: np.ndarray, b: np.ndarray) -> tuple[float, np.ndarray]:
        """Return backward error and residual of a solution."""
        residual = b - self.matrix @ x
        return float(np.max(abs(residual)) / (self.norm * np.max(abs(x)) + np.max(abs(b)))), residual

    def attempt(self, b: np.ndarray) -> np.ndarray:
        """Return a solution of the scaled system, refined where that helps, or raise `RuntimeError`."""
        x = self.raw(b)
        error, residual = self.error_of(x, b)
        if REFINED < error and self.accepted == ACCEPTED:  # an iterative method has done so itself
            better = x + self.raw(residual)
            if (refined := self.error_of(better, b)[0]) < error:
                x, error = better, refined
        if not error <= self.accepted:  # NaN included
            raise RuntimeError(f"backward error {error:.1e}, above {self.accepted:.0e}")
        if not (growth := np.max(abs(x)) / np.max(abs(b))) < SINGULAR:
            raise RuntimeError(f"solution {growth:.0e} times larger than the right-hand side")
        self.backward_error = error
        return x

    def __call__(self, rhs: np.ndarray) -> np.ndarray:
        """Return the solution for a right-hand side."""
        b = rhs * self.scale
        if not np.isfinite(b).all():
            raise ConvergenceError(f"the right-hand side is not finite in row {np.argmin(np.isfinite(b))}")
        if not np.any(b):
            return np.zeros_like(b)
        while True:
            try:
                return self.attempt(b)
            except RuntimeError as error:
                self.failures.append(f"{self.method}: {error}")
                self.advance()


@dataclass(frozen=True, eq=False)
class Permutation:
    """A symmetric permutation of all matrices with one sparsity pattern: where each entry of the result comes from."""

    pattern: tuple[np.ndarray, np.ndarray]  # indptr and indices of the matrices
    unknowns: np.ndarray
    take: np.ndarray
    indices: np.ndarray
    indptr: np.ndarray

    @classmethod
    def of(cls, matrix: csr_array, order: np.ndarray) -> "Permutation":
        """Return the permutation that eliminates nodes in an order."""
        fields, rest = divmod(matrix.shape[0], len(order))
        if rest:
            raise ValueError(
                f"{matrix.shape[0]} rows of the matrix are no multiple of the {len(order)} nodes of the order"
            )
        unknowns = (fields * order[:, None] + np.arange(fields)).ravel()
        numbered = csr_array((np.arange(matrix.nnz), matrix.indices, matrix.indptr), shape=matrix.shape)
        found = numbered[unknowns][:, unknowns].tocsc()
        return cls((matrix.indptr, matrix.indices), unknowns, found.data, found.indices, found.indptr)

    def fits(self, matrix: csr_array) -> bool:
        """Return whether a matrix has the pattern."""
        own = matrix.indptr, matrix.indices
        return all(a is b or np.array_equal(a, b) for a, b in zip(own, self.pattern, strict=True))

    def factors(self, matrix: csr_array) -> Solve:
        """Return the solver made of the permuted matrix's factors."""
        permuted = csc_array((matrix.data[self.take], self.indices, self.indptr), shape=matrix.shape)
        factors = factors_with_diagonal_pivots(permuted, "NATURAL")

        def solve(b: np.ndarray) -> np.ndarray:
            x = np.empty_like(b)
            x[self.unknowns] = factors(b[self.unknowns])
            return x

        return solve


def factors_with_diagonal_pivots(matrix: csc_array, ordering: str) -> Solve:
    """Return SuperLU's solver for a matrix of symmetric pattern, whose order of elimination is kept."""
    options = {"SymmetricMode": True, "Equil": False}
    return splu(matrix, permc_spec=ordering, diag_pivot_thresh=PIVOT, options=options).solve


def with_minimum_degree(matrix: csr_array) -> Solve:
    """Return SuperLU's solver with an ordering from the pattern of A + A'."""
    return factors_with_diagonal_pivots(matrix.tocsc(), "MMD_AT_PLUS_A")


def with_defaults(matrix: csr_array) -> Solve:
    """Return SuperLU's solver with SciPy's defaults: COLAMD, the largest entry of a column as pivot."""
    return splu(matrix.tocsc()).solve


DEFAULT: Method = ("SuperLU by default", with_defaults, ACCEPTED)


def direct_methods(order: np.ndarray | None) -> list[Method]:
    """Return elimination in an order, if there is one, and what to fall back to."""
    if order is None:
        return [("SuperLU by minimum degree", with_minimum_degree, ACCEPTED), DEFAULT]
    known: list[Permutation] = []  # the last pattern's: the matrices of a run share one

    def with_order(matrix: csr_array) -> Solve:
        if not (known and known[0].fits(matrix)):
            known[:] = [Permutation.of(matrix, np.asarray(order))]
        return known[0].factors(matrix)

    return [("SuperLU in the given order", with_order, ACCEPTED), DEFAULT]


def direct(order: np.ndarray | None = None) -> Factorise:
    """Return a factorise that eliminates nodes in the given order.

    Parameters
    ----------
    order : int array (nodes,), as from `ordering.nested_dissection`. Without it, SuperLU's minimum degree on A + A'.

    Returns
    -------
    callable : takes a `csr_array` (3n, 3n), unknowns node by node; returns a solve. Both raise `ConvergenceError` where
        the matrix is singular; the same input gives the same result to the last bit.
    """
    methods = direct_methods(order)
    return lambda matrix: Factors(matrix, methods)


def default_splu() -> Factorise:
    """Return a factorise that leaves all choices to SciPy: the baseline."""
    return lambda matrix: Factors(matrix, [DEFAULT])


def iterative(order: np.ndarray | None = None, rtol: float = 1e-10, iterations: int = 200) -> Factorise:
    """Return a factorise for BiCGSTAB with multigrid, which needs pyamg; `direct` takes over where it fails.

    Parameters
    ----------
    order : int array (nodes,). For `direct`.
    rtol : float. Tolerance of the residual's 2-norm, relative to that of the right-hand side, rows scaled.
    iterations : int. How many at most.
    """
    if find_spec("pyamg") is None:
        raise SceneError(
            "the iterative solver needs pyamg, which is not installed: pip install granular-stability[multigrid], "
            "or choose the direct solver"
        )

    def prepare(matrix: csr_array) -> Solve:
        try:
            cycle = v_cycle(matrix)
        except np.linalg.LinAlgError as error:
            raise RuntimeError(f"the momentum of some node does not determine its velocity ({error})") from None

        def solve(b: np.ndarray) -> np.ndarray:
            x, _ = bicgstab(matrix, b, rtol=rtol, maxiter=iterations, M=cycle)
            reached = np.linalg.norm(b - matrix @ x) / np.linalg.norm(b)  # BiCGSTAB's own residual drifts away
            if not reached <= LOST * rtol:
                raise RuntimeError(f"residual {reached:.1e} after {iterations} iterations, {rtol:.0e} wanted")
            return x

        return solve

    # Its own test has judged the solution: with a large rtol, a backward error would only refuse what was asked for.
    methods: list[Method] = [("BiCGSTAB with multigrid", prepare, np.inf), *direct_methods(order)]
    return lambda matrix: Factors(matrix, methods)


SOLVERS: dict[str, Callable[[np.ndarray], Factorise]] = {
    "direct": direct,
    "iterative": iterative,
    "default": lambda order: default_splu(),
}


def solver_named(name: str, problem: Any) -> Factorise:
    """Return the factorise of that name ("direct", "iterative", "default") for a problem with a ``mesh``."""
    if name not in SOLVERS:
        raise SceneError(
            f"solver = {name!r} is not possible, it must be one of {', '.join(SOLVERS)}: choose one of these"
        )
    return SOLVERS[name](nested_dissection(problem.mesh.logical, problem.mesh.elements))
