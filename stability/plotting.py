"""Datasets -> Matplotlib axes. Nothing is computed here but units, logarithmic coordinates and colour scales.

Only the object interface of Matplotlib is used (`matplotlib.figure.Figure`): no window, no display, no global state.
Growth is coloured from pale to dark orange, decay in blues that stay lighter, so that the two differ for colour-blind
readers and in greyscale; the neutral line is drawn all the same.
"""

import json
import textwrap
from collections.abc import Iterator, Sequence
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.collections import QuadMesh
from matplotlib.contour import ContourSet
from matplotlib.figure import Figure
from matplotlib.patheffects import withStroke
from matplotlib.projections.polar import PolarAxes
from xarray import Dataset

from stability.codegen import write_atomically
from stability.model import Model
from stability.results import assumptions, registered

Levels = Sequence[float]
GROWTH = ("#fdebd3", "#fbc48b", "#ee8a3a", "#b94f10", "#6e2405")  # slowest to fastest
DECAY = ("#f2f6fa", "#e4ecf4", "#d5e2ee", "#c6d8e8", "#b7cde2")
LINE: dict[str, Any] = {
    "color": "black",
    "lw": 1.0,
    "solid_capstyle": "round",
    "solid_joinstyle": "round",
}  # neutral curves
HALO = [withStroke(linewidth=1.6, foreground="white")]  # keeps text legible on colours
# Without these entries the files are the same in every run, and on every machine with the same packages.
METADATA = {"pdf": {"CreationDate": None, "Creator": None, "Producer": None}, "png": {"Software": None}}


def radius(ax: PolarAxes, low: float, high: float, label_from: float = 0, angle: float = 67.5) -> None:
    """Give a polar map the radius log10 |xi|, from ``low`` to ``high`` (1/m), with labels from ``label_from`` on."""
    lowest, highest = np.log10([low, high])
    ticks = np.arange(np.floor(lowest) + 1, np.ceil(highest))
    ax.set_rlim(lowest, highest)
    labels = [f"$10^{{{t:.0f}}}$" if 10**t >= label_from else "" for t in ticks]
    ax.set_rgrids(ticks, labels, angle=angle, ha="center", va="center", path_effects=HALO)
    ax.text(np.radians(angle), highest + 0.115 * (highest - lowest), r"$|\xi|$ (m$^{-1}$)", ha="center", va="center")


def polar_growth(ds: Dataset, ax: PolarAxes, levels: Levels, decay: bool = True, neutral: bool = True) -> ContourSet:
    """Draw a growth map in polar form: the angle is the direction of the wave, the radius log10 of its wavenumber.

    Parameters
    ----------
    ds : result of `growth_map` at one point
    ax : polar axes; `radius` sets their range
    levels : growth rates (1/s), positive and increasing, at which the colour changes; decay takes the same ones
    decay : whether to colour decaying waves too
    neutral : whether to draw the line of zero growth; False where `polar_neutral` draws the exact one

    Returns
    -------
    The filled contours, for `growth_bar`.
    """
    signed = np.array([*(-v for v in reversed(levels)), 0, *levels] if decay else [0, *levels])
    colours = [*DECAY[: len(levels)][::-1] * decay, *GROWTH[: len(levels)]]
    where = np.radians(ds.wave_angle.values), np.log10(ds.wavenumber.values)
    growth = np.arcsinh(ds.growth_rate.transpose("wavenumber", "wave_angle").values / levels[0])
    found = ax.contourf(*where, growth, levels=np.arcsinh(signed / levels[0]), colors=colours)
    if neutral:
        ax.contour(*where, growth, levels=[0], colors=LINE["color"], linewidths=LINE["lw"])
    return found


def growth_bar(drawn: ContourSet, levels: Levels, cax: Axes, label: str) -> None:
    """Draw a colour bar with evenly spaced colours, whatever the scale on which they were found."""
    bar = cax.figure.colorbar(drawn, cax=cax, orientation="horizontal", spacing="uniform")
    ticks = list(drawn.levels)
    values = [*(-v for v in reversed(levels)), 0, *levels][-len(ticks) :]  # the half that is drawn, or all
    bar.set_ticks(ticks, labels=[_number(v) for v in values])
    cax.tick_params(length=0)
    bar.set_label(label)


def _number(value: float) -> str:
    exponent = round(np.log10(abs(value)), 9) if value else 0
    if exponent == int(exponent) and not -2 <= exponent <= 1:
        return f"${'-' * (value < 0)}10^{{{exponent:.0f}}}$"
    return f"${value:g}$"


