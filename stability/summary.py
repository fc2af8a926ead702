"""What a result says, in a few lines for a terminal."""

import json
from collections.abc import Iterator
from textwrap import wrap
from typing import TYPE_CHECKING, Any

import numpy as np

from stability import results

if TYPE_CHECKING:
    from xarray import Dataset

WIDTH = 80  # columns of a sentence


def summary(ds: "Dataset") -> str:
    """Return what a result says, in a few lines. It needs the Dataset alone: an opened file has a summary too."""
    if ds.attrs.get("request") == "field_map":
        rows = [("model", f"{ds.attrs['closure']} on the flow of {ds.attrs['source']}")]
        return _lines(ds, rows + _wrapped("answer", ds.attrs["answer"]))
    model = f"{ds.attrs['closure']} on {ds.attrs['flow']}"
    if ds.attrs.get("request") == "march":
        from stability.timestepper.output import findings

        return _lines(ds, [("model", model), *findings(ds)])
    if ds.attrs.get("request") == "crosscheck":
        return _lines(ds, [("model", model), *_checked(ds)])
    rows = [("model", f"{model}, matrix {ds.attrs['matrix']}")]
    point = [f"{w} = {ds[w].item():g} {ds[w].units}" for w in ("r", "theta") if w in ds.coords]
    rows += [("point", ", ".join(point))] if point else []
    if "sentence" in ds.attrs:
        rows += _verdict(ds)
    else:
        sizes = " x ".join(f"{size} {name}" for name, size in ds.sizes.items() if name != "crossing")
        rows += [("samples", sizes), *_findings(ds), *(_planned(ds) if "plan" in ds.attrs else ())]
    if missed := ", ".join(_missed(ds)):
        rows.append(("base state", missed))
    return _lines(ds, rows)


def _verdict(ds: "Dataset") -> list[tuple[str, str]]:
    """Return what short waves do, or which values of a parameter keep them from it."""
    name = "cure" if "cure_from" in ds else "verdict"
    return [*_wrapped(name, ds.attrs["sentence"]), *_wrapped("notes", *json.loads(ds.attrs["notes"]))]


def _wrapped(name: str, *sentences: str) -> list[tuple[str, str]]:
    """Return sentences as rows of which the first has a name."""
    lines = [line for sentence in sentences for line in wrap(sentence, WIDTH)]
    return [("" if i else name, line) for i, line in enumerate(lines)]


def _missed(ds: "Dataset") -> Iterator[str]:
    """Yield by how much the base state misses the balance laws."""
    if "momentum_residual_x" in ds:
        x, y = ds.momentum_residual_x, ds.momentum_residual_y
        yield f"momentum misses by {np.hypot(x, y).max().item():.2g} {x.units}"
    if "mass_residual" in ds:
        yield f"mass by {abs(ds.mass_residual).max().item():.2g} {ds.mass_residual.units}"
    for name, law in ds.data_vars.items():
        if str(name).startswith(results.RESIDUAL):
            yield f"the law of {str(name).removeprefix(results.RESIDUAL)} by {abs(law).max().item():.2g}"


def _checked(ds: "Dataset") -> Iterator[tuple[str, str]]:
    """Yield the largest error of each part of a cross-check."""
    if "cell_error" in ds:
        yield "waves", f"{ds.sizes['wave']} in a periodic cell: growth within {ds.cell_error.max().item():.2g} of D"
    if "neutral_measured" in ds:
        off = abs(ds.neutral_measured / ds.neutral_predicted - 1).max().item()
        yield "neutral waves", f"growth changes sign within {off:.2g} of the neutral curve"
    if "symbol_matrix_error" in ds:
        finest = ds.symbol_matrix_error.isel(symbol_mesh=-1).max().item()
        yield "symbol", f"that of the finest mesh is within {finest:.2g} of D"
    if "mode_error" in ds:
        yield "modes", f"the leading one grows at {ds.mode_growth[0].item():.5g} 1/s, in the time-stepper within " \
                       f"{ds.mode_error.item():.2g} of that"  # fmt: skip
    if "saturation_thickness" in ds:
        yield "saturation", f"{ds.sizes['course']} runs end in bands {ds.saturation_thickness.min().item():.2g} to " \
                            f"{ds.saturation_thickness.max().item():.2g} m thick"  # fmt: skip


def _lines(ds: "Dataset", rows: list[tuple[str, str]]) -> str:
    """Return title, rows and assumptions."""
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
