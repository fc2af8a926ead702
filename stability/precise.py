"""The same generated expressions in mpmath, to any number of digits.

Inputs are taken as the decimals that they print as: 2e-5 is 2/100000 here, not the nearest float64.
"""

from typing import Any

import numpy as np

from stability import spectrum
from stability.arithmetic import Arithmetic, multiprecision
from stability.errors import SceneError
from stability.model import Model, check_waves

# Beyond the digits asked for: nearly double eigenvalues halve the digits, and q up to 1e12 beside epsilon down to
# 1e-12 spreads the terms of Det D over some forty orders of magnitude.
GUARD_DIGITS = 60


def eigenvalues(
    closure: Any, flow: Any, parameters: dict, point: dict, wavenumber: Any, wave_angle: Any, matrix: str, digits: int
) -> np.ndarray:
    """Return `stability.eigenvalues` as an object array of mpmath numbers with the given number of digits."""
    if isinstance(digits, bool) or not isinstance(digits, int) or not 1 <= digits <= 10_000:
        raise SceneError(f"digits = {digits!r} lies outside [1, 10000]: it is the number of decimal digits")
    waves = np.broadcast(np.asarray(wavenumber, object), np.asarray(wave_angle, object))
    check_waves(np.asarray(wavenumber, float), np.asarray(wave_angle, float))
    guarded = multiprecision(digits + GUARD_DIGITS)
    base = Model(closure, flow, guarded).base(parameters, point)
    rows = [_of_wave(base, guarded.number(q), guarded.number(angle), matrix, guarded) for q, angle in waves]
    found = np.empty((*waves.shape, len(rows[0])), dtype=object)
    target = multiprecision(digits)
    for index, row in zip(np.ndindex(waves.shape), rows, strict=True):
        for i, value in enumerate(row):
            found[(*index, i)] = target.complex(value)
    return found


def _of_wave(base: Any, wavenumber: Any, wave_angle: Any, matrix: str, guarded: Arithmetic) -> tuple:
    found = base.form(wave_angle, matrix).eigenvalues(wavenumber)
    return spectrum.leading_first(found[0], found[1], guarded) if len(found) == 2 else found