def unstable_regions(ds: Dataset) -> Iterator[tuple[np.ndarray, np.ndarray, np.ndarray]]:
    """Yield the connected regions inside a neutral curve as (wave_angle, lowest, highest unstable wavenumber).

    Where waves at an end of the range searched are unstable, the end stands in place of a crossing.
    """
    low, high = json.loads(ds.attrs["wavenumber_range"])
    q, up = ds.neutral_wavenumber.values, ds.unstable_above.values == 1
    starts = np.column_stack([np.where(ds.unstable_longest == 1, low, np.nan), np.where(up, q, np.nan)])
    stops = np.column_stack([np.where(ds.unstable_shortest == 1, high, np.nan), np.where(up, np.nan, q)])
    for start, stop in zip(np.sort(starts).T, np.sort(stops).T, strict=True):
        there = np.flatnonzero(np.isfinite(start))
        for run in filter(len, np.split(there, np.flatnonzero(np.diff(there) > 1) + 1)):
            yield ds.wave_angle.values[run], start[run], stop[run]


def polar_neutral(ds: Dataset, ax: PolarAxes, colour: str | None = GROWTH[0]) -> None:
    """Fill the unstable regions of a neutral curve and draw the curve; tips where two crossings meet are closed.

    Parameters
    ----------
    ds : result of `neutral_curve`
    ax : polar axes with their range set by `radius`
    colour : of the regions; None draws the curve alone
    """
    lowest, highest = ax.get_ylim()
    for angle, low, high in unstable_regions(ds):
        theta, low, high = np.radians(angle), *(np.clip(np.log10(v), lowest, highest) for v in (low, high))
        if colour:
            ax.fill_between(theta, low, high, color=colour, lw=0)
        # What is clipped, or an end of the range, is not neutral: no line there.
        low, high = (np.where((v > lowest) & (v < highest), v, np.nan) for v in (low, high))
        if {angle[0], angle[-1]} & {*ds.wave_angle.values[[0, -1]]}:  # it goes on, round the turn or beyond the samples
            ax.plot(theta, low, theta, high, **LINE)
        else:
            ax.plot(loop(theta, theta), loop(low, high), **LINE)


def loop(there: np.ndarray, back: np.ndarray) -> np.ndarray:
    """Return a path to and fro as one closed path."""
    return np.concatenate([there, back[::-1], there[:1]])


def phase(ds: Dataset, ax: Axes, levels: Levels) -> ContourSet:
    """Draw a phase diagram: the exact boundary over delta and Lambda epsilon, and inside it the growth rate.

    Parameters
    ----------
    ds : result of `phase_diagram`
    ax : its horizontal axis becomes delta, its vertical one Lambda epsilon (logarithmic)
    levels : growth rates times epsilon, positive and increasing, at which the colour changes

    Returns
    -------
    The filled contours, for `growth_bar`.
    """
    delta, scaled = ds.delta.values, ds.scaled_wavenumber.values
    boundary = np.clip(ds.critical_scaled_wavenumber.values, scaled[0], scaled[-1])
    growth = ds.scaled_growth_rate.transpose("scaled_wavenumber", "delta").values
    # The colours come from samples, their outline is exact: it clips the contours, and is filled where they leave gaps.
    region = ax.fill_between(delta, scaled[0], boundary, color=GROWTH[0], lw=0)
    drawn = ax.contourf(delta, scaled, growth, [0, *levels], colors=GROWTH[: len(levels)])
    drawn.set_clip_path(region.get_paths()[0], ax.transData)
    beyond = (boundary == scaled[0]) | (boundary == scaled[-1])
    # Drawn up to where it leaves the picture, not along its border.
    hidden = beyond & np.append(beyond[1:], True) & np.append(True, beyond[:-1])
    ax.plot(delta, np.where(hidden, np.nan, boundary), **LINE)
    ax.set(yscale="log", xlim=(delta[0], delta[-1]), ylim=(scaled[0], scaled[-1]))
    return drawn


def hopper_contours(
    ds: Dataset, ax: Axes, name: str, levels: Levels, colours: str = "viridis", lines: int = 2
) -> ContourSet:
    """Draw a field of one snapshot of a march as filled contours in the plane of the hopper, its apex below.

    Parameters
    ----------
    ds : one snapshot, with the dimensions r and theta
    ax : equal scales on both axes, no frame
    name : of the field
    levels : its values at which the colour changes
    colours : name of a colour map
    lines : every which of the levels is drawn as a line too; 0 for none
    """
    r, theta = np.meshgrid(ds.r.values, np.radians(ds.theta.values), indexing="ij")
    x, y, values = r * np.sin(theta), r * np.cos(theta), ds[name].transpose("r", "theta").values
    drawn = ax.contourf(x, y, values, levels, cmap=colours, extend="both")
    if lines:
        ax.contour(x, y, values, levels[::lines], colors="black", linewidths=0.25, alpha=0.7)
    edge = np.s_[[*[0] * x.shape[1], *range(len(x)), *[-1] * x.shape[1], *range(len(x))[::-1]]]
    column = np.s_[[*range(x.shape[1]), *[-1] * len(x), *range(x.shape[1])[::-1], *[0] * len(x)]]
    ax.plot(x[edge, column], y[edge, column], color="black", lw=0.6)
    ax.set_aspect("equal")
    ax.axis("off")
    return drawn


