"""Checkpoints: one file that is whole or absent, holds numbers and text only, and knows which run it belongs to.

    line 1    the magic word, the SHA-256 of all that follows line 1, and its length in bytes
    line 2    JSON: scene, signature, the state's numbers, name, type and shape of each array
    the rest  the arrays' bytes, in that order

A file is written under another name, brought to the disk, and renamed: whatever stops the machine, the name stands for
the last good checkpoint. Rejected: pickle, which runs code when it is read; npz, whose checksums cover the arrays one
by one and not the numbers beside them.
"""

import errno
import hashlib
import json
import os
import shutil
import tempfile
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any

import numpy as np

from stability.errors import CheckpointError

MAGIC = b"granular-stability-checkpoint-1"
KINDS = "biuf"  # of arrays: numbers alone
FULL = (errno.ENOSPC, errno.EDQUOT)


@dataclass(frozen=True)
class Checkpoint:
    """What a file holds.

    Attributes
    ----------
    scene_text : the scene that is run
    signature : parts of what decides the numbers, each a name and a value
    state : fields of the integrator's state by name
    snapshots : (snapshots, nodes, fields), those that have been passed
    log : the step log, one array for each column
    continued : where the run was taken from one scene to another
    """

    scene_text: str
    signature: dict[str, str]
    state: dict[str, Any]
    snapshots: np.ndarray
    log: dict[str, np.ndarray]
    continued: tuple = ()


def save(
    path: str | Path,
    signature: Mapping[str, str],
    state: Any,
    snapshots: np.ndarray,
    log: Mapping[str, np.ndarray],
    scene_text: str,
    continued: Sequence[Mapping] = (),
) -> None:
    """Write a checkpoint, whole or not at all.

    Parameters
    ----------
    signature : names and values of what decides the numbers; `load` compares them
    state : a dataclass of numbers, arrays and None with a ``step`` and a ``time`` (s)
    snapshots : (snapshots, nodes, fields)
    log : columns of the step log
    scene_text : the scene
    continued : where the run was taken from one scene to another: step, time and the former scene's text of each

    Raises
    ------
    CheckpointError : the file cannot be written; the previous one is kept
    """
    path = Path(path)
    values = {f.name: plain(getattr(state, f.name)) for f in fields(state)}
    arrays = {f"state.{name}": value for name, value in values.items() if isinstance(value, np.ndarray)}
    arrays |= {"snapshots": snapshots} | {f"log.{name}": column for name, column in log.items()}
    packed = {name: np.ascontiguousarray(array) for name, array in arrays.items()}
    head = {
        "scene_text": scene_text,
        "signature": dict(signature),
        "continued": list(continued),
        "state": {name: value for name, value in values.items() if not isinstance(value, np.ndarray)},
        "arrays": {name: [array.dtype.str, array.shape] for name, array in packed.items()},
    }
    content = sealed(b"".join([json.dumps(head).encode(), b"\n", *(array.tobytes() for array in packed.values())]))
    try:
        _replace(path, content)
    except OSError as error:
        raise CheckpointError(_unwritten(path, error, len(content))) from None


def sealed(body: bytes) -> bytes:
    """Return a file's content: a line that proves what follows, then the body."""
    return b"%s %s %d\n%s" % (MAGIC, hashlib.sha256(body).hexdigest().encode(), len(body), body)


def plain(value: Any) -> Any:
    """Return a number of NumPy as one of Python."""
    return value.item() if isinstance(value, np.generic) else value


def _replace(path: Path, content: bytes) -> None:
    """Write a file beside the old one, bring it to the disk, and put it in the old one's place."""
    handle, temporary = tempfile.mkstemp(dir=path.parent, prefix=f"{path.name}.", suffix=".tmp")
    try:
        with os.fdopen(handle, "wb") as file:
            file.write(content)
            file.flush()
            os.fsync(file.fileno())
        os.replace(temporary, path)
    except BaseException:
        Path(temporary).unlink(missing_ok=True)
        raise
    if os.name == "posix":  # elsewhere a folder cannot be opened, and the rename is left to the file system
        folder = os.open(path.parent, os.O_RDONLY)
        try:
            os.fsync(folder)  # the new name
        finally:
            os.close(folder)


