"""A scene -> the analysis that it asks for -> a labelled result."""

from collections.abc import Callable
from concurrent.futures import Executor
from pathlib import Path
from typing import TYPE_CHECKING, Any

from stability import progress as show
from stability import results
from stability.analyses.adaptive import adaptive_map
from stability.analyses.certify import certify
from stability.analyses.growth_map import growth_map
from stability.analyses.neutral_curve import neutral_curve
from stability.analyses.phase_diagram import phase_diagram
from stability.analyses.short_waves import short_waves
from stability.errors import SceneError
from stability.estimates import field_in
from stability.plan import Plan, marched, plan
from stability.scene import Scene, load_scene

if TYPE_CHECKING:
    from xarray import Dataset

    from stability.estimates import Estimate
    from stability.timestepper.forecast import Forecast


ROUNDING = 1e-9  # relative errors below this are rounding, which a plan calls exact


def run(
    scene: Scene | str | Path,
    progress: bool = False,
    executor: Executor | None = None,
    checkpoint: str | Path | None = None,
) -> "Dataset":
    """Return the result that a scene asks for.

    Parameters
    ----------
    scene : a `Scene`, or the path of its file
    progress : whether to show on standard error how far the work is
    executor : None or a `concurrent.futures.Executor`; accepted so that calls need not change later. Nothing is shared
        out yet: a map of half a million waves takes a fraction of a second in one process
    checkpoint : None or, of a march, the file that keeps the run: it goes on from there if the file exists. The file
        stays, for the caller to remove once the result is safe

    Returns
    -------
    Dataset of the analysis (`growth_map`, `adaptive_map`, `neutral_curve`, `phase_diagram`, `short_waves`,
    `least_cure`, `march`, `crosscheck`, `field_map`) with attributes ``title``, ``request`` (its kind), ``scene_text``
    and ``assumed``, so that a file tells by itself what it is, and ``plan`` (JSON), ``plan_reason``, ``plan_warnings``
    and, where something may be approximated, ``predicted_error`` and ``true_error``: how it was made and what it misses

    Raises
    ------
    SceneError : the scene, or a file of one, cannot be modelled
    CheckpointError : the checkpoint is of another scene or version, damaged, or cannot be written
    """
    if not (executor is None or isinstance(executor, Executor)):
        raise TypeError(f"executor must be None or a concurrent.futures.Executor, got {executor!r}")
    scene = scene if isinstance(scene, Scene) else load_scene(scene)
    kept = {} if checkpoint is None else {"checkpoint": checkpoint}
    if kept and scene.request.kind != "march":
        raise SceneError(f"checkpoint = {str(checkpoint)!r}: a {scene.request.kind} keeps none, a march alone does")
    planned = plan(scene)
    analysis = KINDS[scene.request.kind]
    if progress:
        with show.reporting(scene.path.stem) as report:
            found = analysis(scene, planned, report, **kept)
    else:
        found = analysis(scene, planned, None, **kept)
    about = {"title": scene.title, "request": scene.request.kind, "scene_text": scene.text, "assumed": scene.assumed}
    found = results.described(found, **about)
    return results.described(found, **_accounted(planned, found))


def _accounted(planned: "Plan | Forecast | Estimate", found: "Dataset") -> dict[str, Any]:
    """Return the attributes that say how a result was made, what it was expected to miss, and what it misses.

    No times: equal scenes give equal results. ``true_error`` is that of the growth rates on the plan's probe.
    """
    if not isinstance(planned, Plan):
        return {"plan": planned.text, "plan_reason": "\n".join(planned.reasons), "plan_warnings": planned.warnings}
    true = planned.true_error(found.growth_rate.values) if "growth_rate" in found else None
    warnings = list(planned.warnings)
    if true is not None and true > max(planned.predicted_error, ROUNDING):
        warnings.append(f"the true error on the probe, {true:.2g}, exceeds the predicted {planned.predicted_error:.2g}")
    return {
        "plan": planned.text,
        "plan_reason": "\n".join(planned.reasons),
        "plan_warnings": warnings,
        "predicted_error": planned.predicted_error,
        "true_error": "not probed: nothing is approximated" if true is None else true,
    }


