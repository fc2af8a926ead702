"""The code of docs/fields.md runs and prints what it says."""

import contextlib
import io
import re
from pathlib import Path

import stability as st
from stability.cure import smallest_cure
from stability.field.answers import field_answer
from stability.field.grids import field_from
from stability.field.mapping import field_cost, field_map
from stability.field.pictures import field_growth, field_verdicts
from stability.field.reading import read_field
from stability.field.writing import write_vtk

TEXT = (Path(__file__).parents[2] / "docs" / "fields.md").read_text(encoding="utf-8")
PUBLIC = (field_from, read_field, field_map, field_cost, field_verdicts, field_growth, write_vtk, smallest_cure)


def test_every_block_of_code_runs_and_prints_what_follows_it(monkeypatch):
    for function in PUBLIC:
        monkeypatch.setattr(st, function.__name__, function, raising=False)
    names: dict = {}
    pairs = re.findall(r"```python\n((?:(?!```).*\n)*)```\n\nprints\n\n((?:    .*\n)+)", TEXT)
    assert len(pairs) == TEXT.count("```python") == 2
    for code, expected in pairs:
        printed = io.StringIO()
        with contextlib.redirect_stdout(printed):
            exec(compile(code, "fields.md", "exec"), names)  # noqa: S102
        # Sentences may be broken where the page is full.
        assert printed.getvalue().split() == expected.split()


def test_every_function_that_the_page_names_is_there():
    named = set(re.findall(r"st\.(\w+)\(", TEXT))
    assert named <= {f.__name__ for f in PUBLIC} | {"field_answer", "well_posedness"} and callable(field_answer)
