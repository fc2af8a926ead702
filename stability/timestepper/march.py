"""The flow in time: a hopper problem stepped to its snapshots, kept in checkpoints, as a labelled result.

The integrator keeps factors from step to step, which a checkpoint does not hold. So it is begun anew after every
``every`` steps, whether or not a checkpoint is written there: a run that was killed and goes on from its last
checkpoint then takes the same steps, to the last bit, as one that was left alone.
"""

import hashlib
import json
import os
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, fields, replace
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from stability import codegen, results
from stability.closures import CLOSURES
from stability.errors import CheckpointError, ConvergenceError, Interrupted
from stability.flows import FLOWS
from stability.progress import Report
from stability.timestepper import checkpoint as file
from stability.timestepper import output
from stability.timestepper.hopper import hopper_problem
from stability.timestepper.integrate import Control, State, start, steps
from stability.timestepper.linear import solver_named
from stability.timestepper.problem import Problem

if TYPE_CHECKING:
    from xarray import Dataset

LIBRARIES = ("numpy", "scipy", "numba", "pyamg")  # whose versions decide the last digits
SOURCES = ("timestepper", "model")  # with those that a generated module depends on
SPECTATORS = ("checkpoint", "forecast", "output", "paraview")  # of the first, those that decide no state


@dataclass(frozen=True)
class March:
    """What is marched: plain numbers and words, so that it can be written down and compared.

    Attributes
    ----------
    closure, flow : names of a closure with the fields (u, v, p) and of a radial flow, the initial state
    parameters : words of closure and flow, SI units, angles in degrees
    mesh : kind, elements and half of `hopper_mesh`
    snapshots : times (s) at which the fields are kept; the run ends at the last
    first, largest, smallest : time steps (s)
    scheme : "backward_euler" or "bdf2"
    floor : least ||V|| in the rheology (1/s)
    solver : "direct" or "iterative"
    newton : last update of Newton's method, relative to the scales
    noise, seed : largest random velocity in the initial state, over sqrt(g r_0), and the seed of its numbers
    every : steps from one checkpoint to the next
    """

    closure: Any
    flow: Any
    parameters: Mapping[str, float]
    mesh: Mapping[str, Any]
    snapshots: Sequence[float]
    first: float = 1e-5
    largest: float = 5e-4
    smallest: float = 1e-9
    scheme: str = "backward_euler"
    floor: float = 0.05
    solver: str = "direct"
    newton: float = 1e-9
    noise: float = 0.0
    seed: int = 1
    every: int = 20

    @property
    def control(self) -> Control:
        """How the integrator steps."""
        return Control(self.first, self.largest, self.smallest, self.scheme, self.newton)

    @property
    def words(self) -> dict[str, Any]:
        """Everything that is asked, with names in place of closures and flows."""
        found = {f.name: getattr(self, f.name) for f in fields(self)}
        found |= {"snapshots": list(self.snapshots), "mesh": {"kind": "polar", "half": True, **self.mesh}}
        return {word: getattr(value, "name", value) for word, value in found.items()}

    def problem(self) -> Problem:
        """Return the discrete problem, with the noise in its initial state."""
        found = hopper_problem(self.closure, self.flow, self.parameters, self.mesh, self.floor)
        return replace(found, initial=found.initial + noise(found, self.noise, self.seed)) if self.noise else found

    def signature(self, scene_text: str = "") -> dict[str, str]:
        """Return what decides the numbers of a run, part by part."""
        asked = scene_text + json.dumps(self.words, default=float, sort_keys=True)
        versions = {name: results.package_version(name) for name in LIBRARIES}
        versions["numba off"] = os.environ.get("NUMBA_DISABLE_JIT", "0")
        return {
            "scene": hashlib.sha256(asked.encode()).hexdigest(),
            "granular-stability": results.versions()["granular-stability"],
            **versions,
            "sources": sources(self.closure, self.flow),
        }


@dataclass
class Run:
    """A run under way: its state, the snapshots passed so far, and the columns of the step log."""

    state: State
    snapshots: list[np.ndarray]
    log: dict[str, list] = field(default_factory=lambda: {column: [] for column in output.LOG})


@dataclass(frozen=True)
class Keeper:
    """Where a run is kept, and what is written there beside its numbers."""

    path: Path
    signature: dict[str, str]
    scene_text: str
    continued: tuple = ()

    def save(self, run: Run) -> None:
        """Write a checkpoint."""
        columns = {name: np.asarray(values) for name, values in run.log.items()}
        passed = np.array(run.snapshots).reshape(len(run.snapshots), *run.state.q.shape)
        file.save(self.path, self.signature, run.state, passed, columns, self.scene_text, self.continued)

    @property
    def advice(self) -> str:
        """How to go on."""
        return f"stability resume {self.path}"


def sources(closure: Any, flow: Any) -> str:
    """Return the hash of the source files, and of the expressions, that decide the numbers."""
    digest = hashlib.sha256(_sources())
    for registry, entry in ((CLOSURES, closure), (FLOWS, flow)):
        text = codegen.signature(registry.place(entry) if isinstance(entry, str) else entry)
        digest.update(text.encode())
    return digest.hexdigest()


