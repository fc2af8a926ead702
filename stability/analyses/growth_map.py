"""Growth rate and frequency over wavenumber x direction, at one point of a flow or at many."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from stability import fast, results, sweep
from stability.errors import SceneError
from stability.model import Model, check_range, check_waves

BLOCK = sweep.TASK  # samples between two reports of progress


@dataclass(frozen=True)
class Whole:
    """The arrays of a map, (rows, wavenumbers)."""

    growth: np.ndarray
    frequency: np.ndarray | None

    def place(self, rows: slice, columns: slice, new: fast.Scratch) -> tuple[np.ndarray, np.ndarray | None]:
        """Return the part of the arrays that a block fills."""
        return self.growth[rows, columns], None if self.frequency is None else self.frequency[rows, columns]

    def take(self, rows: slice, columns: slice, growth: np.ndarray, ok: np.ndarray | None) -> None:
        """Do nothing: the numbers are in place."""

    def correct(self, rows: np.ndarray, columns: np.ndarray, eigenvalue: np.ndarray) -> None:
        """Replace what the closed form left open."""
        self.growth[rows, columns] = eigenvalue.real
        if self.frequency is not None:
            self.frequency[rows, columns] = eigenvalue.imag


def growth_map(
    closure: Any,
    flow: Any,
    parameters: dict,
    point: dict,
    wavenumber: Any,
    wave_angle: Any,
    matrix: str = "full",
    progress: Callable[[int, int], None] | None = None,
    accuracy: str = "standard",
    frequency: bool = True,
    threads: int = 1,
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
    accuracy : "standard": float64, with the signs of `stability.eigenvalues` and within 2e-9 of each growth rate, far
        closer where it is not small beside the trace (`fast.NEAR`). "draft": float32, for pictures; signs near
        neutrality mean nothing
    frequency : whether the frequency is wanted too; the growth rate alone takes two thirds of the time
    threads : how many; the numbers do not depend on it

    Returns
    -------
    Dataset with ``growth_rate`` (1/s) and ``frequency`` (rad/s), each (position,) wave_angle, wavenumber, and the base
    state with its residuals. Its attribute ``error_bound`` bounds the rounding errors of the growth rate away from
    double eigenvalues, which nothing computes to more than half the digits.

    Raises
    ------
    SceneError : a parameter, a point or a wave outside its range
    """
    if accuracy not in fast.ERROR:
        raise SceneError(f"accuracy = {accuracy!r} is unknown: use one of {', '.join(fast.ERROR)}")
    wavenumber, wave_angle = np.atleast_1d(np.asarray(wavenumber, float)), np.atleast_1d(np.asarray(wave_angle, float))
    check_waves(wavenumber, wave_angle)
    model = Model(closure, flow)
    point = {word: np.asarray(value, float) if np.ndim(value) else value for word, value in point.items()}
    base = model.base(parameters, point)
    variables, coordinates, attributes = results.of_model(model, parameters, point, base, matrix)
    place, residual = next(iter(variables.values()))  # as all of them

    grid = sweep.Grid(base, residual.size, wave_angle, wavenumber, matrix, accuracy == "draft")
    shape, dtype = (grid.rows, wavenumber.size), np.float32 if grid.draft else float
    whole = Whole(np.empty(shape, dtype), np.empty(shape, dtype) if frequency else None)
    sweep.run(grid, lambda: whole, threads, progress, BLOCK)
    if not np.isfinite(whole.growth.sum()):  # one pass; a sum is finite unless a term is not, or all are near the limit
        check_range((whole.growth,), wavenumber, np.tile(wave_angle, residual.size)[:, None])

    dims, full = (*place, "wave_angle", "wavenumber"), (*residual.shape, wave_angle.size, wavenumber.size)
    for name, values in (("growth_rate", whole.growth), ("frequency", whole.frequency)):
        if values is not None:
            variables[name] = dims, values.reshape(full)
    coordinates |= {"wave_angle": wave_angle, "wavenumber": wavenumber}
    attributes |= {"accuracy": accuracy, "error_bound": fast.ERROR[accuracy]}
    return results.dataset(variables, coordinates, **attributes)
