"""How a statement about runs is judged: by measurements, as `measured` writes them, and how they are told."""

from collections.abc import Callable
from typing import Any

import numpy as np

from derivations.verdict import Kind, Verdict

Runs = dict[str, Any]
SIGMAS = 3  # standard errors that a difference must have


def judge(
    label: str, printed: str, evidence: str, holds: bool, right: str, where: str, slip: Kind = Kind.FAILS
) -> Verdict:
    """Return the verdict on a statement: what is right, and what refutes it, count only where it does not hold."""
    if holds:
        return Verdict(label, Kind.HOLDS, printed, "", f"measured: {evidence}")
    return Verdict(label, slip, printed, right, f"measured: {evidence}", where)


def both(runs: Runs) -> list[dict]:
    """Return the two long runs."""
    return [runs["N1"], runs["N3"]]


def named(run: dict) -> str:
    """Return how the evidence calls a run."""
    return f"ε = {power(run['epsilon'])} s on {run['elements']} elements"


def power(epsilon: float) -> str:
    """Return 2·10⁻⁵ and its like."""
    exponent = int(np.floor(np.log10(epsilon) + 1e-9))
    factor = f"{epsilon / 10.0**exponent:g}"
    raised = f"10⁻{'⁰¹²³⁴⁵⁶⁷⁸⁹'[-exponent]}"
    return raised if factor == "1" else f"{factor}·{raised}"


def per_run(runs: Runs, say: Callable[[dict], str]) -> str:
    """Return one clause for each long run."""
    return "; ".join(f"{named(run)}: {say(run)}" for run in both(runs))
