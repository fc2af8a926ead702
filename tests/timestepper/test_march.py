"""A march stopped anywhere goes on to the same bits, says how, and keeps nothing that it does not need."""

import json
import os
from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from stability.errors import CheckpointError, ConvergenceError, Interrupted, SceneError
from stability.timestepper import checkpoint, integrate
from stability.timestepper import march as marching
from stability.timestepper.march import March, march, noise
from tests.conftest import HOPPER

ASKED = March(
    closure="perturbed",
    flow="radial_hopper",
    parameters=HOPPER | {"epsilon": 1e-4},
    mesh={"kind": "polar", "elements": 60, "half": True},
    snapshots=(0.0, 1e-4, 5e-4, 2e-3),
    noise=1e-3,
    every=4,
)


class Killed(BaseException):
    """What a run cannot answer."""


def stopping(at: int, stop: type[BaseException] = Killed):
    """Return a report that stops a run once it has reported so many steps."""
    seen = []

    def report(done: float, total: float, note: str = "", start: float = 0) -> None:
        seen.append(note)
        if len(seen) == at:
            raise stop

    return report


@pytest.fixture(scope="module")
def whole():
    return march(ASKED)


@pytest.mark.parametrize("scheme", ["backward_euler", "bdf2"])
def test_a_run_killed_after_any_step_ends_with_the_same_bits(scheme, tmp_path):
    asked = replace(ASKED, scheme=scheme)
    whole, path = march(asked), tmp_path / "checkpoint"
    steps = whole.sizes["step"]
    assert steps > 3 * ASKED.every
    for at in range(1, steps + 1, 3):
        with pytest.raises(Killed):
            march(asked, path, report=stopping(at))
        assert march(asked, path).identical(whole), f"killed after step {at} of {steps}"
        checkpoint.remove(path)


def test_a_run_killed_again_and_again_ends_with_the_same_bits(whole, tmp_path):
    path = tmp_path / "checkpoint"
    kills = 0
    while True:
        try:
            found = march(ASKED, path, report=stopping(ASKED.every + 1 + kills % 2))
            break
        except Killed:
            kills += 1
    assert kills >= 3 and found.identical(whole)


def test_a_run_without_a_checkpoint_is_the_same_run(whole, tmp_path):
    assert march(ASKED, tmp_path / "checkpoint").identical(whole)


def test_snapshots_are_those_asked_for_and_the_first_is_the_initial_state(whole):
    assert whole.time.values.tolist() == list(ASKED.snapshots)
    assert set(ASKED.snapshots[1:]) <= set(whole.step_time.values), "steps land on snapshots exactly"
    problem = ASKED.problem()
    u, v, _ = np.moveaxis(problem.initial[problem.mesh.grid], -1, 0)
    theta = np.deg2rad(whole.theta.values)
    assert_allclose(whole.velocity_r[0], u * np.cos(theta) + v * np.sin(theta), rtol=1e-13, atol=1e-14)  # roundings
    later = march(replace(ASKED, snapshots=(5e-4,)))
    assert later.time.values.tolist() == [5e-4]


def test_the_log_has_a_row_for_each_step_and_its_times_add_up(whole):
    assert whole.step.values.tolist() == list(range(1, whole.sizes["step"] + 1))
    assert_allclose(np.cumsum(whole.step_size), whole.step_time, rtol=1e-13, atol=0)  # roundings of a sum
    assert (whole.newton_iterations > 0).all() and (whole.newton_update <= ASKED.newton).all()


def test_noise_is_seeded_bounded_and_keeps_to_the_boundary_conditions():
    problem = replace(ASKED, noise=0.0).problem()
    one = noise(problem, 1e-3, 1)
    assert_array_equal(one, noise(problem, 1e-3, 1))
    assert not np.array_equal(one, noise(problem, 1e-3, 2))
    speed = np.sqrt(9.81 * 0.5)
    assert 0.9e-3 * speed < abs(one[:, :2]).max() <= 1e-3 * speed
    assert not one[:, 2].any()
    radii = problem.mesh.nodes / np.hypot(*problem.mesh.nodes.T)[:, None]
    across = radii[:, 0] * one[:, 1] - radii[:, 1] * one[:, 0]
    sides = problem.mesh.grid[:, [0, -1]]
    assert_allclose(across[sides], 0, atol=1e-18)  # a rounding of 1e-3 m/s
    assert_array_equal(problem.initial + one, ASKED.problem().initial)


def test_an_interrupted_run_says_what_is_kept_and_how_to_go_on(whole, tmp_path):
    path = tmp_path / "run.nc.checkpoint"
    with pytest.raises(Interrupted) as caught:
        march(ASKED, path, report=stopping(7, KeyboardInterrupt))
    assert str(caught.value).startswith("interrupted at step 7, t = ")
    assert f"{path} holds step 4, t = " in str(caught.value)
    assert str(caught.value).endswith(f"go on with stability resume {path}")
    assert march(ASKED, path).identical(whole)


def test_an_interrupt_without_a_checkpoint_is_python_s_own():
    with pytest.raises(KeyboardInterrupt) as caught:
        march(ASKED, report=stopping(2, KeyboardInterrupt))
    assert not isinstance(caught.value, Interrupted)


@pytest.fixture
def failing(monkeypatch):
    """Make the integrator fail after step 6."""
    steps = integrate.steps

    def fails(problem, state, *rest):
        for found, row in steps(problem, state, *rest):
            if found.step > 6:
                raise ConvergenceError("no decrease at time 1 s, step 7. Worst cell: 3", state, (0.1, 0.2))
            state = found
            yield found, row

    monkeypatch.setattr(marching, "steps", fails)


