"""A1: the atlas of symbols: growth of short waves over direction, one panel per registered closure."""

from typing import Any

from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from figures import atlas_captions
from figures.atlas import Symbol, by_closure, symbol
from figures.common import DOUBLE, Result, page
from stability.plotting import GROWTH

COLUMNS, ROWS = 4, 4
LOWEST, HIGHEST = -1.6, 2.2
BLUE = "#2b5d8a"  # darker than the blues of decay
LINES: tuple[dict[str, Any], ...] = (
    {"color": "black", "lw": 1.0, "zorder": 3},
    {"color": BLUE, "lw": 0.9, "ls": (0, (3.5, 1.5)), "zorder": 2.5},
)
SHADES = {2: GROWTH[2], 1: GROWTH[1], 0: GROWTH[0]}
CLOSING: dict[str, Any] = {"color": GROWTH[3], "lw": 0.8, "ls": (0, (1, 1.2)), "zorder": 2}
DOT: dict[str, Any] = {"marker": "o", "ms": 3.2, "mfc": "white", "mec": "black", "mew": 0.8, "ls": "none", "zorder": 6}


def draw(result: Result) -> tuple:
    figure = page(DOUBLE, 150)
    panels = {name: [symbol(b) for b in states] for name, states in by_closure().items()}
    axes = figure.subplots(ROWS, COLUMNS, sharex=True, sharey=True)
    figure.subplots_adjust(left=0.058, right=0.985, bottom=0.068, top=0.968, wspace=0.08, hspace=0.28)
    for ax, (name, symbols) in zip(axes.flat, panels.items(), strict=False):
        ax.set_title(name, loc="left", pad=2.5)
        panel(ax, symbols)
    axes[0, 0].set(xlim=(0, 180), ylim=(LOWEST, HIGHEST), yticks=(-1, 0, 1))
    axes[0, 0].set_xticks(range(0, 181, 45), [f"{a}°" for a in range(0, 181, 45)])
    axes[0, 0].set_xticks(range(0, 181, 15), minor=True)
    for ax in axes.flat[len(panels) :]:
        ax.set_axis_off()
    for ax in axes.flat[len(panels) - COLUMNS : len(panels)]:
        ax.tick_params(labelbottom=True)
        for i, side in ((0, "left"), (-1, "right")):
            ax.get_xticklabels()[i].set_ha(side)
    figure.supxlabel("direction of the wave, from the axis of extension", fontsize=8, y=0.004)
    figure.supylabel(r"$\mathrm{Re}\,\lambda\,/\,|\xi|^n$ over its largest value", fontsize=8, x=0.003)
    place = axes.flat[len(panels)].get_position()
    figure.legend(handles=key(), loc="upper left", bbox_to_anchor=(place.x0, place.y1 + 0.01), labelspacing=0.55)
    return figure, atlas_captions.atlas([s for symbols in panels.values() for s in symbols], LOWEST)


def panel(ax: Axes, symbols: list[Symbol]) -> None:
    """Draw the states of one closure."""
    ax.axhline(0, color="0.6", lw=0.5, zorder=1)
    first = symbols[0].verdict
    for low, high in first.wedge:
        for turn in (0, -360):
            if low == high:
                ax.axvline(low + turn, **CLOSING)
            else:
                end = high if low < high else high + 360  # of a range that passes 0
                ax.axvspan(low + turn, end + turn, color=SHADES[int(first.exponent)], lw=0, zorder=0)
    for s, line, y in zip(symbols, LINES, (0.96, 0.82 if symbols[0].wavenumber is None else 0.36), strict=False):
        ax.plot(s.wave_angle, s.growth, **line)
        ax.text(0.5, y, words(s), color=line["color"], ha="center", va="top", transform=ax.transAxes,
                linespacing=1.1, zorder=7)  # fmt: skip
        if s.unstable:
            worst = s.verdict.worst_angle
            ax.plot([worst, 180 - worst], [1, 1], clip_on=False, **DOT | {"mec": line["color"]})


def words(s: Symbol) -> str:
    """Return the exponent of growth, or that waves decay, and the wave that is drawn."""
    n = f"$n={s.verdict.exponent}$"
    wave = "" if s.wavenumber is None else f"\nat {s.wavenumber:g}/m"
    return (n if s.unstable else f"decays, {n}") + wave


def key() -> list:
    """Return the handles of the legend."""
    return [
        *(Patch(color=SHADES[n], label=f"directions that grow, $n={n}$") for n in SHADES),
        Line2D([], [], **CLOSING, label="direction on which growth closes in"),
        Line2D([], [], **DOT, label="worst direction, limiting growth"),
        Line2D([], [], **LINES[0], label="benchmark state"),
        Line2D([], [], **LINES[1], label="second state of the same closure"),
    ]
