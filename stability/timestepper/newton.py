"""Newton's method, damped by the natural monotonicity test, that keeps its factors as long as they serve.

After each trial the *simplified* correction, with the factors of the old iterate and the residual of the new one, says
how much closer the trial is, in units of the solution (Deuflhard, Newton Methods for Nonlinear Problems, 2004, 3.3).
It is the next correction as well if the factors are kept, so that the test costs nothing. On banded states in the
hopper it needs a third of the iterations that a bound on the correction alone needs, and rejects no step.
"""

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from stability.errors import ConvergenceError
from stability.timestepper.problem import Problem

Solve = Callable[[np.ndarray], np.ndarray]

# Found on the hopper: a factorisation costs some ten solves, so factors that still gain a digit in a step are kept;
# beyond 25 iterations or 11 factorisations no run has ever converged, and a smaller step is cheaper than more of them.
CONTRACTION = 0.15
ITERATIONS, FACTORISATIONS = 25, 11
LARGEST_UPDATE = 0.5  # of the scales of velocity and pressure: beyond it the linearisation says nothing
HALVINGS = 6  # of a correction that brings the solution no closer, before the step is given up


@dataclass
class Factors:
    """The factors at hand, and the coefficient of the rate of change that they were made for."""

    factorise: Callable
    solve: Solve | None = None
    coefficient: float = 0.0


@dataclass(frozen=True)
class Outcome:
    """How a solution went.

    Attributes
    ----------
    q : (n, 3) the last iterate
    converged, reason : whether it is a solution, and if not, why, as a sentence
    updates : the largest entry of each correction, relative to the scales
    factorisations : how many were made
    """

    q: np.ndarray
    converged: bool
    reason: str
    updates: tuple[float, ...] = field(default=())
    factorisations: int = 0


def newton(
    problem: Problem,
    start: np.ndarray,
    rate: Callable[[np.ndarray], np.ndarray],
    coefficient: float,
    time: float,
    tolerance: float,
    factors: Factors,
) -> Outcome:
    """Solve ``problem.equations(q, rate(q), time) = 0``.

    Parameters
    ----------
    start : (n, 3) first iterate
    rate : dq/dt as a function of q, with derivative ``coefficient`` (1/s)
    tolerance : of the last correction, relative to the scales
    factors : those at hand; replaced where they no longer serve
    """
    try:
        return _iterated(problem, start, rate, coefficient, time, tolerance, factors)
    except ConvergenceError as error:  # of a linear system: a smaller step may have a solution
        return Outcome(start, False, str(error), (np.inf,))


def _iterated(
    problem: Problem,
    start: np.ndarray,
    rate: Callable,
    coefficient: float,
    time: float,
    tolerance: float,
    factors: Factors,
) -> Outcome:
    q, made = start, 0
    updates: list[float] = []
    if factors.coefficient != coefficient:
        factors.solve = None
    residual = problem.equations(q, rate(q), time)
    correction, size = _correction(problem, factors, residual)
    for _ in range(ITERATIONS):
        if factors.solve is None:
            if made == FACTORISATIONS:
                return Outcome(q, False, f"no convergence after {made} factorisations", tuple(updates), made)
            factors.solve, factors.coefficient = factors.factorise(problem.matrix(q, coefficient)), coefficient
            made += 1
            fresh = True
            correction, size = _correction(problem, factors, residual)
        else:
            fresh = False
        updates.append(size)
        if not np.isfinite(size):
            factors.solve = None
            return Outcome(q, False, "the iteration left the range of numbers", tuple(updates), made)
        if size <= tolerance:
            return Outcome(q - correction, True, "", tuple(updates), made)
        damping = min(1.0, LARGEST_UPDATE / size)
        for _ in range(HALVINGS if fresh else 1):
            trial = q - damping * correction
            left = problem.equations(trial, rate(trial), time)
            following, next_size = _correction(problem, factors, left)
            if closer := next_size <= (1 - damping / 4) * size:
                break
            damping /= 2
        if closer:
            q, residual = trial, left
        elif fresh:  # old factors are given up instead, below
            factors.solve = None
            return Outcome(q, False, "no part of the correction brings the solution closer", tuple(updates), made)
        if closer and damping == 1 and next_size <= max(CONTRACTION * size, tolerance):
            correction, size = following, next_size
        else:
            factors.solve = None
    return Outcome(q, False, f"no convergence after {ITERATIONS} iterations", tuple(updates), made)


def _correction(problem: Problem, factors: Factors, residual: np.ndarray) -> tuple[np.ndarray, float]:
    """Return the correction of a residual with the factors at hand, and its largest entry relative to the scales."""
    if factors.solve is None:
        return residual, np.inf
    correction = factors.solve(residual.ravel()).reshape(residual.shape)
    return correction, float(np.max(abs(correction) / problem.scales))
