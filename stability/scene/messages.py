"""Whatever of a file has not the shape of a scene, in the words of a scene."""

import json
from collections.abc import Iterable
from difflib import get_close_matches
from typing import Any

from pydantic import ValidationError

from stability.scene.requests import REQUESTS, Course, Layout, MeshOf, Noise, Steps
from stability.scene.shape import MAX_SAMPLES, Assumption, Interval, Listed, Spaced, Table, Tolerance

_TABLES: dict[Any, type[Table]] = REQUESTS | {
    "<spaced>": Spaced,
    "<listed>": Listed,
    "tolerance": Tolerance,
    "mesh": MeshOf,
    "step": Steps,
    "perturbation": Noise,
    "saturation": Course,
}

RANGE = '{ from = 1.0, to = 1e4, count = 300, spacing = "log" }, or a list'
MEANING = {
    "title": "one sentence for captions and reports",
    "closure": 'the rheology (stability list closures), or that of a file of your own, as in "my_file.py:NAME"',
    "flow": "the base state (stability list flows)",
    "parameters": 'the numbers printed in the paper, each alone or as { value = 34.0, why = "..." }',
    "assumed": 'the numbers that are not printed, each as { value = 15.0, why = "..." }',
    "request": "the table that says what is asked, with its kind",
    "tolerance": "a table with growth, sign, accuracy and digits",
    "kind": f"what is asked, one of {', '.join(REQUESTS)}",
    "value": "a number in SI units, an angle in degrees, without quotes",
    "why": 'the reason, as in { value = 15.0, why = "theta_w is not given" }',
    "point": "where the flow is sampled, as in point = { r = 1.0, theta = 0.0 }",
    "wavenumber": f"the wavenumbers in 1/m, as in {RANGE}",
    "wave_angle": "the directions in degrees, as in { from = 0.0, to = 360.0, count = 1441 }, or a list",
    "delta": "the rates of dilation, as in { from = -0.5, to = 1.2, count = 341 }, or a list",
    "scaled_wavenumber": f"the values of Lambda epsilon, as in {RANGE}",
    "from": "the lower end, a number",
    "to": "the upper end, a number",
    "count": f"the number of samples, a whole number from 2 to {MAX_SAMPLES}",
    "spacing": "the spacing of the samples",
    "matrix": "the tangent matrix: full is D (P3), truncated D' (P7), leading M (P4); auto lets the toolkit choose",
    "resolve": "the largest step of ln(wavenumber) along a neutral curve: directions are inserted until it holds",
    "growth": "the tolerance relative to the largest growth rate; in a phase diagram, whether growth is asked for",
    "sampling": "how a map is sampled: grid evaluates every wave, adaptive interpolates; auto lets the toolkit choose",
    "frequency": "whether the frequency is asked for, true or false",
    "sign": "float, or certified where signs must be proven",
    "accuracy": "the precision: draft (float32), standard (float64), certified (proven signs) or auto",
    "digits": "the decimal digits of an evaluation in multiprecision",
    "mesh": 'the mesh of the hopper, as in { kind = "polar", elements = 4000, half = true }',
    "mesh.kind": "how the cells lie: polar, graded (squares) or diamond (squares on their corners)",
    "elements": "the number of elements, about",
    "half": "whether the domain ends at the symmetry line, true or false",
    "snapshots": "the times in s at which the fields are kept, as in { from = 0.0, to = 0.1, count = 11 }, or a list",
    "step": "the time steps in s, as in { first = 1e-5, largest = 5e-4, smallest = 1e-9 }",
    "first": "the first time step in s",
    "largest": "the largest time step in s",
    "smallest": "the time step in s at which a march gives up",
    "scheme": "how time is discretised: backward_euler (first order) or bdf2 (second)",
    "floor": "the least ||V|| in 1/s that the rheology sees, as in floor = 0.05",
    "solver": "how linear systems are solved: direct or iterative",
    "perturbation": "a random velocity in the initial state, as in { size = 1e-3, seed = 1 }",
    "size": "the largest random velocity over sqrt(g r_0)",
    "seed": "the seed of the random numbers, a whole number",
    "checkpoint_every": "the number of time steps from one checkpoint to the next",
    "parts": "what is checked, a list of cell, neutral, symbol, hopper and saturation",
    "crosscheck.mesh": "how the cells of the half hopper lie: polar, graded or diamond",
    "duration": "the duration in s of the runs in the hopper",
    "crosscheck.step": "the time step in s of those runs",
    "crosscheck.delta": "the rate of dilation of the cell in which a wave saturates",
    "crosscheck.elements": "the number of elements of the half hopper, about",
    "noise": "the largest random velocity over sqrt(g r_0) in one of the two runs",
    "saturation": "the runs in which a wave saturates, as in [{ epsilon = 1e-4, cells = [32, 64] }]",
    "epsilon": "the perturbation's time scale in s",
    "cells": "the numbers of cells in a wavelength, as in [32, 64, 128]",
    "file": "the file of the flow field: .nc, .vtu, .vts, or other VTK files with the extra vtk",
    "fields": 'the names in that file by the closure\'s letters, as in { u = "velocity:0", p = "stress" }',
    "time": "the time in s of the snapshot, the nearest of which is taken; left out: the last",
    "density": "the density in kg/m3 by which p is divided; left out: p is stress over density already",
    "field_map.duration": "the time in s over which e-folds are counted; left out: 1/||V|| of each point",
    "field_map.cells": "the wavelength in cells that the mesh resolves least, as in cells = 2.0",
    "longest": "the longest wave in m that is looked at; left out: the shorter side of the field's box",
    "check": "whether verdicts are tried at the other end of the gradients' error bars, true or false",
    "parameter": 'the word of the parameter that is open, as in parameter = "epsilon"',
    "smallest_cure.growth": "the growth rate in 1/s that no wave may exceed; left out or 0: no short wave may grow",
    "smallest_cure.longest": "the longest wave in m that is looked at; left out: that over which the pressure changes",
    "rtol": "how close the value that cures is to the one that does not, relative",
    "bracket": "the values between which the least cure is looked for, as in { from = 1e-6, to = 1.0 }",
    "newton": "the last update of Newton's method, relative to the scales of the fields",
}