def _growth_map(scene: Any, planned: Plan, report: show.Report | None) -> "Dataset":
    ask = scene.request
    waves = {"wavenumber": ask.wavenumber.samples, "wave_angle": ask.wave_angle.samples}
    question = {**_state(scene, planned), **waves, "frequency": planned.frequency, "progress": report}
    if planned.sampling == "adaptive":
        found = adaptive_map(**question, growth=planned.interpolation, digits=scene.tolerance.digits)
    else:
        found = growth_map(**question, accuracy="draft" if planned.precision == "draft" else "standard")
    return certify(found, closure=scene.closure, flow=scene.flow) if planned.precision == "certified" else found


def _neutral_curve(scene: Any, planned: Plan, report: show.Report | None) -> "Dataset":
    ask = scene.request
    details: dict[str, Any] = {"resolve": ask.resolve}
    if ask.wavenumber is not None:
        details["wavenumber_range"] = (ask.wavenumber.start, ask.wavenumber.stop)
    return neutral_curve(**_state(scene, planned), wave_angle=ask.wave_angle.samples, **details)


def _phase_diagram(scene: Any, planned: Plan, report: show.Report | None) -> "Dataset":
    ask = scene.request
    angle = scene.parameters["friction_angle"]
    grid = ask.delta.samples, ask.scaled_wavenumber.samples
    return phase_diagram(angle, *grid, progress=report, growth=ask.growth)


def _march(
    scene: Any, planned: "Forecast", report: show.Report | None, checkpoint: str | Path | None = None
) -> "Dataset":
    from stability.timestepper.march import march  # and with it SciPy's solvers, which nothing else needs

    return march(marched(scene), checkpoint, scene.text, report)


def _well_posedness(scene: Any, planned: "Estimate", report: show.Report | None) -> "Dataset":
    matrix = "full" if scene.request.matrix == "auto" else scene.request.matrix
    return short_waves(scene.closure, scene.flow, scene.parameters, scene.request.point, matrix)


def _smallest_cure(scene: Any, planned: "Estimate", report: show.Report | None) -> "Dataset":
    from stability.leastcure import least_cure  # and with it the search for fastest waves

    ask = scene.request
    bracket = None if ask.bracket is None else (ask.bracket.start, ask.bracket.stop)
    asked = {"parameter": ask.parameter, "growth": ask.growth, "rtol": ask.rtol, "longest": ask.longest}
    return least_cure(scene.closure, scene.flow, scene.parameters, ask.point, bracket=bracket, **asked)


def _crosscheck(scene: Any, planned: "Estimate", report: show.Report | None) -> "Dataset":
    from stability.crosscheck.report import SATURATION, crosscheck

    ask = scene.request
    courses = SATURATION if ask.saturation is None else tuple((c.epsilon, c.cells) for c in ask.saturation)
    return crosscheck(
        scene.closure, scene.flow, scene.parameters, ask.point, parts=ask.parts, elements=ask.elements, kind=ask.mesh,
        duration=ask.duration, dt=ask.step, size=ask.noise, seed=ask.seed, delta=ask.delta, courses=courses,
        floor=ask.floor, progress=report,
    )  # fmt: skip


def _field_map(scene: Any, planned: "Estimate", report: show.Report | None) -> "Dataset":
    from stability.field.mapping import field_map

    ask = scene.request
    asked = {"duration": ask.duration, "cells": ask.cells, "longest": ask.longest, "check": ask.check}
    field = field_in(ask, scene.path.parent)
    return field_map(scene.closure, field, scene.parameters, **asked, progress=report)


# What a scene may ask for.
KINDS: dict[str, Callable[..., "Dataset"]] = {
    "march": _march,
    "growth_map": _growth_map,
    "neutral_curve": _neutral_curve,
    "phase_diagram": _phase_diagram,
    "well_posedness": _well_posedness,
    "smallest_cure": _smallest_cure,
    "crosscheck": _crosscheck,
    "field_map": _field_map,
}


def _state(scene: Any, planned: Plan) -> dict[str, Any]:
    """Return what every question about one point of a flow needs."""
    return {
        "closure": scene.closure,
        "flow": scene.flow,
        "parameters": scene.parameters,
        "point": scene.request.point,
        "matrix": planned.matrix,
    }
