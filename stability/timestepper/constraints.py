"""Boundary conditions that replace rows: sliding along walls and lines of symmetry, no stress on arcs, held fields.

At such a node the three rows (two of momentum, one of mass) are turned into the directions along and across the
boundary, and some of them are replaced by ``turn q = value``. What the replaced rows of the balance would have said
is the reaction of the boundary.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from stability.timestepper.mesh import Mesh
from stability.timestepper.pattern import Pattern

NODE_ROWS = 3
PRESSURE = 2


@dataclass(frozen=True, eq=False)
class Constraints:
    """Rows replaced at some nodes.

    Attributes
    ----------
    node : (k,) the nodes
    turn : (k, 3, 3) orthogonal, the rows' new directions
    held : (k, 3) which of the turned rows are replaced
    values : the prescribed ``turn q`` (k, 3) at a time (s)
    """

    node: np.ndarray
    turn: np.ndarray
    held: np.ndarray
    values: Callable[[float], Any] = lambda time: 0.0

    def rows(self, balance: np.ndarray, q: np.ndarray, time: float) -> np.ndarray:
        """Return the equations (n, 3) in place of the balances."""
        found = balance.copy()
        along = np.einsum("kij,kj->ki", self.turn, balance[self.node])
        miss = np.einsum("kij,kj->ki", self.turn, q[self.node]) - self.values(time)
        found[self.node] = np.where(self.held, miss, along)
        return found

    def free(self, balance: np.ndarray) -> np.ndarray:
        """Return the balances (n, 3) with those rows set to zero that a constraint has replaced."""
        found = balance.copy()
        along = np.einsum("kij,kj->ki", self.turn, balance[self.node])
        found[self.node] = np.where(self.held, 0, along)
        return found

    def blocks(self, blocks: np.ndarray, pattern: Pattern) -> np.ndarray:
        """Replace the same rows of the Jacobian's blocks (3, 3, blocks), in place."""
        which = np.full(pattern.n, -1)
        which[self.node] = np.arange(len(self.node))
        b = np.flatnonzero(which[pattern.row] >= 0)
        at = which[pattern.row[b]]
        turned = np.einsum("bij,jlb->ilb", self.turn[at], blocks[:, :, b])
        own = np.where(pattern.column[b] == pattern.row[b], self.turn[at].transpose(1, 2, 0), 0)
        blocks[:, :, b] = np.where(self.held[at].T[:, None, :], own, turned)
        return blocks


NONE = Constraints(np.zeros(0, dtype=int), np.zeros((0, 3, 3)), np.zeros((0, 3), dtype=bool))


def boundary_nodes(mesh: Mesh, name: str) -> np.ndarray:
    """Return the nodes on a boundary."""
    element, k = mesh.boundaries[name].T
    return np.unique(mesh.elements[element[:, None], (k[:, None] + np.arange(2)) % 4])


WALLS, ARCS = ("wall", "axis"), ("inlet", "outlet")


def hopper(mesh: Mesh, walls: Sequence[str] = WALLS, arcs: Sequence[str] = ARCS) -> Constraints:
    """Return the constraints of a wedge whose apex is the origin: no flow through walls, no stress on arcs."""
    across, stress_free = np.zeros(len(mesh.nodes), dtype=bool), np.zeros(len(mesh.nodes), dtype=bool)
    for names, mask in ((walls, across), (arcs, stress_free)):
        for name in names:
            mask[boundary_nodes(mesh, name) if name in mesh.boundaries else []] = True
    node = np.flatnonzero(across | stress_free)
    turn = np.tile(np.eye(NODE_ROWS), (len(node), 1, 1))
    held = np.zeros((len(node), NODE_ROWS), dtype=bool)
    held[:, PRESSURE] = stress_free[node]
    wall = across[node]
    x, y = (mesh.nodes[node[wall]] / np.linalg.norm(mesh.nodes[node[wall]], axis=1, keepdims=True)).T
    # The replaced row is that of the axis nearest to the wall's normal, which keeps the diagonal of the matrix large.
    normal = np.where(abs(x) >= abs(y), 1, 0)
    turn[wall, 1 - normal, :2] = np.stack([x, y], axis=1)
    turn[wall, normal, :2] = np.stack([-y, x], axis=1)
    held[wall, normal] = True
    return Constraints(node, turn, held)


def held_at(node: np.ndarray, values: Callable[[float], np.ndarray]) -> Constraints:
    """Return the constraints that hold all three fields at some nodes; ``values`` gives them (k, 3) at a time."""
    turn = np.tile(np.eye(NODE_ROWS), (len(node), 1, 1))
    return Constraints(node, turn, np.ones((len(node), NODE_ROWS), dtype=bool), values)
