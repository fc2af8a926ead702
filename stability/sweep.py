"""Every wave of a grid, block by block: what maps and reductions share.

A task is a rectangle of positions x directions and a range of wavenumbers. It is cut into blocks that fit the cache; a
sink says where the numbers go and what becomes of them. Samples that the closed form leaves open (near neutrality)
are collected and evaluated by `spectrum`. The cut does not depend on the number of threads, so neither do the bits.
"""

from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from math import ceil, prod
from threading import Lock
from typing import Any, Protocol

import numpy as np

from stability import compiled, fast, hoisted, spectrum
from stability.errors import SceneError
from stability.model import Base, Form

TASK = 2**18  # samples: coefficients are shared by them, and threads take turns
ROWS = 2**11  # directions whose coefficients are formed at once, by way of tensors: 100 temporaries each
FORMS = 2**10  # ... by way of the forms themselves: 400 temporaries each
OPEN = 2**11  # samples left open that are evaluated at once: 25 complex temporaries of as many numbers
PENDING = 2**14


class Sink(Protocol):
    """Where the numbers of a sweep go."""

    def place(self, rows: slice, columns: slice, new: fast.Scratch) -> tuple[np.ndarray, np.ndarray | None]:
        """Return the arrays to write growth rates and frequencies (None: not wanted) into."""

    def take(self, rows: slice, columns: slice, growth: np.ndarray, ok: np.ndarray | None) -> None:
        """Use the growth rates of a block; those that are not ok are still to come."""

    def correct(self, rows: np.ndarray, columns: np.ndarray, eigenvalue: np.ndarray) -> None:
        """Use eigenvalues that were left open."""


