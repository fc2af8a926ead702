"""The result over a field as a Dataset: names, units and meanings."""

from typing import Any

import numpy as np
from xarray import Dataset

from stability import results
from stability.field.grids import Field
from stability.field.judging import CODES

# name: (unit, meaning). What a field map holds.
VARIABLES = {
    "verdict": ("1", "0 masked, 1 stable, 2 waves of finite length grow, 3 short waves grow at a bounded rate, "
                     "4 ill-posed: short waves grow without bound, 5 undecided in float64"),
    "exponent": ("1", "n in sup Re lambda ~ coefficient |xi|^n, of short waves that grow"),
    "coefficient": ("SI", "coefficient of that law, m^n/s"),
    "growth_rate": ("1/s", "largest growth rate over waves of every length; inf where there is no bound"),
    "wavelength": ("m", "length of the fastest wave; 0 where growth is largest in the limit of short waves"),
    "wave_angle": ("deg", "direction of its wavevector from the x axis, in [0, 180)"),
    "grid_wavelength": ("m", "wavelength that the mesh resolves least"),
    "grid_growth_rate": ("1/s", "largest growth rate over all directions at that wavelength"),
    "grid_wave_angle": ("deg", "direction of that wavevector from the x axis, in [0, 180)"),
    "grid_e_folds": ("1", "e-folds that this wave makes in the given time"),
    "strain_rate_norm": ("1/s", "||V|| of the field"),
    "dilation": ("1", "delta = tr V/||V|| of the field"),
    "pressure": ("m2/s2", "average stress over density"),
    "gradient_error": ("1", "estimated error of the velocity gradient, relative to ||V||"),
    "firm": ("1", "1 where the verdict on short waves holds over the error bars of the gradients"),
    "x": ("m", "Cartesian coordinate"),
    "y": ("m", "Cartesian coordinate"),
    "r": ("m", "distance from the apex"),
    "theta": ("deg", "angle from the hopper's axis"),
    "time": ("s", "simulated time of a snapshot"),
}  # fmt: skip


def labelled(field: Field, variables: dict[str, np.ndarray], **attributes: Any) -> Dataset:
    """Return flat arrays over a field's points as a Dataset on the field's axes."""
    shape = field.x.shape
    ds = Dataset({n: (field.dims, np.reshape(a, shape)) for n, a in variables.items()}, coords=dict(field.coordinates))
    for name in ds.variables:
        if name in VARIABLES:
            ds[name].attrs = dict(zip(("units", "long_name"), VARIABLES[str(name)], strict=True))
    ds["verdict"].attrs |= {"flag_values": np.arange(len(CODES), dtype=np.int8), "flag_meanings": " ".join(CODES)}
    return results.described(ds, request="field_map", versions=results.versions(), **attributes)
