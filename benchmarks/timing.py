"""Interleaved timings on one core, as ratios.

Every variant of a group runs in the same process, one after another in each round, so that whatever else the machine
does meets them all. A ratio is the median of the rounds' own ratios; the ratio of the minima stands beside it, and the
two disagree where the machine was too busy to tell.
"""

import os
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

LEAST = 5e-4  # seconds: a shorter call is repeated until one timing lasts this long (the clock's own step is 1 us)
DISAGREEMENT = 0.25  # between the two ratios, beyond which a row is marked
SLOW, SLOW_ROUNDS = 0.4, 2  # a call of more seconds than the first is timed in so many rounds only

Timings = dict[str, np.ndarray]  # seconds per call, one entry per round; NaN where a variant sat a round out


def pin() -> None:
    """Keep this process on one core, where the system has a call for that."""
    if hasattr(os, "sched_setaffinity"):
        os.sched_setaffinity(0, {max(os.sched_getaffinity(0))})  # the first core serves most interrupts


def seconds(call: Callable[[], Any], repeats: int = 1) -> float:
    """Return the process time of one call."""
    start = time.process_time()
    for _ in range(repeats):
        call()
    return (time.process_time() - start) / repeats


def interleaved(variants: Mapping[str, Callable[[], Any]], rounds: int = 7) -> Timings:
    """Return the timings of each variant; slow ones sit the later rounds out.

    Fast ones are called once before each timing: a neighbour with large arrays leaves them cold caches.
    """
    found = {name: np.full(rounds, np.nan) for name in variants}
    for i in range(rounds):
        for name, call in variants.items():
            if i > 0 and np.nanmin(found[name]) >= SLOW:
                if i < SLOW_ROUNDS:
                    found[name][i] = seconds(call)
                continue
            once = seconds(call)
            repeats = max(1, int(np.ceil(LEAST / max(once, 1e-6))))
            found[name][i] = once if once >= SLOW else seconds(call, repeats)
    return found


def per_sample(timings: Timings, samples: Mapping[str, int]) -> Timings:
    """Return timings divided by how many samples each variant evaluates."""
    return {name: found / samples[name] for name, found in timings.items()}


@dataclass(frozen=True)
class Ratio:
    """How many times as long one variant takes as another."""

    median: float
    minima: float

    @property
    def steady(self) -> bool:
        """Whether the two ways to form the ratio agree."""
        return abs(self.median - self.minima) <= DISAGREEMENT * min(self.median, self.minima)


def ratio(timings: Timings, one: str, other: str) -> Ratio:
    """Return the time of ``one`` over the time of ``other``."""
    a, b = timings[one], timings[other]
    return Ratio(float(np.nanmedian(a / b)), float(np.nanmin(a) / np.nanmin(b)))


def median(timings: Timings, name: str) -> float:
    """Return the median time of a variant, in seconds."""
    return float(np.nanmedian(timings[name]))
