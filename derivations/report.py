"""Verdicts -> VERDICTS.md."""

from collections.abc import Iterable
from importlib import import_module

from derivations import GROUPS
from derivations.background import GEOMETRY, GEOMETRY_MEANS
from derivations.verdict import Kind, Verdict

Groups = dict[str, list[Verdict]]  # {title: verdicts}

HEAD = """# Verdicts on the equations of "Instabilities in Granular Flows"

Written by `python -m derivations`; do not edit. Labels are the paper's LaTeX labels. Each printed form is transcribed
in `derivations/` and compared with what the package derives from its balance laws: a symbolic zero, or else a
counter-example, evaluated with 30 digits. Verdicts follow from those comparisons; items judged by reading alone say
"by inspection".
Figure I1 is a sketch and is not judged. Figures N1 to N3 and what the text says of its runs cannot be derived: the last
group judges them by runs of the package's time-stepper, with the threshold and the numbers beside each statement
(`derivations/runs.json`, written by `python -m derivations runs`).
"""

NOTATION = (
    (
        "`φ`",
        "angle from the **major principal stress axis** (most compressive) to the wavevector; `φ_f` is the angle of "
        "friction, `s_f = sin φ_f`, `k = √2 s_f`",
    ),
    (
        "`A`",
        "V/‖V‖ with the full V; in the frame (χ, τ) of the wave `A = [[a, b], [b, d]]`, `a² + 2b² + d² = 1`, `a "
        "+ d = δ`",
    ),
    ("`C`", "`√(2−δ²) cos 2φ`, so `a = (δ−C)/2`, `d = (δ+C)/2`; `c = cos 2φ`; in (L2) to (L4) `C_ij` is a matrix"),
    ("`Λ`, `L`, `q`", "`Λ = μq²/2`, `L = Λε`, `q = |ξ|`; Fr = 1 in every comparison"),
    (
        "`u_x`, `A_xx_y`",
        "derivatives along x, y; all letters of a counter-example are independent of one another "
        "but for what the evidence assumes",
    ),
    (GEOMETRY, GEOMETRY_MEANS),
)


def all_verdicts() -> Groups:
    """Return the verdicts of every group."""
    modules = [import_module(f"derivations.{name}") for name in GROUPS]
    return {module.TITLE: module.verdicts() for module in modules}


def counts(groups: Groups) -> dict[Kind, int]:
    """Return how many verdicts of each kind there are."""
    kinds = [v.kind for verdicts in groups.values() for v in verdicts]
    return {kind: kinds.count(kind) for kind in Kind}


def bars(text: str) -> str:
    """Return the text with bars that do not end a cell of a Markdown table."""
    return text.replace("|", "∣")


def row(*cells: str) -> str:
    """Return one row of a Markdown table."""
    return "| " + " | ".join(bars(cell) for cell in cells) + " |"


def table(head: Iterable[str], rows: Iterable[Iterable[str]]) -> list[str]:
    """Return a Markdown table."""
    head = list(head)
    return [row(*head), row(*["---"] * len(head)), *(row(*cells) for cells in rows)]


def section(title: str, verdicts: list[Verdict]) -> list[str]:
    """Return the table of one group and its counter-examples."""
    rows = [(v.label, v.kind.name, v.printed, v.right or "as printed", v.evidence) for v in verdicts]
    lines = ["", f"## {title}", "", *table(("item", "verdict", "printed", "right", "evidence"), rows)]
    if refuted := [v for v in verdicts if v.counterexample]:
        lines += ["", "Counter-examples:", "", *(f"- {v.label}: {bars(v.counterexample)}" for v in refuted)]
    return lines


def summary(groups: Groups) -> str:
    """Return the README's table: the counts, and every item that the paper gets wrong."""
    number = counts(groups)
    wrong = [v for verdicts in groups.values() for v in verdicts if v.kind in (Kind.MISPRINT, Kind.FAILS)]
    said = ", ".join(f"{number[kind]} {kind.name}" for kind in Kind)
    rows = [(v.label, v.kind.name, v.printed, v.right) for v in wrong]
    return "\n".join([f"{sum(number.values())} items: {said}. What is wrong as printed:", "",
                      *table(("item", "verdict", "printed", "right"), rows)])  # fmt: skip


def document(groups: Groups) -> str:
    """Return the whole text of VERDICTS.md."""
    number = counts(groups)
    summary = [(kind.name, str(number[kind]), kind.value) for kind in Kind]
    summary += [("all", str(sum(number.values())), "")]
    lines = [HEAD, *table(("verdict", "number", "meaning"), summary), "", *table(("symbol", "meaning"), NOTATION)]
    for title, verdicts in groups.items():
        lines += section(title, verdicts)
    return "\n".join(lines) + "\n"
