"""Progress of long work: a bar on a terminal, elsewhere a line every few seconds, so that a log is never silent."""

import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TextIO

Report = Callable[[int, int], None]

HEARTBEAT = 5.0  # seconds between two lines; work that is done sooner leaves none


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

    columns = (BarColumn(), TimeElapsedColumn(), TextColumn("left:"), TimeRemainingColumn())
    bar = Progress(TextColumn(label, markup=False), *columns, console=Console(file=stream), transient=True)
    with bar:
        task = bar.add_task(label, total=None)
        yield lambda done, total: bar.update(task, completed=done, total=total)


@contextmanager
def _heartbeat(label: str, stream: TextIO, every: float) -> Iterator[Report]:
    start, finished, last = time.monotonic(), threading.Event(), [0, 0]

    def report(done: int, total: int) -> None:
        last[:] = done, total

    def beat() -> None:
        # A thread, because the work itself may be one long call that reports nothing.
        while not finished.wait(every):
            print(line(label, time.monotonic() - start, *last), file=stream, flush=True)

    thread = threading.Thread(target=beat, name="heartbeat", daemon=True)
    thread.start()
    try:
        yield report
    finally:
        finished.set()
        thread.join()


def line(label: str, elapsed: float, done: int, total: int) -> str:
    """Return a heartbeat: how far, how long, how much longer at this rate."""
    if not done:
        return f"{label}: running for {elapsed:.0f} s"
    return f"{label}: {done / total:.0%} after {elapsed:.0f} s, about {elapsed * (total / done - 1):.0f} s left"
