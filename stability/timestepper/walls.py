"""Coulomb friction on walls along which material slides (I6): the traction that a wall's normal stress calls for."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from stability.timestepper.law import Law
from stability.timestepper.volumes import Edge, edges

MOMENTUM = 2  # rows of the flux that are the stress: u and v
State = Callable[[np.ndarray, np.ndarray], tuple[np.ndarray, np.ndarray]]


@dataclass(frozen=True, eq=False)
class Wall:
    """One half of a wall's edges (`Edge`).

    Attributes
    ----------
    edge : where
    normal : (2, edges) unit outward normal
    traction : (2, edges) tan phi_w times the unit vector along the wall towards the apex, the origin: material that
        slides there gives off momentum in that direction for each unit of pressing stress. The formula is one-sided;
        `diagnostics.backward` counts the nodes at which the material slides the other way.
    """

    edge: Edge
    normal: np.ndarray
    traction: np.ndarray

    def outflow(self, law: Law, state: State, corner: np.ndarray) -> np.ndarray:
        """Return the momentum (2, edges) that the wall takes up.

        Parameters
        ----------
        state : completes values and gradients by those of a background
        corner : (fields, 4, edges) the fields at the corners of its elements
        """
        flux = law.flux(*self._at(state, corner), self.edge.area)
        pressing = sum(flux[(i,)] * self.normal[i] for i in range(MOMENTUM))  # sigma_nn times the length
        return self.traction * pressing

    def derivative(self, law: Law, state: State, corner: np.ndarray) -> np.ndarray:
        """Return its derivative by the fields at the four corners, (2, fields, 4, edges)."""
        by_q, *by_g = law.flux_moduli(*self._at(state, corner), self.edge.area)
        point = self.edge.point
        pressing = np.zeros((corner.shape[0], 4, len(self.edge.elements)))
        for weight, entries in ((point.shape[0, :, None], by_q), *zip(point.slope[:, 0], by_g, strict=True)):
            for (i, j), modulus in entries.items():
                if i < MOMENTUM:
                    pressing[j] += self.normal[i] * modulus * weight
        return self.traction[:, None, None] * pressing

    def _at(self, state: State, corner: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        point = self.edge.point
        return state(point.values(corner)[:, 0], point.gradients(corner)[:, :, 0])


def coulomb_walls(corners: np.ndarray, boundary: np.ndarray, friction: float) -> list[Wall]:
    """Return the walls on a boundary of elements with corners (elements, 4, 2); ``friction`` is tan phi_w."""
    found = []
    for edge in edges(corners, boundary):
        normal = edge.area / np.hypot(*edge.area)
        along = np.array([-normal[1], normal[0]])
        towards_apex = -np.sign((along * edge.position).sum(axis=0)) * along
        found.append(Wall(edge, normal, friction * towards_apex))
    return found
