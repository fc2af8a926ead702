"""L1: growth rate of plane waves on the radial hopper flow, rigid-plastic equations, and the edges of the wedges."""

import numpy as np

from figures import captions
from figures.common import SINGLE, Result, characteristics, compass, listed, long_waves, page
from stability import plotting

LEVELS = (1e2, 1e4, 1e6, 1e8)  # 1/s


def draw(result: Result) -> tuple:
    ds = result("L1")
    edges = characteristics(ds)
    figure = page(SINGLE, 104)
    ax = figure.add_axes((0.12, 0.275, 0.76, 0.645), projection="polar")
    plotting.radius(ax, ds.wavenumber.values[0], ds.wavenumber.values[-1], label_from=10)
    drawn = plotting.polar_growth(ds, ax, LEVELS)
    least, most = long_waves(ds, ax)
    compass(ax, edges)
    ax.text(np.radians(36.5), 2.72, "growing", rotation=36.5, rotation_mode="anchor", ha="center", va="center")
    for angle in (0, 180):
        ax.text(np.radians(angle), 2.8, "decaying", ha="center", va="center", path_effects=plotting.HALO)
    ax.text(np.radians(270), 1.05, "longer than\nthe hopper", ha="center", va="center", linespacing=1.0)
    bar = figure.add_axes((0.12, 0.115, 0.76, 0.023))
    plotting.growth_bar(drawn, LEVELS, bar, r"growth rate $\mathrm{Re}\,\lambda_2$ (s$^{-1}$)")
    told = {name: listed(angles) for name, angles in edges.items()}
    return figure, plotting.caption(captions.L1.format(**told, least=least, most=most), ds)
