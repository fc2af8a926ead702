"""A checkpoint is whole or absent, is refused where it does not belong, and never costs the last good one."""

import errno
import json
import os
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_array_equal

from stability.errors import CheckpointError
from stability.timestepper import checkpoint
from stability.timestepper.checkpoint import load, remove, save, sweep, told

SIGNATURE = {"scene": "a" * 64, "numpy": "2.2", "sources": "b" * 64}


@dataclass(frozen=True)
class State:
    time: float
    step: int
    q: np.ndarray
    before: np.ndarray | None = None


def state(step: int = 7) -> State:
    return State(0.1 + 0.2, step, np.random.default_rng(step).normal(size=(5, 3)))


def write(path: Path, step: int = 7, **changes) -> None:
    log = {"dt": np.array([1e-5, 1 / 3]), "newton_iterations": np.array([4, 5])}
    snapshots = np.arange(30.0).reshape(2, 5, 3)
    arguments = {"signature": SIGNATURE, "state": state(step), "snapshots": snapshots, "log": log}
    save(path, **arguments | {"scene_text": "title = 'é'\n"} | changes)


@pytest.fixture
def path(tmp_path) -> Path:
    return tmp_path / "run.nc.checkpoint"


def test_what_is_saved_is_loaded_to_the_last_bit(path):
    part = {"step": 3, "time": 0.1, "scene_text": "old"}
    write(path, continued=(part,))
    found = load(path, SIGNATURE)
    assert (found.state["time"], found.state["step"], found.state["before"]) == (0.1 + 0.2, 7, None)
    assert_array_equal(found.state["q"], state().q)
    assert_array_equal(found.snapshots, np.arange(30.0).reshape(2, 5, 3))
    assert found.log["dt"].tolist() == [1e-5, 1 / 3] and found.log["newton_iterations"].tolist() == [4, 5]
    assert found.scene_text == "title = 'é'\n" and found.signature == SIGNATURE and found.continued == (part,)
    assert told(found) == "step 7, t = 0.3 s"


def test_numbers_of_numpy_and_empty_arrays_are_kept(path):
    write(path, state=State(np.float64(0.5), np.int64(2), np.zeros((0, 3))), snapshots=np.zeros((0, 5, 3)))
    found = load(path)
    assert (found.state["time"], found.state["step"]) == (0.5, 2)
    assert found.state["q"].shape == (0, 3) and found.snapshots.shape == (0, 5, 3)


def test_the_file_is_text_and_numbers_and_others_may_read_nothing_into_it(path):
    write(path)
    first, second, _ = path.read_bytes().split(b"\n", 2)
    assert first.startswith(b"granular-stability-checkpoint-1 ")
    assert json.loads(second)["arrays"]["state.q"] == ["<f8", [5, 3]]
    body = path.read_bytes().partition(b"\n")[2].replace(b'"<f8"', b'"|O8"', 1)  # objects: what a pickle would be for
    path.write_bytes(checkpoint.sealed(body))
    with pytest.raises(CheckpointError, match="holds numbers, not"):
        load(path)


def test_every_truncated_file_is_refused(path):
    write(path)
    whole = path.read_bytes()
    for length in range(0, len(whole), 7):
        path.write_bytes(whole[:length])
        with pytest.raises(CheckpointError, match=r"run\.nc\.checkpoint is truncated \("):
            load(path)


def test_a_flipped_bit_anywhere_is_found(path):
    write(path)
    whole = path.read_bytes()
    for place in range(0, len(whole), 11):
        path.write_bytes(whole[:place] + bytes([whole[place] ^ 1]) + whole[place + 1 :])
        with pytest.raises(CheckpointError):
            load(path)


@pytest.mark.parametrize("content", [b"CDF\x01 some netCDF", b"PK\x03\x04 a zip", b"title = 'a scene'\n", b"\x80\x04."])
def test_a_foreign_file_is_named_as_such(content, path):
    path.write_bytes(content)
    with pytest.raises(CheckpointError, match="is not a checkpoint of this toolkit's present format"):
        load(path)


def test_a_missing_file_is_named(path):
    with pytest.raises(CheckpointError, match=r"cannot be read: No such file"):
        load(path)


