"""P2.1: growth rate and exact neutral curve of D on the radial hopper flow, perturbed equations, epsilon = 2e-5 s."""

import numpy as np

from figures import captions
from figures.common import DOUBLE, Result, characteristics, compass, long_waves, page, tongues
from stability import plotting

LEVELS = (1, 10, 100, 1000)  # 1/s
LEADER = {"arrowstyle": "-", "lw": 0.5}
NULL = 45.0  # degrees from e_r: with tr A = 0 the null directions of M (P6) are those of the velocity characteristics
DOT = {"marker": "o", "ms": 3.4, "mfc": "white", "mec": "black", "mew": 0.8, "ls": "none", "zorder": 6}


def draw(result: Result) -> tuple:
    ds, tip, curve = result("P2.1"), result("P2.1-tip"), result("P2.1-curve")
    q = curve.neutral_wavenumber
    shortest, fastest = q.isel(q.argmax(...)), ds.growth_rate.isel(ds.growth_rate.argmax(...))
    figure = page(DOUBLE, 96)
    ax = figure.add_axes((0.045, 0.275, 0.37, 0.645), projection="polar")
    plotting.radius(ax, ds.wavenumber.values[0], ds.wavenumber.values[-1], label_from=10)
    plotting.polar_neutral(curve, ax)
    drawn = plotting.polar_growth(ds, ax, LEVELS, decay=False, neutral=False)
    least, most = long_waves(ds, ax)
    compass(ax, characteristics(ds))
    ax.plot(np.radians(fastest.wave_angle), np.log10(fastest.wavenumber), **DOT)
    ax.text(np.radians(270), 1.0, "longer than\nthe hopper", ha="center", va="center", linespacing=1.0)
    bar = figure.add_axes((0.055, 0.115, 0.35, 0.024))
    plotting.growth_bar(drawn, LEVELS, bar, r"growth rate $\mathrm{Re}\,\lambda_2$ (s$^{-1}$)")

    side = figure.add_axes((0.565, 0.125, 0.41, 0.795))
    tongues(curve, tip, side, NULL, LEVELS)
    side.plot(NULL - fastest.wave_angle, fastest.wavenumber, **DOT)
    side.set(xlabel="45° \N{MINUS SIGN} direction of the wave (deg)", ylabel=r"wavenumber $|\xi|$ (m$^{-1}$)")
    side.set_xticks([10, 1, 0.1, 0.01], ["10", "1", "0.1", "0.01"])
    top = f"closes at {shortest:.0f} m$^{{-1}}$"
    side.annotate(top, (NULL - shortest.wave_angle, shortest), (0.6, 9e3), va="center", ha="right", arrowprops=LEADER)
    side.text(3, 420, "growing", color="white")
    side.text(0.02, 20, "decaying", ha="center")
    for letter, x in (("(a)", 0.02), ("(b)", 0.495)):
        figure.text(x, 0.945, letter)
    told = {
        "fastest": f"{fastest:.3g} 1/s at {fastest.wavenumber:.3g} 1/m and {fastest.wave_angle:.4g} deg",
        "closed": f"{shortest:.4g} 1/m, {shortest.wave_angle:.5g} deg", "least": least, "most": most,
    }  # fmt: skip
    return figure, plotting.caption(captions.P2_1.format(**told), ds, tip, curve)
