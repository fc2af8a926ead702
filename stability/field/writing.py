"""A field map as files: netCDF through `results.save`, and VTK for ParaView."""

import base64
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from stability.codegen import write_atomically
from stability.errors import SceneError
from stability.field.grids import Field
from stability.timestepper.paraview import data_array, opening, structured_grid

if TYPE_CHECKING:
    from xarray import Dataset

VERTEX = 1  # VTK's cell of one point


def write_vtk(ds: "Dataset", field: Field, path: str | Path) -> Path:
    """Write a field map beside the field it was made from, and return the path: .vts on a grid, .vtu elsewhere.

    The arrays stand where the field's values stood. ``inf`` (growth without bound) is written as it is.

    Raises
    ------
    SceneError : the map is not one of this field, or the path has the other format's ending
    """
    path = Path(path)
    ending = ".vts" if field.structured else ".vtu"
    if path.suffix != ending:
        raise SceneError(f"{path.name}: this field is written as {ending}")
    if tuple(ds["verdict"].shape) != field.x.shape:
        raise SceneError(
            f"the map has the shape {ds['verdict'].shape}, the field {field.x.shape}: give the map's own field"
        )
    arrays = {str(n): ds[n].values.astype(float) for n in ds.data_vars if ds[n].dims == field.dims}
    arrays |= {letter: values for letter, values in field.values.items() if letter not in arrays}
    text = on_grid(field, arrays) if field.structured else on_cells(field, arrays)
    write_atomically(path, text.encode())
    return path


def on_grid(field: Field, arrays: dict[str, np.ndarray]) -> str:
    """Return a .vts file."""
    return structured_grid(np.stack([field.x, field.y, np.zeros(field.x.shape)], axis=-1), arrays)


def on_cells(field: Field, arrays: dict[str, np.ndarray]) -> str:
    """Return a .vtu file with the field's own cells, or with a vertex at each point."""
    n, mesh = field.x.size, field.mesh
    places = np.stack([field.x, field.y], axis=-1) if mesh is None else mesh.points
    count = np.arange(n)
    connectivity, offsets, types = (
        (count, count + 1, np.full(n, VERTEX)) if mesh is None else (mesh.connectivity, mesh.offsets, mesh.types)
    )
    data = "".join(data_array(name, values[:, None]) for name, values in arrays.items())
    place = "CellData" if mesh is not None and mesh.place == "cell" else "PointData"
    points = np.concatenate([places, np.zeros((len(places), 1))], axis=1)[:, None]
    return (
        f"{opening('UnstructuredGrid')}<UnstructuredGrid>\n"
        f'<Piece NumberOfPoints="{len(places)}" NumberOfCells="{len(offsets)}">\n'
        f"<Points>\n{data_array('points', points)}</Points>\n<Cells>\n{whole('connectivity', connectivity)}"
        f"{whole('offsets', offsets)}{whole('types', types, 'UInt8')}</Cells>\n"
        f"<{place}>\n{data}</{place}>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>\n"
    )


def whole(name: str, values: np.ndarray, kind: str = "Int64") -> str:
    """Return an array of whole numbers as base64 text."""
    content = np.asarray(values, dtype={"Int64": "<i8", "UInt8": "u1"}[kind]).tobytes()
    text = base64.b64encode(np.array(len(content), dtype="<u8").tobytes() + content).decode()
    return f'<DataArray type="{kind}" Name="{name}" format="binary">{text}</DataArray>\n'
