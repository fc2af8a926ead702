"""What an instability or a singular symbol comes from: terms of the balance laws without which it is gone."""

from collections.abc import Iterator
from typing import Any

from stability.directions import Directions, Special
from stability.model import Base
from stability.puiseux import laws
from stability.realroots import sign

ORDERS = {2: "of the flux to the gradient of", 1: "of first order to", 0: "of zeroth order to"}


def without(base: Base, matrix: str) -> Iterator[tuple[str, tuple]]:
    """Yield every term of the balance laws in words, and the pencil without it.

    A term is the response of one law to one unknown, in one order of the wavenumber.
    """
    second, first, zeroth = base.pencil(matrix)
    parts = places(base)
    for order, words in ORDERS.items():
        for law, rows in parts:
            for unknown, columns in parts:

                def cut(matrix: Any, rows: Any = rows, columns: Any = columns) -> Any:
                    return tuple(
                        tuple(0 if i in rows and j in columns else e for j, e in enumerate(row))
                        for i, row in enumerate(matrix)
                    )

                pencil = (
                    tuple(tuple(map(cut, row)) for row in second) if order == 2 else second,
                    tuple(map(cut, first)) if order == 1 else first,
                    cut(zeroth) if order == 0 else zeroth,
                )
                if pencil != (second, first, zeroth):
                    yield f"the response {words} {unknown} in the balance of {law}", pencil


def places(base: Base) -> list[tuple[str, range]]:
    """Return the fields in words, and the rows of the pencil that are theirs."""
    found, at = [], 0
    for f in base.model.fields:
        count = len(f) if isinstance(f, tuple) else 1
        found.append((f"({', '.join(f)})" if isinstance(f, tuple) else f, range(at, at + count)))
        at += count
    return found


def causes(base: Base, matrix: str, d: Directions, place: float | Special, exponent: Any) -> Iterator[str]:
    """Yield the terms of the balance laws without which nothing grows that fast in the worst direction.

    Those without which a mode is left undetermined (the incompressibility itself) are passed over.
    """
    modes = max(j for j, _ in d.forms)
    for words, pencil in without(base, matrix):
        other = Directions(base.model.evolves, pencil, d.numbers)
        if max((j for j, _ in other.forms), default=-1) == modes and not grows(other, place, exponent):
            yield words


def makers(base: Base, matrix: str, d: Directions, key: tuple[int, int]) -> Iterator[str]:
    """Yield the terms without which a coefficient of det(lambda E - L), that of lambda^j |xi|^m, is not there at all.

    Where it vanishes in some directions only, these are the terms of which it is made.
    """
    for words, pencil in without(base, matrix):
        if key not in Directions(base.model.evolves, pencil, d.numbers).forms:
            yield words


def silent(base: Base, matrix: str) -> Iterator[str]:
    """Yield the balance laws that respond to nothing at this state, and the unknowns to which nothing responds."""
    second, first, zeroth = base.pencil(matrix)
    matrices = [zeroth, *first, *(m for row in second for m in row)]
    for words, rows in places(base):
        if any(base.model.evolves[i] for i in rows):
            continue
        if not any(sign(e) for m in matrices for i in rows for e in m[i]):
            yield f"the balance of {words} responds to nothing here"
        if not any(sign(row[j]) for m in matrices for row in m for j in rows):
            yield f"no balance responds to {words} here"


def grows(other: Directions, place: float | Special, exponent: Any) -> bool:
    """Return whether waves grow as fast in a direction, or close to it if it is a special one."""
    if isinstance(place, float):
        return any(law.sign > 0 and law.exponent >= exponent for law in other.laws(place))
    found = [law.exponent for law in laws(other.nearby(place), other.numbers) if law.sign > 0]
    return any(n >= exponent for n in [*found, *(layer.exponent for layer in other.layers(place))])
