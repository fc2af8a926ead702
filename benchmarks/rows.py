"""Groups of measured rows: what the modules that measure hand to the report."""

from collections.abc import Mapping
from dataclasses import dataclass, field

from benchmarks.timing import Ratio, Timings, median, ratio


@dataclass(frozen=True)
class Limit:
    """A target: a bound from above, or from below where ``at_least``."""

    value: float
    at_least: bool = False

    def met(self, measured: float) -> bool:
        """Return whether a measured value keeps the bound."""
        return measured >= self.value if self.at_least else measured <= self.value

    def __str__(self) -> str:
        return f"{'≥' if self.at_least else '≤'} {self.value:g}"


@dataclass(frozen=True)
class Row:
    """One line of a table. ``measured`` is a ratio of times, or a plain number."""

    variant: str
    time: float | None = None
    error: float | None = None
    measured: Ratio | float | None = None
    limit: Limit | None = None
    note: str = ""

    @property
    def value(self) -> float | None:
        """The number that a target is about."""
        return self.measured.median if isinstance(self.measured, Ratio) else self.measured

    @property
    def met(self) -> bool | None:
        """Whether the target is met; None where there is none."""
        return None if self.limit is None or self.value is None else self.limit.met(self.value)


@dataclass
class Group:
    """A table: what was asked, in which unit of time (and how many of them make a second), its rows and notes."""

    name: str
    text: str
    unit: str = "ns/sample"
    per_second: float = 1e9
    rows: list[Row] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)


def timed(
    timings: Timings,
    baseline: str,
    errors: Mapping[str, float] | None = None,
    limits: Mapping[tuple[str, str], Limit] | None = None,
) -> list[Row]:
    """Return a row per variant as a ratio to the baseline, then a row per target against another variant."""
    errors, limits = errors or {}, limits or {}
    rows = [
        Row(n, median(timings, n), errors.get(n), ratio(timings, n, baseline), limits.get((n, baseline)))
        for n in timings
    ]
    for (one, other), limit in limits.items():
        if other != baseline and one in timings and other in timings:
            rows.append(Row(f"{one}, over {other}", measured=ratio(timings, one, other), limit=limit))
    return rows
