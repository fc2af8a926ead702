"""The loops over elements, plain and compiled, against NumPy's passes over arrays."""

from dataclasses import replace
from itertools import product

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from stability import codegen
from stability.closures import CLOSURES
from stability.timestepper import compiled
from stability.timestepper.constraints import NONE
from stability.timestepper.hopper import hopper_problem
from stability.timestepper.integrate import Control, start, steps
from stability.timestepper.law import Law
from stability.timestepper.linear import direct
from stability.timestepper.mesh import periodic_square
from stability.timestepper.problem import Background, Problem
from tests.conftest import HOPPER

# Another order of the same sums and products: some tens of roundings of terms up to the largest entry.
ROUNDINGS = 1e-13


def hopper(closure: str, kind: str = "polar", half: bool = True, floor: float = 4.0) -> Problem:
    given = HOPPER | ({"epsilon": 1e-3} if closure == "perturbed" else {})
    mesh = {"elements": 24, "kind": kind, "half": half}
    return replace(hopper_problem(closure, "radial_hopper", given, mesh, floor=floor), compiled=False)


def cell() -> Problem:
    law = Law("perturbed", {"friction_angle": 0.6, "epsilon": 1e-2}, floor=0.05)
    background = Background(np.array([(1.0, 0.2), (0.0, -0.9)]), 2.0)
    return Problem(periodic_square(1.0, 3), law, np.zeros((9, 3)), background=background, compiled=False)


def inertial() -> Problem:
    law = {"grain_diameter": 1e-3, "solid_fraction": 0.6, "static_friction": 0.34, "dynamic_friction": 0.56}
    problem = hopper("rigid_plastic")
    law |= {"reference_inertial_number": 0.07}
    initial = problem.initial + [0, 0, 3.0]  # mu(I) needs a positive pressure
    return replace(problem, law=Law("mu_i", law, (-9.81, 0.0), floor=2.0), initial=initial, constraints=NONE)


PROBLEMS = {
    "perturbed, polar": lambda: hopper("perturbed"),
    "perturbed, the whole wedge, no floor": lambda: hopper("perturbed", half=False, floor=0.0),
    "rigid-plastic, with smoothing, on triangles too": lambda: hopper("rigid_plastic", "diamond"),
    "about a background": cell,
    "mu(I)": inertial,
}


@pytest.fixture(params=PROBLEMS)
def problem(request) -> Problem:
    return PROBLEMS[request.param]()


def disturbed(problem: Problem, size: float = 0.1) -> np.ndarray:
    """Return the initial state with noise on all fields."""
    noise = np.random.default_rng(0).uniform(-1, 1, problem.initial.shape)
    return problem.initial + size * noise * problem.scales


def interpreted(problem: Problem, monkeypatch: pytest.MonkeyPatch) -> Problem:
    """Return a problem with the loops as Python runs them."""

    def plain(closure: str) -> tuple:
        generated = codegen.load(CLOSURES, closure, codegen.POINTWISE)
        return compiled.loops(generated, "<plain>", lambda call: call, lambda call: call)

    monkeypatch.setattr(compiled, "kernels", plain)
    return replace(problem, compiled=True)


def assert_same(one: Problem, other: Problem) -> None:
    """Compare balances and Jacobians of two problems, every kind of entry on its own scale."""
    q = disturbed(one)
    found, expected = other.balance(q), one.balance(q)
    assert found.shape == expected.shape
    for i in range(3):
        assert_allclose(found[:, i], expected[:, i], rtol=0, atol=ROUNDINGS * abs(expected[:, i]).max())
    found, expected = other.jacobian_blocks(q), one.jacobian_blocks(q)
    assert found.shape == expected.shape
    for i, j in product(range(3), range(3)):
        assert_allclose(found[i, j], expected[i, j], rtol=0, atol=ROUNDINGS * abs(expected[i, j]).max())


def test_the_loops_give_what_the_array_passes_give(problem, monkeypatch):
    assert_same(problem, interpreted(problem, monkeypatch))


def test_the_floor_and_the_smoothing_are_seen_by_the_loops(monkeypatch):
    plain = interpreted(hopper("rigid_plastic"), monkeypatch)
    q = disturbed(plain)
    for other in (replace(plain, law=replace(plain.law, floor=0.0)), replace(plain, smoothing=None)):
        assert abs(other.balance(q) - plain.balance(q)).max() > 1e-3 * abs(plain.balance(q)).max()
        assert abs(other.jacobian_blocks(q) - plain.jacobian_blocks(q)).max() > 0.01


