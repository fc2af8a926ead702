"""Writes the tables of docs/closures.md from `stability.well_posedness`: python -m docs.tables (half a minute)."""

from collections.abc import Iterator
from pathlib import Path

import stability as st
from docs.numbers import acceptance, verdict
from stability.verdict import Kind, Verdict
from tests.closures.benchmarks import BENCHMARKS

DOCUMENT = Path(__file__).with_name("closures.md")
BEGIN, END = "<!-- {name}: written by `python -m docs.tables`, held by a test -->\n", "<!-- end -->\n"


def table(head: str, rows: Iterator[tuple]) -> str:
    """Return a Markdown table whose columns have names without commas."""
    names = head.split(", ")
    lines = [names, ["---"] * len(names), *rows]
    return "".join(f"| {' | '.join(map(str, line))} |\n" for line in lines)


def exponents() -> Iterator[tuple]:
    """Yield the rows of the table of growth exponents."""
    for b in BENCHMARKS:
        found = verdict(b.closure, b.flow, b.parameters)
        stated = "decays" if b.exponent is None else b.exponent
        computed = "decays" if found.kind is Kind.STABLE else found.exponent
        law = power(found.coefficient, found.exponent)
        where = "" if found.kind is Kind.STABLE or found.worst_angle is None else f"{found.worst_angle:.8g}°"
        where += narrowing(found)
        certified = "yes" if found.certified else "no"
        source = st.CLOSURES[b.closure].source
        yield f"`{b.closure}`", source, b.state, stated, computed, str(found.kind), law, where, certified, b.why


def power(coefficient: float, exponent: object) -> str:
    """Return a law of growth as text; SI units."""
    return f"{coefficient:.8g}" + ("" if exponent == 0 else " q" if exponent == 1 else f" q^{exponent}")


def narrowing(found: Verdict) -> str:
    """Return how directions close in on a single one."""
    return f", within q^-{found.width}" if found.width else ""


TABLES = {
    "exponents": (
        "closure, source, state, n stated, n computed, verdict, fastest short waves (c in mⁿ/s), at, certified, why",
        exponents,
    ),
    "numbers": ("closure, what, stated, computed, relative difference", acceptance),
}


def document() -> str:
    """Return docs/closures.md with its tables computed anew."""
    text = DOCUMENT.read_text(encoding="utf-8")
    for name, (head, rows) in TABLES.items():
        begin = BEGIN.format(name=name)
        before, rest = text.split(begin)
        text = f"{before}{begin}\n{table(head, rows())}\n{END}{rest.split(END, 1)[1]}"
    return text


if __name__ == "__main__":
    DOCUMENT.write_text(document(), encoding="utf-8")
