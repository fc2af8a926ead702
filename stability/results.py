"""Results are labelled arrays: names, dimensions, units and attributes of every Dataset; saving and opening them."""

import json
import platform
import struct
from functools import cache
from importlib.metadata import PackageNotFoundError, version
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from stability.closures import CLOSURES
from stability.codegen import write_atomically
from stability.errors import SceneError
from stability.flows import FLOWS
from stability.model import Base, Model

# name: (unit, meaning). The one list of what a result may hold.
VARIABLES = {
    "growth_rate": ("1/s", "real part of the leading eigenvalue"),
    "frequency": ("rad/s", "imaginary part of the leading eigenvalue, Doppler shift -u.xi included"),
    "wavenumber": ("1/m", "modulus of the wavevector"),
    "wave_angle": ("deg", "direction of the wavevector"),
    "neutral_wavenumber": ("1/m", "wavenumber at which the growth rate changes sign"),
    "neutral_margin": ("1", "stability polynomial there, over the sum of its terms' moduli"),
    "unstable_above": ("1", "1 where waves just shorter than the neutral one grow, 0 where they decay"),
    "unstable_longest": ("1", "1 where the longest waves of the range grow"),
    "unstable_shortest": ("1", "1 where the shortest waves of the range grow"),
    "largest_growth_rate": ("1/s", "largest growth rate over all waves of the grid"),
    "unstable_share": ("1", "part of the grid's waves whose growth rate is positive"),
    "sampled": ("1", "1 where the growth rate was evaluated, 0 where it was interpolated"),
    "sign": ("1", "certified sign of the growth rate: 1 grows, -1 decays, 0 undecided"),
    "delta": ("1", "rate of dilation tr V/||V||"),
    "scaled_wavenumber": ("1", "Lambda epsilon = mu |xi|^2 epsilon/2"),
    "scaled_growth_rate": ("1", "largest growth rate over all directions, times epsilon"),
    "worst_angle": ("deg", "direction of the largest growth, from the major principal stress axis"),
    "region": ("1", "0 stable, 1 unstable at this wavelength, 2 unstable at every wavelength"),
    "critical_scaled_wavenumber": ("1", "Lambda epsilon below which some direction is unstable; 0 if none, inf if all"),
    "r": ("m", "distance from the apex"),
    "theta": ("deg", "angle from the hopper's axis"),
    "pressure": ("m2/s2", "average stress over density"),
    "viscosity": ("m2/s", "mu = k p/||V||"),
    "strain_rate_norm": ("1/s", "||V||"),
    "dilation": ("1", "delta = tr V/||V||"),
    "momentum_residual_x": ("m/s2", "steady momentum balance of the base state along the flow's axis"),
    "momentum_residual_y": ("m/s2", "steady momentum balance of the base state across the flow's axis"),
    "mass_residual": ("1/s", "steady mass balance of the base state"),
    "exponent": (
        "1",
        "n in sup Re lambda ~ coefficient |xi|^n, of the fastest short waves; of the slowest decay if stable",
    ),
    "coefficient": ("SI", "coefficient of that law, m^n/s"),
    "short_wave_angle": ("deg", "direction of the largest coefficient, in [0, 180); NaN where all are alike"),
    "narrowing": ("1", "growing directions about a single one narrow as |xi|^-narrowing; 0 for wedges"),
    "wedge_from": ("deg", "direction at which waves begin to grow with that exponent"),
    "wedge_to": ("deg", "direction at which they cease to; less than the first where the range passes 0"),
    "fastest_growth_rate": ("1/s", "largest growth rate found over waves of every length"),
    "fastest_wavenumber": ("1/m", "wavenumber of that wave"),
    "fastest_wave_angle": ("deg", "direction of that wave"),
    "cure_below": ("SI", "value of the parameter that does not cure, just below the least that does"),
    "cure_from": ("SI", "least value of the parameter found to cure"),
    "cure_to": ("SI", "value up to which those tried from there on cure"),
    "cure_beyond": ("SI", "value just beyond that does not cure"),
    "growth_below": ("1/s", "largest growth rate at the value just below"),
    "band_width": ("m", "length of the fastest wave that is left"),
    "time": ("s", "simulated time of a snapshot"),
    "velocity_r": ("m/s", "velocity away from the apex"),
    "velocity_theta": ("m/s", "velocity across the rays, away from the axis"),
    "step": ("1", "number of the accepted time step"),
    "step_time": ("s", "simulated time at the end of the step"),
    "step_size": ("s", "size of the time step"),
    "newton_iterations": ("1", "iterations of Newton's method in the accepted try"),
    "factorisations": ("1", "factorisations of the Jacobian in the accepted try"),
    "rejected_tries": ("1", "larger steps at which Newton's method failed before"),
    "newton_update": ("1", "last update of Newton's method, relative to the scales"),
    "cells_below_floor": ("1", "elements with ||V|| below the floor"),
    "nodes_without_pressure": ("1", "nodes with p <= 0 that are not held there"),
    "backward_wall_nodes": ("1", "nodes of the wall that slide away from the apex"),
    "mass_budget": ("1", "what the mass balances miss together, relative to the scales"),
    "momentum_budget": ("1", "what the momentum balances miss together, relative to the scales"),
}


