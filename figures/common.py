"""What the figures share: sizes, results kept between runs, and the marks of the characteristic directions."""

import json
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from xarray import Dataset

import stability as st
from figures.fronts import visible
from stability.errors import CheckpointError
from stability.plan import marched
from stability.plotting import GROWTH, LINE, loop, unstable_regions
from stability.results import described, save, versions
from stability.scene import Scene
from stability.timestepper import checkpoint as checkpoints

# What a figure is drawn from: the name of a scene -> its result. With beside=True, of a run that is made only when it
# is asked for, None where it has not been made.
Result = Callable[..., Any]

HERE = Path(__file__).parent
SCENES = HERE / "scenes"
STYLE = HERE / "style.mplstyle"
SINGLE, DOUBLE = 86 / 25.4, 178 / 25.4  # inches: the column widths of most journals
RIM = {0: "0°, $\\mathbf{e}_r$", 90: "90°, $\\mathbf{e}_\\theta$", 180: "180°", 270: "270°"}

# The lines of a run and of a finer one beside it.
COLOURS: tuple[dict[str, Any], ...] = ({"color": "black", "lw": 0.9}, {"color": "#d1690e", "lw": 0.7})

# Degrees from e_r to the major principal stress (the axis of the smaller eigenvalue of A) on the hopper's axis: it
# converges, so that it is squeezed across, along e_theta.
STRESS_AXIS = 90.0


def page(width: float, millimetres: float) -> Figure:
    """Return an empty figure of one of the two widths."""
    return Figure(figsize=(width, millimetres / 25.4))


def result(name: str, folder: Path, fresh: bool = False, scenes: Path = SCENES) -> Dataset:
    """Return the result of a scene: from ``folder`` if it is still what the scene gives, else computed and kept.

    A march shows how far it is and keeps a checkpoint, from which it goes on where it was interrupted.
    """
    if not fresh and (ds := kept(name, folder, scenes)) is not None:
        return ds
    scene = st.load_scene(scenes / f"{name}.toml")
    if scene.request.kind != "march":
        ds = st.run(scene)
        save(ds, folder / f"{name}.nc")
        return ds
    checkpoint = folder / f"{name}.nc.checkpoint"
    if fresh or outdated(checkpoint, scene):
        checkpoints.remove(checkpoint)
    ds = described(st.run(scene, progress=True, checkpoint=checkpoint), signature=signature(scene))
    save(ds, folder / f"{name}.nc")
    checkpoints.remove(checkpoint)
    return ds


def kept(name: str, folder: Path, scenes: Path = SCENES) -> Dataset | None:
    """Return the result in ``folder`` if the same scene, versions and, of a march, sources wrote it."""
    scene, path = st.load_scene(scenes / f"{name}.toml"), folder / f"{name}.nc"
    if not path.exists():
        return None
    ds = st.open_results(path)
    same = ds.attrs["scene_text"] == scene.text and json.loads(ds.attrs["versions"]) == versions()
    if scene.request.kind == "march":
        same = same and json.loads(ds.attrs.get("signature", "{}")) == signature(scene)
    return ds if same else None


def signature(scene: Scene) -> dict[str, str]:
    """Return what decides the numbers of a march."""
    return marched(scene).signature(scene.text)


def outdated(checkpoint: Path, scene: Scene) -> bool:
    """Return whether a checkpoint is of another scene or of other sources, or cannot be read."""
    try:
        return checkpoint.exists() and not checkpoints.load(checkpoint, signature(scene))
    except CheckpointError:
        return True


def story(ds: Dataset, apart: float, count: int) -> list[float]:
    """Return the times of a figure's snapshots: from where waves first show, or as late as the run allows, on."""
    try:
        start = ds.time.values[visible(ds)]
    except ValueError:
        start = ds.time.values[-1]
    start = min(start, ds.time.values[-1] - (count - 1) * apart)
    return [float(ds.time.sel(time=start + i * apart, method="nearest")) for i in range(count)]


def ray(ds: Dataset, angle: float) -> Dataset:
    """Return a march along the ray of its mesh next to an angle (deg)."""
    return ds.sel(theta=angle, method="nearest")


def characteristics(ds: Dataset) -> dict[str, list[float]]:
    """Return the directions (degrees from e_r) of waves across velocity and stress characteristics (L5)."""
    friction_angle = json.loads(ds.attrs["parameters"])["friction_angle"]
    edges = {"velocity": 45.0, "stress": 45.0 + friction_angle / 2}
    return {name: sorted((STRESS_AXIS + sign * edge + turn) % 360 for sign in (1, -1) for turn in (0, 180))
            for name, edge in edges.items()}  # fmt: skip


def compass(ax: Axes, directions: dict[str, list[float]]) -> None:
    """Draw the characteristic directions through a polar map, and label its rim."""
    for dashes, (name, angles) in zip(((5, 2.5), (1, 1.5)), directions.items(), strict=True):
        for i, angle in enumerate(np.radians(angles)):
            label = None if i else f"{name} characteristics"
            ax.plot([angle, angle], ax.get_ylim(), color="black", lw=0.9, ls=(0, dashes), label=label)
    ticks = {a: f"{a:g}°" for angles in directions.values() for a in angles} | RIM
    ax.set_thetagrids(list(ticks), list(ticks.values()))
    ax.figure.legend(*ax.get_legend_handles_labels(), loc="upper center", ncols=2, columnspacing=1.5,
                     bbox_to_anchor=(np.mean(ax.get_position().intervalx), ax.get_position().y0 - 0.045))  # fmt: skip


def long_waves(ds: Dataset, ax: Axes) -> tuple[float, float]:
    """Hatch the disc of long waves that grow in every direction, and return the range of wavenumbers of its edge.

    Such waves are longer than the flow, so that the coefficients of its linearisation are not constant along them.
    """
    growing = ds.growth_rate.transpose("wave_angle", "wavenumber").values > 0
    edge = ds.wavenumber.values[growing.argmin(axis=1)]
    disc: dict[str, Any] = {"facecolor": "0.88", "edgecolor": "0.35", "hatch": "//////", "lw": 0}
    ax.fill_between(np.radians(ds.wave_angle.values), ax.get_ylim()[0], np.log10(edge), **disc)
    return edge.min(), edge.max()


def tongues(curve: Dataset, ds: Dataset, ax: Axes, direction: float, levels: Sequence[float]) -> None:
    """Draw the unstable region that closes just below a direction over the angle left to it: its tip at full width.

    Parameters
    ----------
    curve, ds : results of `neutral_curve`, and of `growth_map` in directions that approach ``direction``
    ax : its horizontal axis becomes ``direction - wave_angle`` (degrees, logarithmic), its vertical one the wavenumber
    direction : degrees; the regions that end less than 1 degree below it are drawn
    levels : growth rates (1/s) at which the colour changes
    """
    left, q = direction - ds.wave_angle.values, ds.wavenumber.values
    growth = ds.growth_rate.transpose("wavenumber", "wave_angle").values
    for angle, low, high in unstable_regions(curve):
        if 0 < direction - angle[-1] < 1:
            outline = loop(direction - angle, direction - angle), loop(low, high)
            (region,) = ax.fill(*outline, facecolor=GROWTH[0], lw=0)
            ax.contourf(left, q, growth, [0, *levels], colors=GROWTH[: len(levels)]).set_clip_path(region)
            ax.plot(*outline, **LINE)
    ax.set(xscale="log", yscale="log", xlim=(left.max(), left.min()), ylim=(q.min(), q.max()))


def listed(angles: list[float]) -> str:
    return ", ".join(f"{a:g}" for a in angles) + " deg"
