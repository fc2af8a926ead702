"""The time-stepper: what a step costs and on what, against SciPy's own choices, multigrid, and NumPy's assembly."""

import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import partial
from importlib.util import find_spec
from pathlib import Path

import numpy as np
from scipy.interpolate import RegularGridInterpolator

from benchmarks.cases import HOPPER
from benchmarks.maps import without_compiled
from benchmarks.memory import ROOT
from benchmarks.rows import Group, Limit, Row, timed
from benchmarks.timing import interleaved, median
from stability.timestepper.hopper import hopper_problem
from stability.timestepper.integrate import Control, State, start, steps
from stability.timestepper.linear import Factorise, Solve, solver_named
from stability.timestepper.march import March, Run
from stability.timestepper.march import stepped as marched
from stability.timestepper.problem import Problem

PARAMETERS = HOPPER | {"epsilon": 1e-4}
DT, END = 5e-4, 0.1  # s: by then bands fill the hopper
SIZES, QUICK = (1000, 4000, 16000, 64000), (1000, 4000)  # elements
STEPS = 6  # timed on each state, after one that is not
RAMP = 100  # how much smaller the first step is after a state was carried to another mesh
LARGE = 16000  # elements: beyond, a state with bands would take minutes to make
DEFAULT, DIRECT, MULTIGRID = "default splu: factors", "direct: factors", "multigrid: set up"
SOLVE = {"default": "default splu: one solve", "direct": "direct: one solve", "iterative": "multigrid: one solve"}
BALANCE, JACOBIAN = "residual", "Jacobian"
NUMPY, NUMBA = "NumPy", "numba"
BASE, BANDED = "base state", "state with bands"
SHARE = {NUMPY: Limit(0.4), NUMBA: Limit(0.2)}


def problem_of(elements: int, kind: str = "polar") -> Problem:
    """Return the paper's hopper, half of it, assembled by NumPy."""
    mesh = {"elements": elements, "kind": kind, "half": True}
    return replace(hopper_problem("perturbed", "radial_hopper", PARAMETERS, mesh), compiled=False)


def paths(problem: Problem) -> dict[str, Problem]:
    """Return the ways to assemble."""
    found = {NUMPY: problem}
    return found if without_compiled() else found | {NUMBA: replace(problem, compiled=True)}


class Watch:
    """A factorise that takes the time of its factors and of their solves, scaling and permutation included."""

    def __init__(self, factorise: Factorise):
        self.factorise = factorise
        self.reset()

    def reset(self) -> None:
        """Start anew."""
        self.began, self.factors, self.solves = time.process_time(), 0.0, 0.0

    def __call__(self, matrix: object) -> Solve:
        """Return a solve of which the time is taken."""
        began = time.process_time()
        solve = self.factorise(matrix)
        self.factors += time.process_time() - began

        def watched(b: np.ndarray) -> np.ndarray:
            began = time.process_time()
            x = solve(b)
            self.solves += time.process_time() - began
            return x

        return watched

    @property
    def seconds(self) -> float:
        """All that was spent since the start."""
        return time.process_time() - self.began


@dataclass(frozen=True)
class Cost:
    """Means over some steps; shares of the time."""

    seconds: float
    factors: float
    solves: float
    iterations: float
    factorisations: float

    @property
    def assembly(self) -> float:
        """The share of all that is neither factorising nor solving."""
        return 1 - self.factors - self.solves


def stepped(problem: Problem, state: State, count: int) -> Cost:
    """Return what steps of `DT` cost on a state, once its own first factors are past."""
    watch = Watch(solver_named("direct", problem))
    control = Control(first=DT, largest=DT)
    going = steps(problem, replace(state, dt=DT), control, [state.time + (count + 1) * DT], watch)
    next(going)
    watch.reset()
    rows = [row for _, row in going]
    return Cost(
        watch.seconds / len(rows),
        watch.factors / watch.seconds,
        watch.solves / watch.seconds,
        float(np.mean([row.newton_iterations for row in rows])),
        float(np.mean([row.factorisations for row in rows])),
    )


