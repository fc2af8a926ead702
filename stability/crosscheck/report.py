"""The whole cross-check as one labelled result."""

from collections.abc import Mapping, Sequence
from itertools import pairwise
from typing import Any

import numpy as np
import xarray as xr

from stability import results
from stability.crosscheck import first_waves, saturation, symbol, waves
from stability.crosscheck.modes import leading_modes, rate_of, stepped
from stability.crosscheck.orders import extrapolated, observed
from stability.crosscheck.symbol import polar_base
from stability.crosscheck.tables import VARIABLES, WAYS
from stability.crosscheck.theory import unit
from stability.errors import SceneError
from stability.progress import Report
from stability.timestepper.hopper import hopper_problem
from stability.timestepper.march import noise

PARTS = ("cell", "neutral", "symbol", "hopper", "saturation")
COST = {"cell": 10, "neutral": 3, "symbol": 1, "hopper": 20, "saturation": 20}  # seconds, roughly, for the progress
SATURATION = ((1e-4, (32, 64, 128, 256)), (4e-3, (32, 64, 128, 256, 512)))  # epsilon (s), cells in a wavelength

Found = dict[str, tuple[tuple[str, ...], Any]]


def cell_parameters(base: Any, parameters: Mapping[str, float]) -> dict[str, float]:
    """Return the words of a periodic cell with friction, strain rate and pressure of a hopper at a point."""
    (pressure, *_), strain = base.state[1], base.letters()["N"]
    return {
        "friction_angle": parameters["friction_angle"],
        "strain_rate": float(strain),
        "pressure": float(pressure),
    }


def cell_part(closure: Any, parameters: dict, chosen: Sequence[waves.Wave] | None, sizes: Mapping) -> Found:
    """Return growth in the periodic cell against D."""
    cells, numbers = sizes.get("cells", waves.CELLS), sizes.get("numbers", waves.STEPS)
    table = waves.cell_table(closure, parameters, chosen, cells=cells, numbers=numbers)
    h, dt = 1 / np.array(cells), 1 / np.array(numbers)
    predicted = np.array([g.predicted for g in table])
    measured = np.array([g.measured for g in table])
    h_orders, dt_orders = waves.ORDERS_H[: h.size - 1], waves.ORDERS_DT[: dt.size - 1]
    without_dt = np.array([extrapolated(dt, m.T, dt_orders) for m in measured])
    without_h = np.array([extrapolated(h, m, h_orders) for m in measured])
    limit = np.array([g.limit for g in table])
    of_wave = {f: np.array([getattr(g.wave, f) for g in table]) for f in ("wavenumber", "wave_angle", "delta")}
    size = abs(predicted)[:, None]
    return {
        "cell_size": (("cell_mesh",), h),
        "cell_step": (("cell_steps",), dt),
        **{f"cell_{name}": (("wave",), value) for name, value in of_wave.items()},
        "cell_epsilon": (("wave",), np.array([g.wave.epsilon for g in table])),
        "cell_drift": (("wave",), np.array([g.wave.drift for g in table])),
        "cell_growth_predicted": (("wave",), predicted.real),
        "cell_frequency_predicted": (("wave",), predicted.imag),
        "cell_growth": (("wave", "cell_mesh", "cell_steps"), measured.real),
        "cell_frequency": (("wave", "cell_mesh", "cell_steps"), measured.imag),
        "cell_growth_limit": (("wave",), limit.real),
        "cell_frequency_limit": (("wave",), limit.imag),
        "cell_error": (("wave",), abs(limit - predicted) / abs(predicted)),
        "cell_error_h": (("wave", "cell_mesh"), abs(without_dt - predicted[:, None]) / size),
        "cell_error_dt": (("wave", "cell_steps"), abs(without_h - predicted[:, None]) / size),
        "cell_order_h": (("wave",), np.array([g.order_h for g in table])),
        "cell_order_dt": (("wave",), np.array([g.order_dt for g in table])),
    }


def neutral_part(closure: Any, parameters: dict, states: Sequence[tuple[float, float]]) -> Found:
    """Return where growth changes sign in the periodic cell, against the neutral curve."""
    rows = []
    for delta, epsilon in states:
        wave = waves.fastest(closure, parameters, delta, epsilon)
        end = waves.neutral(closure, parameters, wave)
        rows.append((delta, epsilon, wave.wave_angle, end, waves.cell_neutral(closure, parameters, wave)))
    names = ("delta", "epsilon", "wave_angle", "predicted", "measured")
    return {f"neutral_{n}": (("ray",), np.array(c)) for n, c in zip(names, zip(*rows, strict=True), strict=True)}


