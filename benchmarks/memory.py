"""Peak memory of a map beyond its output, each in a fresh process."""

import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

from benchmarks.rows import Group, Limit, Row

ROOT = Path(__file__).parent.parent
# The high-water mark is the process's own: ru_maxrss would start from what the parent had when it forked.
SCRIPT = """
import numpy as np
from pathlib import Path
from benchmarks import baselines, maps
from benchmarks.cases import polar

def status(name):
    text = Path("/proc/self/status").read_text()
    return 1024 * int(text.split(name + ":")[1].split()[0])

def call(samples):
    case = polar(samples)
    {setup}
    return case.size, {call}

call(10**4)[1]()
size, ask = call({samples})
Path("/proc/self/clear_refs").write_text("5")
before = status("VmRSS")
found = ask()
print(status("VmHWM") - before, found.nbytes, size)
"""
PACKAGE = {"setup": "", "call": "maps.package(case, frequency=False)"}
DRAFT = {"setup": "", "call": "maps.package(case, frequency=False, accuracy='draft')"}
FORMULA = {"setup": "D = baselines.tangent(case)", "call": "lambda: baselines.by_formula(D())"}
EIGVALS = {"setup": "D = baselines.tangent(case)", "call": "lambda: baselines.by_eigvals(D())"}


def peak(samples: int, **parts: str) -> tuple[int, int, int]:
    """Return peak above the start, the output's own bytes, and samples."""
    command = [sys.executable, "-c", SCRIPT.format(samples=samples, **parts)]
    run = subprocess.run(command, capture_output=True, text=True, check=True, cwd=ROOT)
    return tuple(map(int, run.stdout.split()))  # type: ignore[return-value]


def measure(quick: bool) -> Iterator[Group]:
    """Yield the one group: MiB beyond the output, or bytes per sample of the peers."""
    group = Group("memory", "Peak memory of a map above what the process held before it.", "", 1)
    if not Path("/proc/self/clear_refs").exists():
        group.notes.append("not measured: the system does not tell a process's high-water mark")
        yield group
        return
    for samples in (10**6, 4 * 10**6) if quick else (10**6, 10**7, 10**8):
        used, output, size = peak(samples, **PACKAGE)
        row = Row(
            f"growth_map, {size:,} samples: MiB beyond the output", measured=(used - output) / 2**20, limit=Limit(4)
        )
        group.rows.append(row)
    peers = {"growth_map, draft": DRAFT, "(b) lambdify + closed form": FORMULA, "(a) lambdify + eigvals": EIGVALS}
    for name, parts in {"growth_map": PACKAGE, **peers}.items():
        used, _, size = peak(10**6, **parts)
        group.rows.append(Row(f"{name}, {size:,} samples: bytes per sample", measured=used / size))
    yield group