def carried(source: Problem, state: State, problem: Problem) -> State:
    """Return a state on a polar mesh carried to another mesh, and stepped there until steps are large again."""
    grid, nodes = source.mesh.grid, source.mesh.nodes
    radius, angle = np.hypot(*nodes[grid[:, 0]].T), np.arctan2(*nodes[grid[0]].T[::-1])
    at = RegularGridInterpolator((radius, angle), state.q[grid], bounds_error=False, fill_value=None)
    q = at(np.stack([np.hypot(*problem.mesh.nodes.T), np.arctan2(*problem.mesh.nodes.T[::-1])], axis=1))
    control = Control(first=DT / RAMP, largest=DT)
    here = State(state.time, 0, control.first, q)
    ahead = steps(problem, here, control, [1.0], solver_named("direct", problem))
    return next(after for after, _ in ahead if after.dt >= DT)


def solvers(problem: Problem) -> tuple[dict[str, Callable], dict[str, float]]:
    """Return factorising and solving for the first step, to be timed, and the backward errors of the solutions."""
    q = problem.initial
    matrix, b = problem.matrix(q, 1 / DT), problem.equations(q, 0 * q, 0.0).ravel()
    calls, errors = {}, {}
    large = len(problem.mesh.elements) > LARGE  # the default's factors would take half a minute and 1.3 GB
    for name, factor in (("default", DEFAULT), ("direct", DIRECT), ("iterative", MULTIGRID)):
        if name == "default" and large or name == "iterative" and (large or not find_spec("pyamg")):
            continue
        factorise = solver_named(name, problem)
        solve = factorise(matrix)
        solve(b)
        calls |= {factor: partial(factorise, matrix), SOLVE[name]: partial(solve, b)}
        errors[SOLVE[name]] = getattr(solve, "backward_error", np.nan)
    return calls, errors


def assembling(problem: Problem, q: np.ndarray) -> dict[str, Callable]:
    """Return the calls that assemble on a state."""
    calls: dict[str, Callable] = {}
    for path, own in paths(problem).items():
        calls |= {f"{BALANCE}, {path}": partial(own.equations, q, 0 * q, 0.0)}
        calls |= {f"{JACOBIAN}, {path}": partial(own.matrix, q, 1 / DT)}
        own.matrix(own.initial), own.balance(own.initial)  # compiled now
    return calls


def step_rows(problem: Problem, states: dict[str, State], unit: float, limits: bool) -> Iterator[Row]:
    """Yield what steps cost on each of the states, by each way to assemble, with ``unit`` seconds as one."""
    for (where, state), (path, own) in ((s, p) for s in states.items() for p in paths(problem).items()):
        cost = stepped(own, state, STEPS if len(own.mesh.elements) <= LARGE else 2)
        said = f"a step on the {where}, {path}"
        yield Row(said, cost.seconds, measured=cost.seconds / unit)
        limit = SHARE[path] if limits and where == BANDED else None
        yield Row(f"{said}: share of assembly", measured=cost.assembly, limit=limit)
        if path == NUMPY:
            yield Row(f"{said}: share of factorising", measured=cost.factors)
            yield Row(f"{said}: share of solving", measured=cost.solves)
            yield Row(f"{said}: Newton iterations", measured=cost.iterations)
            yield Row(f"{said}: factorisations", measured=cost.factorisations)


def on_mesh(elements: int, kind: str, source: tuple[Problem, State], rounds: int) -> Group:
    """Return what is measured on one mesh."""
    problem = problem_of(elements, kind)
    states = {BASE: start(problem, Control(first=DT, largest=DT))}
    if elements <= LARGE:
        states[BANDED] = carried(*source, problem)
    name = f"stepper-{elements}" + ("" if kind == "polar" else f"-{kind}")
    text = (
        f"The paper's hopper, half wedge, {kind} mesh of {len(problem.mesh.elements):,} elements, epsilon = 1e-4 s; "
        f"matrix of the first step, then means of a few steps of {DT:g} s. Error: backward error."
    )
    group = Group(name, text, "ms", 1e3)
    calls, errors = solvers(problem)
    calls |= assembling(problem, states[BANDED].q if BANDED in states else problem.initial)
    timings, baseline = interleaved(calls, rounds), next(iter(calls))
    gain = {(DEFAULT, DIRECT): Limit(4, at_least=True) if elements == LARGE else None}
    gain |= {(MULTIGRID, DIRECT): None, (SOLVE["iterative"], SOLVE["direct"]): None}
    gain |= {(f"{call}, {NUMPY}", f"{call}, {NUMBA}"): None for call in (BALANCE, JACOBIAN)}
    group.rows += timed(timings, baseline, errors, gain)
    group.rows += step_rows(problem, states, median(timings, baseline), limits=elements == 4000 and kind == "polar")
    if not find_spec("pyamg"):
        group.notes.append("multigrid is missing: pyamg, the extra `multigrid`, is not installed")
    if reason := without_compiled():
        group.notes.append(f"compiled assembly is missing: {reason}")
    return group


