"""Measure the runs of figures N1 to N3: results -> runs.json, from which `runs` judges what the paper says of its own.

``python -m derivations runs`` does it, with the results kept in figures/out, or computed there where they are missing
(some minutes); the file is part of the repository, so that ``python -m derivations`` judges without a run. Every number
comes from a function of `figures.fronts` or `figures.bands`, which says how it is measured.
"""

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from xarray import Dataset

from figures import bands, fronts

KEPT = Path(__file__).with_name("runs.json")
FIRST = {"2e-5": "N3-first-2e-5", "4e-5": "N3-first-4e-5", "1e-4": "N3-first-1e-4", "2e-4": "N3-first-2e-4"}
DIGITS = 4  # of what is written: more than any of it is good for
SAME = 0.05  # s: when the lengths of waves are compared between meshes
BEFORE = 0.025  # s: the last snapshot is compared with the one so much earlier, the step of figure N3


def measure(result: Callable[[str], Dataset], fine: Dataset | None = None) -> dict[str, Any]:
    """Return all measurements.

    Parameters
    ----------
    result : name of a scene of figures/scenes -> its result
    fine : the run of figure N3 on the finest mesh, where there is one
    """
    first = {epsilon: result(name) for epsilon, name in FIRST.items()}
    meshes = [result("N3-coarse"), result("N3"), *([] if fine is None else [fine])]
    found = {
        "N1": story(result("N1")),
        "N3": story(result("N3")),
        "first": {epsilon: first_waves(ds) for epsilon, ds in first.items()},
        "meshes": [mesh(ds) for ds in meshes],
        "lengths": [length(ds) for ds in (*meshes, first["1e-4"])],
    }
    return rounded(found)


def story(ds: Dataset) -> dict[str, Any]:
    """Return what a run shows from its first waves to its end."""
    first, end = fronts.visible(ds), ds.isel(time=-1)
    seen, time = ds.isel(time=first), ds.time.values
    third = time[-1] * 2 / 3
    places = {name: fronts.place(seen, name) for name in ("pressure", "velocity_theta")}
    earlier = int(abs(time - time[-1] + BEFORE).argmin())
    late = ds.step_time.values > time[first]
    return {
        **of(ds),
        "first_time": time[first],
        "places": places,
        "viscosity": {name: fronts.viscous(ds, *place) for name, place in places.items()},
        "arrivals": fronts.arrivals(ds),
        "early_growth": fronts.growth(ds, time[first] / 2, time[first]),
        "late_growth": fronts.growth(ds, third, time[-1]),
        "travel": fronts.travel(ds, third / 2),
        "likeness": fronts.likeness(ds)[earlier],
        "thickness": bands.thickness(end),
        "across": bands.across(fronts.whole(end)),
        "troughs": bands.troughs(end),
        "troughs_at_first": bands.troughs(seen),
        "steps": [ds.step_size.values[late].min(), ds.step_size.values.max(), ds.rejected_tries.sum().item()],
    }


def of(ds: Dataset) -> dict[str, Any]:
    """Return which run it is."""
    epsilon = json.loads(ds.attrs["parameters"])["epsilon"]
    cell = ds.r.values[1] - ds.r.values[0]
    return {"epsilon": epsilon, "elements": int(ds.attrs["elements"]), "cell": cell, "end": ds.time.values[-1]}


def first_waves(ds: Dataset) -> dict[str, Any]:
    """Return what the first waves are at the end of a short run."""
    return {**of(ds), "windows": fronts.WINDOWS, "waves": fronts.first_lengths(ds)}


def mesh(ds: Dataset) -> dict[str, Any]:
    """Return how thick jumps are on a mesh at the end of a run."""
    return {**of(ds), "thickness": bands.thickness(ds.isel(time=-1))}


def length(ds: Dataset) -> dict[str, Any]:
    """Return how long the first waves are on a mesh."""
    return {**of(ds), "at": SAME, "waves": fronts.lengths(ds.sel(time=SAME, method="nearest"))}


def rounded(value: Any) -> Any:
    """Return plain numbers with few digits, for JSON."""
    if isinstance(value, dict):
        return {key: rounded(one) for key, one in value.items()}
    if isinstance(value, list | tuple | np.ndarray):
        return [rounded(one) for one in value]
    return float(f"{value:.{DIGITS}g}") if isinstance(value, float | np.floating) else int(value)


def write(folder: Path) -> None:
    """Measure with the results of a folder and write runs.json; runs that are missing are made there."""
    from figures.common import kept, result

    found = measure(lambda name: result(name, folder), kept("N3-full", folder))
    KEPT.write_text(json.dumps(found, indent=1) + "\n", encoding="utf-8")


def load() -> dict[str, Any]:
    """Return the measurements of the repository."""
    return json.loads(KEPT.read_text(encoding="utf-8"))
