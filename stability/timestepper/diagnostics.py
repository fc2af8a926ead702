"""What a run says about itself after each step: where the model is stretched, and whether the balances close."""

import numpy as np

from stability.timestepper.constraints import PRESSURE, boundary_nodes
from stability.timestepper.problem import Problem


def counts(problem: Problem, q: np.ndarray) -> dict[str, int]:
    """Return how many cells and nodes leave the range in which the closure means what it says."""
    _, g = problem.at_faces(q)
    held = np.zeros(len(q), dtype=bool)
    held[problem.constraints.node[problem.constraints.held[:, PRESSURE]]] = True
    pressure = q[:, PRESSURE] + (problem.background.pressure if problem.background else 0)
    return {
        "cells_below_floor": int(np.any(problem.law.strain_rate_norm(g) < problem.law.floor, axis=0).sum()),
        "nodes_without_pressure": int(np.count_nonzero((pressure <= 0) & ~held)),
        "backward_wall_nodes": int(np.count_nonzero(backward(problem, q))),
    }


def backward(problem: Problem, q: np.ndarray) -> np.ndarray:
    """Return which nodes of the walls slide away from the apex, against the direction that their friction assumes."""
    if not problem.wall_friction:
        return np.zeros(0, dtype=bool)
    wall = boundary_nodes(problem.mesh, "wall")
    return (q[wall, :2] * problem.mesh.nodes[wall]).sum(axis=1) > 0


def budgets(problem: Problem, q: np.ndarray, rate: np.ndarray, time: float) -> tuple[float, float]:
    """Return what the balances of mass and momentum miss, summed over all control volumes that are free.

    Fluxes between control volumes cancel in the sum, so that what is left is what Newton's method left. Relative to
    the flow of mass, or momentum, with the typical velocity and pressure across the square root of the area.
    """
    miss = problem.constraints.free(problem.mass * rate + problem.balance(q, time)).sum(axis=0)
    size = np.sqrt(problem.volume.sum()) * problem.scales[[PRESSURE, PRESSURE, 0]]
    along, across, mass = abs(miss) / size
    return float(mass), float(max(along, across))