def test_a_run_that_cannot_go_on_keeps_its_last_good_state_and_says_how_to_go_on(failing, tmp_path):
    path = tmp_path / "run.nc.checkpoint"
    with pytest.raises(ConvergenceError) as caught:
        march(ASKED, path)
    assert caught.value.state.step == 6 and caught.value.history == (0.1, 0.2)
    for phrase in ("no decrease at time 1 s, step 7. Worst cell: 3. ", "holds the last good state, step 6, t = ",
                   f"stability resume {path} --scene CHANGED.toml"):  # fmt: skip
        assert phrase in str(caught.value)
    found = checkpoint.load(path)
    assert found.state["step"] == 6 and len(found.log["dt"]) == 6
    assert_array_equal(found.state["q"], caught.value.state.q)


def test_a_failure_without_a_checkpoint_is_the_integrator_s_own(failing):
    with pytest.raises(ConvergenceError) as caught:
        march(ASKED)
    assert str(caught.value) == "no decrease at time 1 s, step 7. Worst cell: 3"


def test_a_tolerance_that_cannot_be_met_fails_in_words(tmp_path):
    impossible = replace(ASKED, newton=1e-30, smallest=ASKED.first)
    with pytest.raises(ConvergenceError, match=r"fails at time 0 s, step 1.*Worst cell: .*holds the last good state"):
        march(impossible, tmp_path / "checkpoint")
    assert checkpoint.load(tmp_path / "checkpoint").state["step"] == 0


def test_a_full_disk_stops_a_run_with_the_last_checkpoint_kept(tmp_path, monkeypatch, whole):
    path, fsync = tmp_path / "checkpoint", os.fsync

    def full(handle: int) -> None:
        if path.exists() and checkpoint.load(path).state["step"] == 8:
            raise OSError(28, "No space left on device")
        fsync(handle)

    monkeypatch.setattr(checkpoint.os, "fsync", full)
    with pytest.raises(CheckpointError, match="the one of step 8, t = .* is kept: make room, then stability resume"):
        march(ASKED, path)
    monkeypatch.undo()
    assert os.listdir(tmp_path) == ["checkpoint"] and march(ASKED, path).identical(whole)


def test_a_checkpoint_of_another_run_is_refused_and_kept(tmp_path):
    path = tmp_path / "checkpoint"
    with pytest.raises(Killed):
        march(ASKED, path, report=stopping(5))
    before = path.read_bytes()
    for other in (replace(ASKED, floor=0.1), replace(ASKED, every=5), replace(ASKED, seed=2)):
        with pytest.raises(CheckpointError, match="belongs to another scene"):
            march(other, path)
    with pytest.raises(CheckpointError, match="belongs to another scene"):
        march(ASKED, path, scene_text="title = 'another'\n")
    assert path.read_bytes() == before


def test_the_signature_names_scene_versions_and_sources(monkeypatch):
    one = ASKED.signature("text")
    assert one.keys() == {"scene", "granular-stability", "numpy", "scipy", "numba", "pyamg", "numba off", "sources"}
    assert one == ASKED.signature("text")
    assert one["scene"] != ASKED.signature("other")["scene"]
    assert one["sources"] != replace(ASKED, closure="rigid_plastic").signature("text")["sources"]
    monkeypatch.setattr(marching, "_sources", lambda: b"edited")
    assert one["sources"] != ASKED.signature("text")["sources"]


def test_a_place_that_cannot_be_written_to_is_told_before_the_work(tmp_path):
    with pytest.raises(CheckpointError, match="No such file or directory; there is no earlier one"):
        march(ASKED, tmp_path / "nowhere" / "checkpoint", report=stopping(1))


@pytest.mark.parametrize(
    ("changes", "says"),
    [({"first": 1.0}, "smallest <= first <= largest"), ({"solver": "magic"}, "solver = 'magic' is not possible"),
     ({"scheme": "rk4"}, "scheme = 'rk4' is unknown"), ({"mesh": {"elements": 1}}, "elements = 1 is not possible")],
)  # fmt: skip
def test_what_cannot_be_marched_is_a_sentence_and_leaves_no_checkpoint(changes, says, tmp_path):
    with pytest.raises(SceneError, match=says):
        march(replace(ASKED, **changes), tmp_path / "checkpoint")
    assert not os.listdir(tmp_path)


def test_progress_says_time_step_and_iterations(tmp_path):
    seen = []
    path = tmp_path / "checkpoint"
    with pytest.raises(Killed):
        march(ASKED, path, report=stopping(6))
    march(ASKED, path, report=lambda *said: seen.append(said))
    done, total, note, start = seen[0]
    assert note.startswith(f"t = {done:.4g} of 0.002 s, step 5, ") and note.endswith(" Newton iterations")
    assert total == 0.002 and start == checkpoint_time(seen) > 0 and seen[-1][0] == total


def checkpoint_time(seen: list) -> float:
    (start,) = {said[3] for said in seen}
    assert start < seen[0][0]
    return start


def test_the_iterative_solver_can_be_asked_for():
    pytest.importorskip("pyamg")
    assert march(replace(ASKED, solver="iterative", snapshots=(2e-5,))).attrs["solver"] == "iterative"


def test_a_closure_of_one_s_own_is_marched_and_named(tmp_path):
    from stability import CLOSURES

    own = replace(CLOSURES["perturbed"], name="own")
    ds = march(replace(ASKED, closure=own, snapshots=(2e-5,)), tmp_path / "checkpoint")
    assert ds.attrs["closure"] == "own"
    expected = march(replace(ASKED, snapshots=(2e-5,)))
    assert_array_equal(ds.velocity_r, expected.velocity_r)
    assert json.loads(ds.attrs["parameters"]) == ASKED.parameters
