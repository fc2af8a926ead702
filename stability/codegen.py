"""Closure or flow -> a module of plain functions, cached on disk: the one door out of SymPy.

Stage 1  `emit.source`: expressions -> Python text; common subexpressions shared, integer powers as products
Stage 2  `load`: text -> namespace, through a cache file whose signature and checksum are verified; a stale,
         corrupt or half-written file is rebuilt, never trusted
Stage 3  ``namespace["build"](arithmetic)``: the same text in any `arithmetic.Arithmetic`

A warm cache needs no SymPy: the signature of a registered entry is the text of every module that its expressions come
from, and the versions. That of an object, or of ``my_file.py:NAME``, has the object's own expressions in place of its
module: equal definitions are derived once, wherever they stand.
"""

import hashlib
import os
import re
import sys
import tempfile
from collections.abc import Mapping
from dataclasses import fields
from functools import cache
from importlib import import_module
from importlib.metadata import version
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from stability.errors import SceneError, StabilityError
from stability.registry import Registry

# Modules, and packages with all that is in them, whose text decides what is generated, beside the entry's own module.
PIPELINE = (
    "arithmetic closures codegen emit errors flows linearise parameters pointwise records registry structure symbols "
    "tangent"
).split()
# The modules that generate: for the linear theory, for the time-stepper, and names and ranges alone (milliseconds).
THEORY, POINTWISE, RECORDS = "emit", "pointwise", "records"


def cache_folder() -> Path:
    """Return the folder of generated modules: $STABILITY_CACHE, or the user's cache folder."""
    if chosen := os.environ.get("STABILITY_CACHE"):
        return Path(chosen)
    return Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "granular-stability"


def sources(place: str | None) -> list[Path]:
    """Return the files that decide the module generated for ``module:ATTRIBUTE``, or for any object."""
    here = Path(__file__).parent
    found = {path for name in PIPELINE for path in ((here / name).rglob("*.py") if (here / name).is_dir() else ())}
    found |= {here / f"{name}.py" for name in PIPELINE if not (here / name).is_dir()}
    own = {Path(str(getattr(find_spec(place.split(":")[0]), "origin", None)))} if place else set()
    return sorted(found | own)


@cache
def signature(entry: Any) -> str:
    """Return the hash of everything that decides the module generated for ``module:ATTRIBUTE``, or for an object.

    Only for an object, whose expressions are written out, is SymPy imported.
    """
    place = entry if isinstance(entry, str) else None
    digest = hashlib.sha256(f"{place}\0{sys.version_info[:2]}\0sympy {version('sympy')}".encode())
    for path in sources(place):
        digest.update(path.read_bytes())
    if place is None:
        digest.update(written(entry).encode())
    return digest.hexdigest()


def written(entry: Any) -> str:
    """Return the text of a `Closure` or a `Flow`, which equal definitions share."""
    from sympy import srepr

    values = {f.name: getattr(entry, f.name) for f in fields(entry)}
    return "\n".join(f"{n} = {srepr(dict(v) if isinstance(v, Mapping) else v)}" for n, v in values.items())


def sealed(source: str, key: str) -> str:
    """Return the text of a cache file: two lines that prove what follows, then the source."""
    return f"# signature {key}\n# checksum {hashlib.sha256(source.encode()).hexdigest()}\n{source}"


def opened(text: str, key: str) -> str | None:
    """Return the source in a cache file, or None if it is stale, truncated or altered."""
    source = text.split("\n", 2)[-1]
    return source if text == sealed(source, key) else None


def _umask() -> int:
    mask = os.umask(0)
    os.umask(mask)
    return mask


def write_atomically(path: Path, content: bytes | memoryview) -> None:
    """Write a file so that a reader, or a second writer, only ever sees a whole one."""
    path.parent.mkdir(parents=True, exist_ok=True)
    handle, temporary = tempfile.mkstemp(dir=path.parent, prefix=path.name, suffix=".tmp")
    try:
        with os.fdopen(handle, "wb") as file:
            file.write(content)
        os.chmod(temporary, 0o666 & ~_umask())  # mkstemp makes private files; others may read a result
        os.replace(temporary, path)
    except BaseException:
        Path(temporary).unlink(missing_ok=True)
        raise


def generate(entry: Any, what: str = THEORY) -> str:
    """Return the module text of a `Closure` or a `Flow`; imports SymPy."""
    return import_module(f"stability.{what}").source(entry)


def derived(entry: Any, what: str) -> str:
    """Return the module text of an object that is not registered, or raise `SceneError` where it cannot be derived."""
    try:
        return generate(entry, what)
    except StabilityError:
        raise
    # A user's own expressions, the only ones that come here, fail in SymPy in any of these ways; the cause is chained.
    except (ArithmeticError, AttributeError, LookupError, NotImplementedError, TypeError, ValueError) as error:
        raise SceneError(f"{entry.name} cannot be derived: {unfit(entry, error)}") from error


def unfit(entry: Any, error: Exception) -> str:
    """Return why an object cannot be derived: the sentence of an error, else that of a look at its pencil."""
    if type(error) is not ValueError and hasattr(entry, "flux"):
        try:
            import_module("stability.structure").modes(entry)
        except ValueError as known:
            error = known
    return str(error) if type(error) is ValueError else f"{type(error).__name__}: {error}"


def execute(source: str) -> dict:
    """Return the namespace of a generated module."""
    namespace: dict = {}
    exec(compile(source, "<generated by stability.codegen>", "exec"), namespace)  # noqa: S102
    return namespace


def load(registry: Registry, entry: Any, what: str = THEORY) -> dict:
    """Return the generated namespace of a registered name, of ``my_file.py:NAME``, or of an object."""
    return namespace(registry, registry.resolved(entry), what)


@cache
def namespace(registry: Registry, entry: Any, what: str) -> dict:
    """Return the generated namespace of a registered name or of an object, from the cache where it holds."""
    named = isinstance(entry, str)
    key = signature(registry.place(entry) if named else entry)
    label = re.sub(r"\W", "_", entry if named else entry.name)
    path = cache_folder() / f"{what}_{registry.kind}_{label}_{key[:16]}.py"
    try:
        source = opened(path.read_text(encoding="utf-8"), key)
    except (OSError, UnicodeDecodeError):
        source = None
    if source is None:
        source = generate(registry[entry], what) if named else derived(entry, what)
        try:
            write_atomically(path, sealed(source, key).encode())
        except OSError:
            pass  # a folder that cannot be written costs the next process a second, nothing else
    return execute(source)