# First bytes of a netCDF file: its format, and the engines of xarray with the modules that they need.
HDF5 = {"h5netcdf": "h5netcdf", "netcdf4": "netCDF4"}
ENGINES: dict[bytes, tuple[str, dict[str, str]]] = {
    b"CDF\x01": ("netCDF-3", {"scipy": "scipy"}),
    b"CDF\x02": ("netCDF-3", {"scipy": "scipy"}),
    b"CDF\x05": ("netCDF-3 of 64-bit data", {"netcdf4": "netCDF4"}),
    b"\x89HDF\r\n\x1a\n": ("netCDF-4 (HDF5)", HDF5),
}
NEEDS = {
    "netCDF-4 (HDF5)": "the extra data: pip install 'granular-stability[data]'",
    "netCDF-3 of 64-bit data": "the package netCDF4: pip install netCDF4",
}

RESIDUALS = {"u": "momentum_residual_x", "v": "momentum_residual_y"}
RESIDUAL = "residual_"  # and the field that a balance law is for


def meaning(name: str) -> tuple[str, str]:
    """Return unit and meaning of a variable."""
    if name.startswith(RESIDUAL):
        return "SI", f"steady balance law of {name.removeprefix(RESIDUAL)}, of the base state"
    return VARIABLES[name]


@cache  # reading a package's metadata takes 3 ms, as long as a map of 2e5 samples
def package_version(name: str) -> str:
    """Return the version of a package, or "not installed"."""
    try:
        return version(name)
    except PackageNotFoundError:
        return "not installed"


def versions() -> dict[str, str]:
    """Return the versions that decide the digits of a result."""
    from stability import __version__

    names = ("numpy", "scipy", "sympy", "mpmath", "xarray")
    return {"granular-stability": __version__, "python": platform.python_version()} | {
        n: package_version(n) for n in names
    }


def dataset(variables: dict[str, tuple], coordinates: dict[str, Any], **attributes: Any) -> xr.Dataset:
    """Return a Dataset whose variables carry unit and meaning; attributes that are not text are stored as JSON."""
    ds = xr.Dataset(variables, coords=coordinates)
    for name in ds.variables:
        ds[name].attrs = dict(zip(("units", "long_name"), meaning(str(name)), strict=True))
    return described(ds, **attributes, versions=versions())


def described(ds: xr.Dataset, **attributes: Any) -> xr.Dataset:
    """Return the Dataset with further attributes (text as it is, anything else as JSON)."""
    return ds.assign_attrs(
        {k: v if isinstance(v, str) else json.dumps(v, default=float) for k, v in attributes.items()}
    )


