"""Parameter records, and the only door from degrees to radians."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from math import inf, isfinite, pi
from typing import Any

from stability.errors import SceneError


@dataclass(frozen=True)
class Parameter:
    """A number that a closure or a flow needs.

    Attributes
    ----------
    word : name in scenes, results and numeric code
    symbol : name of its SymPy symbol (the paper's letter)
    unit : SI unit; "deg" for angles, which become radians in `to_si` and nowhere else
    low, high : the *open* range of allowed values, in that unit
    meaning, source : what it is and where it comes from (paper label or citation)
    """

    word: str
    symbol: str
    unit: str
    low: float
    high: float
    meaning: str
    source: str

    def __post_init__(self) -> None:
        for name in ("word", "symbol", "unit", "meaning", "source"):
            if not isinstance(value := getattr(self, name), str):
                raise SceneError(
                    f"parameter {self.word}: {name} must be text, got {value!r} (of type "
                    f"{type(value).__name__}): a Parameter is (word, symbol, unit, low, high, meaning, source)"
                )
        if not (isinstance(self.low, int | float) and isinstance(self.high, int | float) and self.low < self.high):
            raise SceneError(
                f"parameter {self.word} has no range: low and high must be numbers and low < high, "
                f"got {self.low!r} and {self.high!r}"
            )

        for end in ("low", "high"):
            if type(value := getattr(self, end)) not in (int, float):  # NumPy's own are no text that code can read
                object.__setattr__(self, end, float(value))

    def problem(self, value: Any, where: str = "parameter") -> str | None:
        """Return the sentence that says what is wrong with ``value``, or None."""
        try:
            number = float(value)
        except (TypeError, ValueError):
            return f"{where} {self.word} = {value!r} is not a number: it is {self.described}"
        if isinstance(value, bool) or not isfinite(number) or not self.low < number < self.high:
            unit = f" {self.unit}" if self.unit != "1" else ""
            return f"{where} {self.word} = {value}{unit} lies outside {self.range}: it is {self.described}"
        return None

    @property
    def described(self) -> str:
        """The meaning with its source."""
        return f"the {self.meaning} ({self.source})"

    @property
    def range(self) -> str:
        """The open range in words, such as ``(0, 90) deg``."""
        unit = "" if self.unit == "1" else f" {self.unit}"
        if (self.low, self.high) == (-inf, inf):
            return "the real numbers"
        return f"({self.low:g}, {self.high:g}){unit}"


WIDEST, INSIDE = (1e-15, 1e15), 1e-12  # bracket of an open range without a bound; how far inside a bound one begins

# Shared by the closures (yield condition) and by the hopper flow (Psi_w, w): one record, one range.
FRICTION_ANGLE = Parameter("friction_angle", "varphi", "deg", 0, 90, "internal angle of friction", "paper, I2")
EPSILON = Parameter("epsilon", "epsilon", "s", 0, inf, "time scale of the singular perturbation", "paper, P1.1")


def merged(*groups: Iterable[Parameter]) -> dict[str, Parameter]:
    """Return ``{word: record}`` over several groups; a word that two groups share must be the same record."""
    records: dict[str, Parameter] = {}
    for record in (r for group in groups for r in group):
        if records.setdefault(record.word, record) != record:
            raise SceneError(f"parameter {record.word} is declared twice with different records")
    return records


def meant(word: str, records: Iterable[str], own: Iterable[str]) -> str:
    """Return the parameter that a word names: one of the records, or the one of the closure's own that contains it."""
    if word in (known := list(records)):
        return word
    near = [w for w in own if word and word in w]
    if len(near) == 1:
        return near[0]
    if near:
        raise SceneError(f"parameter {word} may be {' or '.join(near)}: say which")
    raise SceneError(f"parameter {word} is unknown here; known are {', '.join(sorted(known))}")


def bracketed(record: Parameter, bracket: tuple[float, float] | None = None) -> tuple[float, float]:
    """Return the bracket, or a parameter's range of positive values where there is none; its open ends are left out."""
    if bracket is None:
        return max(record.low * (1 + INSIDE), WIDEST[0]), min(record.high * (1 - INSIDE), WIDEST[1])
    pair = isinstance(bracket, tuple | list) and len(bracket) == 2 and all(isinstance(e, int | float) for e in bracket)
    low, high = bracket if pair else (0.0, 0.0)
    if not 0 < low < high:
        raise SceneError(f"bracket = {bracket!r}: give two increasing positive numbers")
    for end in (low, high):
        if problem := record.problem(end, "bracket"):
            raise SceneError(problem)
    return low, high


def problems(records: Mapping[str, Parameter], values: Mapping[str, Any], where: str = "parameter") -> list[str]:
    """Return one sentence for each missing, unknown or out-of-range value."""
    found = [
        f"{where} {w} is missing: it is {r.described}, in {r.range}" for w, r in records.items() if w not in values
    ]
    for word, value in values.items():
        if word not in records:
            found.append(f"{where} {word} is unknown here; known are {', '.join(sorted(records))}")
        elif problem := records[word].problem(value, where):
            found.append(problem)
    return found


def radians(degrees: Any, pi: Any = pi) -> Any:
    """Return the angle in radians; ``pi`` may come from another arithmetic."""
    return degrees * pi / 180


def to_si(records: Mapping[str, Parameter], values: Mapping[str, Any], number: Any = float, pi: Any = pi) -> dict:
    """Return ``{word: number}`` in SI units, angles in radians, or raise `SceneError` with every problem."""
    if found := problems(records, values):
        raise SceneError(*found)
    return {w: radians(number(values[w]), pi) if r.unit == "deg" else number(values[w]) for w, r in records.items()}
