"""The discrete symbol: the exact Jacobian of the hopper's mesh applied to exp(i xi.x), against the tangent matrix D.

At an interior node the three rows of the Jacobian, applied to a plane wave and divided by the control volume, are the
mesh's own L(xi). Its Schur complement tends to D, background gradients included, at second order in the cell size.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from stability.crosscheck.theory import tangent, unit, wave_matrix
from stability.model import Base, Model
from stability.parameters import to_si
from stability.timestepper.hopper import hopper_problem
from stability.timestepper.mesh import Mesh, hopper_mesh
from stability.timestepper.problem import Problem

ELEMENTS = (1000, 4000, 16000, 64000, 256000)
PLACES = ((0.75, 4.0), (1.0, 4.0), (1.25, 8.0))  # r (m) and theta (deg); the nodes nearest to them are looked at


@dataclass(frozen=True, eq=False)
class Symbol:
    """The symbol of one mesh at one node for one wave.

    Attributes
    ----------
    r, theta : of the node (m, deg)
    size : of a cell there (m)
    exact, discrete : D (2, 2) in the node's own frame (1/s)
    eigenvalue, discrete_eigenvalue : leading (1/s)
    """

    r: float
    theta: float
    size: float
    exact: np.ndarray
    discrete: np.ndarray

    @property
    def eigenvalue(self) -> complex:
        """The leading eigenvalue of D (1/s)."""
        return leading(self.exact)

    @property
    def discrete_eigenvalue(self) -> complex:
        """The leading eigenvalue of the symbol (1/s)."""
        return leading(self.discrete)

    @property
    def matrix_error(self) -> float:
        """The largest entry of the difference over the largest of D."""
        return float(abs(self.discrete - self.exact).max() / abs(self.exact).max())

    @property
    def eigenvalue_error(self) -> float:
        """The difference of the leading eigenvalues over that of D."""
        return abs(self.discrete_eigenvalue - self.eigenvalue) / abs(self.eigenvalue)


def leading(matrix: np.ndarray) -> complex:
    """Return the eigenvalue of the largest real part."""
    found = np.linalg.eigvals(matrix)
    return complex(found[np.argmax(found.real)])


def patch(mesh: Mesh, r: float, theta: float) -> tuple[Mesh, int]:
    """Return the elements around the interior node nearest to a place (m, degrees), and the node's number there.

    A node's rows of the Jacobian know of these elements alone.
    """
    node = int(np.argmin(np.hypot(*(mesh.nodes - r * unit(theta)).T)))
    mine = (mesh.elements == node).any(axis=1)
    nodes, elements = np.unique(mesh.elements[mine], return_inverse=True)
    elements = elements.reshape(-1, 4)
    part = Mesh(mesh.nodes[nodes], elements, mesh.corners[mine], {}, None, mesh.logical[nodes])
    return part, int(np.searchsorted(nodes, node))


def polar_base(closure: Any, flow: Any, parameters: Mapping, place: np.ndarray) -> Base:
    """Return the base state of a radial flow at a place (2,) in the mesh's axes."""
    r, theta = np.hypot(*place), np.degrees(np.arctan2(place[1], place[0]))
    return Model(closure, flow).base(parameters, {"r": float(r), "theta": float(theta)})


def turn_to_local(place: np.ndarray) -> np.ndarray:
    """Return the matrix (3, 3) that takes u, v, p from Cartesian to polar components at a place."""
    c, s = place / np.hypot(*place)
    return np.array([[c, s, 0], [-s, c, 0], [0, 0, 1]])


def node_matrix(problem: Problem, blocks: np.ndarray, node: int, wavevector: np.ndarray) -> np.ndarray:
    """Return the mesh's own L(xi), (..., 3, 3), at a node for wavevectors (..., 2), both in polar components.

    Parameters
    ----------
    blocks : `Problem.jacobian_blocks` of the state
    """
    place = problem.mesh.nodes[node]
    turn = turn_to_local(place)
    own = np.flatnonzero(problem.pattern.row == node)
    offset = problem.mesh.nodes[problem.pattern.column[own]] - place
    phase = np.exp(1j * (wavevector @ turn[:2, :2]) @ offset.T)
    return -turn @ np.einsum("ijb,...b->...ij", blocks[:, :, own], phase) @ turn.T / problem.volume[node]


def discrete_symbol(
    closure: Any,
    flow: Any,
    parameters: Mapping[str, float],
    waves: Sequence[tuple[float, float]],
    places: Sequence[tuple[float, float]] = PLACES,
    elements: Sequence[int] = ELEMENTS,
    kind: str = "polar",
) -> list[list[list[Symbol]]]:
    """Return the symbols on several meshes (elements), at several nodes, for several waves.

    Parameters
    ----------
    closure, flow, parameters : a closure on a radial flow; angles in degrees
    waves : wavenumber (1/m) and angle (degrees) from the local e_r
    places : r (m) and theta (degrees); the theory is evaluated at the nearest node's own place
    elements, kind : of `hopper_mesh`, the half wedge
    """
    si = to_si(Model(closure, flow).parameters, parameters)
    geometry = si["outlet_radius"], si["inlet_radius"], si["wedge_angle"]
    found = []
    for number in elements:
        mesh, rows = hopper_mesh(*geometry, elements=number, kind=kind), []
        for r, theta in places:
            part, node = patch(mesh, r, theta)
            problem = hopper_problem(closure, flow, parameters, part)
            blocks = problem.jacobian_blocks(problem.initial)
            base = polar_base(closure, flow, parameters, part.nodes[node])
            rows.append([compared(problem, blocks, node, base, q * unit(angle)) for q, angle in waves])
        found.append(rows)
    return found


def compared(problem: Problem, blocks: np.ndarray, node: int, base: Base, wavevector: np.ndarray) -> Symbol:
    """Return a node's symbol beside the tangent matrix of the base state at its place."""
    x, y = problem.mesh.nodes[node]
    evolves = base.model.evolves
    return Symbol(
        r=float(np.hypot(x, y)),
        theta=float(np.degrees(np.arctan2(y, x))),
        size=float(np.sqrt(problem.volume[node])),
        exact=tangent(wave_matrix(base, wavevector), evolves),
        discrete=tangent(node_matrix(problem, blocks, node, wavevector), evolves),
    )