def symbol_part(closure: Any, flow: Any, parameters: Mapping, elements: Sequence[int], kind: str) -> Found:
    """Return errors of the discrete symbol for the fastest wave of the point, one twice as long and one across."""
    best = first_waves.local_wave(closure, flow, parameters, *symbol.PLACES[1])
    q, angle = best.wavenumber, best.wave_angle
    chosen = ((q, angle), (q / 2, angle), (q / 2, angle + 90))
    found = symbol.discrete_symbol(closure, flow, parameters, chosen, elements=elements, kind=kind)

    def each(name: str) -> np.ndarray:
        return np.array([[[getattr(s, name) for s in row] for row in mesh] for mesh in found])

    size, dims = each("size"), ("symbol_mesh", "place", "symbol_wave")
    order = {}
    for name in ("matrix_error", "eigenvalue_error"):
        flat_size, flat = size.reshape(len(elements), -1), each(name).reshape(len(elements), -1)
        pairs = [observed(flat_size[:, i], flat[:, i]) for i in range(flat.shape[1])]
        order[name] = np.reshape(pairs, size.shape[1:])
    return {
        "symbol_elements": (dims[:1], np.array(elements, float)),
        "symbol_r": (dims[:2], each("r")[..., 0]),
        "symbol_theta": (dims[:2], each("theta")[..., 0]),
        "symbol_wavenumber": (dims[2:], np.array([q for q, _ in chosen])),
        "symbol_wave_angle": (dims[2:], np.array([angle for _, angle in chosen])),
        "symbol_size": (dims, size),
        "symbol_growth_predicted": (dims, each("eigenvalue").real),
        "symbol_growth": (dims, each("discrete_eigenvalue").real),
        "symbol_matrix_error": (dims, each("matrix_error")),
        "symbol_eigenvalue_error": (dims, each("eigenvalue_error")),
        "symbol_matrix_order": (dims[1:], order["matrix_error"]),
        "symbol_eigenvalue_order": (dims[1:], order["eigenvalue_error"]),
    }


def hopper_part(
    closure: Any, flow: Any, parameters: Mapping, mesh: Mapping, duration: float, dt: float, size: float, seed: int
) -> Found:
    """Return the fastest waves of the hopper in four ways, and the leading mode's growth in the time-stepper."""
    args = closure, flow, parameters
    problem = hopper_problem(*args, mesh)
    wedge = parameters["wedge_angle"]
    axis = first_waves.largest_local(*args, np.array([0.0]))
    anywhere = first_waves.largest_local(*args, np.linspace(0, 0.9 * wedge, 6))
    on_mesh = first_waves.largest_on_mesh(problem, *args)
    frequency = abs(on_mesh.frequency)
    modes = leading_modes(problem, first_waves.ABOUT * axis.growth, (0.6 * frequency, frequency))
    middle = polar_base(*args, (parameters["outlet_radius"] + parameters["inlet_radius"]) / 2 * unit(0))
    length = float(np.sqrt(middle.letters()["mu"] * parameters["epsilon"]))
    mode = modes[0]
    place = first_waves.seen(problem, mode.field, length)
    global_mode = first_waves.Found(*place, mode.eigenvalue.real, abs(mode.eigenvalue.imag))
    there = first_waves.local_wave(*args, *place[:2])
    pair = first_waves.pair_of_runs(problem, noise(problem, size, seed), duration, dt)
    run = first_waves.Found(*first_waves.seen(problem, pair.difference, length), first_waves.growth_of(pair))
    rate = rate_of(stepped(problem, mode, 0.04 / abs(mode.eigenvalue), 8), 0.04 / abs(mode.eigenvalue))
    table = (axis, anywhere, there, on_mesh, global_mode, run)
    names = ("r", "theta", "wavenumber", "wave_angle", "growth", "frequency")
    values = np.array([m.eigenvalue for m in modes])
    return {
        "way": (("way",), list(WAYS)),
        **{f"first_{n}": (("way",), np.array([getattr(f, n) for f in table])) for n in names},
        "mode_growth": (("mode",), values.real),
        "mode_frequency": (("mode",), values.imag),
        "mode_residual": (("mode",), np.array([m.residual for m in modes])),
        "mode_stepped_growth": ((), rate.real),
        "mode_stepped_frequency": ((), rate.imag),
        "mode_error": ((), abs(rate - mode.eigenvalue) / abs(mode.eigenvalue)),
        "run_time": (("run_step",), pair.time),
        "run_difference": (("run_step",), pair.size),
    }


