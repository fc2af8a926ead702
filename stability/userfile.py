"""A closure or a flow in a file of the user's own, named as ``my_file.py:NAME``.

This is the one place where a file that a user names is run, and that form of name the only one that runs it. The file
is run as a script would be, with all that a script may do: so name only files whose text you trust.
"""

import logging
import re
import sys
import traceback
from functools import cache
from hashlib import sha256
from importlib import import_module
from pathlib import Path
from types import ModuleType
from typing import Any

from stability.errors import SceneError

FORM = re.compile(r"(.*\.py):([^:/\\]*)", re.DOTALL)
CLASSES = {"closure": "stability.closures.base:Closure", "flow": "stability.flows.base:Flow"}
PARAMETER = "Parameter.__init__()"
SHAPE = "a Parameter is (word, symbol, unit, low, high, meaning, source), with an open range from low to high"

log = logging.getLogger(__name__)


def names_file(word: str) -> bool:
    """Return whether a name is that of something in a file."""
    return FORM.fullmatch(word) is not None


def entry(kind: str, word: str, folder: Path | None = None) -> Any:
    """Return the `Closure` or the `Flow` of ``my_file.py:NAME``; the file is run, once for each text that it has had.

    Parameters
    ----------
    kind : "closure" or "flow"
    word : the name, with a path relative to the folder, or an absolute one
    folder : that of the scene that names it, which a relative path may not leave; None for the present folder

    Raises
    ------
    SceneError : one sentence, where the file cannot be read or run, or holds no such closure or flow
    """
    where = f'{kind} = "{word}"'
    file, name = FORM.fullmatch(word).groups()  # type: ignore[union-attr]
    path = (folder or Path()) / file
    if folder and not Path(file).is_absolute() and not path.resolve().is_relative_to(folder.resolve()):
        raise SceneError(
            f"{where} lies outside the scene's folder: a scene may run files in its folder or below it, or name an "
            "absolute path"
        )
    try:
        text = path.read_text(encoding="utf-8")
    except OSError as error:
        raise SceneError(f"{where}: {error.strerror}: {path.absolute()}") from None
    except UnicodeDecodeError as error:
        raise SceneError(f"{where}: {path.name} is not UTF-8 text (byte {error.start})") from None
    try:
        found = vars(run(path.resolve(), text))
    except RunError as failure:
        raise SceneError(f"{where}: {failure}") from failure.__cause__
    module, attribute = CLASSES[kind].split(":")
    wanted = getattr(import_module(module), attribute)
    if isinstance(found.get(name), wanted):
        return found[name]
    there = [word for word, value in found.items() if isinstance(value, wanted) and not word.startswith("_")]
    known = f"{path.name} defines {', '.join(there)}" if there else f"{path.name} defines no {attribute}"
    if name in found:
        raise SceneError(f"{where}: {name} is of type {type(found[name]).__name__}, not a {attribute} ({known})")
    lacking = f"{path.name} has no {name}" if name else "the name after the colon is missing"
    raise SceneError(f"{where}: {lacking} ({known})")


class RunError(Exception):
    """A file that cannot be run; the message says where and why."""


@cache
def run(path: Path, text: str) -> ModuleType:
    """Return the module that a text makes."""
    log.info("executes %s", path)
    module = ModuleType(f"_named_{sha256(f'{path}{text}'.encode()).hexdigest()[:16]}")
    module.__file__ = str(path)
    sys.modules[module.__name__] = module  # where dataclasses look for themselves
    try:
        exec(compile(text, str(path), "exec", dont_inherit=True), vars(module))  # noqa: S102
    except (Exception, SystemExit) as error:
        del sys.modules[module.__name__]
        raise RunError(_told(path, error)) from error
    return module


def _told(path: Path, error: BaseException) -> str:
    """Return the place in the file and what is wrong there."""
    if isinstance(error, SyntaxError) and error.filename == str(path):
        return f"{path.name} line {error.lineno}: this is not Python: {error.msg}"
    frames = traceback.extract_tb(error.__traceback__)
    line = next((f.lineno for f in reversed(frames) if f.filename == str(path)), None)
    at = f"{path.name} line {line}" if line else path.name
    if isinstance(error, TypeError) and PARAMETER in str(error):
        return f"{at}: {str(error).removeprefix(PARAMETER).strip()}: {SHAPE}"
    if type(error) is ValueError or isinstance(error, SceneError):  # sentences, those of `Closure` and `Parameter` too
        return f"{at}: {error}"
    return f"{at}: {type(error).__name__}: {error}"
