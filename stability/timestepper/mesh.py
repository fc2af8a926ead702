"""Meshes of quadrilaterals: the hopper in three kinds, and periodic cells with exact answers.

"graded" is the image of equal squares under exp(log r + i theta), which is conformal: cells stay squares from outlet to
inlet, so they are finest at the outlet. "diamond" is the image of the same squares turned by 45 degrees.
"""

from collections.abc import Callable
from dataclasses import dataclass
from math import hypot, inf, isfinite, log, pi, sqrt

import numpy as np

from stability.errors import SceneError

KINDS = ("polar", "graded", "diamond")
FEWEST, MOST = 4, 10_000_000  # elements: a cell each way with room for a boundary; SuperLU counts nonzeros in 32 bits
COUNT_WEIGHT = 20  # 5 % in the number of elements is as bad as an aspect ratio of e


@dataclass(frozen=True, eq=False)
class Mesh:
    """Nodes and quadrilaterals in Cartesian coordinates, x up the hopper's axis, its apex at the origin.

    Attributes
    ----------
    nodes : array (n, 2), in m.
    elements : int array (m, 4), counter-clockwise. A triangle is the collapsed quadrilateral (a, b, c, c).
    corners : array (m, 4, 2), in m. Differs from ``nodes[elements]`` only across a periodic boundary.
    boundaries : dict of name to int array (b, 2), rows (element, k): the edge from its corner k to (k + 1) % 4, along
        which the domain lies on the left.
    grid : int array (radii, angles), or None. Node numbers of the polar grid; cell centres of "diamond" are not in it.
    logical : int array (n, 2). Places on a lattice, for `ordering.nested_dissection`.
    """

    nodes: np.ndarray
    elements: np.ndarray
    corners: np.ndarray
    boundaries: dict[str, np.ndarray]
    grid: np.ndarray | None
    logical: np.ndarray


def require(holds: bool, name: str, value: object, allowed: str, advice: str) -> None:
    """Raise `SceneError` with a sentence unless a condition holds."""
    if not holds:
        raise SceneError(f"{name} = {value!r} is not possible, it must be {allowed}: {advice}")


def whole(value: object, low: int, high: float = inf) -> bool:
    """Return whether a value is an integer (not a bool) within bounds."""
    return isinstance(value, int | np.integer) and not isinstance(value, bool) and bool(low <= value <= high)


def size_of_grid(elements: int, width: float, length: float, step: int, diamond: bool) -> tuple[int, int]:
    """Return the numbers of cells along and across whose elements come closest to a wanted number and to squares.

    Parameters
    ----------
    elements : int. Wanted number of elements.
    width, length : float. Extent of the domain across and along, in one unit.
    step : int. The number across is a multiple of it.
    diamond : bool. True where elements are the grid's edges, False where they are its cells.
    """
    cells = elements / 2 if diamond else elements
    guesses = {max(1, round(sqrt(cells * width / length) / step) + d) for d in range(-3, 4)}
    # A count along that fits squares lets the number across match the total, which the long side does best.
    rows = {max(1, round(sqrt(cells * length / width)) + d) for d in range(-3, 4)}
    across = {step * g for g in guesses} | {step * max(1, round(cells / (n * step))) for n in rows}
    best = []
    for a in sorted(across):
        n = max(1, round((elements - a) / (2 * a + 1) if diamond else elements / a))
        count = 2 * a * n + a + n if diamond else a * n
        best.append((COUNT_WEIGHT * abs(log(count / elements)) + abs(log(width * n / (length * a))), n, a))
    return min(best)[1:]


def mirrored(nodes: np.ndarray) -> np.ndarray:
    """Return rows of nodes (rows, angles, 2) from the axis outwards, with their mirror images put before them."""
    image = nodes[:, ::-1] * (1.0, -1.0)  # exact; a sine of -theta need not be that of theta to the last bit
    return np.concatenate([image[:, : image.shape[1] - (nodes[0, 0, 1] == 0)], nodes], axis=1)


def points(radii: np.ndarray, angles: np.ndarray, half: bool) -> np.ndarray:
    """Return the points (radii, angles, 2) of a polar grid, with their mirror images if the domain is whole."""
    found = radii[:, None, None] * np.stack([np.cos(angles), np.sin(angles)], axis=-1)
    return found if half else mirrored(found)


