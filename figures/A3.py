"""A3: critical-state plasticity beside the perturbed system: growth and direction over the rate of dilation."""

from typing import Any

import numpy as np
from matplotlib.axes import Axes

from figures import atlas_captions
from figures.common import DOUBLE, Result, page
from figures.dilation import (
    CRITICAL,
    PERTURBED,
    critical_limit,
    delta,
    k,
    null,
    perturbed_limit,
    scaled,
    slowest_compaction,
)
from stability.plotting import GROWTH, LINE

DELTAS = np.concatenate([np.linspace(-0.3, 0.0, 13)[:-1], np.linspace(0, 1, 29)[:-1] ** 1.5, [0.99]])
FINE = np.linspace(-0.3, 1, 1301)
WAVES = {"critical_state": (1e2, 1e3, 1e4), "perturbed": (1.0, 10.0, 100.0)}  # |xi| (1/m); Lambda epsilon
ASKED = {
    "critical_state": [-0.2, -0.05, 0.0, delta(0.2), delta(0.6)],
    "perturbed": [-0.2, 0.0, 0.1, 0.3, 0.5, 0.7, 0.9],
}
COLOURS = ("#7fa8cc", "#3f78ab", "#1a4468")  # longest wave to shortest
DOT: dict[str, Any] = {"marker": "o", "ms": 3.4, "mfc": "white", "mec": "black", "mew": 0.8, "ls": "none", "zorder": 6}
DILATION = (-10, 0, 10, 20, 30, 45, 60, 90)


def draw(result: Result) -> tuple:
    figure = page(DOUBLE, 118)
    rows = figure.subplots(2, 2, sharex=True, sharey=False, gridspec_kw={"height_ratios": (1.5, 1)})
    figure.subplots_adjust(left=0.07, right=0.985, bottom=0.085, top=0.865, wspace=0.2, hspace=0.1)
    told, first = {}, slowest_compaction()
    for (top, bottom), letters, system, power, limit in (
        (rows[:, 0], "ac", CRITICAL, 1, critical_limit),
        (rows[:, 1], "bd", PERTURBED, 0, perturbed_limit),
    ):
        scale = 1.0 if system is CRITICAL else system.constants["epsilon"]
        for wave, colour in zip(WAVES[system.closure], COLOURS, strict=True):
            q = wave if system is CRITICAL else scaled(wave)
            growth, angle = np.array([system.fastest(d, q) for d in DELTAS]).T
            name = f"$|\\xi|={wave:.0f}$ m$^{{-1}}$" if system is CRITICAL else f"$\\Lambda\\epsilon={wave:g}$"
            top.plot(DELTAS, growth * scale / q**power, color=colour, lw=0.9, label=name)
            bottom.plot(DELTAS, np.where(growth > 0, angle, np.nan), color=colour, lw=0.9)
        top.plot(FINE, limit(FINE), **LINE, label="limit of short waves")
        bottom.plot(FINE, null(FINE), **LINE)
        told[system.closure] = verdicts(system, scale, top, bottom)
        frame(top, bottom, *((first, 1.0, GROWTH[1]) if system is CRITICAL else (0.0, k(), GROWTH[0])))
        for letter, ax in zip(letters, (top, bottom), strict=True):
            ax.text(0.012, 0.965, f"({letter})", transform=ax.transAxes, va="top")
    (a, b), (c, d) = rows
    a.set(ylabel=r"$\mathrm{Re}\,\lambda\,/\,|\xi|$ (m s$^{-1}$)", ylim=(-0.04, 0.62))
    b.set(ylabel=r"$\epsilon\,\mathrm{Re}\,\lambda$", ylim=(-0.09, 0.115))
    for ax in (c, d):
        ax.set(xlabel=r"rate of dilation $\delta=\mathrm{tr}\,V/\|V\|$", ylim=(0, 60), ylabel="fastest direction (deg)")
    figure.text(a.get_position().x0, 0.965, "critical state: exponent 1, ill-posed")
    figure.text(b.get_position().x0, 0.965, "perturbed: exponent 0, bounded growth")
    return figure, atlas_captions.dilation(told, k(), first)


def verdicts(system, scale: float, top: Axes, bottom: Axes) -> list:
    """Draw what the verdict says at some rates of dilation, and return (delta, verdict)."""
    found = [(d, system.verdict(d)) for d in ASKED[system.closure]]
    for d, v in found:
        if v.exponent <= system.exponent:
            top.plot(d, v.coefficient * scale * (v.exponent == system.exponent), **DOT)
        if v.coefficient > 0:
            bottom.plot(d, min(v.worst_angle, 180 - v.worst_angle), **DOT)
    return found


def frame(top: Axes, bottom: Axes, first: float, last: float, shade: str) -> None:
    """Shade the rates of dilation at which short waves grow, and add the dilation angle above."""
    for ax in (top, bottom):
        ax.axvspan(0, last, color=shade, lw=0, zorder=0)
        ax.axvspan(first, 0, color=GROWTH[0], lw=0, zorder=0)
        ax.axhline(0, color="0.6", lw=0.5, zorder=1)
        ax.set(xlim=(-0.3, 1.02))
    above = top.secondary_xaxis("top")
    above.set_xticks(
        [delta(np.sin(np.radians(a))) for a in DILATION], [f"{a}°".replace("-", "\N{MINUS SIGN}") for a in DILATION]
    )
    above.set_xlabel(r"dilation angle $\psi$")
    for x in ((first - 0.3) / 2, *([] if last == 1 else [(last + 1.02) / 2])):
        top.text(x, 0.78, "stable", transform=top.get_xaxis_transform(), ha="center", va="center")
    top.legend(loc="lower center", bbox_to_anchor=((0.3 + last / 2) / 1.32, 0.02), labelspacing=0.3)
