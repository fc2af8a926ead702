"""A field and a closure -> the map over the field: verdicts, fastest waves, and what the mesh's own waves do."""

import os
from collections.abc import Callable, Mapping
from concurrent.futures import ThreadPoolExecutor
from numbers import Real
from threading import Lock
from time import perf_counter
from typing import TYPE_CHECKING, Any

import numpy as np

from stability.errors import SceneError
from stability.field.answers import field_answer
from stability.field.gradients import Jets, jets
from stability.field.grids import Field
from stability.field.guides import guide
from stability.field.judging import CODES, Judged, judged, short_waves
from stability.field.labels import labelled
from stability.field.states import base_of, constrained, masks, solenoidal, strain_error, strain_norm, taken
from stability.field.waves import waves_of

if TYPE_CHECKING:
    from xarray import Dataset

CHUNK = 2**14  # points at once: Python's own time is small then, also beside other threads; some 6 kB a point
TRIAL = 2**12  # points that `field_cost` judges
DIVERGENCE = {
    True: "taken off the velocity gradient, half from u_x and half from v_y: the closure imposes div u = 0",
    False: "as it is",
}
FLOOR = 1e-6  # of the root mean square of ||V||: below it the direction of A is that of the noise


def field_map(
    closure: Any,
    field: Field,
    parameters: Mapping,
    duration: float | None = None,
    cells: float = 2.0,
    longest: float | None = None,
    floor: float = FLOOR,
    check: bool = True,
    threads: int | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> "Dataset":
    """Return the verdict at every point of a field, the fastest wave there, and the fastest of the mesh's waves.

    Parameters
    ----------
    closure : a registered name or a `Closure`
    field : from `read_field` or `field_from`
    parameters : the closure's words to numbers, SI units, angles in degrees
    duration : s, over which e-folds are counted; None: the time 1/||V|| in which the material strains by one
    cells : wavelength that the mesh resolves least, in cells
    longest : m, the longest wave that is looked at; None: the shorter side of the box around the field
    floor : ||V|| below this part of its root mean square counts as rest, and is masked
    check : whether to judge short waves again with gradients at the other end of their error bars (``firm``)
    threads : how many, None for as many as there are cores; the numbers do not depend on it
    progress : called with (points done, points in all)

    Returns
    -------
    Dataset on the field's own axes; `stability.field.labels` lists its variables. The attribute ``answer`` says in
    words whether structures of the mesh's size are the equations' or the scheme's, ``masked`` counts by reason what
    could not be judged.

    Raises
    ------
    SceneError : a parameter out of range, or a field without a value that the closure needs
    """
    for name, value in {"cells": cells, "duration": duration, "longest": longest}.items():
        if value is not None and not (isinstance(value, Real) and np.isfinite(value) and value > 0):
            raise SceneError(f"{name} = {value!r} is no number in (0, inf)")
    if not (isinstance(floor, Real) and 0 <= floor < np.inf):
        raise SceneError(f"floor = {floor!r} is no number in [0, inf)")
    found = jets(field)
    norm, model = strain_rates(closure, parameters, found)
    masked = masks(found, norm, floor)
    good = np.flatnonzero(~np.any(list(masked.values()), axis=0))
    longest = field.longest if longest is None else longest
    size, grid = norm.size, cells * found.size
    out, firm, lock, done = Judged.empty(size), np.zeros(size, np.int8), Lock(), 0

    def work(part: slice) -> None:
        nonlocal done
        index = good[part]
        base = state(closure, parameters, found.narrow, index)
        out.put(index, judged(base, index.size, longest, grid[index]))
        if check:
            other = state(closure, parameters, found.mirrored(index), slice(None))
            again = short_waves(other, waves_of(other, index.size), guide(other, index.size))
            mine = out.code[index]
            firm[index] = np.where(mine == CODES.index("finite"), 1, mine) == again.code
        with lock:
            done += index.size
            if progress:
                progress(done, good.size)

    tasks = [slice(i, i + CHUNK) for i in range(0, good.size, CHUNK)]
    threads = min(threads or usable_cores(), len(tasks))
    if threads <= 1:
        for part in tasks:
            work(part)
    else:
        with ThreadPoolExecutor(threads) as pool:
            list(pool.map(work, tasks))
    time = np.full(size, duration) if duration is not None else 1 / np.where(norm > 0, norm, np.nan)
    jet = found.narrow
    variables = {
        "verdict": out.code, "exponent": out.exponent, "coefficient": out.coefficient,
        "growth_rate": out.growth, "wavelength": out.wavelength, "wave_angle": out.angle,
        "grid_wavelength": grid, "grid_growth_rate": out.grid_growth, "grid_wave_angle": out.grid_angle,
        "grid_e_folds": out.grid_growth * time,
        "strain_rate_norm": norm, "dilation": (jet["u"][1][0] + jet["v"][1][1]) / np.where(norm > 0, norm, np.nan),
        "gradient_error": strain_error(found) / np.where(norm > 0, norm, np.nan),
    }  # fmt: skip
    if "p" in jet:
        variables["pressure"] = jet["p"][0]
    if check:
        variables["firm"] = firm
    ds = labelled(
        field, variables,
        closure=model.closure_name, parameters=dict(parameters), source=field.source,
        duration="1/||V|| at each point" if duration is None else f"{duration:g} s",
        cells=float(cells), longest=float(longest), masked={why: int(m.sum()) for why, m in masked.items()},
        solenoidal=int(constrained(model)), divergence=DIVERGENCE[constrained(model)], sign="float64, not certified",
    )  # fmt: skip
    return ds.assign_attrs(answer=field_answer(ds))


def strain_rates(closure: Any, parameters: Mapping, found: Jets) -> tuple[np.ndarray, Any]:
    """Return ||V|| at every point, and the model; everything that is wrong with the question is said here."""
    model = base_of(closure, parameters, found.narrow).model
    if model.fields[0] != ("u", "v"):
        raise SceneError(f"closure {model.closure_name} has no velocity (u, v) as its first field: no strain rate")
    return strain_norm(found.narrow), model


def state(closure: Any, parameters: Mapping, every: Mapping, index: Any) -> Any:
    """Return the base states at some points, with div u = 0 restored where the closure imposes it."""
    some = taken(every, index)
    base = base_of(closure, parameters, some)
    return base_of(closure, parameters, solenoidal(some)) if constrained(base.model) else base


def usable_cores() -> int:
    """Return how many cores this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def field_cost(closure: Any, field: Field, parameters: Mapping) -> float:
    """Return about how many seconds `field_map` will take on one thread, from some of the field's points.

    A point takes 10 to 60 us, and up to 150 us where three modes are searched for the fastest of many wavenumbers.
    """
    small = jets(field)
    norm, _ = strain_rates(closure, parameters, small)
    good = np.flatnonzero(~np.any(list(masks(small, norm, FLOOR).values()), axis=0))
    if not good.size:
        return 0.0
    index = np.resize(good[:: max(1, good.size // TRIAL)], TRIAL)
    start = perf_counter()
    judged(state(closure, parameters, small.narrow, index), TRIAL, field.longest, 2 * small.size[index])
    return 1.5 * (perf_counter() - start) / TRIAL * good.size  # ``check`` judges short waves again
