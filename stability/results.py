"""Results are labelled arrays: names, dimensions, units and attributes of every Dataset; saving and opening them."""

import json
import platform
from functools import cache
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from stability.codegen import write_atomically
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
    "dilation": ("1", "delta = tr A of the base state"),
    "momentum_residual_x": ("m/s2", "steady momentum balance of the base state along the flow's axis"),
    "momentum_residual_y": ("m/s2", "steady momentum balance of the base state across the flow's axis"),
    "mass_residual": ("1/s", "steady mass balance of the base state"),
}


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
        unit, meaning = VARIABLES[str(name)]
        ds[name].attrs = {"units": unit, "long_name": meaning}
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

    letters, imbalance = base.letters(), base.imbalance()
    found = {"momentum_residual_x": imbalance[0], "momentum_residual_y": imbalance[1], "mass_residual": imbalance[2]}
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


def save(ds: xr.Dataset, path: str | Path) -> Path:
    """Write a Dataset as netCDF (version 3, by SciPy), whole or not at all, and return the path."""
    path = Path(path)
    write_atomically(path, ds.to_netcdf(engine="scipy", format="NETCDF3_64BIT"))
    return path


def open_results(path: str | Path) -> xr.Dataset:
    """Return a saved Dataset, read into memory."""
    with xr.open_dataset(path, engine="scipy", decode_times=False) as ds:
        return ds.load()


def assumptions(ds: xr.Dataset) -> dict[str, str]:
    """Return what was assumed and not printed in the paper, with the reasons."""
    return json.loads(ds.attrs.get("assumed", "{}"))
