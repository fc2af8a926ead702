"""What an instability comes from: terms of the balance laws without which it is gone."""

from collections.abc import Iterator
from typing import Any

from stability.directions import Directions, Special
from stability.model import Base
from stability.puiseux import laws


def causes(base: Base, matrix: str, d: Directions, place: float | Special, exponent: Any) -> Iterator[str]:
    """Yield the terms of the balance laws without which nothing grows that fast in the worst direction.

    A term is the response of one law to one unknown, in one order of the wavenumber. Those without which a mode is left
    undetermined (the incompressibility itself) are passed over.
    """
    second, first, zeroth = base.pencil(matrix)
    places, at = [], 0
    for f in base.model.fields:
        count = len(f) if isinstance(f, tuple) else 1
        places.append((f"({', '.join(f)})" if isinstance(f, tuple) else f, range(at, at + count)))
        at += count
    orders = {
        2: "of the flux to the gradient of",
        1: "of first order to",
        0: "of zeroth order to",
    }
    modes = max(j for j, _ in d.forms)
    for order, words in orders.items():
        for law, rows in places:
            for unknown, columns in places:

                def without(matrix: Any, rows: Any = rows, columns: Any = columns) -> Any:
                    return tuple(
                        tuple(0 if i in rows and j in columns else e for j, e in enumerate(row))
                        for i, row in enumerate(matrix)
                    )

                parts = {
                    2: tuple(tuple(map(without, row)) for row in second),
                    1: tuple(map(without, first)),
                    0: without(zeroth),
                }
                pencil = tuple(parts[o] if o == order else p for o, p in ((2, second), (1, first), (0, zeroth)))
                if pencil == (second, first, zeroth):
                    continue
                other = Directions(base.model.evolves, pencil, d.numbers)
                if max((j for j, _ in other.forms), default=-1) < modes:
                    continue
                if not grows(other, place, exponent):
                    yield f"the response {words} {unknown} in the balance of {law}"


def grows(other: Directions, place: float | Special, exponent: Any) -> bool:
    """Return whether waves grow as fast in a direction, or close to it if it is a special one."""
    if isinstance(place, float):
        return any(law.sign > 0 and law.exponent >= exponent for law in other.laws(place))
    found = [law.exponent for law in laws(other.nearby(place), other.numbers) if law.sign > 0]
    return any(n >= exponent for n in [*found, *(layer.exponent for layer in other.layers(place))])
