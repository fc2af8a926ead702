"""What a closure or a flow is called, where it is published, which fields it has and which numbers it needs.

A generated module of constants alone: listing and checking need no more, and deriving takes seconds.
"""

from typing import Any

from stability.closures.base import Closure
from stability.flows.base import Flow


def constants(entry: Closure | Flow) -> dict[str, Any]:
    """Return the constants of every module that is generated from a closure or a flow."""
    common = {"NAME": entry.name, "TITLE": entry.title, "SOURCE": entry.source, "PARAMETERS": tuple(entry.parameters)}
    if isinstance(entry, Closure):
        return common | {
            "FIELDS": tuple(tuple(map(str, f)) if isinstance(f, tuple) else str(f) for f in entry.fields),
            "EVOLVES": tuple(entry.evolves),
        }
    return common | {"POINT": tuple(entry.point), "AXIS": entry.axis, "FIELDS": tuple(map(str, entry.fields))}


def source(entry: Closure | Flow, **more: Any) -> str:
    """Return the text of a module of constants."""
    title = f"{entry.name} ({entry.source})".replace("\\", "/").replace('"', "'")
    lines = (f"{name} = {value!r}" for name, value in (constants(entry) | more).items())
    return (
        f'"""Generated from {title}. Do not edit."""\n'
        "from math import inf\nfrom stability.parameters import Parameter\n\n" + "\n".join(lines) + "\n"
    )
