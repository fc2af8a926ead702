"""Whatever of a scene cannot be modelled: names and numbers against the records of closure and flow, and together.

The file need not have the right shape here: what has none is left to `messages.fitted`, so that both report together.
"""

import json
from collections.abc import Iterator
from itertools import islice
from math import inf, sqrt
from pathlib import Path
from typing import Any

import numpy as np

from stability import codegen
from stability.closures import CLOSURES
from stability.errors import SceneError
from stability.flows import FLOWS
from stability.model import Model, no_truncation
from stability.parameters import FRICTION_ANGLE, Parameter, merged
from stability.scene import cures, fields, runs
from stability.scene.messages import REQUESTS
from stability.scene.numbers import constants, coordinates, sorted_out, table

# What may stand on an axis of a request.
AXES = (
    Parameter("wavenumber", "q", "1/m", 0, inf, "wavenumber |xi|", "paper, L1"),
    Parameter("wave_angle", "phi", "deg", -inf, inf, "direction of the wave", "paper, L5"),
    Parameter("delta", "delta", "1", -sqrt(2), sqrt(2), "rate of dilation tr V/||V||", "paper, P4.5"),
    Parameter("scaled_wavenumber", "L", "1", 0, inf, "scaled wavenumber Lambda epsilon", "paper, P9"),
)
# Requests that look at one point.
AT_A_POINT = ("growth_map", "neutral_curve", "well_posedness", "smallest_cure", "crosscheck")
IN_TIME = {"march": runs.march, "crosscheck": runs.crosscheck}
MAP_ONLY = {"sign": ("float",), "accuracy": ("auto", "standard"), "digits": ()}  # and what every kind may say of them
UNTOLERANT = ("well_posedness", "smallest_cure", "crosscheck", "field_map")  # kinds of which nothing is approximated
DIAGRAM = {"closure": "perturbed", "flow": "uniform_strain"}  # what a phase diagram is drawn for


def named(raw: dict, folder: Path) -> tuple[dict[str, Any], list[str]]:
    """Return ``{"closure": ..., "flow": ...}``, names or the objects of files that are run, and the problems."""
    found: dict[str, Any] = {}
    problems: list[str] = []
    for registry in (CLOSURES, FLOWS):
        name = raw.get(registry.kind)
        given = registry is FLOWS and table(raw, "request").get("kind") == "field_map"
        try:
            if isinstance(name, str) and not given:
                entry = registry.resolved(name, folder)
                codegen.load(registry, entry, codegen.RECORDS)
                found[registry.kind] = entry
        except SceneError as error:
            problems += (
                [f'flow = "{fields.FIELD}" belongs to [request] kind = "field_map"']
                if (registry is FLOWS and name == fields.FIELD)
                else error.problems
            )
    return found, problems


def physics(raw: dict, entries: dict[str, Any], folder: Path) -> list[str]:
    """Return a sentence for each number or combination that cannot be modelled; the entries are those of `named`."""
    found: list[str] = []
    registries = {registry.kind: registry for registry in (CLOSURES, FLOWS)}
    known = {word: codegen.load(registries[word], entry, codegen.RECORDS) for word, entry in entries.items()}
    request = table(raw, "request")
    kind = request.get("kind")
    both = len(known) == 2 or (kind == "field_map" and "closure" in known)
    try:
        records = merged(*(module["PARAMETERS"] for module in known.values()))
    except SceneError as error:
        return [*error.problems]
    if kind == "phase_diagram":
        records = {FRICTION_ANGLE.word: FRICTION_ANGLE}  # delta and Lambda epsilon are its axes; nothing else enters
        for word in known:
            if raw[word] != DIAGRAM[word]:
                found.append(f'{word} = "{raw[word]}" has no phase diagram: it is drawn for "{DIAGRAM[word]}"')
    opened: dict[str, float] = {}  # a value of the parameter that the scene leaves open
    if kind == "smallest_cure" and both:
        opened, raw, problems = cures.opened(raw, known, records)
        found += problems
        records = {word: record for word, record in records.items() if word not in opened}
        both = bool(opened)  # else nobody knows which words are needed
    numbers, problems = constants(raw, records, complete=both)
    found += problems
    sound = both and len(numbers) == len(records)
    if kind in AT_A_POINT and "flow" in known:
        point, problems = coordinates(request.get("point", {}), known["flow"]["POINT"])
        found += problems
        if sound and len(point) == len(known["flow"]["POINT"]):
            found += base(entries, numbers | opened, point) or _formless(entries, request, table(raw, "tolerance"))
    if kind in IN_TIME:
        found += IN_TIME[kind](raw, known)
    if kind == "field_map":
        found += fields.field_map(raw, known, folder)
    if kind == "march" and sound and raw["flow"] in runs.MARCHED and known["closure"]["FIELDS"] == runs.FIELDS:
        found += runs.hopper_base(entries, numbers)
    return [*found, *_axes(request), *_demands(request, table(raw, "tolerance"))]


