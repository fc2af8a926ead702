"""P1: the phase diagram of D' in (delta, Lambda epsilon), with the exact limits of delta, for two friction angles."""

import json

import numpy as np

from figures import captions
from figures.common import DOUBLE, Result, page
from stability import plotting

LEVELS = (1e-3, 1e-2, 3e-2, 1e-1, 3e-1)  # of epsilon Re lambda

# Scene -> the exact limits of delta in the paper's letters; above 49.94 degrees the last changes form.
PANELS = {
    "P1": (r"$-\frac{k}{2(1+\sqrt{2})}$", "$0$", "$k$", r"$\frac{1+\sqrt{2}}{2}\,k$"),
    "P1-60": (r"$-\frac{k}{2(1+\sqrt{2})}$", "$0$", "$1$", r"$\frac{1}{k}+\sqrt{1-\frac{1}{k^2}}$"),
}
SIDES = {"P1": ("right", "center", "center", "left"), "P1-60": ("right", "center", "center", "center")}
STABLE = {"P1": ((-0.28, 3), (1.19, 3)), "P1-60": ((-0.125, 100), (1.22, 100))}  # where there is room for the word


def draw(result: Result) -> tuple:
    figure, seen = page(DOUBLE, 90), []
    for letter, left, (name, words) in zip("ab", (0.07, 0.545), PANELS.items(), strict=True):
        ds = result(name)
        seen.append(ds)
        ax = figure.add_axes((left, 0.265, 0.4, 0.585), xlabel=r"rate of dilation $\delta$")
        drawn = plotting.phase(ds, ax, LEVELS)
        low, high = json.loads(ds.attrs["unstable_range"])
        values = [low, *json.loads(ds.attrs["always_unstable_range"]), high]
        ax.set_xticks([0, 0.5, 1])
        ax.set_xticks(np.arange(-4, 15) / 10, minor=True)
        names = ax.secondary_xaxis("top")
        names.set_xticks(values, words, fontsize=9)
        for label, side in zip(names.get_xticklabels(), SIDES[name], strict=True):
            label.set_ha(side)
        ax.vlines(values, *ax.get_ylim(), colors="black", lw=0.6, ls=(0, (1, 1.5)))
        angle = json.loads(ds.attrs["parameters"])["friction_angle"]
        figure.text(left - 0.05, 0.95, f"({letter})  $\\varphi={angle:g}°$")
        middle = sum(values[1:3]) / 2
        ax.text(middle, 30, "growth at\nevery wavelength", ha="center", va="center", color="white", linespacing=1.1)
        for place in STABLE[name]:
            ax.text(*place, "stable", ha="center", va="center")
    note = {"ha": "center", "va": "center", "linespacing": 1.1, "arrowprops": {"arrowstyle": "-", "lw": 0.5}}
    figure.axes[0].annotate("growth of\nlong waves\nonly", (0.89, 0.05), (1.2, 0.05), **note)
    figure.axes[0].set_ylabel(r"$\Lambda\epsilon=\mu|\xi|^2\epsilon/2$")
    plotting.growth_bar(drawn, LEVELS, figure.add_axes((0.27, 0.115, 0.46, 0.025)),
                        r"largest growth rate, $\epsilon\,\mathrm{Re}\,\lambda$")  # fmt: skip
    return figure, plotting.caption(captions.P1, *seen)
