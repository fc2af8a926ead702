"""X1: the time-stepper against the linear theory: growth, orders, the discrete symbol, and what becomes of a wave."""

import json

import numpy as np
from matplotlib.ticker import NullFormatter

from figures.common import DOUBLE, Result, page
from stability import plotting
from stability.crosscheck.saturation import stable_delta

CAPTION = """Checks of the time-stepper and the linear theory against each other. (a) Growth rates of {waves} plane
waves of amplitude 1e-8 in a periodic cell of uniform strain, extrapolated to vanishing cells and steps, over those of
D, and their relative errors (largest: {worst:.2g} %; dashed: 0.1 %). Growth changes sign within {neutral:.2g} % of the
neutral curve. (b) Relative errors of each wave over the cell size, steps extrapolated to zero, and over the step,
cells extrapolated to zero; circles: medians. (c) The discrete symbol of the hopper's polar meshes against D with
background gradients: all places and waves, and the largest error of each mesh (finest: {matrix:.2g} % of D,
{eigenvalue:.2g} % of its leading eigenvalue). (d) Amplitude of the fastest wave, epsilon = {epsilon:g} s, on meshes of
several numbers of cells in a wavelength. (e) Thickness of the band that it becomes: two cells on coarse meshes, but no
less than the limit at which the shortest waves stop to grow in the band (lines); epsilon = {large:g} s reaches it at
{fine:.2g} of a wavelength. (f) delta in the band, which does not tend to zero, and its least value between bands,
where it falls below the limit -k/(2(1 + sqrt 2)) of stability."""

DOT = {"ls": "none", "marker": "o", "ms": 3.2, "mew": 0.7}
ORANGE, BLUE = plotting.GROWTH[3], "#35618f"
DASHED = {"color": "0.4", "lw": 0.8, "ls": (0, (4, 2))}


def draw(result: Result) -> tuple:
    ds = result("X1")
    figure = page(DOUBLE, 118)
    places = {"a": (0.075, 0.575), "b": (0.405, 0.575), "c": (0.735, 0.575), "d": (0.075, 0.09), "e": (0.405, 0.09)}
    axes = {n: figure.add_axes((x, y, 0.25, 0.385)) for n, (x, y) in places.items()}
    axes["f"] = figure.add_axes((0.735, 0.09, 0.25, 0.385))
    growth(ds, axes["a"], figure.add_axes((0.075, 0.575, 0.25, 0.09)))
    orders(ds, axes["b"])
    symbols(ds, axes["c"])
    courses(ds, axes["d"])
    thickness(ds, axes["e"])
    dilation(ds, axes["f"])
    for name, ax in axes.items():
        x, y = ax.get_position().x0, ax.get_position().y1
        figure.text(x - 0.055, y + 0.005, f"({name})")
    return figure, plotting.caption(CAPTION.format(**facts(ds)), ds)


def facts(ds) -> dict[str, float]:
    resolved = ds.saturation_epsilon.values == ds.saturation_epsilon.values.max()
    return {
        "waves": ds.sizes["wave"], "worst": 100 * ds.cell_error.values.max(),
        "neutral": 100 * abs(ds.neutral_measured / ds.neutral_predicted - 1).values.max(),
        "matrix": 100 * ds.symbol_matrix_error.values[-1].max(),
        "eigenvalue": 100 * ds.symbol_eigenvalue_error.values[-1].max(),
        "fine": ds.saturation_thickness.values[resolved][-1] / ds.saturation_wavelength.values[resolved][-1],
        "epsilon": ds.saturation_epsilon.values.min(), "large": ds.saturation_epsilon.values.max(),
    }  # fmt: skip


def growth(ds, ax, below) -> None:
    """Draw measured over predicted growth, and the relative errors below."""
    predicted, limit, grows = ds.cell_growth_predicted, ds.cell_growth_limit, ds.cell_growth_predicted.values > 0
    box = ax.get_position()
    ax.set_position((box.x0, box.y0 + 0.13, box.width, box.height - 0.13))
    line = np.array([-2e5, 2e5])
    ax.plot(line, line, **DASHED)
    for mask, colour in ((grows, ORANGE), (~grows, BLUE)):
        ax.plot(predicted.values[mask], limit.values[mask], mfc="white", mec=colour, **DOT)
        below.plot(predicted.values[mask], ds.cell_error.values[mask], mfc=colour, mec=colour, **DOT | {"ms": 2})
    for one in (ax, below):
        one.set_xscale("symlog", linthresh=1)
        one.set(xlim=line, xticks=[-1e4, -1e2, 0, 1e2, 1e4])
    ax.set_yscale("symlog", linthresh=1)
    ax.set(ylim=line, yticks=[-1e4, -1e2, 0, 1e2, 1e4], ylabel="time-stepper (s$^{-1}$)")
    ax.tick_params(labelbottom=False)
    ax.text(0.05, 0.93, "growth rate", transform=ax.transAxes, va="top")
    below.set(yscale="log", ylim=(1e-6, 2e-3), yticks=[1e-5, 1e-3], xlabel="$D$ (s$^{-1}$)", ylabel="error")
    below.axhline(1e-3, **DASHED)