def edges(elements: np.ndarray, k: int) -> np.ndarray:
    """Return boundary rows (element, k) of some elements."""
    return np.stack([elements.ravel(), np.full(elements.size, k)], axis=1)


def named(low: np.ndarray, high: np.ndarray, outlet: np.ndarray, inlet: np.ndarray, half: bool) -> dict:
    """Return the boundaries by name, from those at lowest and highest angle, smallest and largest radius."""
    sides = {"wall": high, "axis": low} if half else {"wall": np.concatenate([low, high])}
    return {"outlet": outlet, "inlet": inlet} | sides


def mesh_of_cells(nodes: np.ndarray, half: bool) -> Mesh:
    """Return the mesh whose elements are the cells of a polar grid of points (radii, angles, 2)."""
    grid = np.arange(nodes[..., 0].size).reshape(nodes.shape[:2])
    elements = np.stack([grid[:-1, :-1], grid[1:, :-1], grid[1:, 1:], grid[:-1, 1:]], axis=-1)
    number = np.arange(elements[..., 0].size).reshape(elements.shape[:2])
    sides = edges(number[:, 0], 0), edges(number[:, -1], 2), edges(number[0], 3), edges(number[-1], 1)
    flat, elements = nodes.reshape(-1, 2), elements.reshape(-1, 4)
    return Mesh(flat, elements, flat[elements], named(*sides, half), grid, np.argwhere(grid >= 0))


def mesh_of_edges(nodes: np.ndarray, centres: np.ndarray, half: bool) -> Mesh:
    """Return the mesh whose elements are the edges of a polar grid, each with the centres of the cells beside it."""
    grid = np.arange(nodes[..., 0].size).reshape(nodes.shape[:2])
    c = grid.size + np.arange(centres[..., 0].size).reshape(centres.shape[:2])
    radial = np.stack([grid[:-1, 1:-1], c[:, :-1], grid[1:, 1:-1], c[:, 1:]], axis=-1)
    angular = np.stack([c[:-1], grid[1:-1, :-1], c[1:], grid[1:-1, 1:]], axis=-1)
    triangles = [
        (grid[:-1, 0], grid[1:, 0], c[:, 0]),  # lowest angle
        (grid[1:, -1], grid[:-1, -1], c[:, -1]),  # highest angle
        (grid[0, 1:], grid[0, :-1], c[0]),  # outlet
        (grid[-1, :-1], grid[-1, 1:], c[-1]),  # inlet
    ]
    sides = [np.stack([a, b, centre, centre], axis=-1) for a, b, centre in triangles]
    parts = [radial.reshape(-1, 4), angular.reshape(-1, 4), *sides]
    ends = np.cumsum([len(p) for p in parts])
    names = [edges(np.arange(end - len(side), end), 0) for side, end in zip(sides, ends[2:], strict=True)]
    elements = np.concatenate(parts)
    flat = np.concatenate([nodes.reshape(-1, 2), centres.reshape(-1, 2)])
    # The turned lattice, where the quadrilaterals are unit squares: factors 30 % smaller than by radius and angle.
    logical = np.concatenate([2 * np.argwhere(grid >= 0), 2 * np.argwhere(c >= 0) + 1]) @ np.array([(1, 1), (1, -1)])
    low, high, outlet, inlet = names
    return Mesh(flat, elements, flat[elements], named(low, high, outlet, inlet, half), grid, logical)


