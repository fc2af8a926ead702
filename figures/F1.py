"""F1: the verdict on the project's own nonlinear run, before and after bands have formed."""

import json

from figures import captions
from figures.common import DOUBLE, Result, page
from stability import plotting
from stability.field.mapping import field_map
from stability.field.pictures import field_growth, field_verdicts
from stability.field.reading import read_field

TIMES = (0.02, 0.12)  # s: after the first transient, and with bands throughout
DURATION = 0.025  # s, the paper's interval between two snapshots
LEVELS = (1, 2, 4, 8)  # e-folds


def draw(result: Result) -> tuple:
    run = result("N3")
    figure = page(DOUBLE, 122)
    bar = figure.add_axes((0.3, 0.09, 0.42, 0.018))
    parameters = {word: json.loads(run.attrs["parameters"])[word] for word in ("friction_angle", "epsilon")}
    told = []
    for column, time in enumerate(TIMES):
        ds = field_map("perturbed", read_field(run, time=time), parameters, duration=DURATION)
        above, below = (figure.add_axes((0.08 + 0.48 * column, y, 0.42, 0.36)) for y in (0.61, 0.16))
        field_verdicts(ds, above)
        field_growth(ds, below, LEVELS, bar=bar)
        above.set(title=f"$t$ = {time:g} s", xlabel="")
        if column:
            above.set(ylabel="")
            below.set(ylabel="")
        else:
            above.get_legend().remove()  # the other's shows all kinds that occur
        told.append(f"At t = {time:g} s: {ds.attrs['answer']}")
    return figure, plotting.caption(captions.F1.format(duration=DURATION, answers=" ".join(told)), run)
