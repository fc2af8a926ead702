"""``python -m derivations [runs]``: run every group, write VERDICTS.md and the table in the README.

With ``runs`` the runs of figures N1 to N3 are measured first, and runs.json is written: some seconds where their
results are kept in figures/out, as ``make figures`` leaves them there, else some minutes.
"""

import sys
from pathlib import Path

from derivations.report import Groups, all_verdicts, counts, document, summary

TARGET = Path(__file__).with_name("VERDICTS.md")

OUT = TARGET.parent.parent / "figures" / "out"
README = TARGET.parent.parent / "README.md"
BEGIN, END = "<!-- verdicts: written by `python -m derivations`, held by a test -->\n", "<!-- end -->\n"


def readme(groups: Groups) -> str:
    """Return the README with its table of verdicts brought up to date."""
    before, rest = README.read_text(encoding="utf-8").split(BEGIN)
    return f"{before}{BEGIN}\n{summary(groups)}\n\n{END}{rest.split(END)[1]}"


def main() -> int:
    """Write both documents; return 0."""
    if sys.argv[1:] == ["runs"]:
        from derivations import measured

        measured.write(OUT)
    elif sys.argv[1:]:
        print("usage: python -m derivations [runs]", file=sys.stderr)
        return 2
    groups = all_verdicts()
    TARGET.write_text(document(groups), encoding="utf-8")
    README.write_text(readme(groups), encoding="utf-8")
    print(f"{TARGET.name}: " + ", ".join(f"{n} {kind.name}" for kind, n in counts(groups).items()))
    return 0


if __name__ == "__main__":
    sys.exit(main())
