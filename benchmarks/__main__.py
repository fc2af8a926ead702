"""`python -m benchmarks [--quick] [--only NAME ...] [--out DIR]` measures, and writes RESULTS.md, X2.csv and X2."""

import argparse
import os
import sys
import time
from importlib import import_module
from pathlib import Path

HERE = Path(__file__).parent
# Modules with a function `measure(quick)` that yields groups of rows, in the order of the report.
PARTS = ("maps", "certified", "curves", "adaptive", "cold_start", "memory", "rungs", "fields", "stepper")
# A second thread of the linear algebra would be somebody else's core.
THREADS = ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS")


def main() -> None:
    parser = argparse.ArgumentParser(
        prog="python -m benchmarks", description="Measure speed and accuracy against baselines."
    )
    parser.add_argument("--quick", action="store_true", help="small sizes and few rounds: a minute, for a look")
    parser.add_argument(
        "--only", nargs="+", choices=PARTS, default=PARTS, metavar="NAME", help=f"of {', '.join(PARTS)}"
    )
    parser.add_argument(
        "--out", type=Path, metavar="DIR", help="folder of RESULTS.md and X2.csv; a partial run needs one"
    )
    parser.add_argument(
        "--figures", type=Path, default=HERE.parent / "figures" / "out", metavar="DIR", help="folder of X2.pdf"
    )
    given = parser.parse_args()
    if "numpy" in sys.modules:
        parser.error("NumPy is loaded already, with its number of threads")
    os.environ.update(dict.fromkeys(THREADS, "1"))
    whole = not given.quick and set(given.only) == set(PARTS)
    out = given.out or (HERE if whole else None)
    run([part for part in PARTS if part in given.only], given.quick, out, given.figures)


def run(parts: list[str], quick: bool, out: Path | None, figures: Path) -> None:
    """Measure the parts; print the report, and write it into ``out`` unless that is None."""
    from benchmarks import pareto, report, timing

    timing.pin()
    groups, start = [], time.perf_counter()
    for part in parts:
        for group in import_module(f"benchmarks.{part}").measure(quick):
            groups.append(group)
            print(f"{time.perf_counter() - start:6.1f} s  {group.name}\n\n{report.table(group)}", flush=True)
    text = report.rendered(groups)
    print(report.verdicts(groups))
    if out is None:
        return
    out.mkdir(parents=True, exist_ok=True)
    (out / "RESULTS.md").write_text(text, encoding="utf-8")
    points = [point for group in groups for point in pareto.points(group)]
    if points:
        pareto.write(points, out / "X2.csv")
        pareto.draw(points, figures)


if __name__ == "__main__":
    main()
