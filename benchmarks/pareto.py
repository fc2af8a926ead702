"""Figure X2: error against time for every rung, the Pareto front marked; and its data, X2.csv."""

import csv
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from matplotlib.axes import Axes
from matplotlib.ticker import LogLocator, NullFormatter

from benchmarks.rows import Group
from benchmarks.rungs import CURVES, SAMPLES

CAPTION = """X2. Error against time for every way to the same answer; a filled mark is on the Pareto front: nothing else
is both faster and at least as accurate. Left, growth rates: median error over ||D||; M and D' err because they leave
terms out. Right, the neutral wavenumbers of 400 directions: median error of ln |xi|. Process time on one core. What
errs by less than 1e-19 is drawn there, with an arrow."""
FLOOR = 1e-19


@dataclass(frozen=True)
class Point:
    """A rung: seconds per sample or direction, and the median error."""

    panel: str
    rung: str
    time: float
    error: float


def points(group: Group) -> list[Point]:
    """Return the rungs of a group that is a panel of the figure."""
    rungs = group.rows if group.name in (SAMPLES, CURVES) else []
    return [Point(group.name, r.variant, r.time, r.error) for r in rungs if r.time is not None and r.error is not None]


def front(panel: Sequence[Point]) -> list[Point]:
    """Return those points that no other one beats in both, fastest first."""
    return sorted((p for p in panel if not any(beats(q, p) for q in panel)), key=lambda p: p.time)


def beats(one: Point, other: Point) -> bool:
    """Return whether one point is at least as good as the other in both, and better in one."""
    return one != other and one.time <= other.time and one.error <= other.error


def write(every: Sequence[Point], path: Path) -> None:
    """Write the figure's data."""
    with path.open("w", encoding="utf-8", newline="") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(["panel", "rung", "seconds", "median_error", "pareto"])
        for p in every:
            best = p in front([q for q in every if q.panel == p.panel])
            table.writerow([p.panel, p.rung, f"{p.time:.4g}", f"{p.error:.3g}", int(best)])


def panel(ax: Axes, rungs: Sequence[Point], scale: float, unit: str) -> None:
    """Draw one panel; times are multiplied by ``scale``."""
    best = front(rungs)
    errors = {p: max(p.error, FLOOR) for p in rungs}
    ax.step([p.time * scale for p in best], [errors[p] for p in best], where="post", color="0.6", lw=0.8, zorder=1)
    for number, p in enumerate(rungs, 1):
        fill = "#b94f10" if p in best else "white"
        ax.plot(p.time * scale, errors[p], "o", mec="#b94f10", mfc=fill, ms=5, label=f"{number}  {p.rung}")
        ax.annotate(
            f"{number}{'' if p.error >= FLOOR else ' ↓'}",
            (p.time * scale, errors[p]),
            (4, 3),
            textcoords="offset points",
            fontsize=7,
        )
    ax.set(xscale="log", yscale="log", xlabel=f"time ({unit})")
    ax.margins(0.09)
    if max(p.time for p in rungs) < 100 * min(p.time for p in rungs):  # too few powers of ten to read the axis by
        ax.xaxis.set_major_locator(LogLocator(subs=(1, 2, 5)))
        ax.xaxis.set_major_formatter("{x:g}")
    ax.xaxis.set_minor_formatter(NullFormatter())
    ax.legend(loc="upper center", bbox_to_anchor=(0.5, -0.22), fontsize=6.5, handlelength=1, frameon=False)


def draw(every: Sequence[Point], folder: Path) -> list[Path]:
    """Write X2.pdf, X2.png and X2.txt into a folder, and return their paths."""
    from matplotlib import style
    from matplotlib.figure import Figure

    from stability.plotting import save

    with style.context(["default", Path(__file__).parent.parent / "figures" / "style.mplstyle"]):
        figure = Figure(figsize=(178 / 25.4, 120 / 25.4))
        left, right = figure.subplots(
            1, 2, gridspec_kw={"bottom": 0.46, "wspace": 0.3, "top": 0.97, "left": 0.1, "right": 0.98}
        )
        panel(left, [p for p in every if p.panel == SAMPLES], 1e9, "ns per sample")
        panel(right, [p for p in every if p.panel == CURVES], 1e6, "µs per direction")
        left.set_ylabel("median error / ‖D‖")
        right.set_ylabel("median error of ln |ξ|")
        return save(figure, folder, "X2", CAPTION)
