"""Fields from files and labelled arrays: netCDF, xarray, the time-stepper's own results, VTK."""

from collections.abc import Mapping
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np

from stability.errors import SceneError
from stability.field import vtkxml
from stability.field.grids import Field, Mesh
from stability.results import is_netcdf, open_results

XML = (".vtu", ".vts")
LEGACY = (".vtk", ".vtr", ".vti", ".vtp", ".pvtu", ".pvts")
NAMES = {"u": ("u", "velocity:0"), "v": ("v", "velocity:1"), "p": ("p", "pressure")}  # tried where nothing is said
FLAT = 1e-9  # of the extent: how far points may lie off the plane z = const


def read_field(
    source: Any, fields: Mapping[str, str] | None = None, time: float | None = None, density: float = 1.0
) -> Field:
    """Return the field in a file or in an xarray Dataset.

    Parameters
    ----------
    source : path of a netCDF, .vtu or .vts file; of another VTK file with the extra ``vtk``, of a netCDF-4 (HDF5) file
        with the extra ``data``; or a Dataset. A Dataset with the dimensions r and theta (degrees), such as the result
        of a march, is turned into Cartesian components; another one has coordinates x and y, 1-D or 2-D
    fields : ``{letter of the closure: name in the source}``; ``"velocity:1"`` is the second component of a vector.
        Letters left out are looked for as u, v (or velocity) and p (or pressure)
    time : s, of the snapshot nearest to it; None: the last one
    density : kg/m3, by which p is divided; 1 where it is stress over density already

    Raises
    ------
    SceneError : a file that cannot be read, a name that is not there, points that do not lie in a plane
    """
    if isinstance(source, str | Path):
        path = Path(source)
        if not path.is_file():
            raise SceneError(f"{path.name}: there is no such file: {path.absolute()}")
        if path.suffix in (*XML, *LEGACY):
            return scaled(of_piece(piece_of(path), fields, path.name), density)
        if not is_netcdf(path):
            raise SceneError(
                f"{path.name} is neither a netCDF nor a VTK file: fields are read from .nc, .vtu, .vts and other files "
                "of VTK; give what you have read yourself to stability.field_from"
            )
        return scaled(of_dataset(open_results(path), fields, time, path.name), density)
    return scaled(of_dataset(source, fields, time, "an xarray Dataset"), density)


def scaled(field: Field, density: float) -> Field:
    """Return the field with its pressure over the density."""
    if not (np.isfinite(density) and density > 0):
        raise SceneError(f"density = {density!r} kg/m3 lies outside (0, inf) kg/m3")
    values = {n: a / density if n == "p" else a for n, a in field.values.items()}
    return Field(field.x, field.y, values, field.dims, field.coordinates, field.source, field.mesh)


def chosen(
    fields: Mapping[str, str] | None, held: Mapping[str, np.ndarray], where: str, axes: int = 1
) -> dict[str, np.ndarray]:
    """Return the arrays that a field is made of, by the closure's letters; what has more axes is a vector."""
    wanted: dict[str, tuple[str, ...]] = {letter: (name,) for letter, name in (fields or {}).items()}
    wanted |= {letter: names for letter, names in NAMES.items() if letter not in wanted}
    found = {}
    for letter, names in wanted.items():
        for name in names:
            array, _, component = name.partition(":")
            if array in held and bool(component) == (held[array].ndim > axes):
                found[letter] = np.asarray(held[array][..., int(component)] if component else held[array], float)
                break
        else:
            listed = ", ".join(f"{n}:0..{a.shape[-1] - 1}" if a.ndim > axes else n for n, a in held.items())
            raise SceneError(
                f"{where} has no {' and no '.join(names)} for {letter}: it holds {listed or 'nothing'}; "
                f'say which, as in fields={{"{letter}": "..."}}'
            )
    return found


def of_dataset(ds: Any, fields: Mapping[str, str] | None, time: float | None, source: str) -> Field:
    """Return the field in a Dataset."""
    if "time" in ds.dims:
        ds = ds.isel(time=-1) if time is None else ds.sel(time=time, method="nearest")
        source += f", t = {float(ds.time):g} s"
    if {"r", "theta"} <= set(ds.dims):
        return polar(ds, fields, source)
    if not {"x", "y"} <= set(ds.variables):
        raise SceneError(f"{source} has no coordinates x and y (nor r and theta): rename those it has")
    x, y = ds["x"], ds["y"]
    dims = ("y", "x") if x.ndim == y.ndim == 1 and x.dims != y.dims else x.dims
    if dims == ("y", "x") and (x.dims, y.dims) != (("x",), ("y",)):
        ds = ds.rename({x.dims[0]: "x", y.dims[0]: "y"})
    held = {str(n): ds[n].transpose(*dims).values for n in ds.data_vars if set(ds[n].dims) == set(dims)}
    values = chosen(fields, held, source, len(dims))
    if dims == ("y", "x") and x.ndim == 1:
        X, Y = np.meshgrid(np.asarray(x.values, float), np.asarray(y.values, float))
        return Field(X, Y, values, dims, {"x": ("x", x.values), "y": ("y", y.values)}, source)
    X, Y = (np.asarray(c.transpose(*dims).values, float) for c in (x, y))
    return Field(X, Y, values, tuple(map(str, dims)), {"x": (dims, X), "y": (dims, Y)}, source)


