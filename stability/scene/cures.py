"""What of a scene cannot be cured: the parameter that it leaves open, and the bracket in which that is looked for."""

from dataclasses import replace
from math import sqrt

from stability.errors import SceneError
from stability.parameters import Parameter, bracketed, meant
from stability.scene.numbers import sorted_out, table

TABLES = ("parameters", "assumed")


def opened(raw: dict, known: dict[str, dict], records: dict[str, Parameter]) -> tuple[dict, dict, list[str]]:
    """Return ``{word: a value to try}`` of the open parameter, the scene without it, and the problems."""
    request, found = table(raw, "request"), []
    asked = request.get("parameter", "epsilon")
    if not isinstance(asked, str):
        return {}, raw, []
    try:
        word = meant(asked, records, [r.word for r in known["closure"]["PARAMETERS"]])
    except SceneError as error:
        return {}, raw, [f"[request] {problem}" for problem in error.problems]
    for part in TABLES:
        if word in table(raw, part):
            found.append(f"[{part}] {word} is what [request] parameter leaves open: leave it out")
    positive = replace(records[word], low=max(records[word].low, 0))
    low, high = bracketed(positive)
    ends = {"from": low, "to": high}
    for end in ends:
        value, problems = sorted_out(positive, table(request, "bracket").get(end), f"[request] bracket.{end}")
        ends[end] = value.get(word, ends[end])
        found += problems
    rest = {part: {w: v for w, v in table(raw, part).items() if w != word} for part in TABLES if part in raw}
    return {word: sqrt(ends["from"]) * sqrt(ends["to"])}, raw | rest, found
