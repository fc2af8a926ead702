"""The README's code runs and prints what it says; its links lead somewhere."""

import contextlib
import io
import re
from pathlib import Path

ROOT = Path(__file__).parent.parent
TEXT = (ROOT / "README.md").read_text(encoding="utf-8")


def test_every_block_of_code_runs_and_prints_what_follows_it():
    names: dict = {}
    pairs = re.findall(r"```python\n((?:(?!```).*\n)*)```\n\nprints\n\n((?:    .*\n)+)", TEXT)
    assert len(pairs) == TEXT.count("```python") == 3
    for code, expected in pairs:
        printed = io.StringIO()
        with contextlib.redirect_stdout(printed):
            exec(compile(code, "README.md", "exec"), names)  # noqa: S102
        assert printed.getvalue() == re.sub(r"(?m)^    ", "", expected)


def test_every_link_leads_to_a_file():
    for page in (ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md"))):
        for target in re.findall(r"\]\(([^)#]+)\)", page.read_text(encoding="utf-8")):
            if not target.startswith("http"):
                assert (page.parent / target).exists(), f"{page.name} links to {target}"
