"""The toolkit's errors: each carries the evidence that a user needs to go on."""


class StabilityError(Exception):
    """Base of every error that the toolkit raises on purpose."""


class SceneError(StabilityError, ValueError):
    """Input that cannot be modelled. ``problems`` lists every fault found, one sentence each."""

    def __init__(self, *problems: str):
        self.problems = problems
        super().__init__("\n".join(problems))


class ConvergenceError(StabilityError, ArithmeticError):
    """A numerical method that did not reach its tolerance; the message says where and how far it came."""


class PrecisionError(StabilityError, ArithmeticError):
    """A number that the chosen precision cannot decide; the message says which precision would."""
