"""I1: schematic of a shear band. It shows no data: the grains are a random packing from a fixed seed."""

import numpy as np
from matplotlib.patches import Circle, Rectangle

from figures import captions
from figures.common import SINGLE, Result, page
from figures.grains import packing
from stability import plotting

WIDTH, HEIGHT, BAND = 22.0, 20.0, 5.0  # of the block and of the band, in grain diameters
AXIS, REACH = 23.2, 3.6  # where the profile stands, and the largest velocity drawn
DIMENSION = {"arrowstyle": "<->", "lw": 0.6, "shrinkA": 0, "shrinkB": 0, "mutation_scale": 5}
MOTION = DIMENSION | {"arrowstyle": "-|>", "lw": 1.0, "color": "black", "mutation_scale": 8}


def velocity(y: np.ndarray) -> np.ndarray:
    return REACH * np.tanh(4 * y / BAND)


def draw(result: Result) -> tuple:
    figure = page(SINGLE, 58)
    ax = figure.add_axes((0, 0, 1, 1), xlim=(-15, 28.5), ylim=(-14.67, 14.67), aspect="equal")
    ax.axis("off")
    ax.add_patch(Rectangle((-WIDTH / 2, -BAND / 2), WIDTH, BAND, color="#fbc48b", lw=0))
    heights = np.linspace(-HEIGHT / 2, HEIGHT / 2, 401)
    centres, radii = packing(WIDTH, HEIGHT)
    for (x, y), r in zip(centres, radii, strict=True):
        fill = "#fdebd3" if abs(y) < BAND / 2 else "white"
        column = np.hypot(x - velocity(heights), y - heights).min() < 0.52
        ax.add_patch(Circle((x, y), r, fc="0.3" if column else fill, ec="0.15", lw=0.4))
    for sign in (1, -1):
        ax.annotate("", (5 * sign, 11.8 * sign), (-5 * sign, 11.8 * sign), arrowprops=MOTION)
        ax.plot([WIDTH / 2, AXIS + REACH + 1.5], [sign * BAND / 2] * 2, color="black", lw=0.5, ls=(0, (4, 3)))
    ax.annotate("", (13, BAND / 2), (13, -BAND / 2), arrowprops=DIMENSION)
    ax.text(13.5, 0, "several $d$", va="center")
    ax.text(-11.7, 0, "shear\nband", ha="right", va="center", linespacing=1.1)
    (x, y), r = min(zip(centres, radii, strict=True), key=lambda g: np.hypot(*(g[0] - (-10.5, -6.5))))  # it shows d
    for edge in (y - r, y + r):
        ax.plot([x, -12.9], [edge, edge], color="black", lw=0.5)
    ax.annotate("", (-12.6, y + r), (-12.6, y - r), arrowprops=DIMENSION | {"mutation_scale": 3.5})
    ax.text(-13.6, y, "$d$", ha="center", va="center")

    ax.plot([AXIS, AXIS], [-HEIGHT / 2, HEIGHT / 2], color="black", lw=0.5)
    ax.plot([AXIS - REACH, AXIS - REACH, AXIS + REACH, AXIS + REACH], [-HEIGHT / 2, 0, 0, HEIGHT / 2], "k:", lw=0.9)
    ax.plot(AXIS + velocity(heights), heights, color="black", lw=1.2)
    for at in (-9.5, -7.5, -5.5, -3.5, 3.5, 5.5, 7.5, 9.5):
        ax.annotate("", (AXIS + velocity(at), at), (AXIS, at), arrowprops=MOTION | {"lw": 0.6, "mutation_scale": 5})
    ax.text(AXIS, 11.8, "velocity $u$", ha="center", va="center")
    return figure, plotting.caption(captions.I1)
