"""The numbers of a scene against their records: what is unknown, missing, out of range, or given twice."""

from dataclasses import replace
from math import isfinite
from typing import Any

from stability.parameters import Parameter
from stability.scene.messages import nearest, unknown


def table(raw: dict, name: str) -> dict:
    """Return a table of the file, or an empty one where it is none."""
    return raw[name] if isinstance(raw.get(name), dict) else {}


def number(given: Any) -> float | None:
    """Return the number of an entry, or None where `messages.fitted` has found that it is none."""
    given = given.get("value") if isinstance(given, dict) else given
    return given if isinstance(given, int | float) and not isinstance(given, bool) and isfinite(given) else None


def sorted_out(record: Parameter, given: Any, name: str) -> tuple[dict, list[str]]:
    """Return ``{word: number}`` or ``{}``, and the problems, of one number called ``[table] word`` in the file."""
    where, word = name.split()
    if (value := number(given)) is None:
        return {}, []
    problem = replace(record, word=word).problem(value, where)
    return ({}, [problem]) if problem else ({record.word: value}, [])


def constants(raw: dict, records: dict[str, Parameter], complete: bool) -> tuple[dict, list[str]]:
    """Return the valid parameters, and the problems. Which words are needed is known only where ``complete``."""
    good: dict[str, float] = {}
    found: list[str] = []
    seen: set[str | None] = set()
    for part in ("parameters", "assumed"):
        for word, given in table(raw, part).items():
            name = f"[{part}] {word}"
            if word in seen:
                found.append(f"{name} stands under [parameters] too: keep it there if it is printed, here if it is not")
            elif word in records:
                valid, problems = sorted_out(records[word], given, name)
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


def coordinates(given: Any, records: tuple[Parameter, ...]) -> tuple[dict, list[str]]:
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
            valid, problems = sorted_out(record, given[record.word], f"[request] point.{record.word}")
            good |= valid
            found += problems
        else:
            found.append(f"[request] point.{record.word} is missing: it is {record.described}, in {record.range}")
    return good, found