def hopper_mesh(
    outlet_radius: float,
    inlet_radius: float,
    wedge_angle: float,
    elements: int,
    kind: str = "polar",
    half: bool = True,
) -> Mesh:
    """Return a mesh of the wedge between two arcs, its cells as square as their number allows.

    Parameters
    ----------
    outlet_radius, inlet_radius : float, in m.
    wedge_angle : float, in radians, from the axis to a wall.
    elements : int. Wanted number of elements, met within 5 % from 500 on.
    kind : "polar" has equal steps in radius and angle, and squares at the middle radius; "graded" has radii in
        geometric progression, and squares everywhere; "diamond" has these turned by 45 degrees, and triangles along the
        boundary.
    half : bool. True for the half above the symmetry line (boundaries "outlet", "inlet", "wall", "axis"); False for the
        whole wedge, mirror-symmetric to the last bit, whose "wall" holds both walls.

    Raises
    ------
    SceneError : where an argument is outside its range.
    """
    require(0 < outlet_radius < inf, "outlet_radius", outlet_radius, "positive", "give the outlet's distance in m")
    beyond = f"above the outlet_radius = {outlet_radius!r}"
    require(outlet_radius < inlet_radius < inf, "inlet_radius", inlet_radius, beyond, "exchange or change the two")
    require(0 < wedge_angle < pi / 2, "wedge_angle", wedge_angle, "between 0 and pi/2", "give it in radians")
    allowed = f"a whole number from {FEWEST} to {MOST}"
    require(whole(elements, FEWEST, MOST), "elements", elements, allowed, "1000 show the flow, 16000 the bands")
    require(kind in KINDS, "kind", kind, f"one of {', '.join(KINDS)}", "choose one of these")

    polar, step = kind == "polar", 1 if half else 2
    width = wedge_angle * step * ((outlet_radius + inlet_radius) / 2 if polar else 1)
    length = inlet_radius - outlet_radius if polar else log(inlet_radius / outlet_radius)
    along, across = size_of_grid(elements, width, length, step, kind == "diamond")

    space: Callable[..., np.ndarray] = np.linspace if polar else np.geomspace
    radii = space(outlet_radius, inlet_radius, along + 1)
    angles = np.linspace(0, wedge_angle, across // step + 1)
    nodes = points(radii, angles, half)
    if kind != "diamond":
        return mesh_of_cells(nodes, half)
    centres = points(np.sqrt(radii[:-1] * radii[1:]), (angles[:-1] + angles[1:]) / 2, half)
    return mesh_of_edges(nodes, centres, half)


def periodic_cell(
    length: float, cells: int, direction: tuple[float, float] = (1.0, 0.0), width: float | None = None
) -> Mesh:
    """Return one row of elements along a direction, periodic along it and across it: a plane wave's domain.

    Parameters
    ----------
    length : float, in m. Period along the direction.
    cells : int. Number of elements, and of nodes.
    direction : pair of floats of length 1 (it is not scaled), in Cartesian components.
    width : float, in m. Period across; a cell's length where it is not given.
    """
    require(0 < length < inf, "length", length, "positive", "give the period in m")
    require(whole(cells, 3, MOST), "cells", cells, f"a whole number from 3 to {MOST}", "a wave needs some ten")
    unit = len(direction) == 2 and all(map(isfinite, direction)) and abs(hypot(*direction) - 1) < 1e-12
    require(unit, "direction", direction, "a unit vector", "divide it by its length")
    width = length / cells if width is None else width
    require(0 < width < inf, "width", width, "positive", "leave it out to have squares")

    x, y = direction
    i = np.arange(cells)
    along = np.arange(cells + 1)[:, None] * (length / cells) * np.array([x, y])
    above = along + width * np.array([-y, x])
    elements = np.stack([i, (i + 1) % cells, (i + 1) % cells, i], axis=1)
    corners = np.stack([along[:-1], along[1:], above[1:], above[:-1]], axis=1)
    return Mesh(along[:-1], elements, corners, {}, None, np.stack([i, 0 * i], axis=1))


def periodic_square(length: float, cells: int) -> Mesh:
    """Return a square of ``cells`` by ``cells`` elements with sides of ``length`` in m, periodic in both."""
    require(0 < length < inf, "length", length, "positive", "give the period in m")
    require(whole(cells, 3, 3000), "cells", cells, "a whole number from 3 to 3000", "a wave needs some ten")
    place = np.moveaxis(np.indices((cells, cells)), 0, -1).reshape(-1, 1, 2)
    lattice = place + np.array([(0, 0), (1, 0), (1, 1), (0, 1)])  # corners of the cells, unwrapped
    elements = (lattice % cells) @ np.array([cells, 1])
    return Mesh(place[:, 0] * (length / cells), elements, lattice * (length / cells), {}, None, place[:, 0])
