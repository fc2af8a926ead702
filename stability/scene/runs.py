"""What the time-stepper cannot do with a scene: flows that fill no hopper, fields that it does not solve for, sizes."""

from collections.abc import Iterator
from math import inf, sqrt
from typing import Any

import numpy as np

from stability.errors import SceneError
from stability.model import Model
from stability.parameters import Parameter
from stability.scene.numbers import number, sorted_out, table

MAX_SIZE = 50_000_000  # samples of one result: their growth rates and frequencies fill 0.8 GB
STORED = 6  # numbers of a node and a snapshot
MARCHED = ("radial_hopper", "radial_hopper_compatible")  # flows whose domain the time-stepper meshes
FIELDS = (("u", "v"), "p")  # what it solves for
CELL = {"friction_angle", "epsilon"}  # what a closure of the periodic cell needs, and no more

# The numbers of a march, and of a cross-check.
MARCH = tuple(
    Parameter(word, "", unit, 0, high, meaning, "the time-stepper")
    for word, unit, high, meaning in (
        ("step.first", "s", inf, "first time step"),
        ("step.largest", "s", inf, "largest time step"),
        ("step.smallest", "s", inf, "time step at which a march gives up"),
        ("floor", "1/s", inf, "least ||V|| in the rheology"),
        ("perturbation.size", "1", 1, "largest random velocity over sqrt(g r_0)"),
    )
)
CROSSCHECK = tuple(
    Parameter(word, "", unit, low, high, meaning, "the cross-check")
    for word, unit, low, high, meaning in (
        ("duration", "s", 0, inf, "duration of the runs in the hopper"),
        ("step", "s", 0, inf, "time step of those runs"),
        ("noise", "1", 0, 1, "largest random velocity over sqrt(g r_0)"),
        ("floor", "1/s", 0, inf, "least ||V|| in the rheology"),
        ("delta", "1", -sqrt(2), sqrt(2), "rate of dilation of the cell in which a wave saturates"),
    )
)
EPSILON = Parameter("saturation.epsilon", "", "s", 0, inf, "time scale of the singular perturbation", "paper, P1.1")


def march(raw: dict, known: dict[str, dict]) -> Iterator[str]:
    """Yield what cannot be marched: names, and the numbers of the request."""
    yield from stepped(raw, known, "marched")
    request = raw["request"]
    for record in MARCH:
        part, _, word = record.word.rpartition(".")
        given = table(request, part) if part else request
        yield from sorted_out(record, given.get(word), f"[request] {record.word}")[1]
    times = request.get("snapshots")
    count = len(times) if isinstance(times, list) else times.get("count") if isinstance(times, dict) else 0
    size = STORED * (number(count) or 0) * (number(table(request, "mesh").get("elements")) or 0)
    if size > MAX_SIZE:
        yield f"[request] asks for {size:.2g} numbers, over the limit of {MAX_SIZE:.0e}: lower elements or count"


def crosscheck(raw: dict, known: dict[str, dict]) -> Iterator[str]:
    """Yield what cannot be cross-checked: names, and the numbers of the request."""
    yield from stepped(raw, known, "cross-checked")
    request = raw["request"]
    if "closure" in known and known["closure"]["FIELDS"] == FIELDS:
        words = {record.word for record in known["closure"]["PARAMETERS"]}
        if words != CELL:
            yield (
                f'closure = "{raw["closure"]}" cannot be cross-checked: the periodic cell gives it '
                f"{', '.join(sorted(CELL))}, and it needs {', '.join(sorted(words))}"
            )
    for record in CROSSCHECK:
        yield from sorted_out(record, request.get(record.word), f"[request] {record.word}")[1]
    courses = request.get("saturation")
    for course in courses if isinstance(courses, list) else ():
        if isinstance(course, dict):
            yield from sorted_out(EPSILON, course.get("epsilon"), "[request] saturation.epsilon")[1]


def stepped(raw: dict, known: dict[str, dict], what: str) -> Iterator[str]:
    """Yield the names that the time-stepper cannot take."""
    if "closure" in known and known["closure"]["FIELDS"] != FIELDS:
        names = ", ".join(n for f in known["closure"]["FIELDS"] for n in (f if isinstance(f, tuple) else (f,)))
        yield f'closure = "{raw["closure"]}" cannot be {what}: its fields are ({names}), not (u, v, p)'
    if "flow" in known and raw["flow"] not in MARCHED:
        yield f'flow = "{raw["flow"]}" cannot be {what}: it fills no hopper; choose {" or ".join(MARCHED)}'


def hopper_base(entries: dict[str, Any], constants: dict) -> list[str]:
    """Return what the base state of a march breaks, seen from the middle of the hopper."""
    middle = {"r": (constants["outlet_radius"] + constants["inlet_radius"]) / 2, "theta": 0.0}
    try:
        with np.errstate(all="ignore"):
            Model(entries["closure"], entries["flow"]).base(constants, middle)
    except SceneError as error:  # a scene of a march names no point
        return [problem for problem in error.problems if not problem.startswith("the point")]
    return []
