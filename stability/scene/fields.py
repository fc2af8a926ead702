"""What of a scene cannot be mapped over a flow field: its file, the letters of its closure, and its numbers."""

from collections.abc import Iterator
from math import inf
from pathlib import Path

from stability.parameters import Parameter
from stability.scene.messages import unknown
from stability.scene.numbers import sorted_out, table

FIELD = "field"  # the word that stands for the flow
NUMBERS = tuple(
    Parameter(word, "", unit, low, inf, meaning, "the field map")
    for word, unit, low, meaning in (
        ("density", "kg/m3", 0, "density by which p is divided"),
        ("duration", "s", 0, "time over which e-folds are counted"),
        ("cells", "1", 0, "wavelength in cells that the mesh resolves least"),
        ("longest", "m", 0, "longest wave that is looked at"),
        ("time", "s", -inf, "time of the snapshot"),
    )
)


def field_map(raw: dict, known: dict[str, dict], folder: Path) -> Iterator[str]:
    """Yield what cannot be mapped."""
    if isinstance(raw.get("flow"), str) and raw["flow"] != FIELD:
        yield f'flow = "{raw["flow"]}" is not that of a field_map: flow = "{FIELD}", with [request] file'
    request = raw["request"]
    for record in NUMBERS:
        yield from sorted_out(record, request.get(record.word), f"[request] {record.word}")[1]
    file = request.get("file")
    if isinstance(file, str) and file and not (folder / file).is_file():
        yield f'[request] file = "{file}": there is no such file: {(folder / file).absolute()}'
    if "closure" in known:
        letters = [n for f in known["closure"]["FIELDS"] for n in (f if isinstance(f, tuple) else (f,))]
        for word in table(request, "fields"):
            if word not in letters:
                yield unknown(f"[request] fields.{word}", word, letters)
