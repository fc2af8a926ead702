"""The tables of docs/closures.md are those that the package computes, and meet the stated numbers."""

import pytest

from docs.tables import DOCUMENT, document
from stability.closures import CLOSURES
from tests.closures.benchmarks import BENCHMARKS


def cells(name: str) -> list[list[str]]:
    """Return the rows of a table of the document, without head and rule."""
    text = DOCUMENT.read_text(encoding="utf-8").split(f"<!-- {name}: ")[1].split("<!-- end -->")[0]
    return [line.strip("| \n").split(" | ") for line in text.splitlines() if line.startswith("| ")][2:]


def test_every_closure_and_state_has_its_row_and_no_sign_is_left_open():
    rows = cells("exponents")
    assert [(row[0], row[2], row[-1]) for row in rows] == [(f"`{b.closure}`", b.state, b.why) for b in BENCHMARKS]
    assert {row[0].strip("`") for row in rows} == set(CLOSURES)
    assert {row[-2] for row in rows} == {"yes"}


def test_every_computed_exponent_is_the_stated_one():
    for row, benchmark in zip(cells("exponents"), BENCHMARKS, strict=True):
        stated = "decays" if benchmark.exponent is None else str(benchmark.exponent)
        assert row[3] == row[4] == stated


def test_every_number_meets_the_stated_one():
    rows = cells("numbers")
    assert len(rows) >= 15 and {row[-1] for row in rows} <= {"below 1e-14", "within 1e-12"}


@pytest.mark.slow  # a verdict for each state, half a minute; compiling every closure comes first
def test_the_document_is_what_its_command_writes():
    assert DOCUMENT.read_text(encoding="utf-8") == document(), "run: python -m docs.tables"
