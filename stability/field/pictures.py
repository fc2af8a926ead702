"""A field map drawn: verdict and growth side by side. Nothing is computed here but colours."""

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import QuadMesh
from matplotlib.colors import BoundaryNorm, ListedColormap
from matplotlib.patches import Patch
from xarray import Dataset

from stability.plotting import DECAY, GROWTH

# By code: masked, stable, finite, bounded, ill-posed, undecided. They differ in lightness too.
COLOURS = ("#ffffff", DECAY[1], GROWTH[1], GROWTH[2], GROWTH[4], "#6e6e6e")
WORDS = ("not judged", "stable", "finite waves grow", "short waves grow, bounded", "ill-posed", "undecided")
BELOW = DECAY[1]
LABELS = {
    "grid_e_folds": "e-folds of waves of {cells:g} cells",
    "grid_growth_rate": "growth rate of waves of {cells:g} cells (1/s)",
    "growth_rate": "largest growth rate (1/s)",
}
SIZE = 4.0  # points^2: of the mark of a scattered point


def field_verdicts(ds: Dataset, ax: Axes) -> Any:
    """Draw the verdict at every point of a field map, with a legend of the kinds that occur."""
    code = ds["verdict"].values.astype(float)
    drawn = coloured(ds, ax, code, ListedColormap(COLOURS), BoundaryNorm(np.arange(-0.5, 6), 6))
    kinds = [k for k in range(6) if np.any(code == k)]
    ax.legend(handles=[Patch(fc=COLOURS[k], ec="black", lw=0.4, label=WORDS[k]) for k in kinds], frameon=False,
              loc="upper center", bbox_to_anchor=(0.5, -0.24), ncols=2, fontsize="small")  # fmt: skip
    return drawn


def field_growth(ds: Dataset, ax: Axes, levels: Any, name: str = "grid_e_folds", bar: Axes | None = None) -> Any:
    """Draw a variable of a field map in the colours of growth.

    Parameters
    ----------
    ds : result of `field_map`
    ax : axes
    levels : values, positive and increasing, at which the colour changes; all that is less is drawn as decay
    name : ``grid_e_folds``, ``growth_rate`` or ``grid_growth_rate``
    bar : axes of the colour bar; None: they are taken from ``ax``

    Returns
    -------
    what was drawn
    """
    bounds = [-np.inf, *levels, np.inf]
    colours = ListedColormap([BELOW, *GROWTH[-len(levels) :]])
    code = np.digitize(ds[name].values, bounds[1:-1]).astype(float)
    code[~(ds["verdict"].values > 0)] = np.nan
    drawn = coloured(ds, ax, code, colours, BoundaryNorm(np.arange(-0.5, len(levels) + 1), len(levels) + 1))
    place: dict[str, Any] = {"cax": bar} if bar else {"ax": ax, "pad": 0.26, "shrink": 0.9}
    scale = ax.figure.colorbar(drawn, orientation="horizontal", **place)
    scale.set_ticks([i + 0.5 for i in range(len(levels))], labels=[f"{v:g}" for v in levels])
    scale.set_label(LABELS.get(name, name.replace("_", " ")).format(cells=float(ds.attrs["cells"])))
    return drawn


def coloured(ds: Dataset, ax: Axes, values: np.ndarray, colours: ListedColormap, norm: BoundaryNorm) -> Any:
    """Draw values on the field's own points."""
    ax.set(aspect="equal", xlabel=r"$x$ (m)", ylabel=r"$y$ (m)")
    x, y = ds["x"].values, ds["y"].values
    if values.ndim == 2:
        x, y = np.meshgrid(x, y) if x.ndim == 1 else (x, y)
        drawn: QuadMesh = ax.pcolormesh(corners(x), corners(y), values, cmap=colours, norm=norm, rasterized=True)
        return drawn
    return ax.scatter(x, y, c=values, s=SIZE, cmap=colours, norm=norm, lw=0, rasterized=True)


def corners(centres: np.ndarray) -> np.ndarray:
    """Return the corners of cells around points (rows, columns): means of four, continued linearly at the border."""
    wide = np.pad(centres, 1, mode="reflect", reflect_type="odd")
    return (wide[1:, 1:] + wide[:-1, 1:] + wide[1:, :-1] + wide[:-1, :-1]) / 4
