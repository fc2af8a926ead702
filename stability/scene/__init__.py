"""A scene: the TOML file that says what is modelled, read and checked before anything runs.

All problems of a file are found at once: `messages` says where it has not the shape of `shape`, and `physics` checks
names, numbers and their combination against the records of closure and flow.
"""

import tomllib
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from stability.errors import SceneError
from stability.scene.messages import fitted
from stability.scene.physics import named, physics
from stability.scene.requests import (
    CrossCheck,
    FieldMap,
    GrowthMap,
    March,
    NeutralCurve,
    PhaseDiagram,
    SmallestCure,
    WellPosed,
)
from stability.scene.shape import Tolerance


@dataclass(frozen=True)
class Scene:
    """What is modelled.

    Attributes
    ----------
    title : one sentence for captions
    closure, flow : registered names; the `Closure` or the `Flow` itself where the file names ``my_file.py:NAME``;
        "field" where the flow is that of a file
    parameters : words to numbers, printed and assumed together, in SI units, angles in degrees
    assumed : words to reasons, for those numbers that the paper does not print
    request : what is asked; its class is that of its kind in `shape`
    tolerance : what the result must hold; `plan` decides how
    text, path : the file, so that a result can carry it
    """

    title: str
    closure: Any
    flow: Any
    parameters: dict[str, float]
    assumed: dict[str, str]
    request: GrowthMap | NeutralCurve | PhaseDiagram | WellPosed | SmallestCure | FieldMap | March | CrossCheck
    tolerance: Tolerance
    text: str
    path: Path


def load_scene(path: str | Path) -> Scene:
    """Return the scene in a TOML file; a Python file that it names as ``my_file.py:NAME`` is run, and nothing else.

    Raises
    ------
    SceneError : the file cannot be read, or something in it is wrong. ``problems`` holds a sentence for each fault: the
        file's name, the place, what stands there, what is allowed, and what it means
    """
    path = Path(path)
    return scene_of(_read(path), path)


def scene_of(text: str, path: Path, folder: Path | None = None) -> Scene:
    """Return the scene in a text; ``path`` is named in the problems of `SceneError`.

    Python files that it names are looked for in the folder, or in that of the path.
    """
    try:
        raw = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise SceneError(f"{path.name}: this is not TOML: {error}") from None
    layout, problems = fitted(raw)
    entries, strange = named(raw, folder or path.parent)
    problems += strange + physics(raw, entries, folder or path.parent)
    if layout is None or problems:
        raise SceneError(*(f"{path.name}: {problem}" for problem in problems))
    return Scene(
        title=layout.title,
        closure=entries["closure"],
        flow=entries.get("flow", layout.flow),
        parameters={word: entry.value for word, entry in (layout.parameters | layout.assumed).items()},
        assumed={word: entry.why for word, entry in layout.assumed.items()},
        request=layout.request,
        tolerance=layout.tolerance,
        text=text,
        path=path,
    )


def _read(path: Path) -> str:
    try:
        return path.read_text(encoding="utf-8")
    except OSError as error:
        raise SceneError(f"{path.name}: {error.strerror}: {path.absolute()}") from None
    except UnicodeDecodeError as error:
        raise SceneError(f"{path.name}: this is not UTF-8 text (byte {error.start}), so not TOML") from None
