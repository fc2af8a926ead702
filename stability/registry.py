"""Visible registries whose entries are imported when they are first asked for, so that a list needs no SymPy."""

from collections.abc import Iterator, Mapping
from difflib import get_close_matches
from importlib import import_module
from pathlib import Path
from typing import Any

from stability.errors import SceneError


class Registry(Mapping):
    """``{name: "module:ATTRIBUTE"}``, read as ``{name: object}``."""

    __hash__ = object.__hash__  # by identity, as a key of caches

    def __init__(self, kind: str, places: Mapping[str, str]):
        self.kind, self.places = kind, dict(places)

    def __getitem__(self, name: str) -> Any:
        found = self.resolved(name)
        if found is not name:
            return found
        module, attribute = self.place(name).split(":")
        return getattr(import_module(module), attribute)

    def __contains__(self, name: object) -> bool:
        return name in self.places

    def __iter__(self) -> Iterator[str]:
        return iter(self.places)

    def __len__(self) -> int:
        return len(self.places)

    def __repr__(self) -> str:
        return f"{self.kind}s: {', '.join(self.places)}"

    def resolved(self, name: Any, folder: Path | None = None) -> Any:
        """Return the object that ``my_file.py:NAME`` names, which runs that file; anything else as it is.

        A relative path is taken from the folder, which it may not leave, or from the present one.
        """
        if not isinstance(name, str) or name in self.places or ".py:" not in name:
            return name
        from stability import userfile

        return userfile.entry(self.kind, name, folder)

    def place(self, name: str) -> str:
        """Return the ``module:ATTRIBUTE`` of an entry, or raise `SceneError` that names the nearest one."""
        if name in self.places:
            return self.places[name]
        near = get_close_matches(str(name), self.places, n=1)
        hint = f"; did you mean {near[0]!r}?" if near else ""
        if str(name).endswith(".py"):
            hint = f': name what the file defines too, as in "{name}:NAME"'
        raise SceneError(f"{self.kind} {name!r} is unknown{hint} (known: {', '.join(self.places)})")
