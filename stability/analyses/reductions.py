"""The largest growth over all waves, without keeping a map: a sweep whose blocks are reduced while in the cache."""

from collections.abc import Callable
from typing import Any

import numpy as np

from stability import fast, results, sweep
from stability.model import Model, check_waves


class Largest:
    """The largest growth rate of each position, its sample, and how many samples grow; samples count in map order."""

    def __init__(self, positions: int, directions: int, columns: int):
        self.directions, self.columns = directions, columns
        self.best = np.full(positions, -np.inf)
        self.sample = np.full(positions, np.iinfo(np.int64).max)
        self.growing = np.zeros(positions, np.int64)

    def place(self, rows: slice, columns: slice, new: fast.Scratch) -> tuple[np.ndarray, None]:
        """Return scratch for a block."""
        return new("growth", (rows.stop - rows.start, columns.stop - columns.start)), None

    def take(self, rows: slice, columns: slice, growth: np.ndarray, ok: np.ndarray | None) -> None:
        """Merge a block, without the samples that are still to come."""
        if ok is not None:
            np.copyto(growth, -np.inf, where=~ok)
        row, column = np.arange(rows.start, rows.stop), growth.argmax(axis=1)
        best = growth[row - rows.start, column]
        self.merge(best, row, column + columns.start, np.count_nonzero(growth > 0, axis=1))

    def correct(self, rows: np.ndarray, columns: np.ndarray, eigenvalue: np.ndarray) -> None:
        """Merge samples that were left open."""
        self.merge(eigenvalue.real, rows, columns, eigenvalue.real > 0)

    def merge(self, best: np.ndarray, row: np.ndarray, column: np.ndarray, growing: np.ndarray) -> None:
        """Merge candidates; of equal ones the first in the map counts, whatever the order of merging."""
        position, sample = row // self.directions, row * self.columns + column
        np.add.at(self.growing, position, growing)
        order = np.lexsort((sample, -best, position))
        position, first = np.unique(position[order], return_index=True)
        self.replace(position, best[order[first]], sample[order[first]])

    def replace(self, position: np.ndarray, best: np.ndarray, sample: np.ndarray) -> None:
        """Take over what is larger, or as large and earlier."""
        old = self.best[position]
        better = (best > old) | ((best == old) & (sample < self.sample[position]))
        self.best[position[better]], self.sample[position[better]] = best[better], sample[better]

    def join(self, other: "Largest") -> None:
        """Merge what another thread has found."""
        self.growing += other.growing
        self.replace(np.arange(self.best.size), other.best, other.sample)


def largest_growth(
    closure: Any,
    flow: Any,
    parameters: dict,
    point: dict,
    wavenumber: Any,
    wave_angle: Any,
    matrix: str = "full",
    threads: int = 1,
    progress: Callable[[int, int], None] | None = None,
) -> "results.xr.Dataset":
    """Return the largest growth rate of a grid of waves, where it is, and which part of the grid grows.

    The same numbers as reducing `growth_map`, in memory that does not depend on the size of the grid: 1e9 waves are
    swept in some 10 MiB.

    Parameters
    ----------
    closure, flow, parameters, point, wavenumber, wave_angle, matrix, threads, progress : as in `growth_map`

    Returns
    -------
    Dataset with ``largest_growth_rate`` (1/s), its ``wavenumber`` (1/m) and ``wave_angle`` (degrees), and
    ``unstable_share``, per position where the point holds arrays; the first wave in map order where several are equal.

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
    dims, residual = next(iter(variables.values()))  # as all of them
    n, m = wave_angle.size, wavenumber.size
    grid = sweep.Grid(base, residual.size, wave_angle, wavenumber, matrix)
    found, *others = sweep.run(grid, lambda: Largest(residual.size, n, m), threads, progress)
    for other in others:
        found.join(other)
    row, column = np.divmod(found.sample, m)
    shape = residual.shape
    variables |= {
        "wavenumber": (dims, wavenumber[column].reshape(shape)),
        "wave_angle": (dims, wave_angle[row % n].reshape(shape)),
    }
    ds = results.dataset(variables, coordinates, **attributes, samples=n * m)
    for name, values in (("largest_growth_rate", found.best), ("unstable_share", found.growing / (n * m))):
        unit, meaning = results.VARIABLES[name]
        ds[name] = (dims, values.reshape(shape), {"units": unit, "long_name": meaning})
    return ds
