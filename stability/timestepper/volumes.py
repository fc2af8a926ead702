"""Control volumes of bilinear elements (Schneider and Raw, 1987): where fluxes cross, where supplies act.

Lines from the centre of each element to the middles of its edges cut it into four parts, one for each corner. The
parts around a node are its control volume; the lines are the faces. Interpolation and gradients are Cartesian, so that
a closure's flux is used as it is written, without metric terms.

Reference corners 0 to 3 run counter-clockwise from (-1, -1). Face s lies between corners s and s + 1 and its area
vector points from the former to the latter. Arrays end with the axis of elements, along which NumPy sweeps.
"""

from dataclasses import dataclass

import numpy as np

CORNERS = np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)], dtype=float)
MIDDLES = (CORNERS + np.roll(CORNERS, -1, axis=0)) / 2  # of the edges


@dataclass(frozen=True, eq=False)
class Points:
    """Interpolation at some points of each element.

    Attributes
    ----------
    shape : (points, 4) values of the four shape functions
    slope : (2, points, 4, elements) their Cartesian derivatives (1/m)
    """

    shape: np.ndarray
    slope: np.ndarray

    def values(self, corner: np.ndarray) -> np.ndarray:
        """Return (fields, points, elements) from (fields, 4, elements)."""
        return np.einsum("sj,cjm->csm", self.shape, corner)

    def gradients(self, corner: np.ndarray) -> np.ndarray:
        """Return (2, fields, points, elements) from (fields, 4, elements)."""
        return np.einsum("bsjm,cjm->bcsm", self.slope, corner)


def interpolation(reference: np.ndarray, corners: np.ndarray) -> Points:
    """Return the interpolation at reference points (points, 2) of elements with corners (elements, 4, 2)."""
    (X, Y), (x, y) = reference.T[:, :, None], CORNERS.T
    shape = (1 + X * x) * (1 + Y * y) / 4
    by_reference = np.array([x * (1 + Y * y), y * (1 + X * x)]) / 4  # (2, points, 4)
    jacobian = np.einsum("asj,mjb->absm", by_reference, corners)  # d position_b / d reference_a
    (xX, yX), (xY, yY) = jacobian
    determinant = xX * yY - yX * xY
    inverse = np.array([[yY, -yX], [-xY, xX]]) / determinant  # [b][a]: d reference_a / d position_b
    return Points(shape, np.ascontiguousarray(np.einsum("basm,asj->bsjm", inverse, by_reference)))


def turned(edge: np.ndarray) -> np.ndarray:
    """Return vectors (..., 2) turned by -90 degrees: the area vector on the right of a line."""
    return np.stack([edge[..., 1], -edge[..., 0]], axis=-1)


@dataclass(frozen=True, eq=False)
class Volumes:
    """Faces and parts of all elements.

    Attributes
    ----------
    face, part : interpolation at the middle of each face, and of each part
    area : (2, 4, elements) area vectors of the faces (m, for a unit depth)
    volume : (4, elements) areas of the parts (m2)
    """

    face: Points
    part: Points
    area: np.ndarray
    volume: np.ndarray


def blended(points: Points, centre: Points, weight: float) -> Points:
    """Return points whose gradients are their own by ``weight`` and those of the element's centre for the rest."""
    return Points(points.shape, weight * points.slope + (1 - weight) * centre.slope)


def control_volumes(corners: np.ndarray, face_weight: float = 1.0) -> Volumes:
    """Return faces and parts of elements with corners (elements, 4, 2); `blended` says what ``face_weight`` does."""
    centre = corners.mean(axis=1, keepdims=True)
    middle = (corners + np.roll(corners, -1, axis=1)) / 2
    before = np.roll(middle, 1, axis=1)
    across, along = centre - corners, before - middle  # diagonals of the parts: their cross product is twice the area
    volume = (across[..., 0] * along[..., 1] - across[..., 1] * along[..., 0]) / 2
    return Volumes(
        face=blended(interpolation(MIDDLES / 2, corners), interpolation(np.zeros((1, 2)), corners), face_weight),
        part=interpolation(CORNERS / 2, corners),
        area=np.ascontiguousarray(turned(centre - middle).transpose(2, 1, 0)),
        volume=np.ascontiguousarray(volume.T),
    )


@dataclass(frozen=True, eq=False)
class Edge:
    """One of the two halves of boundary edges, all with the same local number.

    Attributes
    ----------
    elements, corner : (edges,) the elements, and the corner whose control volume ends there
    point : interpolation at the middle of the half
    area : (2, edges) outward area vectors (m)
    position : (2, edges) of that middle (m)
    """

    elements: np.ndarray
    corner: int
    point: Points
    area: np.ndarray
    position: np.ndarray


def edges(corners: np.ndarray, boundary: np.ndarray) -> list[Edge]:
    """Return the halves of the edges of a boundary, rows (element, k) from corner k to corner k + 1."""
    found = []
    for k in range(4):
        elements = boundary[boundary[:, 1] == k, 0]
        for near, far in ((k, (k + 1) % 4), ((k + 1) % 4, k)) if len(elements) else ():
            own = corners[elements]
            reference = (3 * CORNERS[near] + CORNERS[far]) / 4
            found.append(
                Edge(
                    elements=elements,
                    corner=near,
                    point=interpolation(reference[None], own),
                    area=turned(own[:, (k + 1) % 4] - own[:, k]).T / 2,
                    position=(3 * own[:, near] + own[:, far]).T / 4,
                )
            )
    return found
