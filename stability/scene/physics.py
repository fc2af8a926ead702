"""Whatever of a scene cannot be modelled: names and numbers against the records of closure and flow, and together.

The file need not have the right shape here: what has none is left to `messages.fitted`, so that both report together.
"""

import json
from collections.abc import Iterator
from dataclasses import replace
from itertools import islice
from math import inf, isfinite, sqrt
from typing import Any

import numpy as np

from stability import codegen
from stability.closures import CLOSURES
from stability.errors import SceneError
from stability.flows import FLOWS
from stability.model import Model
from stability.parameters import FRICTION_ANGLE, Parameter, merged
from stability.scene.messages import REQUESTS, nearest, unknown

MAX_SIZE = 50_000_000  # samples of one result: their growth rates and frequencies fill 0.8 GB

# What may stand on an axis of a request.
AXES = (
    Parameter("wavenumber", "q", "1/m", 0, inf, "wavenumber |xi|", "paper, L1"),
    Parameter("wave_angle", "phi", "deg", -inf, inf, "direction of the wave", "paper, L5"),
    Parameter("delta", "delta", "1", -sqrt(2), sqrt(2), "rate of dilation tr V/||V||", "paper, P4.5"),
    Parameter("scaled_wavenumber", "L", "1", 0, inf, "scaled wavenumber Lambda epsilon", "paper, P9"),
)
AT_A_POINT = ("growth_map", "neutral_curve")  # the kinds of request that look at one point of a flow
MAP_ONLY = {"sign": ("float",), "accuracy": ("auto", "standard"), "digits": ()}  # and what every kind may say of them
DIAGRAM = {"closure": "perturbed", "flow": "uniform_strain"}  # what a phase diagram is drawn for


def physics(raw: dict) -> list[str]:
    """Return a sentence for each name, number or combination that cannot be modelled."""
    found: list[str] = []
    known: dict[str, dict] = {}
    for registry in (CLOSURES, FLOWS):
        name = raw.get(registry.kind)
        try:
            known |= {registry.kind: codegen.load(registry, name)} if isinstance(name, str) else {}
        except SceneError as error:
            found += error.problems
    request = _table(raw, "request")
    records = merged(*(module["PARAMETERS"] for module in known.values()))
    if request.get("kind") == "phase_diagram":
        records = {FRICTION_ANGLE.word: FRICTION_ANGLE}  # delta and Lambda epsilon are its axes; nothing else enters
        for word in known:
            if raw[word] != DIAGRAM[word]:
                found.append(f'{word} = "{raw[word]}" has no phase diagram: it is drawn for "{DIAGRAM[word]}"')
    constants, problems = _constants(raw, records, complete=len(known) == 2)
    found += problems
    if request.get("kind") in AT_A_POINT and "flow" in known:
        point, problems = _coordinates(request.get("point", {}), known["flow"]["POINT"])
        found += problems
        if len(known) == 2 and len(constants) == len(records) and len(point) == len(known["flow"]["POINT"]):
            try:
                with np.errstate(all="ignore"):  # a relation between numbers that do not exist does not hold
                    Model(raw["closure"], raw["flow"]).base(constants, point)
            except SceneError as error:
                found += error.problems
    return [*found, *_axes(request), *_demands(request, _table(raw, "tolerance"))]


def _table(raw: dict, name: str) -> dict:
    return raw[name] if isinstance(raw.get(name), dict) else {}


def _number(given: Any) -> float | None:
    """Return the number of an entry, or None where `messages.fitted` has found that it is none."""
    given = given.get("value") if isinstance(given, dict) else given
    return given if isinstance(given, int | float) and not isinstance(given, bool) and isfinite(given) else None


def _sorted_out(record: Parameter, given: Any, name: str) -> tuple[dict, list[str]]:
    """Return ``{word: number}`` or ``{}``, and the problems, of one number called ``[table] word`` in the file."""
    table, word = name.split()
    if (value := _number(given)) is None:
        return {}, []
    problem = replace(record, word=word).problem(value, table)
    return ({}, [problem]) if problem else ({record.word: value}, [])


def _constants(raw: dict, records: dict[str, Parameter], complete: bool) -> tuple[dict, list[str]]:
    """Return the valid parameters, and the problems. Which words are needed is known only where ``complete``."""
    good: dict[str, float] = {}
    found: list[str] = []
    seen: set[str | None] = set()
    for table in ("parameters", "assumed"):
        for word, given in _table(raw, table).items():
            name = f"[{table}] {word}"
            if word in seen:
                found.append(f"{name} stands under [parameters] too: keep it there if it is printed, here if it is not")
            elif word in records:
                valid, problems = _sorted_out(records[word], given, name)
                good |= valid
                found += problems
            elif complete:
                found.append(unknown(name, word, records))
                seen.add(nearest(word, records))  # a misspelt word is not missing as well
            seen.add(word)
    for word, record in records.items() if complete else ():
        if word not in seen:
            where = "a value that is not printed belongs under [assumed], with its reason"
            found.append(f"[parameters] {word} is missing: it is {record.described}, in {record.range}; {where}")
    return good, found


def _coordinates(given: Any, records: tuple[Parameter, ...]) -> tuple[dict, list[str]]:
    """Return the valid coordinates of a point, and the problems."""
    good: dict[str, float] = {}
    found: list[str] = []
    names = [record.word for record in records]
    if not isinstance(given, dict):
        return {}, []
    for word in given:
        if word not in names:
            name = f"[request] point.{word}"
            found.append(unknown(name, word, names) if names else f"{name} is unknown: this flow is uniform")
    for record in records:
        if record.word in given:
            valid, problems = _sorted_out(record, given[record.word], f"[request] point.{record.word}")
            good |= valid
            found += problems
        else:
            found.append(f"[request] point.{record.word} is missing: it is {record.described}, in {record.range}")
    return good, found


def _demands(request: dict, tolerance: dict) -> Iterator[str]:
    """Yield what is asked in combinations that nothing can give."""
    asked = [word for word, plain in MAP_ONLY.items() if tolerance.get(word) not in (None, *plain)]
    if request.get("kind") in REQUESTS and request["kind"] != "growth_map":
        for word in asked:
            yield f"[tolerance] {word} = {json.dumps(tolerance[word], default=str)} belongs to a growth_map"
    elif request.get("sampling") == "grid" and "digits" in asked:
        yield '[request] sampling = "grid" excludes [tolerance] digits: they are too dear for a full grid'
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
            problems = (problem for name, value in named.items() for problem in _sorted_out(record, value, name)[1])
            yield from islice(problems, most)
        count = given.get("count", len(listed))
        size *= count if isinstance(count, int) and count > 0 else 1
    if size > MAX_SIZE:
        yield f"[request] asks for {size:.2g} samples, over the limit of {MAX_SIZE:.0e}: lower a count"
