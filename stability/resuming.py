"""A march that goes on from a checkpoint: by the scene that the file holds, or by a changed one."""

from pathlib import Path
from typing import TYPE_CHECKING, Any

from stability.errors import SceneError
from stability.plan import marched
from stability.runner import run
from stability.scene import Scene, load_scene, scene_of
from stability.timestepper import checkpoint as checkpoints
from stability.timestepper.integrate import State

if TYPE_CHECKING:
    from xarray import Dataset


def resume(checkpoint: str | Path, progress: bool = False, scene: Scene | str | Path | None = None) -> "Dataset":
    """Return the result of a march that goes on from a checkpoint, by the scene that the file holds.

    Parameters
    ----------
    checkpoint : the file, which is left in place
    progress : whether to show on standard error how far the work is
    scene : None, or a changed scene to go on with: steps, scheme, floor, solver, tolerance and times to come may differ

    Raises
    ------
    SceneError : the changed scene asks for another flow, or for times that have passed
    CheckpointError : the file is damaged, or was written by another version
    """
    path = Path(checkpoint)
    held = checkpoints.load(path)
    scene = scene if scene is None or isinstance(scene, Scene) else load_scene(scene)
    former = scene_of(held.scene_text, path, scene.path.parent if scene else None)  # where its files of closures are
    if scene is None:
        return run(former, progress, checkpoint=path)
    if scene.text != former.text:
        _hand_over(held, former, scene, path)
    return run(scene, progress, checkpoint=path)


def _hand_over(held: checkpoints.Checkpoint, former: Any, scene: Any, path: Path) -> None:
    """Write a checkpoint anew for a changed scene."""
    if scene.request.kind != "march":
        raise SceneError(f"{scene.path.name}: a {scene.request.kind} cannot go on from a checkpoint, only a march")
    now = held.state["time"]
    old, new = marched(former), marched(scene)
    checkpoints.load(path, old.signature(held.scene_text))  # of this version
    passed = [[t for t in asked.snapshots if t <= now] for asked in (old, new)]
    found = [
        f"{scene.path.name}: {word} differs from that of {path}, so its run cannot be continued"
        for word in ("closure", "flow", "parameters", "mesh", "noise", "seed")
        if getattr(old, word) != getattr(new, word)
    ]
    if passed[0] != passed[1] or new.snapshots[-1] <= now:
        found.append(
            f"{scene.path.name}: [request] snapshots must be those of {path} up to t = {now:g} s, and go on beyond"
        )
    if found:
        raise SceneError(*found)
    part = {"step": held.state["step"], "time": now, "scene_text": held.scene_text}
    checkpoints.save(
        path,
        new.signature(scene.text),
        State(**held.state),
        held.snapshots,
        held.log,
        scene.text,
        (*held.continued, part),
    )
