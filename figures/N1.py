"""N1: the average stress in the hopper, snapshots 0.01 s apart, epsilon = 2e-5 s; a finer run below if kept."""

import numpy as np

from figures import captions
from figures.common import DOUBLE, Result, page, story
from figures.fronts import whole
from stability import plotting

APART, COUNT = 0.01, 4  # s, of the snapshots
LEVELS = np.arange(0, 4.81, 0.2)  # m2/s2


def draw(result: Result) -> tuple:
    runs = [ds for ds in (result("N1"), result("N1-full", beside=True)) if ds is not None]
    times, height = story(runs[0], APART, COUNT), 24 + 58 * len(runs)
    figure, high = page(DOUBLE, height), 54 / height
    for row, ds in enumerate(runs):
        fields = whole(ds)
        for i, time in enumerate(times):
            ax = figure.add_axes((0.01 + 0.2475 * i, 1 - 5 / height - (row + 1) * 1.04 * high, 0.2375, high))
            drawn = plotting.hopper_contours(fields.sel(time=time, method="nearest"), ax, "pressure", LEVELS)
            ax.set(xlim=(-0.4, 0.4), ylim=(0.46, 1.52))
            if row == 0:
                ax.set_title(f"$t={time:.3f}$ s", pad=2)
            if len(runs) > 1 and i == 0:
                said = f"{ds.attrs['elements']}\nelements"
                ax.text(0.99, 0.05, said, transform=ax.transAxes, va="bottom", ha="right")
    figure.axes[0].plot([-0.33, -0.33], [0.5, 1.0], color="black", lw=1.0)
    figure.axes[0].text(-0.355, 0.75, "0.5 m", rotation=90, va="center", ha="right")
    place = figure.add_axes((0.27, 11 / height, 0.46, 3 / height))
    bar = figure.colorbar(drawn, cax=place, orientation="horizontal", ticks=np.arange(5))
    bar.set_label(r"average stress $p/\rho$ (m$^2$ s$^{-2}$)")
    told = f"{times[0]:.3f} to {times[-1]:.3f} s"
    return figure, plotting.caption(captions.N1.format(times=told, first=captions.first_seen(runs[0])), *runs)
