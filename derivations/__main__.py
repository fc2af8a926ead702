"""``python -m derivations``: run every group, write VERDICTS.md and the table in the README."""

import sys
from pathlib import Path

from derivations.report import Groups, all_verdicts, counts, document, summary

TARGET = Path(__file__).with_name("VERDICTS.md")

README = TARGET.parent.parent / "README.md"
BEGIN, END = "<!-- verdicts: written by `python -m derivations`, held by a test -->\n", "<!-- end -->\n"


def readme(groups: Groups) -> str:
    """Return the README with its table of verdicts brought up to date."""
    before, rest = README.read_text(encoding="utf-8").split(BEGIN)
    return f"{before}{BEGIN}\n{summary(groups)}\n\n{END}{rest.split(END)[1]}"


def main() -> int:
    """Write both documents; return 0."""
    groups = all_verdicts()
    TARGET.write_text(document(groups), encoding="utf-8")
    README.write_text(readme(groups), encoding="utf-8")
    print(f"{TARGET.name}: " + ", ".join(f"{n} {kind.name}" for kind, n in counts(groups).items()))
    return 0


if __name__ == "__main__":
    sys.exit(main())
