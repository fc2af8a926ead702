"""Leading eigenpairs of the discrete Jacobian about a state that a source holds, and what the stepper makes of them.

``J w = lambda M w`` with M w the rate of change: its modes with the largest growth rate are found by Arnoldi's method
about complex shifts, and grow in the time-stepper by 1/(1 - lambda dt) in each step of backward Euler.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.sparse import csr_array
from scipy.sparse.linalg import LinearOperator, eigs

from stability.timestepper.integrate import Control, start, steps
from stability.timestepper.linear import direct
from stability.timestepper.ordering import nested_dissection
from stability.timestepper.problem import Problem

PER_SHIFT = 6  # eigenvalues looked for about each shift
ARNOLDI_TOL = 1e-10  # of an eigenvalue, relative; ten digits more than the comparison needs are not had for less
AMPLITUDE = 1e-8  # of the start in the stepper, times the typical speed

# Of Newton's last correction, relative to the scales: 1e-4 of a mode of 1e-8; rounding leaves 1e-15.
TOLERANCE = 1e-12


@dataclass(frozen=True, eq=False)
class Mode:
    """An eigenpair of the discrete problem.

    Attributes
    ----------
    eigenvalue : growth rate + i frequency (1/s)
    field : (n, 3) complex u, v, p at the nodes, of largest velocity one
    residual : of the eigenvalue equation, relative
    """

    eigenvalue: complex
    field: np.ndarray
    residual: float


def held(problem: Problem) -> Problem:
    """Return the problem whose initial state is steady, since a source cancels what its balances miss."""
    miss = replace(problem, source=None).balance(problem.initial) / problem.volume[:, None]
    return replace(problem, source=lambda time: miss)


def matrices(problem: Problem, q: np.ndarray) -> tuple[csr_array, csr_array]:
    """Return J and M, of one sparsity, of ``M dq/dt = -J q`` for small disturbances of a state."""
    J, sum_of_both = problem.matrix(q), problem.matrix(q, 1.0)
    return J, csr_array((sum_of_both.data - J.data, J.indices, J.indptr), shape=J.shape)


def modes_near(problem: Problem, shift: complex, count: int = PER_SHIFT) -> list[Mode]:
    """Return the modes whose eigenvalues lie nearest to a shift (1/s), about the initial state."""
    J, M = matrices(problem, problem.initial)
    data = J.data + shift * M.data
    solve = direct(nested_dissection(problem.mesh.logical, problem.mesh.elements))(
        csr_array((data, J.indices, J.indptr), shape=J.shape)
    )
    # (J + shift M)^-1 M w = w/(shift - lambda); M alone is singular, with the eigenvalue zero of this operator.
    operator = LinearOperator(J.shape, matvec=lambda w: solve(M @ w), dtype=complex)
    begin = M @ np.random.default_rng(0).normal(size=J.shape[0]).astype(complex)
    values, vectors = eigs(operator, k=count, v0=begin, tol=ARNOLDI_TOL, ncv=max(20, 3 * count))
    found = []
    for value, w in zip(shift - 1 / values, vectors.T, strict=True):
        miss = np.linalg.norm(J @ w + value * (M @ w)) / np.linalg.norm(abs(J) @ abs(w))
        field = w.reshape(-1, 3)
        found.append(Mode(complex(value), field / np.hypot(*abs(field[:, :2]).T).max(), float(miss)))
    return found


def leading_modes(
    problem: Problem, growth: float, frequencies: Sequence[float], count: int = PER_SHIFT, same: float = 1e-6
) -> list[Mode]:
    """Return modes of the held initial state by decreasing growth.

    Parameters
    ----------
    problem : whose initial state is to be held
    growth : real part of all shifts (1/s): the local theory's largest growth, near 0.0138/epsilon
    frequencies : their imaginary parts (rad/s), which should span those of the growing waves
    count : of modes about each shift
    same : eigenvalues closer than this, relative, are one
    """
    problem, found = held(problem), list[Mode]()
    for frequency in frequencies:
        for mode in modes_near(problem, complex(growth, frequency), count):
            if all(abs(mode.eigenvalue - other.eigenvalue) > same * abs(mode.eigenvalue) for other in found):
                found.append(mode)
    return sorted(found, key=lambda m: -m.eigenvalue.real)


def stepped(problem: Problem, mode: Mode, dt: float, number: int) -> np.ndarray:
    """Return the amplitudes (number + 1,) of a mode that the time-stepper carries on from 1e-8, relative to its start.

    The state is the held one plus the real part of c w. As w is an eigenvector, what is added stays in the plane of
    Re w and Im w, in which c is found by least squares.
    """
    problem = held(problem)
    size = AMPLITUDE * problem.scales[0]
    begun = replace(problem, initial=problem.initial + size * mode.field.real)
    control = Control(first=dt, largest=dt, smallest=dt / 2, tolerance=TOLERANCE)
    factorise = direct(nested_dissection(problem.mesh.logical, problem.mesh.elements))
    velocity = mode.field[:, :2].ravel()
    plane = np.stack([velocity.real, -velocity.imag], axis=1)

    def amplitude(q: np.ndarray) -> complex:
        (real, imaginary), *_ = np.linalg.lstsq(plane, (q - problem.initial)[:, :2].ravel(), rcond=None)
        return complex(real, imaginary) / size

    found = [1 + 0j]
    for state, _ in steps(begun, start(begun, control), control, [number * dt], factorise):
        found.append(amplitude(state.q))
    return np.array(found)


def rate_of(amplitudes: np.ndarray, dt: float) -> complex:
    """Return the eigenvalue (1/s) with which backward Euler, a factor 1/(1 - lambda dt) a step, made these amplitudes.

    The mean over the steps, in which the growth is the same but for rounding and what is not linear.
    """
    ratio = np.exp(np.log(amplitudes[1:] / amplitudes[:-1]).mean())
    return complex((1 - 1 / ratio) / dt)
