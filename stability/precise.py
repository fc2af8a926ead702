"""The same generated expressions in mpmath, to any number of digits.

Inputs are taken as the decimals that they print as: 2e-5 is 2/100000 here, not the nearest float64.
"""

from typing import Any

import numpy as np

from stability import spectrum
from stability.arithmetic import Arithmetic, multiprecision
from stability.errors import PrecisionError, SceneError
from stability.model import Model, check_waves

# Beyond the digits asked for, and doubled until two runs agree: nearly double eigenvalues halve the digits, and q up to
# 1e12 beside epsilon down to 1e-12 spreads the terms of Det D over some forty orders of magnitude.
GUARD_DIGITS, MOST_DIGITS = 60, 20_000


def eigenvalues(
    closure: Any, flow: Any, parameters: dict, point: dict, wavenumber: Any, wave_angle: Any, matrix: str, digits: int
) -> np.ndarray:
    """Return `stability.eigenvalues` as an object array of mpmath numbers with the given number of digits."""
    if isinstance(digits, bool) or not isinstance(digits, int) or not 1 <= digits <= 10_000:
        raise SceneError(f"digits = {digits!r} lies outside [1, 10000]: it is the number of decimal digits")
    if arrays := [word for word, value in point.items() if np.ndim(value)]:
        raise SceneError(f"digits= takes one point: give a number instead of an array for {', '.join(arrays)}")
    grid = np.broadcast(np.asarray(wavenumber, object), np.asarray(wave_angle, object))
    waves = list(grid)
    check_waves(np.asarray(wavenumber, float), np.asarray(wave_angle, float))

    def run(guard: int) -> list:
        arithmetic = multiprecision(digits + guard)
        form = Model(closure, flow, arithmetic).base(parameters, point).form
        number = arithmetic.number
        return [leading(form(number(angle), matrix).eigenvalues(number(q)), arithmetic) for q, angle in waves]

    guard, rows = GUARD_DIGITS, run(GUARD_DIGITS)
    while True:
        guard *= 2
        if guard > MOST_DIGITS:
            raise PrecisionError(
                f"{MOST_DIGITS} guard digits do not settle {digits} digits: a parameter is too extreme"
            )
        again = run(guard)
        pairs = zip(sum(rows, ()), sum(again, ()), strict=True)
        if all(agree(one, other, digits) for one, other in pairs):
            break
        rows = again
    found = np.empty((*grid.shape, len(again[0])), dtype=object)
    target = multiprecision(digits)
    for index, row in zip(np.ndindex(grid.shape), again, strict=True):
        found[index] = [target.complex(value) for value in row]
    return found


def leading(found: tuple, arithmetic: Arithmetic) -> tuple:
    """Return the eigenvalues, the leading one first."""
    return spectrum.leading_first(found[0], found[1], arithmetic) if len(found) == 2 else found


def agree(one: Any, other: Any, digits: int) -> bool:
    """Return whether real and imaginary part agree to so many digits; an exact zero may be any rounding of one."""
    rounding = abs(other) * other.real.context.mpf(10) ** -(digits + GUARD_DIGITS // 2)
    pairs = ((one.real, other.real), (one.imag, other.imag))
    return all(abs(a - b) <= max(abs(b) * other.real.context.mpf(10) ** -digits, rounding) for a, b in pairs)
