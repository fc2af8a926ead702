"""Growth rate and frequency over wavenumber x direction, at one point of a flow or at many."""

from collections.abc import Callable
from math import ceil
from typing import Any

import numpy as np

from stability import results, spectrum
from stability.model import Form, Model, check_waves

# Samples evaluated at once: about 25 temporaries of 8 to 16 bytes then stay in a 16 MiB cache, and memory beyond the
# output stays below that whatever the grid.
BLOCK = 2**15


def leading(form: Form, wavenumber: Any) -> Any:
    """Return the eigenvalue of largest real part."""
    found = form.eigenvalues(wavenumber)
    return found[0] if len(found) == 1 else spectrum.leading_first(*found)[0]


def growth_map(
    closure: Any,
    flow: Any,
    parameters: dict,
    point: dict,
    wavenumber: Any,
    wave_angle: Any,
    matrix: str = "full",
    progress: Callable[[int, int], None] | None = None,
) -> "results.xr.Dataset":
    """Return growth rate and frequency of the leading mode of every wave.

    Parameters
    ----------
    closure, flow : registered names, or a `Closure` and a `Flow`
    parameters : words to numbers, SI units, angles in degrees
    point : coordinates of the flow's point (angles in degrees); 1-D arrays of one length give a map per position
    wavenumber : 1-D, 1/m, positive
    wave_angle : 1-D, degrees from the flow's axis
    matrix : "full" (D), "truncated" (D', P7) or "leading" (M, P4)
    progress : called with (rows done, rows in all)

    Returns
    -------
    Dataset with ``growth_rate`` (1/s) and ``frequency`` (rad/s), each (position,) wave_angle, wavenumber, and the base
    state with its residuals.

    Raises
    ------
    SceneError : a parameter, a point or a wave outside its range
    """
    wavenumber, wave_angle = np.atleast_1d(np.asarray(wavenumber, float)), np.atleast_1d(np.asarray(wave_angle, float))
    check_waves(wavenumber, wave_angle)
    model = Model(closure, flow)
    point = {word: np.asarray(value, float) if np.ndim(value) else value for word, value in point.items()}
    base = model.base(parameters, point)
    variables, coordinates, attributes = results.of_model(model, parameters, point, base, matrix)
    dims = (*variables["mass_residual"][0], "wave_angle", "wavenumber")
    positions = variables["mass_residual"][1].size

    n, m = wave_angle.size, wavenumber.size
    growth, frequency = np.empty((positions * n, m)), np.empty((positions * n, m))
    rows = max(1, BLOCK // m)
    for start in range(0, positions * n, rows):
        row = np.arange(start, min(start + rows, positions * n))
        form = base.at(row // n).form(wave_angle[row % n], matrix)
        for i in range(ceil(m / BLOCK)):
            block = slice(i * BLOCK, (i + 1) * BLOCK)
            found = leading(form.column(), wavenumber[block])
            growth[row, block], frequency[row, block] = found.real, found.imag
        if progress:
            progress(int(row[-1]) + 1, positions * n)
    shape = (*variables["mass_residual"][1].shape, n, m)
    variables |= {"growth_rate": (dims, growth.reshape(shape)), "frequency": (dims, frequency.reshape(shape))}
    coordinates |= {"wave_angle": wave_angle, "wavenumber": wavenumber}
    return results.dataset(variables, coordinates, **attributes)
