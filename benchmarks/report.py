"""RESULTS.md: the machine, a table per group, every target with its verdict, every missed one with its reason."""

import os
import platform
import subprocess
from collections.abc import Sequence

import numpy as np

from benchmarks import native
from benchmarks.rows import Group, Row
from benchmarks.timing import Ratio
from stability.results import package_version

# Why a target is missed, written by hand after looking into it: "group: variant" -> a sentence.
REASONS: dict[str, str] = {
    "map-1e6: growth_map": (
        "the kernel alone meets it; the rest is the call: coefficients of 1,000 directions (1.5 ns a sample), samples "
        "near neutrality solved again (2), the first touch of 8 MB of output (2), the labelled Dataset (2)"
    ),
    "map-1e6: growth_map, compiled (numba)": (
        "only the kernel is compiled, and at this size the call around it outweighs it; it is chosen by itself from "
        "2e8 samples on"
    ),
    "map-1e6: (a) lambdify + eigvals, over growth_map": "the call around the kernel; over the kernel alone it is 250",
    "map-1e6: (b) lambdify + closed form, over growth_map": (
        "the peer evaluates the package's own D in letters, 324 operations; over the kernel alone it is 24"
    ),
    "map-1e6: (b) lambdify(cse) + closed form, over growth_map": (
        "the peer evaluates the package's own D in letters, 324 operations; over the kernel alone it is 20"
    ),
    "positions: growth_map": (
        "with 32 wavenumbers a direction, forming coefficients and tables in NumPy costs 8 to 10 ns a sample, which C "
        "does in registers; the labelled Dataset and samples solved again 4 to 5"
    ),
    "positions: (b) lambdify(cse) + closed form, over growth_map": ("as above, and the peer's D in letters is short"),
    "cold-start: stability.eigenvalues": (
        "beside NumPy the process reads importlib.metadata (0.04 s, for the versions that sign the cache), inspect "
        "(0.03 s, by dataclasses) and fractions"
    ),
    "cold-start: (a) derive D, lambdify, eigvals, over stability.eigenvalues": (
        "the peer became faster: the package's own D has 324 operations and is derived and lambdified in 1 s"
    ),
}
UNKNOWN = "no reason has been found yet"

HEADER = """# Results of `make bench`

Written by `python -m benchmarks`. Times are process CPU time on one pinned core, medians over interleaved rounds in
one process. A ratio is the median of the rounds' ratios; the ratio of the minima stands beside it, and `?` marks a pair
that disagrees by more than 25 %: the machine was busy. Without further words a ratio is over the first variant of its
table.
Each map was compared with 50 digits on 200 of its samples before it was timed (gate: 4e-15 ‖D‖, float32 1e-6 ‖D‖).

Baselines: **(a)** `sympy.lambdify` of D and `numpy.linalg.eigvals`, what users do; **(b)** the same with the quadratic
formula; **(c)** hand-written C with everything hoisted that can be, compiled on the spot: the practical limit.
"""


def processor() -> str:
    """Return the name of the processor's model."""
    try:
        with open("/proc/cpuinfo", encoding="utf-8") as file:
            return next(line.split(":", 1)[1].strip() for line in file if line.startswith("model name"))
    except (OSError, StopIteration):
        return platform.machine()


def compiler_version() -> str:
    """Return the first line with which the compiler introduces itself."""
    if not (name := native.compiler()):
        return "none"
    return subprocess.run([name, "--version"], capture_output=True, text=True, check=True).stdout.splitlines()[0]


def machine() -> list[tuple[str, str]]:
    """Return what the numbers depend on."""
    config = np.show_config(mode="dicts")
    simd = config.get("SIMD Extensions", {})
    blas = config["Build Dependencies"]["blas"]
    names = ("scipy", "sympy", "mpmath", "python-flint", "numba", "pyamg", "matplotlib")
    return [
        ("processor", f"{processor()}, {os.cpu_count()} cores"),
        ("SIMD that NumPy found", " ".join(simd.get("found", [])) or "baseline"),
        ("Python, NumPy, BLAS", f"{platform.python_version()}, {np.__version__}, {blas['name']} {blas['version']}"),
        ("packages", ", ".join(f"{name} {package_version(name)}" for name in names)),
        ("C compiler", f"{compiler_version()}, {' '.join(native.FLAGS)}"),
        ("load average at the end", " ".join(f"{load:.1f}" for load in os.getloadavg())),
    ]


def number(value: float | None) -> str:
    """Return three significant digits, without an exponent where that is readable."""
    if value is None or np.isnan(value):
        return ""
    return (
        f"{value:.3g}"
        if value == 0 or 1e-2 <= abs(value) < 1000
        else f"{value:,.0f}"
        if value >= 1000
        else f"{value:.1e}"
    )


def line(cells: Sequence[str]) -> str:
    """Return one line of a table."""
    return f"| {' | '.join(cells)} |"


def cells(row: Row, group: Group) -> list[str]:
    """Return the cells of a row."""
    time = "" if row.time is None else number(row.time * group.per_second)
    ratio = row.measured
    pair = (
        (number(ratio.median) + "?" * (not ratio.steady), number(ratio.minima))
        if isinstance(ratio, Ratio)
        else (number(ratio), "")
    )
    verdict = {None: "", True: "yes", False: "**no**"}[row.met]
    return [row.variant, time, number(row.error), *pair, str(row.limit or ""), verdict]


def table(group: Group) -> str:
    """Return a group as text."""
    head = ["variant", group.unit, "error", "ratio", "of minima", "target", "met?"]
    lines = [line(head), line(["---", *["---:"] * 5, "---"]), *(line(cells(row, group)) for row in group.rows)]
    notes = "".join(f"\nNote: {note}.\n" for note in dict.fromkeys(group.notes))
    return f"## {group.name}\n\n{group.text}\n\n" + "\n".join(lines) + "\n" + notes


def verdicts(groups: Sequence[Group]) -> str:
    """Return how many targets are met, and why the others are not."""
    asked = [(group, row) for group in groups for row in group.rows if row.met is not None]
    missed = [(f"{group.name}: {row.variant}", row) for group, row in asked if not row.met]
    lines = [
        f"- {key}: {number(row.value)}, target {row.limit}. Reason: {REASONS.get(key, UNKNOWN)}." for key, row in missed
    ]
    return f"## Targets\n\n{len(asked) - len(missed)} of {len(asked)} are met.\n" + "".join(
        f"{text}\n" for text in ["", *lines]
    )


def rendered(groups: Sequence[Group]) -> str:
    """Return RESULTS.md."""
    facts = "\n".join([line(["machine", ""]), line(["---", "---"]), *(line(fact) for fact in machine())])
    return "\n".join([HEADER, facts, "", verdicts(groups), *(table(group) for group in groups)])