def _unwritten(path: Path, error: OSError, size: int) -> str:
    """Return the sentence about a checkpoint that could not be written."""
    try:
        kept = f"the one of {told(load(path))} is kept"
    except CheckpointError:
        kept = "there is no earlier one"
    if error.errno not in FULL:
        return f"checkpoint {path} cannot be written: {error.strerror or error}; {kept}"
    free = shutil.disk_usage(path.parent).free
    return (
        f"checkpoint {path} cannot be written: no space is left, {size} bytes are needed and {free} are free; {kept}: "
        f"make room, then stability resume {path}"
    )


def told(found: Checkpoint) -> str:
    """Return step and time of a checkpoint."""
    return f"step {found.state['step']}, t = {found.state['time']:.6g} s"


def load(path: str | Path, signature: Mapping[str, str] | None = None) -> Checkpoint:
    """Return a checkpoint.

    Parameters
    ----------
    signature : None, or what must have decided the numbers in the file

    Raises
    ------
    CheckpointError : the file cannot be read, is none of ours, truncated or altered, or belongs to another scene or
        another version
    """
    path = Path(path)
    try:
        content = path.read_bytes()
    except OSError as error:
        raise CheckpointError(f"checkpoint {path} cannot be read: {error.strerror}") from None
    line, _, body = content.partition(b"\n")
    magic, *rest = line.split(b" ")
    if magic != MAGIC[: len(magic)]:
        raise CheckpointError(f"{path} is not a checkpoint of this toolkit's present format: name another file")
    if len(rest) != 2 or not rest[1].isdigit() or len(body) < int(rest[1]):
        wanted = f"{len(body)} of {int(rest[1])} bytes are there" if len(rest) == 2 and rest[1].isdigit() else "no size"
        raise CheckpointError(f"checkpoint {path} is truncated ({wanted}): run the scene again, or use another copy")
    if hashlib.sha256(body).hexdigest().encode() != rest[0]:
        raise CheckpointError(f"checkpoint {path} has been altered: its checksum is wrong; use another copy")
    found = _unpacked(body)
    if signature is not None and found.signature != dict(signature):
        raise CheckpointError(f"checkpoint {path} {_difference(found.signature, signature)}")
    return found


def _unpacked(body: bytes) -> Checkpoint:
    text, _, rest = body.partition(b"\n")
    head, offset, arrays = json.loads(text), 0, {}
    for name, (kind, shape) in head["arrays"].items():
        dtype = np.dtype(kind)
        if dtype.kind not in KINDS:
            raise CheckpointError(f"a checkpoint holds numbers, not {kind}")
        count = int(np.prod(shape, dtype=int))
        arrays[name] = np.frombuffer(rest, dtype, count, offset).reshape(shape).copy()
        offset += count * dtype.itemsize
    groups: dict[str, dict] = {"state": head["state"], "log": {}}
    for name, array in arrays.items():
        group, _, word = name.partition(".")
        if word:
            groups[group][word] = array
    shared = {name: head[name] for name in ("scene_text", "signature")}
    return Checkpoint(
        **shared,
        state=groups["state"],
        snapshots=arrays["snapshots"],
        log=groups["log"],
        continued=tuple(head["continued"]),
    )


def _difference(held: Mapping[str, str], wanted: Mapping[str, str]) -> str:
    """Return the end of the sentence that says why two signatures differ."""
    if held.get("scene") != wanted.get("scene"):
        return "belongs to another scene: stability resume continues it; to run this scene, remove it or choose another"
    parts = [part for part in {**wanted, **held} if held.get(part) != wanted.get(part)]
    versions = [f"{p} {held.get(p)} (here {wanted.get(p)})" for p in parts if len(held.get(p, "")) < 64]
    by = ", ".join(versions) or "another state of the toolkit's source files"
    return f"was written by {by}: continue it with that, or run the scene again"


def sweep(path: str | Path) -> None:
    """Remove what killed runs left of unfinished checkpoints of this name. No other run may be using it."""
    path = Path(path)
    for stale in path.parent.glob(f"{_literal(path.name)}.*.tmp"):
        stale.unlink(missing_ok=True)


def _literal(name: str) -> str:
    """Return a glob pattern for a name."""
    return "".join(f"[{c}]" if c in "*?[" else c for c in name)


def remove(path: str | Path) -> None:
    """Remove a checkpoint that is no longer needed, and what is left of unfinished ones."""
    Path(path).unlink(missing_ok=True)
    sweep(path)
