"""Field maps: time a point, against the eigenvalues of a coarse scan at each; time and memory of a million points."""

import subprocess
import sys
from collections.abc import Callable, Iterator
from functools import partial

import numpy as np

from benchmarks.cases import HOPPER
from benchmarks.memory import ROOT
from benchmarks.rows import Group, Row, timed
from benchmarks.timing import Timings, interleaved, per_sample
from stability.field.grids import Field, field_from
from stability.field.mapping import field_map
from stability.model import Model

PARAMETERS = {
    "rigid_plastic": {"friction_angle": 34},
    "viscous": {"friction_angle": 34, "kinematic_viscosity": 1e-3},
    "perturbed": {"friction_angle": 34, "epsilon": 2e-5},
    "mu_i": {
        "static_friction": 0.38, "dynamic_friction": 0.64, "reference_inertial_number": 0.279, "grain_diameter": 1e-3,
        "solid_fraction": 0.6,
    },
    "cosserat": {"friction_angle": 34, "coupling": 1, "internal_length": 1e-3, "micro_inertia": 1e-6},
}  # fmt: skip
SIDE, QUICK, SCAN = 150, 60, (24, 8)  # points each way; directions and wavenumbers of the coarse scan
BASELINE = "eigvals of 24 x 8 waves a point, entries free"
# A fresh process: the high-water mark of its memory is its own.
SCRIPT = """
import os, time
from pathlib import Path
if hasattr(os, "sched_setaffinity"):
    os.sched_setaffinity(0, range(os.cpu_count()))  # the parent keeps to one core
from benchmarks.fields import PARAMETERS, sheared
from stability.field.mapping import field_map

def status(name):
    text = Path("/proc/self/status").read_text()
    return 1024 * int(text.split(name + ":")[1].split()[0])

field_map({closure!r}, sheared(20), PARAMETERS[{closure!r}])
field = sheared({side})
if Path("/proc/self/clear_refs").exists():
    Path("/proc/self/clear_refs").write_text("5")
before, start = status("VmRSS"), time.perf_counter()
ds = field_map({closure!r}, field, PARAMETERS[{closure!r}], threads={threads})
print(time.perf_counter() - start, status("VmHWM") - before, ds.nbytes)
"""


def sheared(side: int) -> Field:
    """Return the paper's hopper flow at side x side points, with waves on it that give it every sign of delta."""
    r, theta = np.meshgrid(np.linspace(0.7, 1.2, side), np.linspace(-8, 8, side), indexing="ij")
    base = Model("rigid_plastic", "radial_hopper").base(HOPPER, {"r": r.ravel(), "theta": theta.ravel()})
    (along, _), p = base.state[0][0], base.state[1][0]
    along, p = (np.broadcast_to(a, r.size).reshape(r.shape) for a in (along, p))
    angle = np.deg2rad(theta)
    along = along * (1 + 0.02 * np.sin(40 * r) * np.cos(30 * angle))
    c, s = np.cos(angle), np.sin(angle)
    return field_from(r * c, r * s, u=along * c, v=along * s, p=p, spin=0 * p)


def coarse(points: int) -> Callable[[], object]:
    """Return the eigenvalues of a scan of 2 x 2 matrices at every point."""
    rng = np.random.default_rng(0)
    shape = (points, *SCAN, 2, 2)
    D = rng.normal(size=shape) + 1j * rng.normal(size=shape)
    return lambda: np.linalg.eigvals(D).real.max()


def measure(quick: bool) -> Iterator[Group]:
    """Yield times a point, then time and memory of a million points."""
    side, few = QUICK if quick else SIDE, 200
    field = sheared(side)
    variants: dict[str, Callable] = {BASELINE: coarse(few)}
    for closure, parameters in PARAMETERS.items():
        variants[closure] = partial(field_map, closure, field, parameters, threads=1)
    samples = dict.fromkeys(variants, side * side) | {BASELINE: few}
    timings: Timings = per_sample(interleaved(variants, 3), samples)
    text = (
        f"`field_map` on {side * side:,} points, one thread: gradients, verdict, the fastest wave of all and that of "
        "two cells, and the verdict again at the other end of the gradients' error. The baseline: one coarse scan."
    )
    yield Group("field maps", text, "us/point", 1e6, timed(timings, BASELINE))
    big = 300 if quick else 1000
    text = f"{big * big:,} points, each run in a process of its own: wall time, and memory above what it held before."
    group = Group("field maps, a million points", text, "s", 1)
    for closure in ("rigid_plastic", "perturbed"):
        for threads in (1, 2):
            seconds, memory, output = run(closure, big, threads)
            group.rows.append(Row(f"{closure}, {threads} thread{'s' * (threads > 1)}", time=seconds))
        group.rows.append(Row(f"{closure}: MiB above the start, the result included", measured=memory / 2**20))
    group.rows.append(Row("the result alone: MiB", measured=output / 2**20))
    yield group


def run(closure: str, side: int, threads: int) -> tuple[float, int, int]:
    """Return seconds, bytes above the start, and bytes of the result, of a fresh process on all its cores."""
    command = [sys.executable, "-c", SCRIPT.format(closure=closure, side=side, threads=threads)]
    done = subprocess.run(command, capture_output=True, text=True, check=True, cwd=ROOT)
    seconds, memory, output = done.stdout.split()
    return float(seconds), int(memory), int(output)