def whole_run(elements: int) -> tuple[Group, Problem, State]:
    """Return what a run of `END` seconds takes, as anyone would start it, with its problem and its last state."""
    mesh = {"elements": elements, "kind": "polar", "half": True}
    asked = March("perturbed", "radial_hopper", PARAMETERS, mesh, [END])
    problem = asked.problem()
    calls, _ = solvers(problem)
    unit = median(interleaved({DEFAULT: calls[DEFAULT]}, 3), DEFAULT)
    watch = Watch(solver_named(asked.solver, problem))
    run = Run(start(problem, asked.control), [])
    marched(problem, asked.control, watch, run, [END], asked.every)
    assembly = NUMPY if problem._loops is None else f"{NUMBA}, its start or compilation included"
    text = (
        f"{len(problem.mesh.elements):,} elements, half wedge, epsilon = 1e-4 s, to {END:g} s, steps up to "
        f"{asked.largest:g} s; assembled by {assembly}. Ratio: to one default splu, {unit * 1e3:.0f} ms."
    )
    group = Group(f"stepper-run-{elements}", text, "s", 1)
    # The one target in seconds: that a run of the paper's size is over within minutes is what is asked.
    limit = Limit(180) if elements == 4000 else None
    group.rows += [
        Row("the whole run", watch.seconds, measured=watch.seconds / unit),
        Row("the whole run, in seconds", measured=watch.seconds, limit=limit),
        Row("steps", measured=float(run.state.step)),
        Row("Newton iterations a step", measured=float(np.mean(run.log["newton_iterations"]))),
        Row("factorisations a step", measured=float(np.mean(run.log["factorisations"]))),
        Row("share of assembly", measured=1 - (watch.factors + watch.solves) / watch.seconds),
        Row("largest miss of a mass balance", measured=float(np.max(run.log["mass_budget"]))),
    ]
    return group, problem, run.state


SCRIPT = """
from pathlib import Path
from benchmarks import stepper
from stability.timestepper.linear import solver_named

def status(name):
    text = Path("/proc/self/status").read_text()
    return 1024 * int(text.split(name + ":")[1].split()[0])

small = stepper.problem_of(100)
stepper.first_step(small, solver_named("{solver}", small))
problem = stepper.problem_of({elements})
problem.balance(problem.initial)
factorise = solver_named("{solver}", problem)
Path("/proc/self/clear_refs").write_text("5")
before = status("VmRSS")
stepper.first_step(problem, factorise)
print(status("VmHWM") - before)
"""


def first_step(problem: Problem, factorise: Factorise) -> None:
    """Assemble, factorise and solve once."""
    q = problem.initial
    factorise(problem.matrix(q, 1 / DT))(problem.equations(q, 0 * q, 0.0).ravel())


def memory(sizes: tuple[int, ...]) -> Group:
    """Return the peak memory of a first step, each in a fresh process."""
    group = Group("stepper-memory", "Peak memory of one Newton iteration above mesh and geometry, in MiB.", "", 1)
    if not Path("/proc/self/clear_refs").exists():
        group.notes.append("not measured: the system does not tell a process's high-water mark")
        return group
    found = {}
    for elements in sizes:
        for solver in ("direct", "default") if elements <= LARGE else ("direct",):
            command = [sys.executable, "-c", SCRIPT.format(elements=elements, solver=solver)]
            run = subprocess.run(command, capture_output=True, text=True, check=True, cwd=ROOT)
            found[elements, solver] = int(run.stdout)
            group.rows.append(Row(f"{solver}, {elements:,} elements", measured=found[elements, solver] / 2**20))
    if (LARGE, "default") in found:
        gain = found[LARGE, "default"] / found[LARGE, "direct"]
        said = f"default splu over direct, {LARGE:,} elements"
        group.rows.append(Row(said, measured=gain, limit=Limit(1.9, at_least=True)))
    return group


def measure(quick: bool) -> Iterator[Group]:
    """Yield the whole run, whose last state the meshes start from, then the meshes by size, then memory."""
    whole, *source = whole_run(1000 if quick else 4000)
    yield whole
    sizes = QUICK if quick else SIZES
    for elements in sizes:
        for kind in ("polar", "diamond") if elements == 4000 else ("polar",):
            yield on_mesh(elements, kind, source, 1 if elements > LARGE else 3 if quick else 7)
    yield memory(sizes)
