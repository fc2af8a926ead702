"""For which of the values between two ends a property holds: a scan, and bisection where it comes and goes."""

from collections.abc import Callable
from math import ceil, log10, sqrt

import numpy as np

SPACING, LEAST, MOST = 2, 13, 61  # values tried in a decade; from end to end


def scanned(holds: Callable[[float], bool], low: float, high: float) -> tuple[list[float], list[tuple[int, int]]]:
    """Return the values tried, equally far apart in the logarithm, and the first and last index of each run that holds.

    Where the property changes twice between neighbours, that is not seen.
    """
    count = min(max(1 + ceil(SPACING * log10(high / low)), LEAST), MOST)
    values = [float(v) for v in np.geomspace(low, high, count)]
    runs: list[tuple[int, int]] = []
    for i, value in enumerate(values):
        if not holds(value):
            continue
        if runs and runs[-1][1] == i - 1:
            runs[-1] = runs[-1][0], i
        else:
            runs.append((i, i))
    return values, runs


def halved(holds: Callable[[float], bool], good: float, bad: float, rtol: float) -> tuple[float, float]:
    """Return (good, bad) brought together to rtol by bisection in the logarithm; either may be the larger one."""
    while abs(good - bad) > rtol * min(good, bad):
        middle = sqrt(good) * sqrt(bad)
        if not min(good, bad) < middle < max(good, bad):
            break
        good, bad = (middle, bad) if holds(middle) else (good, middle)
    return good, bad


def apart(holds: Callable[[float], bool], good: float, bad: float, rtol: float) -> tuple[float, float] | None:
    """Return (good, bad) moved away from each other until a stricter judge agrees with both, or None.

    Each step is twice as long as the one before, the first rtol; None where the judge differs farther off.
    """
    up = 1 if good > bad else -1
    found = []
    for value, wanted, way in ((good, True, up), (bad, False, -up)):
        step = rtol
        while holds(value) is not wanted:
            value, step = value * (1 + way * step), 2 * step
            if step > 0.5:
                return None
        found.append(value)
    return found[0], found[1]
