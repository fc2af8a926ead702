"""A2: the mu(I) phase diagram: growth over (I, direction), and the ill-posed region over (mu_s, I)."""

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.path import Path

from figures import atlas_captions, inertial
from figures.common import DOUBLE, Result, page
from stability.plotting import GROWTH, LINE, growth_bar, loop

PUBLISHED = (0.0193500918873711, 0.85226581486577)  # Barker et al. 2015, glass beads
LEVELS = (0.003, 0.01, 0.03, 0.08, 0.2)
RANGE = -4.0, 2.0  # log10 I
DIRECTIONS = np.linspace(22, 50, 113)
ALL_DIRECTIONS = np.linspace(0, 90, 361)
FRICTIONS = np.linspace(1e-3, 0.6, 61)
DOT: dict[str, Any] = {"marker": "o", "ms": 3.2, "mfc": "white", "mec": "black", "mew": 0.8, "ls": "none", "zorder": 6}
LIMIT: dict[str, Any] = {"color": "black", "lw": 0.6, "ls": (0, (1, 1.5)), "zorder": 4}


def draw(result: Result) -> tuple:
    figure = page(DOUBLE, 92)
    left = figure.add_axes((0.068, 0.27, 0.39, 0.66), ylabel="inertial number $I$")
    right = figure.add_axes((0.548, 0.27, 0.437, 0.66), sharey=left)
    drawn = directions(left)
    edges, closing = frictions(right)
    for ax in (left, right):
        ax.set(yscale="log", ylim=10.0 ** np.array(RANGE))
        for limit in PUBLISHED:
            ax.axhline(limit, **LIMIT)
    left.set(xlabel="direction of the wave, from the axis of extension (deg)", xlim=DIRECTIONS[[0, -1]])
    right.set(xlabel=r"static friction $\mu_s$, with $\mu_2-\mu_s$ of glass beads", xlim=(0, 0.6))
    for limit in PUBLISHED:
        figure.text(0.5005, left.transData.transform((0, limit))[1] / figure.bbox.height, f"{limit:.6g}",
                    ha="center", va="center")  # fmt: skip
    bar = figure.add_axes((0.27, 0.115, 0.46, 0.026))
    growth_bar(drawn, LEVELS, bar, r"growth rate $\mathrm{Re}\,\lambda/(\eta|\xi|^2)$, (b): in the worst direction")
    for letter, x in (("(a)", 0.012), ("(b)", 0.52)):
        figure.text(x, 0.955, letter)
    return figure, atlas_captions.mu_i(edges, closing)


def outline(low: float, high: float) -> tuple[np.ndarray, np.ndarray]:
    """Return directions and inertial numbers once round the growing region whose tip is the neutral number ``high``.

    Samples gather at the tip, where both edges meet as the square root of the distance to it.
    """
    numbers = 10 ** (np.log10(high) + (np.log10(low) - np.log10(high)) * np.linspace(0, 1, 120) ** 2)
    first, second = np.array([inertial.wedge(I) for I in numbers]).T
    return loop(first[::-1], second[::-1]), loop(numbers[::-1], numbers[::-1])


def directions(ax: Axes):
    """Draw growth over direction and inertial number, inside the exact neutral curves; return the contours."""
    numbers = np.geomspace(*10.0 ** np.array(RANGE), 241)
    growth = np.array([inertial.growth(I, DIRECTIONS) for I in numbers])
    drawn = ax.contourf(DIRECTIONS, numbers, growth, [0, *LEVELS], colors=GROWTH)
    regions = [outline(10**end, tip) for end, tip in zip(RANGE, inertial.neutral(), strict=True)]
    for region in regions:
        ax.fill(*region, facecolor=GROWTH[0], lw=0, zorder=0)
        ax.plot(*(part[:-1] for part in region), **LINE)
    whole = Path.make_compound_path(*(Path(np.column_stack(region), closed=True) for region in regions))
    drawn.set_clip_path(whole, ax.transData)
    ax.text(36, 0.13, "every direction decays", ha="center", va="center")
    return drawn


def frictions(ax: Axes) -> tuple:
    """Draw the ill-posed region over static friction and inertial number; return glass's edges and the tip."""
    static, number = inertial.tip()
    samples = static * (1 - np.linspace(0, 0.999, 90) ** 2)
    low, high = np.array([inertial.neutral(s) for s in samples[1:]]).T
    edge = np.concatenate([low[::-1], [number], high]), np.concatenate([samples[:0:-1], [static], samples[1:]])
    numbers = np.geomspace(*10.0 ** np.array(RANGE), 73)
    growth = [[inertial.growth(I, ALL_DIRECTIONS, s).max() for s in FRICTIONS] for I in numbers]
    ax.set_facecolor(GROWTH[0])
    ax.tick_params(labelleft=False)
    ax.contourf(FRICTIONS, numbers, growth, [0, *LEVELS], colors=GROWTH)
    ax.fill(edge[1], edge[0], facecolor="white", lw=0)
    ax.plot(edge[1], edge[0], **LINE)
    dots = np.arange(0.05, static, 0.05)
    for condition in np.transpose([inertial.neutral(s, inertial.printed) for s in dots]):
        ax.plot(dots, condition, **DOT, clip_on=True)
    glass = inertial.GLASS["static_friction"]
    ax.axvline(glass, **LIMIT)
    ax.text(glass - 0.005, 6e-4, "glass beads", rotation=90, ha="right", va="center")
    ax.text(0.22, 0.13, "well-posed", ha="center", va="center")
    ax.text(0.5, 4, "ill-posed", ha="center", va="center", color="white")
    return inertial.neutral(), (static, number)