@pytest.mark.parametrize(
    ("changes", "says"),
    [
        ({"scene": "c" * 64}, "belongs to another scene"),
        ({"scene": "c" * 64, "numpy": "2.3"}, "belongs to another scene"),
        ({"numpy": "2.3"}, "was written by numpy 2.2 (here 2.3): continue it with that"),
        ({"sources": "c" * 64}, "was written by another state of the toolkit's source files"),
        ({"scipy": "1.15"}, "was written by scipy None (here 1.15)"),
    ],
)
def test_another_scene_and_another_version_are_told_apart(changes, says, path):
    write(path)
    before = path.read_bytes()
    with pytest.raises(CheckpointError) as caught:
        load(path, SIGNATURE | changes)
    assert says in str(caught.value) and "\n" not in str(caught.value)
    assert path.read_bytes() == before


@pytest.mark.parametrize("call", ["fsync", "replace"])
@pytest.mark.parametrize("fault", [errno.ENOSPC, errno.EIO])
def test_a_failing_disk_keeps_the_last_good_checkpoint(call, fault, path, monkeypatch):
    write(path, step=3)
    before = path.read_bytes()

    def fails(*_):
        raise OSError(fault, os.strerror(fault))

    monkeypatch.setattr(checkpoint.os, call, fails)
    with pytest.raises(CheckpointError) as caught:
        write(path, step=4)
    assert "the one of step 3, t = 0.3 s is kept" in str(caught.value)
    if fault == errno.ENOSPC:
        for phrase in ("no space is left", "bytes are needed", "are free", f"make room, then stability resume {path}"):
            assert phrase in str(caught.value)
    assert path.read_bytes() == before and os.listdir(path.parent) == [path.name]


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="no device that is always full")
def test_a_device_that_is_full_is_an_error_and_no_half_file(path, monkeypatch):
    opened = os.open("/dev/full", os.O_WRONLY)
    (path.parent / "x.tmp").touch()
    monkeypatch.setattr(checkpoint.tempfile, "mkstemp", lambda **_: (opened, str(path.parent / "x.tmp")))
    with pytest.raises(CheckpointError, match="no space is left, .*; there is no earlier one: make room"):
        write(path)
    assert not os.listdir(path.parent)


def test_a_folder_that_is_missing_is_told(tmp_path):
    with pytest.raises(CheckpointError, match="cannot be written: No such file or directory; there is no earlier one"):
        write(tmp_path / "nowhere" / "run.checkpoint")


def test_an_interrupt_while_writing_leaves_the_old_file_alone(path, monkeypatch):
    write(path, step=3)
    before = path.read_bytes()

    def interrupted(_):
        raise KeyboardInterrupt

    monkeypatch.setattr(checkpoint.os, "fsync", interrupted)
    with pytest.raises(KeyboardInterrupt):
        write(path, step=4)
    assert path.read_bytes() == before and os.listdir(path.parent) == [path.name]


def test_content_and_name_are_brought_to_the_disk_in_that_order(path, monkeypatch):
    done = []
    fsync, replace = os.fsync, os.replace
    monkeypatch.setattr(checkpoint.os, "fsync", lambda f: (done.append("fsync"), fsync(f)))
    monkeypatch.setattr(checkpoint.os, "replace", lambda a, b: (done.append("rename"), replace(a, b)))
    write(path)
    assert done == (["fsync", "rename", "fsync"] if os.name == "posix" else ["fsync", "rename"])


def test_leftovers_of_killed_runs_are_swept_and_nothing_else(tmp_path):
    path = tmp_path / "a[1].nc.checkpoint"
    write(path)
    for name in ("a[1].nc.checkpoint.x7.tmp", "a1.nc.checkpoint.x7.tmp", "a[1].nc.checkpoint.bak", "other.tmp"):
        (tmp_path / name).touch()
    sweep(path)
    others = ["a1.nc.checkpoint.x7.tmp", "a[1].nc.checkpoint.bak", "other.tmp"]
    assert sorted(os.listdir(tmp_path)) == sorted([path.name, *others])
    remove(path)
    remove(path)
    assert sorted(os.listdir(tmp_path)) == sorted(others)
