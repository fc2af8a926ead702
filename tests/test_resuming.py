"""A march goes on from its checkpoint: to the same bits, or by a changed scene that says so."""

import json
import os
import random
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from stability.errors import CheckpointError, SceneError
from stability.results import open_results, save
from stability.resuming import resume
from stability.runner import run
from stability.summary import summary
from stability.timestepper import checkpoint
from tests.test_scene import GOOD, MARCH
from tests.timestepper.test_march import Killed, stopping

ROOT = Path(__file__).parent.parent
SMALL = MARCH.replace("elements = 400", "elements = 60").replace("to = 0.02, count = 5", "to = 2e-3, count = 3")


@pytest.fixture
def stopped(tmp_path, monkeypatch):
    """Write a scene and a checkpoint of its run, which stopped after step 6; return their paths."""
    scene, path = tmp_path / "small.toml", tmp_path / "small.nc.checkpoint"
    scene.write_text(SMALL)

    def stop(*_):
        class Reporting:
            __enter__ = staticmethod(lambda: stopping(6))
            __exit__ = staticmethod(lambda *_: None)

        return Reporting()

    with monkeypatch.context() as patched:
        patched.setattr("stability.progress.reporting", stop)
        with pytest.raises(Killed):
            run(scene, progress=True, checkpoint=path)
    return scene, path


def changed(tmp_path: Path, *pairs: tuple[str, str], text: str = SMALL) -> Path:
    for old, new in pairs:
        assert old in text
        text = text.replace(old, new)
    path = tmp_path / "changed.toml"
    path.write_text(text)
    return path


def test_a_run_is_resumed_by_the_scene_that_its_checkpoint_holds(stopped):
    scene, path = stopped
    assert checkpoint.load(path).state["step"] == 4
    whole = run(scene)
    scene.unlink()
    assert resume(path).identical(whole)
    assert path.exists(), "removed by whoever has saved the result"


def test_the_same_run_again_goes_on_too(stopped):
    scene, path = stopped
    assert run(scene, checkpoint=path).identical(run(scene))


def test_the_same_scene_by_name_changes_nothing(stopped):
    scene, path = stopped
    assert resume(path, scene=scene).identical(run(scene))


def test_a_changed_scene_goes_on_from_the_same_state_and_the_result_says_so(stopped, tmp_path):
    scene, path = stopped
    state = checkpoint.load(path).state
    later = changed(tmp_path, ("to = 2e-3, count = 3", "to = 3e-3, count = 4"), ("largest = 5e-4", "largest = 2e-4"))
    found = resume(path, scene=later)
    assert found.time.values.tolist() == [0, 1e-3, 2e-3, 3e-3] and found.attrs["scene_text"] == later.read_text()
    assert json.loads(found.attrs["continued"]) == [{"step": 4, "time": state["time"], "scene_text": SMALL}]
    assert f"from step 4, t = {state['time']:.6g} s of another scene" in summary(found)
    whole = run(scene)
    assert found.step_time[:4].equals(whole.step_time[:4]) and found.step_size[4:].max() <= 2e-4 * (1 + 1e-12)
    assert resume(path).identical(found), "the checkpoint is the changed scene's now"


@pytest.mark.parametrize(
    ("pair", "says"),
    [
        (("epsilon = 1e-4", "epsilon = 2e-4"), "parameters differs from that of"),
        (("elements = 60", "elements = 70"), "mesh differs from that of"),
        (("radial_hopper", "radial_hopper_compatible"), "flow differs from that of"),
        (("to = 2e-3, count = 3", "to = 2e-3, count = 401"), r"snapshots must be those of .* up to t = "),
        (("to = 2e-3, count = 3", "to = 5e-5, count = 2"), r"snapshots must be those of .* and go on beyond"),
    ],
)
def test_a_scene_of_another_flow_or_of_times_that_have_passed_is_refused(pair, says, stopped, tmp_path):
    _, path = stopped
    before = path.read_bytes()
    with pytest.raises(SceneError, match=f"^changed.toml: .*{says}"):
        resume(path, scene=changed(tmp_path, pair))
    assert path.read_bytes() == before


def test_a_map_cannot_go_on_from_a_checkpoint(stopped, tmp_path):
    _, path = stopped
    with pytest.raises(SceneError, match="a growth_map cannot go on from a checkpoint, only a march"):
        resume(path, scene=changed(tmp_path, text=GOOD))


def test_a_checkpoint_of_other_sources_is_refused_by_a_changed_scene_too(stopped, tmp_path, monkeypatch):
    _, path = stopped
    monkeypatch.setattr("stability.timestepper.march._sources", lambda: b"edited")
    with pytest.raises(CheckpointError, match="another state of the toolkit's source files"):
        resume(path, scene=changed(tmp_path, ("floor = 0.05", "floor = 0.1")))
    with pytest.raises(CheckpointError, match="another state of the toolkit's source files"):
        resume(path)