def polar(ds: Any, fields: Mapping[str, str] | None, source: str) -> Field:
    """Return the field on a polar grid, x along theta = 0."""
    names = {"u": "velocity_r", "v": "velocity_theta", "p": "pressure"} | dict(fields or {})
    dims = ("r", "theta")
    held = {str(n): ds[n].transpose(*dims).values for n in ds.data_vars if set(ds[n].dims) == set(dims)}
    values = chosen(names, held, source, 2)
    angle = np.deg2rad(ds["theta"].values)[None, :]
    r, c, s = ds["r"].values[:, None], np.cos(angle), np.sin(angle)
    along, across = values["u"], values["v"]
    values |= {"u": along * c - across * s, "v": along * s + across * c}
    x, y = r * c, r * s
    place = {"r": ("r", ds["r"].values), "theta": ("theta", ds["theta"].values), "x": (dims, x), "y": (dims, y)}
    return Field(x, y, values, dims, place, source)


def of_piece(piece: vtkxml.Piece, fields: Mapping[str, str] | None, source: str) -> Field:
    """Return the field of a VTK file: at its points where they hold the arrays, else at the centres of its cells."""
    points = np.asarray(piece.points, float)
    extent = np.ptp(points, axis=0)
    if extent[2] > FLAT * extent.max():
        raise SceneError(f"{source} is not flat: z runs over {extent[2]:g} m; cut a plane z = const out of it first")
    try:
        values, place = chosen(fields, piece.at_points, source), "point"
    except SceneError:
        if not piece.at_cells:
            raise
        values, place = chosen(fields, piece.at_cells, f"{source} (cells)"), "cell"
    if piece.kind == "StructuredGrid":
        return of_grid(piece, values, place, source)
    cells = piece.topology
    mesh = Mesh(points[:, :2], cells["connectivity"], cells["offsets"], cells["types"], place)
    x, y = (points if place == "point" else centres(points, cells))[:, :2].T
    return Field(x, y, values, (place,), {"x": (place, x), "y": (place, y)}, source, mesh)


def of_grid(piece: vtkxml.Piece, values: dict, place: str, source: str) -> Field:
    """Return the field of a structured grid, at its points or at the centres of its cells."""
    shape = tuple(n for n in piece.shape if n > 1)
    if len(shape) != 2:
        raise SceneError(
            f"{source} is a grid of {' x '.join(map(str, piece.shape[::-1]))} points: two-dimensional only"
        )
    x, y = (np.asarray(piece.points[:, i], float).reshape(shape) for i in (0, 1))
    if place == "cell":
        x, y = ((c[1:, 1:] + c[:-1, 1:] + c[1:, :-1] + c[:-1, :-1]) / 4 for c in (x, y))
    dims = ("j", "i")
    return Field(
        x, y, {n: a.reshape(x.shape) for n, a in values.items()}, dims, {"x": (dims, x), "y": (dims, y)}, source
    )


def centres(points: np.ndarray, cells: Mapping[str, np.ndarray]) -> np.ndarray:
    """Return the mean of each cell's points."""
    starts = np.concatenate([[0], cells["offsets"][:-1]]).astype(int)
    total = np.add.reduceat(points[cells["connectivity"]], starts, axis=0)
    return total / np.diff([*starts, len(cells["connectivity"])])[:, None]


def piece_of(path: Path) -> vtkxml.Piece:
    """Return what a VTK file holds; VTK itself (extra ``vtk``) reads what `vtkxml` does not."""
    reason = f"{path.name}: {path.suffix} files are read by VTK itself, .vtu and .vts files without it"
    if path.suffix in XML:
        try:
            return vtkxml.read(path)
        except vtkxml.NeedsVTKError as e:
            reason = str(e)
    if find_spec("vtkmodules") is None:
        raise SceneError(f"{reason}; or install the extra vtk (pip install 'granular-stability[vtk]')")
    from stability.field.vtklibrary import xml_of

    return vtkxml.parsed(xml_of(path), path.name)
