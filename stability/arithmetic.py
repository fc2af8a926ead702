"""The arithmetics that generated expressions run in: one namespace each, so that one text serves them all."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np


@dataclass(frozen=True)
class Arithmetic:
    """Numbers and elementary functions.

    ``number`` reads a decimal or a float, ``rational(p, q)`` is p/q, and ``direction(degrees, arithmetic)`` returns
    cosine and sine; ``centre`` is the nearest float and ``size`` an upper bound of the modulus, as floats; ``unit``
    is the ball [-1, 1].
    """

    name: str
    number: Callable
    complex: Callable
    rational: Callable
    where: Callable
    floor: Callable
    pi: Any
    sqrt: Callable
    sin: Callable
    cos: Callable
    tan: Callable
    asin: Callable
    atan: Callable
    exp: Callable
    log: Callable
    direction: Callable
    centre: Callable = float
    size: Callable = abs
    unit: Any = None


def cosine_sine(degrees: Any, a: Arithmetic) -> tuple[Any, Any]:
    """Return cosine and sine of an angle in degrees, exact at multiples of 45 degrees.

    Radians cannot hold 45 degrees, and at a wavenumber of 1e6 /m the rounding of pi/4 would decide the growth rate of a
    wave along the velocity characteristic: the quarter turns are taken off in degrees, where they are exact.
    """
    quarters = a.floor(degrees / 90 + 0.5)
    rest = degrees - 90 * quarters
    diagonal = abs(rest) == 45
    c, s = a.cos(rest * a.pi / 180), a.sin(rest * a.pi / 180)
    half = a.sqrt(a.rational(1, 2))
    c, s = a.where(diagonal, half, c), a.where(diagonal, a.where(rest > 0, half, -half), s)
    turn = quarters - 4 * a.floor(quarters / 4)
    return (
        a.where(turn == 0, c, a.where(turn == 1, -s, a.where(turn == 2, -c, s))),
        a.where(turn == 0, s, a.where(turn == 1, c, a.where(turn == 2, -s, -c))),
    )


def _float(value: Any) -> Any:
    return np.asarray(value, dtype=float) if np.ndim(value) else float(value)


def _turned(degrees: Any, a: Arithmetic) -> tuple[Any, Any]:
    return cosine_sine(np.fmod(degrees, 360), a)  # fmod is exact, for angles of any size


NUMPY = Arithmetic(
    "float64", _float, complex, lambda p, q: p / q, np.where, np.floor, np.pi,
    np.sqrt, np.sin, np.cos, np.tan, np.arcsin, np.arctan, np.exp, np.log, _turned, np.asarray,
)  # fmt: skip


@cache
def multiprecision(digits: int) -> Arithmetic:
    """Return mpmath arithmetic with that many decimal digits, in a context of its own."""
    from mpmath import MPContext  # kept out of `import stability`

    mp = MPContext()
    mp.dps = digits

    def number(value: Any) -> Any:
        # A scene's 2e-5 means the decimal, not the nearest float: repr restores what was written.
        return mp.mpf(repr(float(value)) if isinstance(value, float) else str(value))

    return Arithmetic(
        f"mpmath, {digits} digits", number, mp.mpc, lambda p, q: mp.mpf(p) / q,
        lambda c, a, b: a if c else b, mp.floor, +mp.pi,
        mp.sqrt, mp.sin, mp.cos, mp.tan, mp.asin, mp.atan, mp.exp, mp.log, cosine_sine,
    )  # fmt: skip