LONGEST = 60  # characters of a wrong value that a message repeats
SAYS = {
    "union_tag_not_found": "is neither a range nor a list",
    "too_short": "is empty",
    "too_long": "has more than {max_length} values",
    "string_too_short": "is empty",
    "dict_type": "is not a table",
    "model_type": "is not a table",
    "model_attributes_type": "is not a table",
}


def nearest(word: str, known: Iterable[str]) -> str | None:
    """Return the known word that was probably meant."""
    return next(iter(get_close_matches(word, list(known), n=1)), None)


def unknown(name: str, word: str, known: Iterable[str]) -> str:
    """Return the sentence about a word that is not known here."""
    near = nearest(word, known)
    return f"{name} is unknown{f'; did you mean {near}?' if near else ''} (known: {', '.join(known)})"


def fitted(raw: dict) -> tuple[Layout | None, list[str]]:
    """Return the scene's tables, or None and one sentence for each place where the file has not their shape."""
    try:
        return Layout.model_validate(raw), []
    except ValidationError as failure:
        errors = failure.errors(include_url=False)
    # A misspelt key is one fault, not an unknown key and a missing one.
    strange = [error["loc"] for error in errors if error["type"] == "extra_forbidden"]
    meant = [(*place[:-1], nearest(str(place[-1]), _keys(place))) for place in strange]
    # Nor is a list whose items are wrong empty, though pydantic is left with none of them.
    inside = {error["loc"][:n] for error in errors for n in range(len(error["loc"]))}
    again = {"missing": meant, "too_short": inside}
    return None, [_sentence(e) for e in errors if e["loc"] not in again.get(e["type"], ())]


def _keys(place: tuple) -> list[str]:
    """Return the keys of the table that a place lies in."""
    if len(place) == 1:
        table: type[Table] = Layout
    elif place[0] in ("parameters", "assumed"):
        table = Assumption
    else:
        table = _TABLES.get(next(key for key in reversed(place[:-1]) if isinstance(key, str)), Interval)
    return [field.alias or name for name, field in table.model_fields.items()]


def _is_tag(i: int, place: tuple) -> bool:
    """Tell pydantic's names of alternatives from the keys of the file."""
    return str(place[i]).startswith("<") or (place[0] == "request" and i == 1)


def _name(keys: list) -> str:
    """Return a place as a reader looks for it: ``[request] wavenumber.count``."""
    path = "".join(f"[{k}]" if isinstance(k, int) else f".{k}" for k in keys[1:] if k not in ("value", "values"))
    if path:
        return f"[{keys[0]}] {path[1:]}"
    return f"[{keys[0]}]" if keys[0] in ("parameters", "assumed", "request", "tolerance") else str(keys[0])


def _shown(value: Any) -> str:
    """Return a value as TOML would write it, shortened."""
    text = json.dumps(value, default=str, ensure_ascii=False)
    return text if len(text) <= LONGEST else f"{text[:LONGEST]}..."


def _sentence(error: Any) -> str:
    """Return one of pydantic's errors in the words of a scene."""
    place, fault, context = error["loc"], error["type"], error.get("ctx", {})
    keys = [key for i, key in enumerate(place) if not _is_tag(i, place)]
    name, word = _name(keys), next(k for k in reversed(keys) if isinstance(k, str))
    path = ".".join(map(str, keys[1:]))
    said = MEANING.get(f"{place[1]}.{path}" if len(place) > 1 else path, MEANING.get(path, MEANING.get(word)))
    meaning = f": it is {said}" if said else ""
    if fault == "extra_forbidden":
        return unknown(name, word, _keys(place))
    if fault == "missing":
        return f"{name} is missing{meaning}"
    if word == "request" and fault == "union_tag_not_found":
        return f"[request] kind is missing: it is {MEANING['kind']}"
    if fault == "union_tag_invalid":
        return unknown(f"[request] kind = {_shown(context['tag'])}", context["tag"], REQUESTS)
    if fault == "value_error":
        return f"{name} = {_shown(error['input'])} {context['error']}"  # a sentence of `shape`, which says it all
    told = SAYS[fault].format(**context) if fault in SAYS else error["msg"].removeprefix("Input ")
    return f"{name} = {_shown(error['input'])} {told}{meaning}"
