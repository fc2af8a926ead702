"""What a derivation ends in: verdicts, as data."""

from collections.abc import Iterable
from dataclasses import dataclass
from enum import Enum


class Kind(Enum):
    """The four verdicts; the value is what the word means."""

    HOLDS = "right as printed"
    HOLDS_IF = "right under the condition given"
    MISPRINT = "a local slip of the print; the right form is given"
    FAILS = "false as printed; the right statement is given"


class UnprovedError(Exception):
    """A verdict was asked for that the algebra does not support."""


@dataclass(frozen=True)
class Verdict:
    """One item of the paper, judged.

    Attributes
    ----------
    label : LaTeX label of the equation, or a few words for an item without one
    kind : the verdict
    printed : what the paper prints
    right : what is right; for HOLDS an equivalent form or nothing
    evidence : how it was decided
    counterexample : a point and the two values there, to 30 digits, where the print was refuted
    """

    label: str
    kind: Kind
    printed: str
    right: str
    evidence: str
    counterexample: str = ""


def inspected(label: str, kind: Kind, printed: str, right: str, reason: str) -> Verdict:
    """Return the verdict on a purely textual item, which nothing was computed for."""
    return Verdict(label, kind, printed, right, f"by inspection: {reason}")


def show(verdicts: Iterable[Verdict]) -> None:
    """Print verdicts as plain text."""
    for v in verdicts:
        print(f"{v.label:<28} {v.kind.name:<9} {v.right or v.printed}")
        print(f"{'':38} {v.evidence}")
        if v.counterexample:
            print(f"{'':38} {v.counterexample}")