@cache
def _sources() -> bytes:
    package = Path(codegen.__file__).parent
    found = [p for name in SOURCES for p in (*package.glob(f"{name}.py"), *(package / name).glob("*.py"))]
    return b"".join(hashlib.sha256(p.read_bytes()).digest() for p in sorted(found) if p.stem not in SPECTATORS)


def noise(problem: Problem, size: float, seed: int) -> np.ndarray:
    """Return random velocities (n, 3), uniform up to ``size`` times the scale of velocity, zero where one is held."""
    n = len(problem.mesh.nodes)
    found = np.zeros((n, 3))
    found[:, :2] = size * problem.scales[:2] * np.random.default_rng(seed).uniform(-1, 1, (n, 2))
    fixed = problem.constraints
    turned = np.where(fixed.held, 0, np.einsum("kij,kj->ki", fixed.turn, found[fixed.node]))
    found[fixed.node] = np.einsum("kji,kj->ki", fixed.turn, turned)
    return found


def march(
    asked: March,
    checkpoint: str | Path | None = None,
    scene_text: str = "",
    report: Report | None = None,
) -> "Dataset":
    """Return the flow in time.

    Parameters
    ----------
    checkpoint : None, or the file in which the run is kept; if it exists the run goes on from there. It is left in
        place: `checkpoint.remove` takes it away once the result is safe
    scene_text : the scene that is run, for the checkpoint
    report : called with (simulated time, its end, a sentence, the time at which this run began)

    Raises
    ------
    SceneError : what is asked cannot be marched
    ConvergenceError : the smallest step fails; a checkpoint of the last good state is written
    CheckpointError : the checkpoint cannot be written, or is of another run
    Interrupted : Ctrl-C, where there is a checkpoint to go on from
    """
    problem, control = asked.problem(), asked.control
    factorise = solver_named(asked.solver, problem)  # before anything is written: it may not be installed
    times = [float(t) for t in asked.snapshots]
    run = Run(start(problem, control), [problem.initial] if times[0] == 0 else [])
    keeper = None
    if checkpoint is not None:
        keeper = Keeper(Path(checkpoint), asked.signature(scene_text), scene_text)
        file.sweep(keeper.path)
        if keeper.path.exists():
            run, keeper = taken_up(keeper)
        else:
            keeper.save(run)  # a place that cannot be written to is told before the work
    stepped(problem, control, factorise, run, times, asked.every, keeper, report)
    return output.dataset(problem, times, run.snapshots, run.log, **described(asked, keeper))


def taken_up(keeper: Keeper) -> tuple[Run, Keeper]:
    """Return the run that a checkpoint holds."""
    found = file.load(keeper.path, keeper.signature)
    log = {column: list(found.log[column]) for column in output.LOG}
    return Run(State(**found.state), list(found.snapshots), log), replace(keeper, continued=found.continued)


def stepped(
    problem: Problem,
    control: Control,
    factorise: Callable,
    run: Run,
    times: Sequence[float],
    every: int,
    keeper: Keeper | None = None,
    report: Report | None = None,
) -> None:
    """Take a run to the last of the times, in place."""
    begun = run.state.time
    try:
        while run.state.time < times[-1]:
            ahead = [t for t in times if t > run.state.time]
            for state, row in steps(problem, run.state, control, ahead, factorise):
                add(run, state, row, times)
                if report:
                    said = f"t = {state.time:.4g} of {times[-1]:.4g} s, step {state.step}, "
                    report(state.time, times[-1], f"{said}{row.newton_iterations} Newton iterations", begun)
                if state.step % every == 0:
                    break
            if keeper and run.state.time < times[-1]:
                keeper.save(run)
    except KeyboardInterrupt:
        if keeper is None:
            raise
        raise Interrupted(
            f"interrupted at step {run.state.step}, t = {run.state.time:.6g} s; {keeper.path} holds "
            f"{file.told(file.load(keeper.path))}: go on with {keeper.advice}"
        ) from None
    except ConvergenceError as error:
        if keeper is None:
            raise
        raise given_up(error, run, keeper) from None


def add(run: Run, state: State, row: Any, times: Sequence[float]) -> None:
    """Add an accepted step to a run."""
    run.state = state
    for column, values in run.log.items():
        values.append(getattr(row, column))
    if state.time in times:
        run.snapshots.append(state.q)


def given_up(error: ConvergenceError, run: Run, keeper: Keeper) -> ConvergenceError:
    """Write a checkpoint of the last good state, and return the error with how to go on."""
    try:
        keeper.save(Run(error.state or run.state, run.snapshots, run.log))
        kept = f"{keeper.path} holds the last good state, step {run.state.step}, t = {run.state.time:.6g} s"
    except CheckpointError as unwritten:
        kept = str(unwritten)
    return ConvergenceError(
        f"{error}. {kept}: go on with {keeper.advice} --scene CHANGED.toml, whose steps or floor differ",
        error.state,
        error.history,
    )


def described(asked: March, keeper: Keeper | None) -> dict[str, Any]:
    """Return the attributes of a result."""
    words = asked.words
    del words["snapshots"]
    words["steps"] = {size: words.pop(size) for size in ("first", "largest", "smallest")}
    words["checkpoint_every"] = words.pop("every")
    return words | ({"continued": keeper.continued} if keeper and keeper.continued else {})
