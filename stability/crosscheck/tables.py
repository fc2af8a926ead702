"""Names, units and meanings of the cross-check's variables, and its result as Markdown tables."""

from collections.abc import Sequence

import numpy as np
import xarray as xr

from stability.crosscheck.saturation import NUMBERS

WAYS = (
    "D on the axis",
    "D anywhere",
    "D at the global mode's place",
    "symbol of the mesh",
    "global mode",
    "first waves of a run",
)

VARIABLES = {
    "way": ("", "how the fastest wave was found"),
    "cell_size": ("1", "cell over wavelength"),
    "cell_step": ("1", "time step over the time of the run"),
    "cell_wavenumber": ("1/m", "modulus of the wavevector"),
    "cell_wave_angle": ("deg", "direction of the wavevector from the axis of extension"),
    "cell_delta": ("1", "rate of dilation of the cell"),
    "cell_epsilon": ("s", "perturbation"),
    "cell_drift": ("m/s", "speed of the material along the streamlines of a simple shear; 0 for pure strain"),
    "cell_growth_predicted": ("1/s", "growth rate by D"),
    "cell_frequency_predicted": ("rad/s", "frequency by D"),
    "cell_growth": ("1/s", "growth rate in the time-stepper"),
    "cell_frequency": ("rad/s", "frequency in the time-stepper"),
    "cell_growth_limit": ("1/s", "growth rate in the time-stepper, extrapolated to vanishing cells and steps"),
    "cell_frequency_limit": ("rad/s", "frequency in the time-stepper, extrapolated to vanishing cells and steps"),
    "cell_error": ("1", "distance of the limit from D, over the modulus of the eigenvalue"),
    "cell_error_h": ("1", "the same for vanishing steps on each mesh"),
    "cell_error_dt": ("1", "the same for vanishing cells with each step"),
    "cell_order_h": ("1", "order of convergence in the cell size"),
    "cell_order_dt": ("1", "order of convergence in the step"),
    "neutral_delta": ("1", "rate of dilation of the cell"),
    "neutral_epsilon": ("s", "perturbation"),
    "neutral_wave_angle": ("deg", "direction of the ray from the axis of extension"),
    "neutral_predicted": ("1/m", "wavenumber on the neutral curve of D"),
    "neutral_measured": ("1/m", "wavenumber at which growth changes sign in the time-stepper"),
    "symbol_elements": ("1", "elements of the half hopper"),
    "symbol_r": ("m", "distance of the node from the apex"),
    "symbol_theta": ("deg", "angle of the node from the axis"),
    "symbol_wavenumber": ("1/m", "modulus of the wavevector"),
    "symbol_wave_angle": ("deg", "direction of the wavevector from e_r"),
    "symbol_size": ("m", "size of the node's control volume"),
    "symbol_growth_predicted": ("1/s", "growth rate by D at the node's place"),
    "symbol_growth": ("1/s", "growth rate by the mesh's own symbol"),
    "symbol_matrix_error": ("1", "largest entry of the difference over the largest of D"),
    "symbol_eigenvalue_error": ("1", "difference of the leading eigenvalues over that of D"),
    "symbol_matrix_order": ("1", "order of convergence of the matrix"),
    "symbol_eigenvalue_order": ("1", "order of convergence of the leading eigenvalue"),
    "first_r": ("m", "distance from the apex"),
    "first_theta": ("deg", "angle from the axis"),
    "first_wavenumber": ("1/m", "modulus of the wavevector"),
    "first_wave_angle": ("deg", "direction of the wavevector from e_r"),
    "first_growth": ("1/s", "growth rate"),
    "first_frequency": ("rad/s", "frequency, NaN where it was not seen"),
    "mode_growth": ("1/s", "growth rate of a mode of the discrete Jacobian"),
    "mode_frequency": ("rad/s", "frequency of a mode of the discrete Jacobian"),
    "mode_residual": ("1", "residual of the eigenvalue equation, relative"),
    "mode_stepped_growth": ("1/s", "growth rate of the leading mode in the time-stepper, Euler's factor removed"),
    "mode_stepped_frequency": ("rad/s", "frequency of the leading mode in the time-stepper, Euler's factor removed"),
    "mode_error": ("1", "distance of the two eigenvalues, relative"),
    "run_time": ("s", "simulated time"),
    "run_difference": ("m/s", "root mean square of the velocity that noise in the initial state adds"),
    "saturation_epsilon": ("s", "perturbation"),
    "saturation_cells": ("1", "cells in a wavelength"),
    "saturation_wavelength": ("m", "length of the cell"),
    "saturation_end": ("s", "time at which the run ended"),
    "saturation_time": ("s", "simulated time"),
    "saturation_course": ("m/s", "half the range of the velocity along the fronts, over time"),
    "saturation_rate_predicted": ("1/s", "||V|| at which the shortest waves stop to grow in the band"),
    "saturation_thickness_predicted": ("m", "thickness of a band of that ||V|| with the measured jump"),
} | {f"saturation_{name}": (unit, f"{meaning}, at the end") for name, (unit, meaning) in NUMBERS.items()}