def heeding() -> None:
    """Undo what a shell does to its background jobs, such as a CI run: they are started deaf to Ctrl-C."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)


def process(folder: Path, *arguments: str) -> subprocess.Popen:
    environment = os.environ | {"PYTHONPATH": str(ROOT)}
    command = [sys.executable, "-m", "stability", *arguments, "--quiet"]
    options = {"cwd": folder, "env": environment, "stderr": subprocess.PIPE, "text": True}
    return subprocess.Popen(command, **options, preexec_fn=heeding if os.name == "posix" else None)


def killed_at_random(tmp_path: Path, kills: int, seed: int) -> set[int]:
    """Kill a run at random moments so often, let it end, and return the steps of the checkpoints that kills left."""
    (tmp_path / "scene.toml").write_text(KILLED)
    run(tmp_path / "scene.toml")  # generated modules are made once, and not by the processes that are killed
    start = time.monotonic()
    save(run(tmp_path / "scene.toml"), tmp_path / "whole.nc")
    taken = time.monotonic() - start
    kept, left, rng = tmp_path / "out.nc.checkpoint", set(), random.Random(seed)
    while True:
        # `resume` and the same `run` again are two ways to go on.
        again = kept.exists() and rng.random() < 0.5
        before = stamp(kept)
        with process(tmp_path, *(["resume", kept.name] if again else ["run", "scene.toml", "-o", "out.nc"])) as running:
            if kills and rng.random() < 0.8:  # else while it starts
                while running.poll() is None and stamp(kept) == before:
                    time.sleep(0.002)
            try:
                status = running.wait(rng.uniform(0, taken) if kills else None)
            except subprocess.TimeoutExpired:
                running.send_signal(signal.SIGKILL)
                running.wait()
                kills -= 1
                left.add(checkpoint.load(kept).state["step"] if kept.exists() else -1)
                continue
        assert status == 0, running.stderr.read()
        assert_ended(tmp_path)
        if not kills:
            return left


def stamp(path: Path) -> int:
    """Return when a file was changed, 0 where there is none."""
    return path.stat().st_mtime_ns if path.exists() else 0


def assert_ended(folder: Path) -> None:
    """Check that the result is that of the run that was left alone, and that nothing else is left of the run."""
    assert (folder / "out.nc").read_bytes() == (folder / "whole.nc").read_bytes()
    assert open_results(folder / "out.nc").sizes["step"] > 20
    assert sorted(p.name for p in folder.iterdir()) == ["out.nc", "scene.toml", "whole.nc"]
    (folder / "out.nc").unlink()


KILLED = MARCH.replace("to = 0.02", "to = 0.01").replace("checkpoint_every = 4", "checkpoint_every = 2")


@pytest.mark.skipif(sys.platform == "win32", reason="no SIGKILL to send")
def test_a_run_killed_at_three_random_moments_ends_with_the_same_bits(tmp_path):
    killed_at_random(tmp_path, 3, seed=1)


@pytest.mark.slow
@pytest.mark.skipif(sys.platform == "win32", reason="no SIGKILL to send")
def test_a_run_killed_at_twenty_five_random_moments_ends_with_the_same_bits(tmp_path):
    assert len(killed_at_random(tmp_path, 25, seed=2)) >= 5


@pytest.mark.skipif(sys.platform == "win32", reason="no SIGINT to send")
def test_an_interrupt_at_the_shell_says_what_is_kept_and_the_run_goes_on(tmp_path):
    (tmp_path / "short.toml").write_text(KILLED)
    run(tmp_path / "short.toml")  # generated modules are made once
    (tmp_path / "short.toml").unlink()
    (tmp_path / "scene.toml").write_text(KILLED.replace("to = 0.01", "to = 0.1"))  # seconds of work, whatever machine
    with process(tmp_path, "run", "scene.toml") as running:
        while not (tmp_path / "scene.nc.checkpoint").exists():
            time.sleep(0.01)
        running.send_signal(signal.SIGINT)
        said = running.stderr.read()
    assert running.returncode == 130, said
    assert said.splitlines()[-1].startswith("error: interrupted at step ")
    assert said.endswith("go on with stability resume scene.nc.checkpoint\n")
    with process(tmp_path, "resume", "scene.nc.checkpoint") as running:
        assert running.wait() == 0, running.stderr.read()
    assert sorted(p.name for p in tmp_path.iterdir()) == ["scene.nc", "scene.toml"]