def space_time(ds: Dataset, wave: np.ndarray, ax: Axes, largest: float, colours: str = "RdBu_r") -> QuadMesh:
    """Draw a wave (time, r) along one ray of a march over time and radius, and return the coloured mesh."""
    drawn = ax.pcolormesh(
        ds.time.values, ds.r.values, wave.T, cmap=colours, vmin=-largest, vmax=largest, shading="gouraud",
        rasterized=True,
    )  # fmt: skip
    ax.set(xlim=ds.time.values[[0, -1]], ylim=ds.r.values[[0, -1]], xlabel="time (s)", ylabel="$r$ (m)")
    return drawn


def caption(text: str, *results: Dataset) -> str:
    """Return a caption: what is seen, then each result's parameters, assumptions and base state with its residual."""
    parts = dict.fromkeys([" ".join(text.split()), *(part for ds in results for part in _facts(ds))])  # each one once
    return "\n\n".join(textwrap.fill(part, 100) for part in parts) + "\n"


def _facts(ds: Dataset) -> Iterator[str]:
    model = Model(*registered(ds))
    units = {word: record.unit for word, record in (model.parameters | model.point).items()}
    parameters, assumed = json.loads(ds.attrs["parameters"]), assumptions(ds)

    def told(word: str, value: float) -> str:
        return f"{word.replace('_', ' ')} = {value:g}" + (f" {units[word]}" if units.get(word, "1") != "1" else "")

    if printed := ", ".join(told(word, value) for word, value in parameters.items() if word not in assumed):
        yield f"Parameters: {printed}."
    if assumed:
        yield "Assumed: " + "; ".join(f"{told(w, parameters[w])} ({why})" for w, why in assumed.items()) + "."
    if ds.attrs.get("request") == "march":
        yield _marched(ds)
        return
    if point := ", ".join(told(word, ds[word].item()) for word in model.point if word in ds.coords):
        x, y = (ds[n].item() for n in ("momentum_residual_x", "momentum_residual_y"))
        mass = f" and {abs(ds.mass_residual.item()):.1g} 1/s in its mass balance" if "mass_residual" in ds else ""
        yield f"Base state at {point}: it misses a steady flow by {np.hypot(x, y):.1g} m/s2 in its momentum{mass}."
    if (sign := ds.attrs.get("sign", "")).startswith("certified"):
        yield f"Signs of the growth rate: {sign}."


def _marched(ds: Dataset) -> str:
    """Return what a caption says of a march: mesh, steps, floor, noise, and the cells below the floor."""
    mesh, steps = json.loads(ds.attrs["mesh"]), json.loads(ds.attrs["steps"])
    part = "half the wedge (the other half is its mirror image)" if mesh["half"] else "the whole wedge"
    scheme = {"backward_euler": "backward Euler", "bdf2": "BDF2"}[ds.attrs["scheme"]]
    below = json.loads(ds.attrs["counted"])["cells_below_floor"]
    return (
        f"Run {ds.attrs['title']}: {ds.attrs['elements']} {mesh['kind']} elements over {part}; {scheme}, "
        f"{ds.sizes['step']} steps of at most {steps['largest']:g} s to t = {ds.time.values[-1]:g} s; random initial "
        f"velocities up to {float(ds.attrs['noise']):g} sqrt(g r_0), seed {ds.attrs['seed']}; ||V|| in the rheology at "
        f"least {float(ds.attrs['floor']):g} 1/s: {below['last']} elements are below it at the end, {below['largest']} "
        f"at most."
    )


def save(figure: Figure, folder: str | Path, name: str, caption: str) -> list[Path]:
    """Write NAME.pdf, NAME.png (300 dpi) and NAME.txt (the caption), the same bytes in every run; return the paths."""
    files = {}
    for kind, metadata in METADATA.items():
        content = BytesIO()
        with rc_context({"pdf.fonttype": 42}):  # whole fonts, which editors can use, in place of outlines
            figure.savefig(content, format=kind, dpi=300, metadata=metadata)
        files[Path(folder) / f"{name}.{kind}"] = content.getvalue()
    files[Path(folder) / f"{name}.txt"] = caption.encode()
    for path, whole in files.items():
        write_atomically(path, whole)
    return list(files)
