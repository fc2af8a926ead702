"""A march -> a labelled Dataset on the mesh's polar grid, and its lines in a summary.

Gradients at a node are the means over its control volume. Where ||V|| falls below the floor, delta and mu are formed
with the bounded norm that the rheology sees (`pointwise`), while ||V|| itself is given as it is.
"""

import json
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from stability import codegen, results
from stability.arithmetic import NUMPY
from stability.closures import CLOSURES
from stability.timestepper.mesh import Mesh
from stability.timestepper.problem import Problem

if TYPE_CHECKING:
    from xarray import Dataset

# Column of the step log: name in a result. What is left out (the seconds) differs from run to run.
LOG = {
    "time": "step_time",
    "dt": "step_size",
    "newton_iterations": "newton_iterations",
    "factorisations": "factorisations",
    "rejected": "rejected_tries",
    "update": "newton_update",
    "cells_below_floor": "cells_below_floor",
    "nodes_without_pressure": "nodes_without_pressure",
    "backward_wall_nodes": "backward_wall_nodes",
    "mass_budget": "mass_budget",
    "momentum_budget": "momentum_budget",
}
# What leaves the range in which the closure means what it says, in the words of a summary.
COUNTED = {
    "cells_below_floor": "cells with ||V|| below the floor",
    "nodes_without_pressure": "nodes with p <= 0 beside those of the arcs",
    "backward_wall_nodes": "nodes of the wall that slide away from the apex",
}
STRAIGHT = 1e-12  # of the coordinates: beyond rounding, and the grid would not be polar


def dataset(
    problem: Problem,
    times: Sequence[float],
    snapshots: Sequence[np.ndarray],
    log: Mapping[str, Sequence],
    **attributes: Any,
) -> "Dataset":
    """Return the result of a march.

    Parameters
    ----------
    times : of the snapshots, in s
    snapshots : (n, 3) u, v (m/s) and p (m2/s2) at the nodes, Cartesian
    log : columns of the step log, by the names of `LOG`
    attributes : what the result says of itself

    Returns
    -------
    Dataset with the dimensions time, r (m), theta (deg) and step
    """
    r, theta = polar_grid(problem.mesh)
    each = [fields(problem, q) for q in snapshots]
    variables: dict[str, tuple] = {
        name: (("time", "r", "theta"), np.stack([one[name] for one in each])) for name in each[0]
    }
    for column, name in LOG.items():
        values = np.asarray(log[column])
        whole = values.dtype.kind in "iu"
        variables[name] = "step", values.astype("int32" if whole else float)  # netCDF 3 has no int64
    coordinates = {"time": np.asarray(times, dtype=float), "r": r, "theta": np.rad2deg(theta)}
    coordinates["step"] = np.arange(1, len(variables["step_time"][1]) + 1, dtype="int32")
    counted = {name: {"largest": int(max(log[name])), "last": int(log[name][-1])} for name in COUNTED if len(log[name])}
    cells = {"elements": len(problem.mesh.elements), "nodes": len(problem.mesh.nodes)}
    return results.dataset(variables, coordinates, request="march", counted=counted, **cells, **attributes)


def polar_grid(mesh: Mesh) -> tuple[np.ndarray, np.ndarray]:
    """Return the radii (m) and the angles (radians) of a mesh's polar grid."""
    if mesh.grid is None:
        raise ValueError("the mesh has no polar grid: only those of a hopper can be written as a result")
    x, y = np.moveaxis(mesh.nodes[mesh.grid], -1, 0)
    r, theta = np.hypot(x, y), np.arctan2(y, x)
    if np.ptp(r, axis=1).max() > STRAIGHT * r.max() or np.ptp(theta, axis=0).max() > STRAIGHT:
        raise ValueError("the nodes of the mesh's grid do not lie on arcs and rays")
    return r[:, 0], theta[0]


