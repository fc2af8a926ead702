"""Eigenvalues with a guaranteed growth rate: float64 where its own bound allows, balls elsewhere."""

from typing import Any

import numpy as np

from stability.balls import FIRST_BITS, LAST_BITS, enclosing
from stability.certified import Certifier, Tally
from stability.enclosures import bounded_eigenvalues, enclosed_eigenvalues, within
from stability.errors import PrecisionError


def guaranteed(
    closure: Any, flow: Any, parameters: dict, point: dict, wavenumber: Any, wave_angle: Any, matrix: str, rtol: float
) -> tuple[np.ndarray, Tally]:
    """Return eigenvalues (waves..., modes), real parts to ``rtol`` relative, and how each was reached.

    float64 with its own error bound first; where that is too large, balls of doubling precision. A real part that is
    still not separated from zero at `LAST_BITS` is returned as the centre of its enclosure and tallied as undecided.
    Waves are the given float64 numbers; parameters and point are decimals.
    """
    q, angle = np.broadcast_arrays(np.asarray(wavenumber, float), np.asarray(wave_angle, float))
    certifier, tally = Certifier(closure, flow, parameters, point, matrix), Tally()
    q, angle, shape = q.ravel(), angle.ravel(), q.shape
    with np.errstate(all="ignore"):  # what overflows has no bound, and goes to the balls
        found, error = bounded_eigenvalues(certifier.float_base.form(angle, matrix), q)
        good = np.all(within(found, error, rtol), axis=-1)
    tally.add("float64", np.count_nonzero(good))
    for i in np.flatnonzero(~good):
        bits, decided = FIRST_BITS, False
        while not decided and bits <= LAST_BITS:
            row = enclosed_eigenvalues(certifier.form(angle[i], bits), float(q[i]))
            decided = all(within(value, radius, rtol) for value, radius in row)
            name = enclosing(bits).name
            bits *= 2
        if np.isinf([value for value, _ in row]).any():
            raise PrecisionError(
                f"the eigenvalues at wavenumber {float(q[i])!r} 1/m, wave_angle {float(angle[i])!r} deg lie outside "
                f"the range of float64, {np.finfo(float).max:.3g}, for all that {LAST_BITS} bits can tell: choose "
                "another wavenumber, or ask for digits"
            )
        tally.add(name if decided else "undecided", 1)
        if not decided:
            tally.tie(angle[i], q[i], row[0])
        found[i] = [value for value, _ in row]
    return found.reshape(*shape, -1), tally