def orders(ds, ax) -> None:
    """Draw the errors of every wave over cell size and time step."""
    for name, size, colour, order in (("h", ds.cell_size, ORANGE, 2), ("dt", ds.cell_step, BLUE, 1)):
        error = ds[f"cell_error_{name}"].values
        ax.loglog(size, error.T, color=colour, lw=0.5, alpha=0.6)
        ax.loglog(size, np.median(error, axis=0), color=colour, mfc="white", marker="o", ms=3.5)
        guide = size.values[[0, -1]]
        middle = np.median(error, axis=0)[-1] * 0.3
        ax.loglog(guide, middle * (guide / guide[1]) ** order, **DASHED)
        label, x = {"h": ("cell: order 2", 0.035), "dt": ("step: order 1", 0.085)}[name]
        ax.text(x, middle * 0.8 * (x / guide[1]) ** order, label, color=colour, va="top")
    ax.set(xlabel="cell/wavelength, step/duration", ylabel="relative error", xlim=(0.012, 0.33), ylim=(3e-4, 0.3))
    ax.set_xticks([0.02, 0.05, 0.1, 0.2], ["0.02", "0.05", "0.1", "0.2"])
    ax.xaxis.set_minor_formatter(NullFormatter())


def symbols(ds, ax) -> None:
    """Draw the errors of the discrete symbol over the cell size."""
    for name, colour, label in (("matrix", ORANGE, "$D$"), ("eigenvalue", BLUE, r"leading $\lambda$")):
        size = ds.symbol_size.values.reshape(ds.sizes["symbol_mesh"], -1) * 1e3
        error = ds[f"symbol_{name}_error"].values.reshape(size.shape)
        ax.loglog(size, error, color=colour, lw=0.5, alpha=0.6)
        ax.loglog(size.mean(axis=1), error.max(axis=1), color=colour, mfc="white", marker="o", ms=3.5, label=label)
    guide = np.array([1.2, 12])
    ax.loglog(guide, 1.5e-4 * guide**2, **DASHED)
    ax.text(4, 1.3e-3, "order 2", va="top")
    ax.legend(loc="upper left")
    ax.set(xlabel="cell (mm)", ylabel="relative error")


def courses(ds, ax) -> None:
    """Draw the amplitude over time for the smaller epsilon."""
    fine = np.flatnonzero(ds.saturation_epsilon.values == ds.saturation_epsilon.values.min())
    for i, shade in zip(fine, np.linspace(1.5, 4, fine.size), strict=True):
        label = f"{ds.saturation_cells.values[i]:.0f}"
        colour = plotting.GROWTH[int(shade)]
        ax.semilogy(1e3 * ds.saturation_time[i], ds.saturation_course[i], color=colour, label=label)
    ax.legend(title="cells", loc="lower right", title_fontsize=7.5)
    ax.set(xlabel="time (ms)", ylabel="amplitude (m s$^{-1}$)", xlim=(0, None))


def each(ds):
    for epsilon, colour in zip(np.unique(ds.saturation_epsilon), (ORANGE, BLUE, "0.3"), strict=False):
        yield epsilon, ds.sel(course=ds.saturation_epsilon.values == epsilon), colour


def thickness(ds, ax) -> None:
    """Draw the band's thickness over the cell size, both in wavelengths."""
    h = np.array([5e-4, 5e-2])
    ax.loglog(h, 2 * h, **DASHED)
    ax.text(3e-3, 3.4e-3, "2 cells", rotation=43, rotation_mode="anchor", color="0.4", ha="center", va="top")
    for (epsilon, one, colour), mark in zip(each(ds), (DOT, DOT | {"marker": "s", "ms": 5}), strict=False):
        size = 1 / one.saturation_cells
        ax.loglog(size, one.saturation_thickness / one.saturation_wavelength, mfc="none", mec=colour, **mark)
        limit = (one.saturation_thickness_predicted / one.saturation_wavelength).values[-1]
        ax.axhline(limit, color=colour, lw=0.8)
        ax.text(4.7e-2, limit * 1.1, rf"$\epsilon = {1e3 * epsilon:g}$ ms", color=colour, ha="right", va="bottom")
    ax.set(xlabel="cell/wavelength", ylabel="thickness/wavelength", xlim=h, ylim=(2e-4, 0.12))


def dilation(ds, ax) -> None:
    """Draw delta in the band and its least value between bands over the cell size."""
    for _, one, colour in each(ds):
        size = 1 / one.saturation_cells
        ax.semilogx(size, one.saturation_band_delta, mfc="white", mec=colour, **DOT)
        ax.semilogx(size, one.saturation_least_delta, mfc=colour, mec=colour, **DOT)
    limit = stable_delta(np.sqrt(2) * np.sin(np.radians(json.loads(ds.attrs["parameters"])["friction_angle"])))
    ax.axhline(limit, **DASHED)
    ax.text(4.7e-2, limit + 0.009, "stable below", ha="right", va="bottom", color="0.4")
    ax.axhline(0, color="black", lw=0.6)
    ax.text(4.7e-2, 0.095, "in the band", ha="right", va="bottom")
    ax.text(4.7e-2, -0.212, "between bands", ha="right", va="top")
    ax.set(xlabel="cell/wavelength", ylabel=r"$\delta$", xlim=(5e-4, 5e-2), ylim=(-0.27, 0.15))
