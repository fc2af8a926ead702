"""Write docs/extremes.md: every method on every family. ``python -m tests.extremes.table`` takes some three minutes."""

from pathlib import Path

import numpy as np

from tests.extremes.meanings import HEAD, MEANINGS, TAIL
from tests.extremes.methods import PEERS, TOOLKIT, Measured, measure
from tests.extremes.samples import FAMILIES, cases

COUNT = 5700  # per family: more than 1e5 in all
PAGE = Path(__file__).parents[2] / "docs" / "extremes.md"
Row = dict[str, float]


def row(measured: Measured) -> Row:
    """Return the numbers of one family: counts, and quantiles of the relative error of the leading growth rate."""
    found: Row = {"samples": measured.sign.size}
    for method in measured.found:
        found[f"{method} wrong"] = int(measured.wrong(method).sum())
        found[f"{method} no value"] = int(measured.missing(method).sum())
        if method != "certified signs":
            error = measured.error(method)
            quantiles = np.quantile(error, [0.5, 0.99, 1], method="nearest")
            found |= {
                f"{method} {name}": float(q) for name, q in zip(("median", "99 %", "max"), quantiles, strict=True)
            }
    for method, tally in measured.tallies.items():
        found[f"{method} by float64"] = 100 * tally.by.get("float64", 0) / measured.sign.size
    return found


def cell(found: Row, method: str) -> str:
    """Return wrong signs, samples without a value, and the three quantiles."""
    counts = f"{found[f'{method} wrong']:.0f}, {found[f'{method} no value']:.0f}"
    if method == "certified signs":
        return counts
    return f"{counts}; " + ", ".join(f"{found[f'{method} {q}']:.0e}" for q in ("median", "99 %", "max"))


def grid(rows: dict[str, Row], methods: tuple[str, ...], shares: bool) -> list[str]:
    """Return a Markdown table, one family per line."""
    heads = ["family", "samples", *methods]
    heads += ["float64 suffices for: values", "signs"] if shares else []
    lines = ["| " + " | ".join(heads) + " |", "|" + "---|" * len(heads)]
    for family, found in rows.items():
        cells = [family.replace("_", " "), f"{found['samples']:.0f}", *(cell(found, m) for m in methods)]
        if shares:
            cells += [f"{found[f'{m} by float64']:.1f} %" for m in ("guaranteed", "certified signs")]
        lines.append("| " + " | ".join(cells) + " |")
    totals = (
        f"{sum(r[f'{m} wrong'] for r in rows.values()):.0f}, {sum(r[f'{m} no value'] for r in rows.values()):.0f}"
        for m in methods
    )
    return [
        *lines,
        "| **all** | "
        + " | ".join([f"{sum(r['samples'] for r in rows.values()):.0f}", *totals])
        + " |"
        + " |" * 2 * shares,
    ]


def page(rows: dict[str, Row]) -> str:
    """Return the text of the page."""
    meanings = [f"* **{family.replace('_', ' ')}**: {MEANINGS[family]}" for family in rows]
    parts = [
        HEAD, "## The toolkit\n", *grid(rows, TOOLKIT, True), "\n## Without it\n", *grid(rows, PEERS, False),
        "\n## What is extreme, and what fails\n", *meanings, TAIL,
    ]  # fmt: skip
    return "\n".join(parts)


def parsed(text: str) -> dict[str, dict[str, list[float]]]:
    """Return the numbers of a page, ``{family: {method: [...]}}``."""
    found: dict[str, dict[str, list[float]]] = {}
    heads: list[str] = []
    for line in text.splitlines():
        cells = [c.strip() for c in line.strip("|").split("|")]
        if line.startswith("| family"):
            heads = cells
        elif line.startswith("| ") and not line.startswith("| **"):
            numbers = ([float(n.strip(" %")) for n in c.replace(";", ",").split(",")] for c in cells[1:])
            found.setdefault(cells[0].replace(" ", "_"), {}).update(zip(heads[1:], numbers, strict=True))
    return found


def main() -> None:
    rows = {family: row(measure(list(cases(family, COUNT)), compare=True)) for family in FAMILIES}
    PAGE.parent.mkdir(exist_ok=True)
    PAGE.write_text(page(rows), encoding="utf-8")


if __name__ == "__main__":
    main()