def fields(problem: Problem, q: np.ndarray) -> dict[str, np.ndarray]:
    """Return the fields of a state (n, 3) on the polar grid, (radii, angles) each."""
    grid, theta = problem.mesh.grid, polar_grid(problem.mesh)[1]
    u, v, p = np.moveaxis(q[grid], -1, 0)
    gradient = problem.velocity_gradient(q)[grid]
    strain = (gradient + np.swapaxes(gradient, -1, -2)) / 2
    norm = np.sqrt((strain**2).sum(axis=(-1, -2)))
    bounded = floored(norm, problem.law.floor)
    found = {
        "velocity_r": u * np.cos(theta) + v * np.sin(theta),
        "velocity_theta": v * np.cos(theta) - u * np.sin(theta),
        "pressure": p,
        "strain_rate_norm": norm,
        "dilation": np.trace(strain, axis1=-2, axis2=-1) / bounded,
    }
    letters = closure_letters(problem, q[grid], gradient)
    if {"k", "mu"} <= letters.keys():
        found["viscosity"] = np.broadcast_to(letters["k"] * p / bounded, p.shape)
    return found


def floored(norm: np.ndarray, floor: float) -> np.ndarray:
    """Return the norm of the strain rate as the rheology sees it."""
    m = np.maximum(norm, floor)
    return (norm**2 + m**2) / (2 * m)


def closure_letters(problem: Problem, q: np.ndarray, gradient: np.ndarray) -> dict:
    """Return the closure's letters at points (..., 3) with velocity gradients (..., 2, 2); others are taken as zero."""
    zero = np.zeros(q.shape[:-1])
    none = (zero, zero)
    slopes = tuple(tuple(gradient[..., i, j] for j in (0, 1)) for i in (0, 1))
    velocity = ((q[..., 0], q[..., 1]), slopes, ((none, none), (none, none)))
    functions = codegen.load(CLOSURES, problem.law.closure)["build"](NUMPY)
    with np.errstate(all="ignore"):  # A and mu do not exist where ||V|| vanishes
        return functions["letters"]((velocity, (q[..., 2], none, (none, none))), problem.law.parameters)


def findings(ds: "Dataset") -> list[tuple[str, str]]:
    """Return what a march's result says, as rows of a summary."""
    end, last = ds.time.values[-1], ds.isel(time=-1)
    mesh = json.loads(ds.attrs["mesh"])
    half = "half the wedge" if mesh["half"] else "the whole wedge"
    rows = [
        ("mesh", f"{mesh['kind']}, {ds.attrs['elements']} elements over {half}"),
        ("marched", f"to t = {end:g} s, {ds.sizes['time']} snapshots, {ds.sizes['step']} steps ({ds.attrs['scheme']})"),
        ("Newton", f"{int(ds.newton_iterations.sum())} iterations, {int(ds.factorisations.sum())} factorisations, "
                   f"{int(ds.rejected_tries.sum())} rejected tries"),
        ("at the end", f"||V|| from {last.strain_rate_norm.min().item():.3g} to "
                       f"{last.strain_rate_norm.max().item():.3g} 1/s, delta from {last.dilation.min().item():.2g} to "
                       f"{last.dilation.max().item():.2g}, |u_theta| up to "
                       f"{abs(last.velocity_theta).max().item():.3g} m/s"),
        ("balances", f"mass closes within {abs(ds.mass_budget).max().item():.1e}, momentum within "
                     f"{abs(ds.momentum_budget).max().item():.1e} of the scales"),
    ]  # fmt: skip
    total = {"cells_below_floor": ds.attrs["elements"]}
    for name, count in json.loads(ds.attrs["counted"]).items():
        of = f", of {total[name]}" if name in total else ""
        said = f"{COUNTED[name]}: {count['last']} at the end, {count['largest']} at most{of}"
        rows.append(("counted" if name == "cells_below_floor" else "", said))
    for part in json.loads(ds.attrs.get("continued", "[]")):
        rows.append(("continued", f"from step {part['step']}, t = {part['time']:.6g} s of another scene"))
    return rows
