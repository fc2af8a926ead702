"""N2: radial slices of average stress and tangential velocity, 0.02 s apart, epsilon = 2e-5 s: the run of figure N1."""

from figures import captions
from figures.common import COLOURS, DOUBLE, Result, page, ray, story
from stability import plotting

APART, COUNT, ANGLE = 0.02, 3, 6.0  # s, of the snapshots; degrees from the axis, of the slices
PANELS = (
    ("pressure", r"$p/\rho$ (m$^2$ s$^{-2}$)", "average stress", 1.0),
    ("velocity_theta", r"$u_\theta$ (mm s$^{-1}$)", "tangential velocity", 1e3),
)


def draw(result: Result) -> tuple:
    runs = [ds for ds in (result("N1-full", beside=True), result("N1")) if ds is not None]
    figure, times = page(DOUBLE, 110), story(runs[-1], APART, COUNT)
    for column, (name, label, title, unit) in enumerate(PANELS):
        for row, time in enumerate(times):
            ax = figure.add_axes((0.075 + 0.495 * column, 0.71 - 0.295 * row, 0.42, 0.245))
            for ds, style in zip(runs[::-1], COLOURS, strict=False):
                slice_ = ray(ds, ANGLE).sel(time=time, method="nearest")
                ax.plot(slice_.r, unit * slice_[name], **style, label=f"{ds.attrs['elements']} elements")
            ax.set(xlim=(ds.r.values[0], ds.r.values[-1]), ylabel=label)
            if name == "pressure":
                ax.set_ylim(0, 5)
            else:
                ax.axhline(0, color="0.6", lw=0.4, zorder=0)
                ax.set_ylim(-90, 90)
            ax.text(0.015, 0.95, f"$t={time:.3f}$ s", transform=ax.transAxes, va="top")
            ax.tick_params(labelbottom=row == COUNT - 1)
            if row == 0:
                ax.set_title(title, pad=4)
        ax.set_xlabel("$r$ (m)")
    if len(runs) > 1:
        figure.axes[0].legend(loc="lower center")
    angle = ray(runs[-1], ANGLE).theta.item()
    told = {"angle": f"{angle:.3g}", "first": captions.first_seen(runs[-1])}
    return figure, plotting.caption(captions.N2.format(**told), *runs[::-1])