def saturation_part(closure: Any, parameters: dict, delta: float, runs: Sequence, floor: float) -> Found:
    """Return the courses of the fastest wave for some epsilon, on meshes of some numbers of cells."""
    k = float(np.sqrt(2) * np.sin(np.radians(parameters["friction_angle"])))
    courses, epsilons = [], []
    for epsilon, cells in runs:
        found = saturation.saturation(closure, parameters, delta, epsilon, cells, floor=floor)
        courses += found
        epsilons += [epsilon] * len(found)
    last = {n: np.array([c.rows[n][-1] for c in courses]) for n in saturation.NUMBERS}
    jumps = zip(epsilons, last["band_delta"], last["band_jump"], strict=True)
    steps = max(c.time.size for c in courses)

    def padded(rows: list[np.ndarray]) -> np.ndarray:
        return np.array([np.pad(r, (0, steps - r.size), constant_values=np.nan) for r in rows])

    return {
        "saturation_epsilon": (("course",), np.array(epsilons)),
        "saturation_cells": (("course",), np.array([c.cells for c in courses], float)),
        "saturation_wavelength": (("course",), np.array([c.wavelength for c in courses])),
        "saturation_end": (("course",), np.array([c.time[-1] for c in courses])),
        "saturation_time": (("course", "saturation_step"), padded([c.time for c in courses])),
        "saturation_course": (("course", "saturation_step"), padded([c.rows["amplitude"] for c in courses])),
        **{f"saturation_{n}": (("course",), v) for n, v in last.items()},
        "saturation_rate_predicted": (
            ("course",),
            np.array([saturation.band_rate(k, e, d) for e, d in zip(epsilons, last["band_delta"], strict=True)]),
        ),
        "saturation_thickness_predicted": (
            ("course",),
            np.array([saturation.band_thickness(k, e, d, j) for e, d, j in jumps]),
        ),
    }


def crosscheck(
    closure: Any,
    flow: Any,
    parameters: Mapping[str, float],
    point: Mapping[str, float],
    parts: Sequence[str] = PARTS,
    chosen: Sequence[waves.Wave] | None = None,
    states: Sequence[tuple[float, float]] = ((-0.1, 1e-4), (0.0, 1e-4), (0.2, 1e-4)),
    elements: int = 2000,
    kind: str = "diamond",
    symbol_elements: Sequence[int] = symbol.ELEMENTS,
    symbol_kind: str = "polar",
    duration: float = 0.045,
    dt: float = 5e-4,
    size: float = 1e-3,
    seed: int = 1,
    delta: float = 0.0,
    courses: Sequence[tuple[float, Sequence[int]]] = SATURATION,
    floor: float = saturation.FLOOR,
    progress: Report | None = None,
    **sizes: Sequence[int],
) -> xr.Dataset:
    """Return the time-stepper and the linear theory side by side.

    Parameters
    ----------
    closure, flow : a closure with the fields (u, v, p) and epsilon, and a radial flow
    parameters : words of both, SI units, angles in degrees
    point : r (m) and theta (degrees), whose strain rate and pressure the periodic cell has
    parts : of `PARTS`
    chosen : waves in the cell; those of `waves.waves` where none are given
    states : (delta, epsilon) of the rays along which the neutral wave is looked for
    elements, kind : of the half hopper's mesh
    symbol_elements, symbol_kind : of the meshes on which the discrete symbol is taken
    duration, dt, size, seed : of the two runs in the hopper (s), and of the noise that one of them starts with, over
        sqrt(g r_0)
    delta, courses, floor : of the cell in which the wave saturates; pairs of epsilon (s) and numbers of cells; least
        ||V|| (1/s)
    sizes : ``cells`` and ``numbers`` of steps in the periodic cell

    Returns
    -------
    Dataset with the variables of `tables.VARIABLES` that belong to the parts
    """
    if unknown := [p for p in parts if p not in PARTS]:
        raise SceneError(f"parts = {unknown} are unknown: use some of {', '.join(PARTS)}")
    base = polar_base(closure, flow, parameters, point["r"] * unit(point["theta"]))
    given = cell_parameters(base, parameters)
    mesh = {"elements": elements, "kind": kind}
    work = {
        "cell": lambda: cell_part(closure, given, chosen, sizes),
        "neutral": lambda: neutral_part(closure, given, states),
        "symbol": lambda: symbol_part(closure, flow, parameters, symbol_elements, symbol_kind),
        "hopper": lambda: hopper_part(closure, flow, parameters, mesh, duration, dt, size, seed),
        "saturation": lambda: saturation_part(closure, given, delta, courses, floor),
    }
    asked = [p for p in PARTS if p in parts]
    done = np.cumsum([0, *(COST[p] for p in asked)])
    found: Found = {}
    for part, (before, _) in zip(asked, pairwise(done), strict=True):
        if progress:
            progress(float(before), float(done[-1]), part)
        found |= work[part]()
    ds = xr.Dataset({n: v for n, v in found.items() if n != "way"})
    if "way" in found:
        ds = ds.assign_coords(way=found["way"][1])
    for name in ds.variables:
        unit_of, meaning = VARIABLES[str(name)]
        ds[name].attrs = {"units": unit_of, "long_name": meaning}
    return results.described(
        ds,
        closure=base.model.closure_name,
        flow=base.model.flow_name,
        parameters=dict(parameters),
        point=dict(point),
        cell_parameters=given,
        parts=list(asked),
        flow_constants=base.flow_letters,
        wave_angle_axis=base.model.axis,
        sign="float64, not certified",
        versions=results.versions(),
    )