def table(head: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    """Return a Markdown table."""
    return "\n".join("| " + " | ".join(row) + " |" for row in (head, ["---"] * len(head), *rows)) + "\n"


def cell_table(ds: xr.Dataset) -> str:
    """Return growth in the periodic cell against D, a row for each wave."""
    head = ("delta", "epsilon (s)", "drift (m/s)", "wavenumber (1/m)", "angle (deg)", "D (1/s)", "time-stepper (1/s)")
    names = ("delta", "epsilon", "drift", "wavenumber", "wave_angle")
    rows = []
    for i in range(ds.sizes["wave"]):
        one = ds.isel(wave=i)
        predicted, limit = (
            told(one[f"cell_growth_{s}"].item(), one[f"cell_frequency_{s}"].item(), bool(one.cell_drift))
            for s in ("predicted", "limit")
        )
        given = (f"{one[f'cell_{n}'].item():.4g}" for n in names)
        orders = (f"{one[f'cell_order_{n}'].item():.2f}" for n in ("h", "dt"))
        rows.append((*given, predicted, limit, f"{one.cell_error.item():.1e}", *orders))
    return table((*head, "relative error", "order in h", "order in dt"), rows)


def told(growth: float, frequency: float, oscillates: bool) -> str:
    """Return an eigenvalue in words."""
    return f"{growth:.6g} {frequency:+.5g} i" if oscillates else f"{growth:.6g}"


def neutral_table(ds: xr.Dataset) -> str:
    """Return the places where growth changes sign."""
    names = ("delta", "epsilon", "wave_angle", "predicted", "measured")
    rows = []
    for i in range(ds.sizes["ray"]):
        values = [ds[f"neutral_{n}"].values[i] for n in names]
        rows.append((*(f"{v:.6g}" for v in values), f"{abs(values[4] / values[3] - 1):.1e}"))
    head = ("delta", "epsilon (s)", "angle (deg)", "neutral curve of D (1/m)", "change of sign (1/m)", "relative error")
    return table(head, rows)


def symbol_table(ds: xr.Dataset) -> str:
    """Return the largest errors of the discrete symbol over places and waves, a row for each mesh."""
    over = ("place", "symbol_wave")
    rows: list[Sequence[str]] = []
    for i, n in enumerate(ds.symbol_elements.values):
        one = ds.isel(symbol_mesh=i)
        matrix, value = (one[f"symbol_{e}_error"].max(over).item() for e in ("matrix", "eigenvalue"))
        rows.append((f"{n:.0f}", f"{1000 * one.symbol_size.mean().item():.3g}", f"{matrix:.1e}", f"{value:.1e}"))
    ranges = [(ds[f"symbol_{e}_order"].min().item(), ds[f"symbol_{e}_order"].max().item()) for e in ERRORS]
    rows.append(("order", "", *(f"{low:.2f} to {high:.2f}" for low, high in ranges)))
    return table(("elements", "cell (mm)", "largest error of D", "largest error of its leading eigenvalue"), rows)


def first_table(ds: xr.Dataset) -> str:
    """Return the fastest waves in the hopper, a row for each way to find them."""
    names = ("r", "theta", "wavenumber", "wave_angle", "growth")
    values = np.array([ds[f"first_{n}"].values for n in names]).T
    rows = [
        (str(way), *(f"{v:.3g}" for v in row[:3]), f"{100 * 2 * np.pi / row[2]:.2g}", *(f"{v:.3g}" for v in row[3:]))
        for way, row in zip(ds.way.values, values, strict=True)
    ]
    head = ("", "r (m)", "theta (deg)", "wavenumber (1/m)", "wavelength (cm)", "angle from e_r (deg)", "growth (1/s)")
    return table(head, rows)


def saturation_table(ds: xr.Dataset) -> str:
    """Return the bands of the periodic cell, a row for each run."""
    names = ("epsilon", "cells", "amplitude", "band_jump", "band_rate", "rate_predicted", "band_delta", "least_delta")
    rows = []
    for i in range(ds.sizes["course"]):
        one = {str(n).removeprefix("saturation_"): v.values[i] for n, v in ds.items() if v.dims == ("course",)}
        length = one["wavelength"]
        thickness = [f"{one[n] / length:.5f}" for n in ("thickness", "thickness_predicted")]
        cells = f"{one['thickness'] / length * one['cells']:.0f}"
        rows.append((*(f"{one[n]:.4g}" for n in names), f"{one['stable_share']:.2f}", *thickness, cells))
    head = ("epsilon (s)", "cells", "amplitude (m/s)", "jump (m/s)", "rate in the band (1/s)", "its limit (1/s)")
    more = ("delta in the band", "least delta", "share that no wave destabilises", "thickness/wavelength")
    return table((*head, *more, "its limit", "cells in the band"), rows)


def markdown(ds: xr.Dataset) -> str:
    """Return every table that a result has data for, under headings."""
    found = ["# The time-stepper against the linear theory\n"]
    for variable, heading, write in SECTIONS:
        if variable in ds:
            found += [f"## {heading}\n", write(ds)]
        if variable == "first_r" and variable in ds:
            found.append(REASONS)
            found.append(MODE.format(**{n: ds[f"mode_{n}"].item() for n in MODE_NUMBERS}, **leading_mode(ds)))
    return "\n".join(found)


def leading_mode(ds: xr.Dataset) -> dict[str, float]:
    """Return the eigenvalue of the leading mode."""
    return {"growth": ds.mode_growth.values[0], "frequency": ds.mode_frequency.values[0]}


ERRORS = ("matrix", "eigenvalue")
MODE_NUMBERS = ("stepped_growth", "stepped_frequency", "error")
MODE = """The leading eigenvalue of the discrete Jacobian is {growth:.5f} {frequency:+.5f} i 1/s; the time-stepper, from
1e-8 of its mode and with Euler's factor 1/(1 - lambda dt) removed, shows {stepped_growth:.5f}
{stepped_frequency:+.5f} i: a relative difference of {error:.1e}.
"""
REASONS = """Why they differ. D takes the flow for uniform over a wave. It is not: the fastest direction turns with the
ray, so that a straight front is at its best over a part of its length only (at epsilon = 1e-4 a wave of 80 1/m at 40
degrees grows at 131 1/s at 1 m on the axis, and at 89 on the ray of 4 degrees, one wavelength away), and D's maximum
is nearly flat along the hopper, which leaves the place to boundaries and mesh. A global mode must hold together while
the flow carries it through all this; its growth lies below that of the best place. The waves of a run grow on a flow
that the first 0.02 s have changed, and have been seen for a few times their growth time only. The mesh's own symbol
differs from D at second order (above): with ten cells in a wave, polar meshes are too stiff and diamond ones too soft.
"""

SECTIONS = (
    ("cell_error", "Plane waves in a periodic cell", cell_table),
    ("neutral_predicted", "Where growth changes sign", neutral_table),
    ("symbol_size", "The discrete symbol of the hopper's mesh", symbol_table),
    ("first_r", "The fastest waves in the hopper", first_table),
    ("saturation_cells", "Bands in a periodic cell", saturation_table),
)
