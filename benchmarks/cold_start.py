"""Fresh processes: what a first map costs from a shell, against `import numpy` and against deriving every time."""

import os
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from resource import RUSAGE_CHILDREN, getrusage
from tempfile import TemporaryDirectory

import numpy as np

from benchmarks.cases import PERTURBED, POINT
from benchmarks.rows import Group, Limit, timed

ROOT = Path(__file__).parent.parent
WAVES = "import numpy as np\nq, angle = np.geomspace(0.1, 2e4, 100), np.linspace(0, 360, 100)\n"
ASK = f"'perturbed', 'radial_hopper', {PERTURBED!r}, {POINT!r}"
PEER = f"""
from benchmarks import baselines
from benchmarks.cases import Case
case = Case(q, angle, {PERTURBED!r}, {POINT!r})
baselines.by_eigvals(baselines.tangent(case)())
"""
NUMPY, LIBRARY, EIGENVALUES, MAP = (
    "import numpy, make the waves",
    "import numpy and xarray",
    "stability.eigenvalues",
    "stability.growth_map (imports xarray)",
)
DERIVED, LAMBDIFY = "stability.eigenvalues, empty cache", "(a) derive D, lambdify, eigvals"
SCRIPTS = {
    NUMPY: WAVES,
    LIBRARY: f"{WAVES}import xarray",
    EIGENVALUES: f"{WAVES}import stability as st\nst.eigenvalues({ASK}, q, angle[:, None])",
    MAP: f"{WAVES}import stability as st\nst.growth_map({ASK}, q, angle)",
    DERIVED: f"{WAVES}import stability as st\nst.eigenvalues({ASK}, q, angle[:, None])",
    LAMBDIFY: WAVES + PEER,
}
SLOW = (DERIVED, LAMBDIFY)


def process(script: str, cache: str | None = None) -> float:
    """Return the process time of a fresh Python that runs a script."""
    before = getrusage(RUSAGE_CHILDREN)
    environment = os.environ | ({"STABILITY_CACHE": cache} if cache else {})
    subprocess.run([sys.executable, "-c", script], check=True, cwd=ROOT, env=environment)
    after = getrusage(RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def measure(quick: bool) -> Iterator[Group]:
    """Yield the one group."""
    rounds = 2 if quick else 8
    timings = {name: np.full(rounds, np.nan) for name in SCRIPTS}
    for name in (EIGENVALUES, MAP):  # warms the package's cache and the files' one
        process(SCRIPTS[name])
    for i in range(rounds):
        for name, script in SCRIPTS.items():
            if i < (1 if quick else 3) or name not in SLOW:
                with TemporaryDirectory() as empty:
                    timings[name][i] = process(script, empty if name == DERIVED else None)
    group = Group(
        "cold-start", "A fresh process each: 10,000 samples at one position, process time with all imports.", "s", 1
    )
    limits = {
        (EIGENVALUES, NUMPY): Limit(1.25),
        (MAP, LIBRARY): Limit(1.5),
        (LAMBDIFY, EIGENVALUES): Limit(7, at_least=True),
    }
    group.rows += timed(timings, NUMPY, limits=limits)
    yield group
