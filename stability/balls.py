"""Arb balls (python-flint) and mpmath intervals as arithmetics: every result is an enclosure of the exact number.

python-flint is the extra ``certify``. Without it the same expressions run in `mpmath.iv`, some thirty times slower.
"""

from fractions import Fraction
from functools import cache
from importlib.util import find_spec
from math import inf, isfinite, nextafter
from typing import Any

from stability.arithmetic import Arithmetic, cosine_sine
from stability.bounded import INFLATION

FIRST_BITS, LAST_BITS = 128, 4096  # the precision is doubled in between


def available() -> bool:
    """Return whether python-flint is installed."""
    return find_spec("flint") is not None


def exact(value: Any) -> Fraction:
    """Return a decimal, or a float as the decimal that it prints as, as a fraction."""
    return Fraction(repr(float(value)) if isinstance(value, float) else str(value))  # a NumPy float's repr has its type


def enclosing(bits: int) -> Arithmetic:
    """Return ball or interval arithmetic with a working precision of ``bits``, set here for all that follows."""
    if not available():
        return intervals(bits)
    from flint import ctx

    ctx.prec = bits  # python-flint's own: also whenever an arithmetic is used again after another precision
    return arb_balls(bits)


def exact_float(value: float, arithmetic: Arithmetic) -> Any:
    """Return exactly that float64 number, not the decimal that it prints as."""
    p, q = value.as_integer_ratio()
    return arithmetic.number(p) / arithmetic.number(q)


def float_enclosure(ball: Any, arithmetic: Arithmetic) -> tuple[float, float]:
    """Return a float64 number and how far from it the ball may reach: inf where float64 has no such number."""
    centre = arithmetic.centre(ball)
    if not isfinite(centre):
        return centre, inf
    gap = ball - exact_float(centre, arithmetic)
    reach = arithmetic.size(gap) * INFLATION
    return centre, 0.0 if gap == 0 else nextafter(reach, inf) if reach < inf else inf


def upper(ball: Any) -> Any:
    """Return a bound of the modulus, as a ball: it may lie outside the range of float64."""
    return ball.abs_upper() if hasattr(ball, "abs_upper") else abs(ball).b


@cache
def arb_balls(bits: int) -> Arithmetic:
    """Return Arb arithmetic; its precision is python-flint's context: use `enclosing`, which sets that."""
    from flint import acb, arb, ctx, fmpq

    ctx.prec = bits

    def number(value: Any) -> Any:
        if isinstance(value, arb):
            return value
        if isinstance(value, int):
            return arb(value)
        fraction = exact(value)
        return arb(fmpq(fraction.numerator, fraction.denominator))

    return Arithmetic(
        name=f"Arb, {bits} bits", number=number, complex=acb, rational=lambda p, q: arb(fmpq(p, q)),
        where=lambda c, a, b: a if c else b, floor=lambda a: a.floor(), pi=arb.pi(),
        sqrt=lambda a: arb(a).sqrt(), sin=lambda a: arb(a).sin(), cos=lambda a: arb(a).cos(),
        tan=lambda a: arb(a).tan(), asin=lambda a: arb(a).asin(), atan=lambda a: arb(a).atan(),
        exp=lambda a: arb(a).exp(), log=lambda a: arb(a).log(),
        direction=cosine_sine, centre=lambda a: float(arb(a).mid()), size=lambda a: float(arb(a).abs_upper()),
        unit=arb(0, 1),
    )  # fmt: skip


@cache
def intervals(bits: int) -> Arithmetic:
    """Return mpmath interval arithmetic; what `mpmath.iv` lacks is monotonic and taken from the end points."""
    from mpmath import MPContext
    from mpmath.ctx_iv import MPIntervalContext

    iv, mp = MPIntervalContext(), MPContext()
    iv.prec, mp.prec = bits, bits + 20
    slack = iv.mpf([1, 1]) * iv.mpf(2) ** (-bits)  # end points err by less: they are evaluated with 20 bits more

    def number(value: Any) -> Any:
        if hasattr(value, "delta"):
            return value
        fraction = exact(value)
        return iv.mpf(fraction.numerator) / fraction.denominator

    def rising(function: Any) -> Any:
        def enclosed(a: Any) -> Any:
            a = iv.mpf(a)
            low, high = (iv.mpf(function(mp.mpf(end))) for end in (a.a, a.b))
            return iv.mpf([(low - abs(low) * slack).a, (high + abs(high) * slack).b])

        return enclosed

    def floor(a: Any) -> Any:
        low, high = mp.floor(mp.mpf(a.a)), mp.floor(mp.mpf(a.b))
        return iv.mpf([low, high])

    return Arithmetic(
        name=f"mpmath intervals, {bits} bits", number=number, complex=iv.mpc, rational=lambda p, q: iv.mpf(p) / q,
        where=lambda c, a, b: a if c else b, floor=floor, pi=+iv.pi, sqrt=lambda a: iv.sqrt(a), sin=lambda a: iv.sin(a),
        cos=lambda a: iv.cos(a), tan=lambda a: iv.sin(a) / iv.cos(a), asin=rising(mp.asin), atan=rising(mp.atan),
        exp=lambda a: iv.exp(a), log=lambda a: iv.log(a), direction=cosine_sine,
        centre=lambda a: float(mp.mpf(iv.mpf(a).mid)), size=lambda a: float(mp.mpf(abs(iv.mpf(a)).b)),
        unit=iv.mpf([-1, 1]),
    )  # fmt: skip
