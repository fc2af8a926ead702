"""A field: velocity, pressure and whatever else a closure needs, at the points of a grid or at scattered points."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from stability.errors import SceneError

FEWEST = 5  # points each way of a grid: derivatives over every second point need five
SCATTERED = 45  # points at least where there is no grid: the wide stencil of `gradients` takes 40 neighbours


@dataclass(frozen=True, eq=False)
class Mesh:
    """The cells of an unstructured field, kept for writing it back.

    Attributes
    ----------
    points : array (n, 2), in m
    connectivity, offsets, types : as in a .vtu file
    place : "point" or "cell": where the values of the field live
    """

    points: np.ndarray
    connectivity: np.ndarray
    offsets: np.ndarray
    types: np.ndarray
    place: str


@dataclass(frozen=True, eq=False)
class Field:
    """A flow in Cartesian coordinates of the plane.

    Attributes
    ----------
    x, y : coordinates in m; (rows, columns) on a structured grid, (points,) elsewhere
    values : ``{letter of the closure: array}``, such as u and v (m/s) and p (stress over density, m2/s2)
    dims : names of the axes of these arrays in a result
    coordinates : further coordinates of a result, as xarray takes them
    source : where the field comes from, in words
    mesh : the cells of an unstructured field, if they are known
    """

    x: np.ndarray
    y: np.ndarray
    values: Mapping[str, np.ndarray]
    dims: tuple[str, ...]
    coordinates: Mapping[str, Any]
    source: str = "arrays"
    mesh: Mesh | None = None

    def __post_init__(self) -> None:
        shape = self.x.shape
        wrong = [n for n, a in {"y": self.y, **self.values}.items() if a.shape != shape]
        if wrong:
            raise SceneError(f"the field's x has the shape {shape}, but {', '.join(wrong)} another one")
        if not (np.isfinite(self.x).all() and np.isfinite(self.y).all()):
            raise SceneError("the field has coordinates that are not finite: leave such points out, or fill them")
        if self.structured and min(shape) < FEWEST:
            raise SceneError(f"a grid of {shape[0]} x {shape[1]} points is too small: {FEWEST} each way are needed")
        if not self.structured and self.x.size < SCATTERED:
            raise SceneError(f"{self.x.size} points without a grid are too few: {SCATTERED} are needed")

    @property
    def structured(self) -> bool:
        """Whether the points form rows and columns."""
        return self.x.ndim == 2

    @property
    def longest(self) -> float:
        """The shorter side (m) of the box around the field: no longer wave has a direction there."""
        return float(min(np.ptp(self.x), np.ptp(self.y)))


def field_from(x: Any, y: Any, density: float = 1.0, **values: Any) -> Field:
    """Return a field from plain arrays.

    Parameters
    ----------
    x, y : coordinates in m. 1-D with 2-D values (y, x): a rectilinear grid. 2-D: a curvilinear grid. 1-D with 1-D
        values: scattered points
    density : kg/m3, by which ``p`` is divided; 1 where it is stress over density already
    values : ``u``, ``v`` (m/s, Cartesian), ``p`` (positive in compression), and whatever else the closure needs;
        NaN marks points without a value

    Raises
    ------
    SceneError : arrays that do not fit, or too few points
    """
    x, y = np.asarray(x, float), np.asarray(y, float)
    arrays = {name: np.asarray(value, float) for name, value in values.items()}
    if not arrays:
        raise SceneError("a field needs values: u, v and p for most closures")
    if not (np.isfinite(density) and density > 0):
        raise SceneError(f"density = {density!r} kg/m3 lies outside (0, inf) kg/m3")
    if "p" in arrays:
        arrays["p"] = arrays["p"] / density
    if x.ndim == y.ndim == 1 and next(iter(arrays.values())).ndim == 2:
        X, Y = np.meshgrid(x, y)
        return Field(X, Y, arrays, ("y", "x"), {"x": ("x", x), "y": ("y", y)})
    if x.ndim == 2:
        return Field(x, y, arrays, ("j", "i"), {"x": (("j", "i"), x), "y": (("j", "i"), y)})
    return Field(x, y, arrays, ("point",), {"x": ("point", x), "y": ("point", y)})
