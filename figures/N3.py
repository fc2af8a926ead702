"""N3: radial slices 0.025 s apart at epsilon = 1e-4 s, the waves in space and time, and their length over epsilon."""

import json

import numpy as np
from matplotlib.ticker import NullFormatter

from figures import captions
from figures.common import COLOURS, DOUBLE, Result, page, ray, story
from figures.fronts import RADII, WINDOWS, first_lengths, mean_length, power_law, travel, waves
from stability import plotting

APART, COUNT, ANGLE = 0.025, 5, 6.0  # s, of the snapshots; degrees from the axis, of the slices
SHIFT = 1.0  # m2/s2 between slices
FIRST = ("N3-first-2e-5", "N3-first-4e-5", "N3-first-1e-4", "N3-first-2e-4")
DOT = {"marker": "o", "ms": 3.4, "mfc": "white", "mec": "black", "ecolor": "black", "elinewidth": 0.8, "ls": "none"}
HALF = {"color": "0.5", "lw": 0.8, "ls": (0, (4, 3))}


def draw(result: Result) -> tuple:
    ds, fine, first = result("N3"), result("N3-full", beside=True), [result(name) for name in FIRST]
    figure, times = page(DOUBLE, 84), story(ds, APART, COUNT)
    slices = figure.add_axes((0.045, 0.13, 0.25, 0.79))
    for one, style in zip([ds, fine] if fine is not None else [ds], COLOURS, strict=False):
        for i, time in enumerate(times):
            line = ray(one, ANGLE).sel(time=time, method="nearest")
            slices.plot(line.r, line.pressure - SHIFT * i, **style)
            if one is ds:
                slices.text(1.515, -SHIFT * i, f"{time:.4g} s", fontsize=7, va="center")
    slices.set(xlim=(0.5, 1.5), xlabel="$r$ (m)", ylabel=r"average stress $p/\rho$, each shifted down by 1", yticks=[])
    slices.vlines(0.53, 3.2, 4.2, color="black", lw=0.8)
    slices.text(0.545, 3.7, "1 m$^2$ s$^{-2}$", va="center", fontsize=7)

    plane, moved = figure.add_axes((0.415, 0.13, 0.265, 0.79)), travel(ds, times[1])
    wave = waves(ray(ds, ANGLE).pressure.values, ds.r.values, axis=-1)
    drawn = plotting.space_time(ds, wave, plane, largest=0.3)
    paths(plane, ds, moved, times[0])
    bar = figure.colorbar(drawn, cax=figure.add_axes((0.69, 0.13, 0.011, 0.79)), ticks=[-0.3, 0, 0.3])
    bar.ax.set_yticklabels(["\N{MINUS SIGN}0.3", "0", "0.3"])
    bar.set_label(r"waves of $p/\rho$ (m$^2$ s$^{-2}$)", labelpad=-3)

    law = figure.add_axes((0.815, 0.13, 0.175, 0.79))
    epsilon, length, error, exponent = lengths(first)
    law.errorbar(epsilon, 100 * length, 100 * length * error, **DOT)
    line = np.array([1.4e-5, 2.9e-4])
    law.plot(line, 100 * exponent[2] * line ** exponent[0], color="black", lw=0.8)
    law.plot(line, 100 * np.exp(np.log(length).mean()) * np.sqrt(line / np.exp(np.log(epsilon).mean())), **HALF)
    law.set(xscale="log", yscale="log", xlim=line, ylim=(3, 25))
    law.set(xlabel=r"$\epsilon$ ($10^{-5}$ s)", ylabel="wavelength (cm)")
    law.set_yticks([3, 5, 10, 20], ["3", "5", "10", "20"])
    law.set_xticks(epsilon, [f"{1e5 * one:g}" for one in epsilon])
    for axis in (law.xaxis, law.yaxis):
        axis.set_minor_formatter(NullFormatter())
    law.text(0.06, 0.96, f"$\\epsilon^{{{exponent[0]:.2f} \\pm {exponent[1]:.2f}}}$", transform=law.transAxes, va="top")
    law.text(0.94, 0.05, r"dashed: $\epsilon^{1/2}$", transform=law.transAxes, ha="right")
    for letter, x in (("(a)", 0.01), ("(b)", 0.365), ("(c)", 0.765)):
        figure.text(x, 0.955, letter)
    told = {
        "speeds": "; ".join(f"{c:.2f} +- {e:.2f} m/s at r = {r:g} m (material {u:.2f})"
                            for r, (c, e, _, u) in zip(RADII, moved, strict=True)),
        "angle": f"{ray(ds, ANGLE).theta.item():.3g}", "after": f"{times[1]:.3g}",
        "exponent": f"{exponent[0]:.2f} +- {exponent[1]:.2f}", "first": captions.first_seen(ds),
        "beside": f"Orange: on {fine.attrs['elements']} elements. " if fine is not None else "",
        "windows": ", ".join(f"{r:g}" for r in WINDOWS),
    }  # fmt: skip
    kept = [one for one in (ds, fine, *first) if one is not None]
    return figure, plotting.caption(captions.N3.format(**told), *kept)


def lengths(first: list) -> tuple[np.ndarray, np.ndarray, np.ndarray, tuple[float, float, float]]:
    """Return epsilon, the wavelengths (m) of the first waves, their relative errors, and the power law through them."""
    epsilon = np.array([json.loads(ds.attrs["parameters"])["epsilon"] for ds in first])
    length, error = np.array([mean_length(first_lengths(ds)) for ds in first]).T
    return epsilon, length, error, power_law(epsilon, length)


def paths(ax, ds, moved: np.ndarray, start: float) -> None:
    """Draw the path of a wave at the speeds measured (full), and that of the material (dashed)."""
    for column, dashes in ((0, "-"), (3, (0, (4, 3)))):
        time, r, step = start, 1.15, 5e-4
        track = [(time, r)]
        while r > 0.6 and time < ds.time.values[-1]:
            r += step * np.interp(r, RADII, moved[:, column])
            time += step
            track.append((time, r))
        ax.plot(*np.transpose(track), color="black", lw=1.0, ls=dashes)
