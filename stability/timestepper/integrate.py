"""Steps in time: backward Euler (the paper's) or BDF2, with steps that shrink where Newton fails and grow where not."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from math import ceil
from time import perf_counter

import numpy as np

from stability.errors import ConvergenceError, SceneError
from stability.timestepper.diagnostics import budgets, counts
from stability.timestepper.newton import Factors, Outcome, newton
from stability.timestepper.problem import Problem

SCHEMES = ("backward_euler", "bdf2")
EASY = 8  # Newton iterations: a step that took no more was easy
GROWTH, SHRINKAGE = 1.3, 0.5
# Of a step to the one before it, for BDF2: beyond 1 + sqrt(2) it is unstable, and where a short step to a snapshot is
# followed by one fifty times as long, the past would weigh fifty times as much. One step of first order costs no order.
LARGEST_RATIO = 2.2


@dataclass(frozen=True, eq=False)
class State:
    """All that decides how a run goes on.

    Attributes
    ----------
    time, step : simulated time (s), accepted steps so far
    dt : the step to try next (s)
    q : (n, 3) u, v (m/s) and p (m2/s2) at the nodes
    before, dt_before : the fields one step earlier and that step, for BDF2; None and 0 at the start
    """

    time: float
    step: int
    dt: float
    q: np.ndarray
    before: np.ndarray | None = None
    dt_before: float = 0.0


@dataclass(frozen=True)
class Control:
    """How to step.

    Attributes
    ----------
    first, largest, smallest : steps (s)
    scheme : one of `SCHEMES`
    tolerance : of Newton's last update, relative to the scales
    """

    first: float = 1e-5
    largest: float = 5e-4
    smallest: float = 1e-9
    scheme: str = "backward_euler"
    tolerance: float = 1e-9

    def __post_init__(self) -> None:
        if self.scheme not in SCHEMES:
            raise SceneError(f"scheme = {self.scheme!r} is unknown: use one of {', '.join(SCHEMES)}")
        if not 0 < self.smallest <= self.first <= self.largest:
            raise SceneError(
                f"steps must satisfy 0 < smallest <= first <= largest, got {self.smallest:g}, {self.first:g} and "
                f"{self.largest:g} s"
            )


@dataclass(frozen=True)
class Step:
    """One accepted step, a row of the log.

    Attributes
    ----------
    time, dt : at its end, its size (s)
    newton_iterations, factorisations : of the accepted try
    rejected : tries that failed before it
    update : Newton's last update, relative to the scales
    cells_below_floor : elements where ||V|| lies below the floor somewhere
    nodes_without_pressure : nodes with p <= 0 that are not held there
    backward_wall_nodes : nodes of walls that slide away from the apex, where the friction has the wrong sign
    mass_budget, momentum_budget : what the balances of all free control volumes miss together (`diagnostics`)
    seconds : the time that it took
    """

    time: float
    dt: float
    newton_iterations: int
    factorisations: int
    rejected: int
    update: float
    cells_below_floor: int
    nodes_without_pressure: int
    backward_wall_nodes: int
    mass_budget: float
    momentum_budget: float
    seconds: float


def start(problem: Problem, control: Control) -> State:
    """Return the initial state of a problem."""
    return State(0.0, 0, control.first, problem.initial)


def steps(
    problem: Problem, state: State, control: Control, stops: Sequence[float], factorise: Callable
) -> Iterator[tuple[State, Step]]:
    """Step from a state to the last of the times ``stops``, landing on each of them.

    Yields the new state and its row of the log after each accepted step. What follows depends on the state alone
    and on the factors kept from earlier steps; a new call starts without factors, so a run that is to go on exactly
    as it would have done must begin a new call wherever it may be interrupted.

    Raises
    ------
    ConvergenceError : the smallest step fails; it carries the last good state and what was tried
    """
    factors = Factors(factorise)
    for stop in stops:
        while state.time < stop:
            state, step = advanced(problem, state, control, stop, factors)
            yield state, step


def advanced(problem: Problem, state: State, control: Control, stop: float, factors: Factors) -> tuple[State, Step]:
    """Return the state after one step towards the time ``stop``, and its row of the log."""
    began, dt, history = perf_counter(), min(state.dt, control.largest), []
    while True:
        tries = max(1, ceil((stop - state.time) / dt * (1 - 1e-12)))  # equal steps to the stop: none is a sliver
        used = (stop - state.time) / tries
        time = stop if tries == 1 else state.time + used
        coefficient, rate = differences(state, used, control.scheme)
        found = newton(problem, state.q, rate, coefficient, time, control.tolerance, factors)
        if found.converged:
            break
        history.append((used, found))
        factors.solve = None
        dt = SHRINKAGE * used
        if dt < control.smallest:
            raise failure(problem, state, control, history)
    easy = not history and len(found.updates) <= EASY
    after = State(
        time=time,
        step=state.step + 1,
        dt=min(GROWTH * dt, control.largest) if easy else dt,
        q=found.q,
        before=state.q if control.scheme == "bdf2" else None,
        dt_before=used,
    )
    return after, logged(problem, after, found, rate(found.q), len(history), perf_counter() - began)


def differences(state: State, dt: float, scheme: str) -> tuple[float, Callable[[np.ndarray], np.ndarray]]:
    """Return d rate/dq (1/s) and the rate of change at the end of a step, as a function of the fields there."""
    ratio = dt / state.dt_before if state.before is not None else np.inf
    if scheme == "backward_euler" or ratio > LARGEST_RATIO:
        return 1 / dt, lambda q: (q - state.q) / dt
    # BDF2 on steps of unequal size
    a, b = (1 + 2 * ratio) / (1 + ratio), ratio**2 / (1 + ratio)
    past = b * (state.q - state.before)
    return a / dt, lambda q: (a * (q - state.q) - past) / dt


def logged(problem: Problem, state: State, found: Outcome, rate: np.ndarray, rejected: int, seconds: float) -> Step:
    """Return the row of the log of an accepted step."""
    mass, momentum = budgets(problem, state.q, rate, state.time)
    return Step(
        time=state.time,
        dt=state.dt_before,
        newton_iterations=len(found.updates),
        factorisations=found.factorisations,
        rejected=rejected,
        update=found.updates[-1],
        **counts(problem, state.q),
        mass_budget=mass,
        momentum_budget=momentum,
        seconds=seconds,
    )


def failure(problem: Problem, state: State, control: Control, history: list) -> ConvergenceError:
    """Return the error that says where and how a run came to its end."""
    dt, last = history[-1]
    rate = (last.q - state.q) / dt
    residual = abs(problem.equations(last.q, rate, state.time + dt)) / problem.volume[:, None]
    node, row = np.unravel_index(np.argmax(np.nan_to_num(residual, nan=np.inf)), residual.shape)
    x, y = problem.mesh.nodes[node]
    tried = ", ".join(f"{used:.3g} s ({found.reason})" for used, found in history)
    return ConvergenceError(
        f"Newton's method fails at time {state.time:.6g} s, step {state.step + 1}: tried {tried}; the smallest step "
        f"allowed is {control.smallest:.3g} s. Updates of the last try: "
        f"{', '.join(f'{u:.2g}' for u in last.updates[-6:])}. Worst cell: the one around x = {x:.4g} m, y = {y:.4g} m, "
        f"{('momentum along', 'momentum across', 'mass')[row]}. Raise the floor under ||V||, refine the mesh, or allow "
        "smaller steps",
        state=replace(state, dt=control.first),
        history=tuple(last.updates),
    )
