"""The toolkit's errors: each carries the evidence that a user needs to go on."""

from collections.abc import Sequence
from typing import Any


class StabilityError(Exception):
    """Base of every error that the toolkit raises on purpose."""


class SceneError(StabilityError, ValueError):
    """Input that cannot be modelled. ``problems`` lists every fault found, one sentence each."""

    def __init__(self, *problems: str):
        self.problems = problems
        super().__init__("\n".join(problems))


class ConvergenceError(StabilityError, ArithmeticError):
    """A numerical method that did not reach its tolerance; the message says where and how far it came.

    ``state`` is the last good one, from which a run can go on, and ``history`` the residuals of the step that failed.
    """

    def __init__(self, message: str, state: Any = None, history: Sequence = ()):
        self.state, self.history = state, history
        super().__init__(message)


class PrecisionError(StabilityError, ArithmeticError):
    """A number that the chosen precision cannot decide; the message says which precision would."""


class CheckpointError(StabilityError):
    """A checkpoint that cannot be written or continued; the message says why, and which one is kept."""


class Interrupted(KeyboardInterrupt):
    """A run that was stopped from outside; the message says what is kept and how to go on."""