def test_complex_numbers_take_numpys_way(monkeypatch):
    problem = interpreted(hopper("perturbed"), monkeypatch)
    q = disturbed(problem)
    direction = np.random.default_rng(1).normal(size=q.shape) * problem.scales
    step = 1e-30  # no difference is formed, so that nothing is lost by a tiny step
    by_step = problem.equations(q + 1j * step * direction, 0 * q, 0.0).imag / step
    along = (problem.matrix(q) @ direction.ravel()).reshape(q.shape)
    assert_allclose(along, by_step, rtol=0, atol=1e-12 * abs(by_step).max())  # sums of up to 27 products


def test_walls_touch_no_node_twice():
    for kind in ("polar", "graded", "diamond"):
        problem = hopper("perturbed", kind, half=False)
        assert problem._walls
        for wall in problem._walls:
            node = problem.mesh.elements[wall.edge.elements, wall.edge.corner]
            assert len(np.unique(node)) == len(node)


def test_loops_are_compiled_for_large_meshes_where_numba_is(monkeypatch):
    monkeypatch.delenv("NUMBA_DISABLE_JIT", raising=False)
    monkeypatch.setattr(compiled, "find_spec", lambda name: name)
    assert compiled.pays(compiled.PAYS) and not compiled.pays(compiled.PAYS - 1)
    monkeypatch.setenv("NUMBA_DISABLE_JIT", "1")
    assert not compiled.pays(10**6)
    monkeypatch.delenv("NUMBA_DISABLE_JIT")
    monkeypatch.setattr(compiled, "find_spec", lambda name: None)
    assert not compiled.pays(10**6)


def test_an_argument_overrules_the_size_of_the_mesh(monkeypatch):
    monkeypatch.setattr("stability.timestepper.problem.pays", lambda elements: elements >= 24)
    problem = replace(interpreted(hopper("perturbed"), monkeypatch), compiled=None)
    assert len(problem.mesh.elements) >= 24 and problem._loops is not None
    assert replace(problem, compiled=False)._loops is None


# From here on numba is needed.


@pytest.fixture
def numba():
    return pytest.importorskip("numba", reason="numba is not installed: the extra `fast`")


COMPILED = [
    "perturbed, polar",
    "perturbed, the whole wedge, no floor",
    "about a background",
    "rigid-plastic, with smoothing, on triangles too",
    pytest.param("mu(I)", marks=pytest.mark.slow),  # each closure takes some 6 s to compile
]


@pytest.mark.parametrize("name", COMPILED)
def test_compiled_loops_give_what_the_array_passes_give(name, numba):
    problem = PROBLEMS[name]()
    assert_same(problem, replace(problem, compiled=True))


def test_compiled_loops_give_the_same_bits_each_time(numba):
    one, other = (replace(hopper("perturbed"), compiled=True) for _ in range(2))
    q = disturbed(one)
    assert_array_equal(one.balance(q), other.balance(q))
    assert_array_equal(one.jacobian_blocks(q), other.jacobian_blocks(q))


def test_a_run_with_compiled_loops_goes_as_it_does_with_numpy(numba):
    control, problem = Control(first=1e-4, largest=1e-4), hopper("perturbed")
    runs = []
    for asked in (problem, replace(problem, compiled=True)):
        runs.append(list(steps(asked, start(asked, control), control, [5e-4], direct())))
    (state, row), (other, other_row) = (run[-1] for run in runs)
    assert len(runs[0]) == len(runs[1]) == 5 and row.newton_iterations == other_row.newton_iterations
    # Each step ends with a last correction below 1e-9, of iterates that differ by roundings.
    assert_allclose(other.q, state.q, rtol=0, atol=1e-9 * max(problem.scales))


def test_numbers_that_leave_the_range_come_out_as_nan_and_raise_nothing(numba):
    problem = replace(hopper("perturbed", floor=0.0), compiled=True)
    assert np.isnan(problem._loops.balance(np.full_like(problem.initial, np.nan))).any()
    problem._loops.blocks(0 * problem.initial)  # 0/0: at rest, without a floor


def test_machine_code_is_kept_under_a_name_that_signs_the_text(numba, tmp_path, monkeypatch):
    monkeypatch.setenv("STABILITY_CACHE", str(tmp_path))
    path = compiled.kept("perturbed", "text")
    assert path.read_text() == "text" and path.parent == tmp_path
    before = path.stat().st_mtime_ns
    assert compiled.kept("perturbed", "text") == path and path.stat().st_mtime_ns == before
    assert len({path, compiled.kept("perturbed", "other"), compiled.kept("rigid_plastic", "text")}) == 3
    assert compiled.kept(CLOSURES["perturbed"], "text") is None


def test_a_folder_that_cannot_be_written_costs_time_only(numba, tmp_path, monkeypatch):
    (tmp_path / "file").write_text("in the way")
    monkeypatch.setenv("STABILITY_CACHE", str(tmp_path / "file" / "below"))
    assert compiled.kept("perturbed", "text") is None