@dataclass(frozen=True)
class Grid:
    """What is swept: rows are positions x directions, columns are wavenumbers."""

    base: Base
    positions: int
    wave_angle: np.ndarray
    wavenumber: np.ndarray
    matrix: str
    draft: bool = False

    @property
    def rows(self) -> int:
        """How many rows there are."""
        return self.positions * self.wave_angle.size

    @property
    def hoisted(self) -> bool:
        """Whether tensors pay: one position needs its forms anyway, for the samples left open, at the same cost."""
        return self.positions > 1 and self.matrix == "full" and self.base.model.closed

    def form(self, rows: np.ndarray) -> Form:
        """Return the forms of some rows, every coefficient an array."""
        n = self.wave_angle.size
        return self.base.at(rows // n).form(self.wave_angle[rows % n], self.matrix).filled(rows.size)

    def tasks(self, samples: int) -> Iterator[tuple[slice, slice, slice]]:
        """Yield ranges of positions, of directions (all of them unless one position has enough) and wavenumbers."""
        n, m = self.wave_angle.size, self.wavenumber.size
        for columns in parts(m, fast.COLUMNS):
            rows = min(ROWS if self.hoisted else FORMS, max(1, samples // (columns.stop - columns.start)))
            directions = [
                slice(group.start + part.start, group.start + part.stop)
                for group in cuts(n, FORMS)  # a worker keeps the forms of a group for its tasks
                for part in cuts(group.stop - group.start, rows)
            ]
            for positions in cuts(self.positions, max(1, rows // n)):
                for some in directions:
                    yield positions, some, columns


def cuts(size: int, length: int) -> list[slice]:
    """Return ranges of one length, the last one as long as what remains."""
    return [slice(i, min(i + length, size)) for i in range(0, size, length)]


def parts(size: int, longest: int) -> list[slice]:
    """Return ranges of nearly equal length: a short remainder would suit BLAS badly."""
    return cuts(size, ceil(size / ceil(size / longest)))


def leading(form: Form, wavenumber: Any) -> Any:
    """Return the eigenvalue of largest real part."""
    found = form.eigenvalues(wavenumber)
    return spectrum.leading_first(*found)[0] if len(found) == 2 else found[0]


class Worker:
    """One thread's scratch, and the samples that it has left open."""

    def __init__(self, grid: Grid, sink: Sink):
        self.grid, self.sink = grid, sink
        self.new = fast.Scratch(np.float32 if grid.draft else float)
        self.modes = grid.base.model.modes
        self.kernel = fast.single if self.modes == 1 else compiled.pair if compiled.pays(grid) else fast.pair
        self.powers: dict = {}
        self.columns, self.directions, self.group = slice(0), slice(0), -1
        self.kept: tuple = (None, None, None)
        self.pending: list[tuple[np.ndarray, np.ndarray]] = []
        self.left = 0

    def table(self, positions: slice, directions: slice, columns: slice) -> tuple[fast.Table, Form | None, int]:
        """Return the polynomials of a task, the forms they come from (None: tensors), and the first row of either."""
        n = self.grid.wave_angle.size
        first, last = positions.start * n + directions.start, (positions.stop - 1) * n + directions.stop
        if self.grid.positions == 1:
            first -= first % FORMS
            last = min(first + FORMS, n)
        if (first, last, columns) != self.kept[0]:
            form = None if self.grid.hoisted else self.grid.form(np.arange(first, last))
            source = (form.coefficients, form.speed) if form else self.hoisted(positions, directions)
            found = (fast.of_pair if self.modes == 2 else fast.of_single)(*source)
            if columns != self.columns:
                self.columns, self.powers = columns, fast.powers_of(found, self.grid.wavenumber[columns])
            table = (fast.draft_table if self.grid.draft else fast.table)(found, last - first, self.powers)
            self.kept = (first, last, columns), table, form
        return self.kept[1], self.kept[2], first

    def hoisted(self, positions: slice, directions: slice) -> tuple:
        """Return coefficients by way of tensors, which serve the next ROWS positions too."""
        grid = self.grid
        if directions != self.directions:
            arithmetic = grid.base.model.arithmetic
            cosine, sine = arithmetic.direction(grid.wave_angle[directions], arithmetic)
            self.directions, self.turned = directions, hoisted.directions(cosine, sine)
        size = positions.stop - positions.start
        if not self.group <= positions.start < positions.stop <= self.group + ROWS or self.group < 0:
            self.group = positions.start
            stop = min(self.group + ROWS, grid.positions)
            self.tensors = hoisted.tensors(grid.base.at(slice(self.group, stop)), stop - self.group)
        first = positions.start - self.group
        return hoisted.coefficients(self.tensors.at(slice(first, first + size)), self.turned, self.modes)

    def task(self, positions: slice, directions: slice, columns: slice) -> None:
        """Evaluate one task."""
        grid = self.grid
        n = grid.wave_angle.size
        start = positions.start * n + directions.start
        stop = (positions.stop - 1) * n + directions.stop
        if not grid.base.model.closed:
            return self.solve(slice(start, stop), columns)
        t, form, first = self.table(positions, directions, columns)
        for block in cuts(stop - start, max(1, fast.BLOCK // (columns.stop - columns.start))):
            rows = slice(start + block.start, start + block.stop)
            local = slice(rows.start - first, rows.stop - first)
            growth, frequency = self.sink.place(rows, columns, self.new)
            with np.errstate(all="ignore"):  # what overflows is NaN, and left open
                ok = self.kernel(t, local, growth, frequency, self.new)
            if ok is not None and ok.all():
                ok = None
            self.sink.take(rows, columns, growth, ok)
            if ok is not None:
                i, j = np.divmod(np.flatnonzero(np.logical_not(ok, out=ok)), ok.shape[1])
                self.pending.append((i + rows.start, j + columns.start))
                self.left += i.size
                if self.left > PENDING:
                    self.flush(form, first)
        if form:
            self.flush(form, first)

    def solve(self, rows: slice, columns: slice) -> None:
        """Evaluate rows of a closure without closed forms, by its pencil."""
        for block in cuts(rows.stop - rows.start, max(1, PENDING // (columns.stop - columns.start))):
            some = slice(rows.start + block.start, rows.start + block.stop)
            growth, frequency = self.sink.place(some, columns, self.new)
            found = leading(self.grid.form(np.arange(some.start, some.stop)).column(), self.grid.wavenumber[columns])
            growth[...] = found.real
            if frequency is not None:
                frequency[...] = found.imag
            self.sink.take(some, columns, growth, None)

    def flush(self, form: Form | None = None, start: int = 0) -> None:
        """Evaluate what was left open; ``form`` holds the rows from ``start`` on, if it is known."""
        if not self.left:
            return
        row, column = (np.concatenate(part) for part in zip(*self.pending, strict=True))
        self.pending, self.left = [], 0
        if form is not None:
            return self.settle(form, row, row - start, column)
        unique, inverse = np.unique(row, return_inverse=True)
        for group in cuts(unique.size, FORMS):
            here = (inverse >= group.start) & (inverse < group.stop)
            self.settle(self.grid.form(unique[group]), row[here], inverse[here] - group.start, column[here])

    def settle(self, form: Form, row: np.ndarray, index: np.ndarray, column: np.ndarray) -> None:
        """Evaluate samples of the rows ``index`` of a form."""
        for some in cuts(row.size, OPEN):
            found = leading(form.rows(index[some]), self.grid.wavenumber[column[some]])
            self.sink.correct(row[some], column[some], found)


def run(
    grid: Grid,
    sink: Callable[[], Any],
    threads: int = 1,
    progress: Callable[[int, int], None] | None = None,
    samples: int = TASK,
) -> list:
    """Sweep a grid.

    Parameters
    ----------
    sink : called once for every thread; a `Sink`
    threads : how many; results do not depend on it
    progress : called with (rows done, rows in all)
    samples : about how many make a task

    Returns
    -------
    the sinks
    """
    if isinstance(threads, bool) or not isinstance(threads, int) or threads < 1:
        raise SceneError(f"threads = {threads!r} is not a positive integer")
    tasks, lock, done = grid.tasks(samples), Lock(), 0
    total = grid.rows * grid.wavenumber.size
    workers = [Worker(grid, sink()) for _ in range(threads)]

    def work(worker: Worker) -> None:
        nonlocal done
        while True:
            with lock:
                task = next(tasks, None)
            if task is None:
                return worker.flush()
            worker.task(*task)
            with lock:
                done += prod(part.stop - part.start for part in task)
                if progress:
                    progress(done * grid.rows // total, grid.rows)

    if threads == 1:
        work(workers[0])
    else:
        with ThreadPoolExecutor(threads) as pool:
            for future in [pool.submit(work, worker) for worker in workers]:
                future.result()
    return [worker.sink for worker in workers]
