"""Growth maps at one position and at many: the package against what users do, and against C."""

from collections.abc import Callable, Iterator
from importlib.util import find_spec
from unittest.mock import patch

import numpy as np

import stability as st
from benchmarks import baselines, native
from benchmarks.accuracy import FLOAT32, FLOAT64, Truth, truth
from benchmarks.cases import Case, polar, positions
from benchmarks.rows import Group, Limit, timed
from benchmarks.timing import interleaved, per_sample
from stability import compiled, fast
from stability.model import Model

KERNEL = "growth_map's kernel alone"
PACKAGE, FULL, DRAFT = "growth_map", "growth_map with frequency", "growth_map, draft (float32)"
COMPILED = "growth_map, compiled (numba)"
EIGVALS, FORMULA, SHARED = "(a) lambdify + eigvals", "(b) lambdify + closed form", "(b) lambdify(cse) + closed form"
ON_FLOW = "(a) lambdify(cse) of D written out on the flow + eigvals"
C, C_FULL = "(c) C", "(c) C with frequency"
TOLERANCE = {DRAFT: FLOAT32}

Calls = dict[str, Callable[[], np.ndarray]]


def package(case: Case, **options: object) -> Callable[[], np.ndarray]:
    """Return the call of the package's own map."""
    return lambda: st.growth_map(*case.question, case.wavenumber, case.wave_angle, **options).growth_rate.values


def kernel(case: Case) -> Callable[[], np.ndarray]:
    """Return the call of the package's kernel alone: coefficients and the output are given."""
    form = Model(case.closure, case.flow).base(case.parameters, case.point).form(case.wave_angle)
    polynomials = fast.of_pair(form.coefficients, form.speed)
    table = fast.table(polynomials, case.wave_angle.size, fast.powers_of(polynomials, case.wavenumber))
    new, growth = fast.Scratch(float), np.zeros(case.shape)
    rows = max(1, fast.BLOCK // case.wavenumber.size)
    blocks = [slice(start, min(start + rows, len(growth))) for start in range(0, len(growth), rows)]

    def call() -> np.ndarray:
        for block in blocks:
            fast.pair(table, block, growth[block], None, new)
        return growth

    return call


def compiled_package(case: Case) -> Callable[[], np.ndarray]:
    """Return the call of the package's map by numba, which it would only choose for longer sweeps."""
    plain = package(case, frequency=False)

    def call() -> np.ndarray:
        with patch.object(compiled, "PAYS", 0):
            return plain()

    return call


def without_compiled() -> str | None:
    """Return why there is no compiled path, or None if there is one."""
    return None if find_spec("numba") else "numba, the extra `fast`, is not installed"


def variants(case: Case) -> Calls:
    """Return every way to a map of growth rates."""
    D, D_shared = baselines.tangent(case), baselines.tangent(case, cse=True)
    calls: Calls = {C: native.growth(case), C_FULL: native.growth(case, frequency=True)} if native.compiler() else {}
    calls |= {
        PACKAGE: package(case, frequency=False),
        FULL: package(case),
        DRAFT: package(case, frequency=False, accuracy="draft"),
    }
    if without_compiled() is None:
        calls[COMPILED] = compiled_package(case)
    calls |= {
        FORMULA: lambda: baselines.by_formula(D()),
        SHARED: lambda: baselines.by_formula(D_shared()),
        EIGVALS: lambda: baselines.by_eigvals(D()),
    }
    return calls


def admitted(calls: Calls, exact: Truth, group: Group) -> dict[str, float]:
    """Return the largest error of each variant, and drop those that fail the gate."""
    errors = {name: float(exact.errors(call()).max()) for name, call in calls.items()}
    for name, error in errors.items():
        if not error <= TOLERANCE.get(name, FLOAT64):
            group.notes.append(f"{name}: not timed, its error of {error:.1e} ‖D‖ fails the gate")
            del calls[name]
    return errors


def measured(group: Group, case: Case, calls: Calls, limits: dict, rounds: int) -> Group:
    """Fill a group with the timings of those variants that pass the gate."""
    errors = admitted(calls, truth(case), group)
    timings = per_sample(interleaved(calls, rounds), dict.fromkeys(calls, case.size))
    group.rows += timed(timings, C if C in calls else PACKAGE, errors, limits)
    if C not in calls:
        group.notes.append("(c) is missing, with the targets against it: no C compiler (or it failed the gate)")
    if reason := without_compiled():
        group.notes.append(f"the compiled path is missing: {reason}")
    return group


def measure(quick: bool) -> Iterator[Group]:
    """Yield the maps at one position, by size, then many positions."""
    against = {
        (PACKAGE, C): Limit(5.5),
        (COMPILED, C): Limit(1.2),
        (EIGVALS, PACKAGE): Limit(200, at_least=True),
        (FORMULA, PACKAGE): Limit(20, at_least=True),
        (SHARED, PACKAGE): Limit(20, at_least=True),
    }
    for samples in (10**4, 10**6) if quick else (10**4, 10**6, 10**7):
        case = polar(samples)
        group = Group(f"map-{samples:.0e}".replace("+0", ""), f"One position, {case.size:,} samples.")
        calls = variants(case) | {KERNEL: kernel(case)}
        if samples == 10**4 and not quick:
            calls[ON_FLOW] = written_out(case)
        yield measured(group, case, calls, against if samples == 10**6 else {}, 3 if quick else 9)
    case = positions(100 if quick else 1000)
    text = (
        f"{case.shape[0]:,} positions, {case.shape[1]} directions, {case.shape[2]} wavenumbers; coefficients included."
    )
    limits = {(PACKAGE, C): Limit(6), (SHARED, PACKAGE): Limit(12, at_least=True)}
    yield measured(Group("positions", text), case, variants(case), limits, 3 if quick else 9)


def written_out(case: Case) -> Callable[[], np.ndarray]:
    """Return the call of a user who starts from D on the flow, every letter written out."""
    compute = baselines.on_flow(case.closure, case.flow)
    degrees = {"friction_angle", "wall_friction_angle", "wedge_angle", "theta"}
    values = {word: np.deg2rad(v) if word in degrees else v for word, v in (case.parameters | case.point).items()}
    return lambda: baselines.by_eigvals(compute(*baselines.wavevectors(case), values))
