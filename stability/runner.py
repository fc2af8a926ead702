"""A scene -> the analysis that it asks for -> a labelled result."""

import json
from collections.abc import Callable
from concurrent.futures import Executor
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from stability import progress as show
from stability import results
from stability.analyses.adaptive import adaptive_map
from stability.analyses.certify import certify
from stability.analyses.growth_map import growth_map
from stability.analyses.neutral_curve import neutral_curve
from stability.analyses.phase_diagram import phase_diagram
from stability.plan import Plan, plan
from stability.scene import Scene, load_scene

if TYPE_CHECKING:
    from xarray import Dataset


ROUNDING = 1e-9  # relative errors below this are rounding, which a plan calls exact


def run(scene: Scene | str | Path, progress: bool = False, executor: Executor | None = None) -> "Dataset":
    """Return the result that a scene asks for.

    Parameters
    ----------
    scene : a `Scene`, or the path of its file
    progress : whether to show on standard error how far the work is
    executor : None or a `concurrent.futures.Executor`; accepted so that calls need not change later. Nothing is shared
        out yet: a map of half a million waves takes a fraction of a second in one process

    Returns
    -------
    Dataset of the analysis (`growth_map`, `adaptive_map`, `neutral_curve`, `phase_diagram`) with the attributes
    ``title``, ``scene_text`` and ``assumed``, so that a file tells by itself what it is, and ``plan`` (JSON),
    ``plan_reason``, ``plan_warnings``, ``predicted_error`` and ``true_error``: how it was made and what it misses

    Raises
    ------
    SceneError : the scene, or a file of one, cannot be modelled
    """
    if not (executor is None or isinstance(executor, Executor)):
        raise TypeError(f"executor must be None or a concurrent.futures.Executor, got {executor!r}")
    scene = scene if isinstance(scene, Scene) else load_scene(scene)
    planned = plan(scene)
    analysis = KINDS[scene.request.kind]
    if progress:
        with show.reporting(scene.path.stem) as report:
            found = analysis(scene, planned, report)
    else:
        found = analysis(scene, planned, None)
    found = results.described(found, title=scene.title, scene_text=scene.text, assumed=scene.assumed)
    return results.described(found, **_accounted(planned, found))


def _accounted(planned: Plan, found: "Dataset") -> dict[str, Any]:
    """Return the attributes that say how a result was made, what it was expected to miss, and what it misses.

    No times: equal scenes give equal results. ``true_error`` is that of the growth rates on the plan's probe.
    """
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
    return certify(found) if planned.precision == "certified" else found


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


# What a scene may ask for.
KINDS: dict[str, Callable[[Scene, Plan, show.Report | None], "Dataset"]] = {
    "growth_map": _growth_map,
    "neutral_curve": _neutral_curve,
    "phase_diagram": _phase_diagram,
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


def summary(ds: "Dataset") -> str:
    """Return what a result says, in a few lines. It needs the Dataset alone: an opened file has a summary too."""
    rows = [("model", f"{ds.attrs['closure']} on {ds.attrs['flow']}, matrix {ds.attrs['matrix']}")]
    point = [f"{w} = {ds[w].item():g} {ds[w].units}" for w in ("r", "theta") if w in ds.coords]
    rows += [("point", ", ".join(point))] if point else []
    rows.append(("samples", " x ".join(f"{size} {name}" for name, size in ds.sizes.items() if name != "crossing")))
    rows += _findings(ds)
    if "plan" in ds.attrs:
        rows += _planned(ds)
    if "mass_residual" in ds:
        x, y, mass = (ds[name] for name in ("momentum_residual_x", "momentum_residual_y", "mass_residual"))
        rows.append(("base state", f"momentum misses by {np.hypot(x, y).max().item():.2g} {x.units}, "
                                   f"mass by {abs(mass).max().item():.2g} {mass.units}"))  # fmt: skip
    parameters = json.loads(ds.attrs["parameters"])
    rows += [("assumed", f"{word} = {parameters[word]:g}: {why}") for word, why in results.assumptions(ds).items()]
    return "\n".join([ds.attrs["title"], *(f"  {name:<15}{text}" for name, text in rows)])


def _findings(ds: "Dataset") -> list[tuple[str, str]]:
    """Return the results proper."""
    if "growth_rate" in ds:
        growth = ds.growth_rate
        at = growth.isel(growth.argmax(...))
        where = _where(at, "wavenumber", "wave_angle")
        if at.wavenumber == growth.wavenumber[-1]:
            where += " (the shortest wave sampled: growth may rise further)"
        share = f"{(growth > 0).mean().item():.1%} of the samples"
        return [("largest growth", f"{at.item():.5g} {growth.units} at {where}"), ("growing", share)]
    if "neutral_wavenumber" in ds:
        q = ds.neutral_wavenumber
        count = int(q.notnull().sum())
        found = [("crossings", f"{count} in {int(q.notnull().any('crossing').sum())} directions")]
        for name, at in (("shortest", q.argmax(...)), ("longest", q.argmin(...))) if count else ():
            edge = q.isel(at)
            found.append((f"{name} wave", f"neutral at {edge.item():.5g} {q.units}, {_where(edge, 'wave_angle')}"))
        return found
    low, high = json.loads(ds.attrs["unstable_range"])
    always = json.loads(ds.attrs["always_unstable_range"])
    return [
        ("unstable", f"some wavelength for {low:.4g} < delta < {high:.4g}"),
        ("", f"every wavelength for {always[0]:.4g} <= delta <= {always[1]:.4g}"),
        *([("check", f"{ds.attrs['disagreements']} of {ds.region.size} samples disagree with a search over directions")]
          if "disagreements" in ds.attrs else []),
    ]  # fmt: skip


def _planned(ds: "Dataset") -> list[tuple[str, str]]:
    """Return the rung of the ladder that was taken, and its error where something is approximated."""
    planned = json.loads(ds.attrs["plan"])
    words = {"draft": "float32", "standard": "float64", "certified": "float64, signs proven"}
    precision = f"{ds.attrs['digits']} digits" if "digits" in ds.attrs else words[planned["precision"]]
    rows = [("sampling", f"{planned['sampling']}, {precision}")]
    if not ds.attrs["true_error"].startswith("not"):
        rows.append(("error", f"{planned['predicted_error']:.2g} predicted ({planned['error_kind']}), "
                              f"{float(ds.attrs['true_error']):.2g} on a probe, of the largest growth"))  # fmt: skip
    if "sampled" in ds:
        rows.append(("evaluated", f"{ds.sampled.mean().item():.1%} of the samples; the others are interpolated"))
    if "sign" in ds:
        rows.append(("signs", ds.attrs["sign"]))
    return rows


def _where(value: Any, *names: str) -> str:
    return ", ".join(f"{name} {value[name].item():.5g} {value[name].units}" for name in names)