def base(entries: dict[str, Any], parameters: dict, point: dict) -> list[str]:
    """Return what is wrong with the base state at a point."""
    try:
        with np.errstate(all="ignore"):  # a relation between numbers that do not exist does not hold
            Model(entries["closure"], entries["flow"]).base(parameters, point)
    except SceneError as error:
        return [*error.problems]
    return []


def _formless(entries: dict[str, Any], request: dict, tolerance: dict) -> Iterator[str]:
    """Yield what needs eigenvalues in closed form, if the closure has none."""
    model = Model(entries["closure"], entries["flow"])
    if model.closed:
        return
    matrix, kind = request.get("matrix"), request.get("kind")
    if matrix in ("truncated", "leading"):
        yield f'[request] matrix = "{matrix}": {no_truncation(model.closure_name)}'
    asked = ['[request] kind = "neutral_curve"'] if kind == "neutral_curve" else []
    if request.get("sampling") == "adaptive":
        asked.append('[request] sampling = "adaptive"')
    said = {f"[tolerance] {word}": tolerance.get(word) for word in ("growth", "digits", "sign", "accuracy")}
    plain = (None, "float", "standard", "auto")
    asked += [f"{word} = {json.dumps(v, default=str)}" for word, v in said.items() if v not in plain]
    for what in asked:
        yield (
            f"{what} needs eigenvalues in closed form, and closure {model.closure_name} has {model.modes} modes and "
            "none: ask for a growth_map without tolerance, or for well_posedness"
        )


def _demands(request: dict, tolerance: dict) -> Iterator[str]:
    """Yield what is asked in combinations that nothing can give."""
    kind, said = request.get("kind"), {word: json.dumps(value, default=str) for word, value in tolerance.items()}
    asked = [word for word, plain in MAP_ONLY.items() if tolerance.get(word) not in (None, *plain)]
    if kind in REQUESTS and kind != "growth_map":
        for word in asked:
            yield f"[tolerance] {word} = {said[word]} belongs to a growth_map"
    elif request.get("sampling") == "grid" and "digits" in asked:
        yield '[request] sampling = "grid" excludes [tolerance] digits: they are too dear for a full grid'
    if kind in UNTOLERANT and "growth" in tolerance:
        yield f"[tolerance] growth = {said['growth']} belongs to a growth_map"
    if kind == "march" and "growth" in tolerance:
        yield f"[tolerance] growth = {said['growth']} is no tolerance of a march: newton is"
    if kind in REQUESTS and kind != "march" and "newton" in tolerance:
        yield f"[tolerance] newton = {said['newton']} belongs to a march"
    if request.get("frequency") is True and request.get("matrix") in ("truncated", "leading"):
        yield f'[request] frequency = true needs matrix = "full": "{request["matrix"]}" leaves out the Doppler shift'


def _axes(request: dict) -> Iterator[str]:
    """Yield the problems of a request's samples: a number out of range (of a list, the first), or too many of them."""
    size = 1
    for record in AXES:
        given = request.get(record.word)
        given = given if isinstance(given, dict) else {"values": given}
        listed = given["values"] if isinstance(given.get("values"), list) else []
        ends = {f"[request] {record.word}.{end}": given.get(end) for end in ("from", "to")}
        items = {f"[request] {record.word}[{i}]": value for i, value in enumerate(listed)}
        for named, most in ((ends, 2), (items, 1)):
            problems = (problem for name, value in named.items() for problem in sorted_out(record, value, name)[1])
            yield from islice(problems, most)
        count = given.get("count", len(listed))
        size *= count if isinstance(count, int) and count > 0 else 1
    if size > runs.MAX_SIZE:
        yield f"[request] asks for {size:.2g} samples, over the limit of {runs.MAX_SIZE:.0e}: lower a count"
