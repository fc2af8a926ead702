"""Fields of a march as files for ParaView: a structured grid (.vts) for each snapshot, and their times (.pvd)."""

import base64
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from stability.codegen import write_atomically

if TYPE_CHECKING:
    from xarray import Dataset

SCALARS = ("velocity_r", "velocity_theta", "pressure", "strain_rate_norm", "dilation", "viscosity")


def write_paraview(ds: "Dataset", folder: str | Path, name: str = "march") -> Path:
    """Write the snapshots of a march into a folder, and return the path of the collection to open.

    The radius varies fastest over the points, which lie in the plane z = 0; ``velocity`` is Cartesian.
    """
    if not {"time", "r", "theta"} <= set(ds.dims):
        raise ValueError("only the result of a march has fields over time, r and theta")
    folder = Path(folder)
    angle = np.deg2rad(ds.theta.values)[:, None]
    c, s = np.cos(angle), np.sin(angle)
    flat = np.zeros((ds.sizes["theta"], ds.sizes["r"]))
    points = np.stack([ds.r.values * c, ds.r.values * s, flat], axis=-1)
    entries = []
    for i, time in enumerate(ds.time.values):
        now = {name: ds[name].values[i].T for name in SCALARS if name in ds}
        u, v = now["velocity_r"], now["velocity_theta"]
        arrays = {"velocity": np.stack([u * c - v * s, u * s + v * c, flat], axis=-1)} | now
        file = f"{name}_{i:04d}.vts"
        write_atomically(folder / file, structured_grid(points, arrays).encode())
        entries.append(f'    <DataSet timestep="{float(time)!r}" group="" part="0" file="{file}"/>\n')
    collection = folder / f"{name}.pvd"
    text = f"{opening('Collection')}  <Collection>\n{''.join(entries)}  </Collection>\n</VTKFile>\n"
    write_atomically(collection, text.encode())
    return collection


def opening(kind: str) -> str:
    """Return the head of a file."""
    form = 'version="1.0" byte_order="LittleEndian" header_type="UInt64"'
    return f'<?xml version="1.0"?>\n<VTKFile type="{kind}" {form}>\n'


def structured_grid(points: np.ndarray, arrays: dict[str, np.ndarray]) -> str:
    """Return a .vts file of points (rows, columns, 3) and of arrays (rows, columns) or (rows, columns, 3)."""
    extent = f"0 {points.shape[1] - 1} 0 {points.shape[0] - 1} 0 0"  # the first index varies fastest
    data = "".join(data_array(name, values) for name, values in arrays.items())
    return (
        f'{opening("StructuredGrid")}<StructuredGrid WholeExtent="{extent}">\n<Piece Extent="{extent}">\n'
        f"<Points>\n{data_array('points', points)}</Points>\n<PointData>\n{data}</PointData>\n"
        "</Piece>\n</StructuredGrid>\n</VTKFile>\n"
    )


def data_array(name: str, values: np.ndarray) -> str:
    """Return an array as base64 text: its length in bytes, then float64 numbers."""
    content = np.ascontiguousarray(values, dtype="<f8").tobytes()
    text = base64.b64encode(np.array(len(content), dtype="<u8").tobytes() + content).decode()
    components = values.shape[2] if values.ndim == 3 else 1
    named = f'type="Float64" Name="{name}" NumberOfComponents="{components}" format="binary"'
    return f"<DataArray {named}>{text}</DataArray>\n"
