"""Progress of long work: a bar on a terminal, elsewhere a line every few seconds, so that a log is never silent."""

import sys
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Protocol, TextIO

HEARTBEAT = 5.0  # seconds between two lines; work that is done sooner leaves none


class Report(Protocol):
    """How work says how far it is."""

    def __call__(self, done: float, total: float, note: str = "", start: float = 0) -> None:
        """Take the work done, in any unit; ``start`` is what was done before this run, ``note`` says it in words."""


@contextmanager
def reporting(label: str, stream: TextIO | None = None, every: float = HEARTBEAT) -> Iterator[Report]:
    """Give a function ``report(done, total)`` and show on ``stream`` (standard error) what it was told last.

    Work that never calls it is shown as well, with its elapsed time.
    """
    stream = sys.stderr if stream is None else stream
    with (_bar if stream.isatty() else _heartbeat)(label, stream, every) as report:
        yield report


@contextmanager
def _bar(label: str, stream: TextIO, every: float) -> Iterator[Report]:
    from rich.console import Console  # only a terminal needs it
    from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn, TimeRemainingColumn

    said = TextColumn("{task.fields[note]}", markup=False)
    columns = (BarColumn(), said, TimeElapsedColumn(), TextColumn("left:"), TimeRemainingColumn())
    bar = Progress(TextColumn(label, markup=False), *columns, console=Console(file=stream), transient=True)

    def report(done: float, total: float, note: str = "", start: float = 0) -> None:
        bar.update(task, completed=done, total=total, note=note)

    with bar:
        task = bar.add_task(label, total=None, note="")
        yield report


@contextmanager
def _heartbeat(label: str, stream: TextIO, every: float) -> Iterator[Report]:
    begin, finished = time.monotonic(), threading.Event()
    last: list[tuple[float, float, str, float]] = [(0, 0, "", 0)]

    def report(done: float, total: float, note: str = "", start: float = 0) -> None:
        last[0] = done, total, note, start

    def beat() -> None:
        # A thread, because the work itself may be one long call that reports nothing.
        while not finished.wait(every):
            print(line(label, time.monotonic() - begin, *last[0]), file=stream, flush=True)

    thread = threading.Thread(target=beat, name="heartbeat", daemon=True)
    thread.start()
    try:
        yield report
    finally:
        finished.set()
        thread.join()


def line(label: str, elapsed: float, done: float, total: float, note: str = "", start: float = 0) -> str:
    """Return a heartbeat: how far, how long, how much longer at this run's rate."""
    said = f" ({note})" if note else ""
    if not done > start:
        return f"{label}: running for {elapsed:.0f} s{said}"
    left = elapsed * (total - done) / (done - start)
    return f"{label}: {done / total:.0%}{said} after {elapsed:.0f} s, about {left:.0f} s left"