def of_model(model: Model, parameters: dict, point: dict, base: Base, matrix: str) -> tuple[dict, dict, dict]:
    """Return the variables, coordinates and attributes that every result about a base state has."""
    dims = ("position",) if any(np.ndim(v) for v in point.values()) else ()

    def placed(value: Any) -> tuple:
        shape = np.broadcast_shapes(*(np.shape(v) for v in point.values())) if dims else ()
        return dims, np.broadcast_to(np.asarray(value, dtype=float), shape).copy()

    letters, found = base.letters(), residuals(model, base)
    if {"mu", "N", "A_xx", "A_yy"} <= letters.keys():
        found |= {
            "viscosity": letters["mu"],
            "strain_rate_norm": letters["N"],
            "dilation": letters["A_xx"] + letters["A_yy"],
        }
    return (
        {name: placed(value) for name, value in found.items()},
        {word: placed(value) for word, value in point.items()},
        {
            "closure": model.closure_name,
            "flow": model.flow_name,
            "matrix": matrix,
            "parameters": dict(parameters),
            "flow_constants": base.flow_letters,
            "wave_angle_axis": model.axis,
            "sign": "float64, not certified",
        },
    )


def residuals(model: Model, base: Base) -> dict[str, Any]:
    """Return by how much the base state misses each balance law, by the law's name.

    The first two are those of momentum where the first field is a velocity (u, v); the third is that of mass where the
    only other field is a pressure. Any other law has the name of the component of the fields that stands in its row.
    """
    components = [c for f in model.fields for c in (f if isinstance(f, tuple) else (f,))]
    names = {c: f"{RESIDUAL}{c}" for c in components}
    if model.fields[0] == ("u", "v"):
        names |= RESIDUALS
    if model.fields == (("u", "v"), "p"):
        names["p"] = "mass_residual"
    return dict(zip(names.values(), base.imbalance(), strict=True))


def save(ds: xr.Dataset, path: str | Path) -> Path:
    """Write a Dataset as netCDF (version 3, by SciPy), whole or not at all, and return the path."""
    path = Path(path)
    write_atomically(path, ds.to_netcdf(engine="scipy", format="NETCDF3_64BIT"))
    return path


def kind_of(path: Path) -> tuple[str, dict[str, str]]:
    """Return the format of a netCDF file and what reads it, by its first bytes; ("", {}) of any other file."""
    with open(path, "rb") as file:
        first = file.read(max(map(len, ENGINES)))
    return next((said for start, said in ENGINES.items() if first.startswith(start)), ("", {}))


def is_netcdf(path: Path) -> bool:
    """Return whether a file begins as one of netCDF does."""
    return bool(kind_of(path)[1])


def open_results(path: str | Path) -> xr.Dataset:
    """Return a saved Dataset, or that of another netCDF file, read into memory.

    Raises
    ------
    SceneError : a file of another format, one that is cut short, or one that needs a package which is not installed
    OSError : no such file
    """
    path = Path(path)
    format_, engines = kind_of(path)
    if not engines:
        raise SceneError(f"{path.name} is no netCDF file: it begins with the bytes of no format of netCDF")
    engine = next((name for name, module in engines.items() if find_spec(module) is not None), None)
    if engine is None:
        raise SceneError(f"{path.name} is {format_}, which needs {NEEDS[format_]}")
    try:
        # SciPy leaves a file open that it cannot read, unless it was opened for it.
        with open(path, "rb") as file:
            with xr.open_dataset(file if engine == "scipy" else path, engine=engine, decode_times=False) as ds:
                return ds.load()
    # What is not whole fails somewhere in a library: in a header, in a length, in the data themselves.
    except (EOFError, LookupError, OSError, OverflowError, RuntimeError, TypeError, ValueError, struct.error) as error:
        raise SceneError(f"{path.name} is {format_} by its first bytes, and cannot be read: {told(error)}") from error


def told(error: Exception) -> str:
    """Return the first line of what a library says, which may go on with advice."""
    return next((line.strip() for line in str(error).splitlines() if line.strip()), type(error).__name__)


def registered(ds: xr.Dataset) -> tuple[str, str]:
    """Return the closure's and the flow's names of a result, or raise `SceneError` where they are not registered.

    A result may come from anywhere: what it names is never looked for in files.
    """
    for registry in (CLOSURES, FLOWS):
        registry.place(ds.attrs[registry.kind])
    return ds.attrs["closure"], ds.attrs["flow"]


def assumptions(ds: xr.Dataset) -> dict[str, str]:
    """Return what was assumed and not printed in the paper, with the reasons."""
    return json.loads(ds.attrs.get("assumed", "{}"))
