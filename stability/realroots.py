"""Real roots of polynomials with ball coefficients: certified isolation by Descartes' rule and bisection.

A polynomial is a list of balls, constant term first. On an interval (a, b) the rule counts the changes of sign of
``(1 + x)^d p((a + b x)/(1 + x))``: none means no root, one means exactly one simple root. Where balls do not decide
down to `WIDTH` of the precision, the interval holds a root of higher multiplicity, for all that can be told: a
polynomial that touches zero does so in rounding, never in balls.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from mpmath import MPContext

Balls = list[Any]
WIDTH = 1 / 8  # of the bits: a root of multiplicity 4 is then seen with half of the bits to spare


@dataclass(frozen=True)
class Root:
    """A root within ``radius`` of ``centre``, of that multiplicity (certain for 1, else the least that fits)."""

    centre: Fraction
    radius: Fraction
    multiplicity: int


def sign(ball: Any) -> int:
    """Return the certain sign of a ball, or 0."""
    return 1 if ball > 0 else -1 if ball < 0 else 0


def vanishes(polynomial: Sequence[Any]) -> bool:
    """Return whether no coefficient is certainly different from zero."""
    return not any(sign(c) for c in polynomial)


def value(polynomial: Sequence[Any], x: Any) -> Any:
    """Return the value at x, by Horner's rule."""
    total = 0 * x
    for c in reversed(polynomial):
        total = total * x + c
    return total


def shifted(polynomial: Sequence[Any], a: Any) -> Balls:
    """Return the coefficients about a: p(a + x)."""
    found = list(polynomial)
    for i in range(len(found) - 1):
        for j in range(len(found) - 2, i - 1, -1):
            found[j] = found[j] + a * found[j + 1]
    return found


def derivative(polynomial: Sequence[Any]) -> Balls:
    """Return the derivative."""
    return [k * c for k, c in enumerate(polynomial)][1:]


def multiplied(one: Sequence[Any], other: Sequence[Any]) -> Balls:
    """Return the product."""
    found: Balls = [0] * (len(one) + len(other) - 1)
    for i, a in enumerate(one):
        for j, b in enumerate(other):
            found[i + j] = found[i + j] + a * b
    return found


def number(x: Fraction, arithmetic: Any) -> Any:
    """Return a fraction as a ball."""
    return arithmetic.number(x.numerator) / arithmetic.number(x.denominator)


def changes(polynomial: Balls, a: Fraction, b: Fraction, arithmetic: Any) -> int:
    """Return the changes of sign on (a, b), or -1 where balls do not decide: 0 or 1 are then certain."""
    there = shifted(polynomial, number(a, arithmetic))  # p(a + x), x in (0, b - a)
    width, power = number(b - a, arithmetic), arithmetic.number(1)
    for k in range(1, len(there)):
        power = power * width
        there[k] = there[k] * power
    signs = [sign(c) for c in shifted(there[::-1], arithmetic.number(1))]
    if 0 in signs:
        return -1
    return sum(s != t for s, t in zip(signs, signs[1:], strict=False))


def isolated(polynomial: Sequence[Any], a: Fraction, b: Fraction, arithmetic: Any, bits: int) -> list[Root]:
    """Return the roots in (a, b), each in an interval of its own, in order; everything else is certainly free of them.

    The end points must not be roots.
    """
    p = trimmed(polynomial)
    if len(p) < 2:
        return []
    narrow = Fraction(1, 2 ** int(bits * WIDTH))
    found: list[tuple[Fraction, Fraction, bool]] = []
    stack = [(a, b)]
    while stack:
        low, high = stack.pop()
        count = changes(p, low, high, arithmetic)
        if count == 0:
            continue
        if count == 1 and sign(value(p, number(low, arithmetic))) * sign(value(p, number(high, arithmetic))) < 0:
            found.append((*bisected(p, low, high, narrow, arithmetic), True))
        elif high - low < narrow:
            found.append((low, high, False))
        else:
            middle = low + (high - low) * Fraction(499, 1000)  # not the middle: roots like to lie there
            stack += [(middle, high), (low, middle)]
    return [refined(p, low, high, simple, arithmetic, bits) for low, high, simple in joined(found, narrow)]


def trimmed(polynomial: Sequence[Any]) -> Balls:
    """Return the polynomial without leading coefficients that are zero for all that can be told."""
    p = list(polynomial)
    while p and not sign(p[-1]):
        p.pop()
    return p


def bisected(p: Balls, low: Fraction, high: Fraction, narrow: Fraction, arithmetic: Any) -> tuple[Fraction, Fraction]:
    """Return a narrower interval around the one simple root."""
    at_low = sign(value(p, number(low, arithmetic)))
    while high - low > narrow:
        middle = (low + high) / 2
        here = sign(value(p, number(middle, arithmetic)))
        if here == 0:
            break
        low, high = (middle, high) if here == at_low else (low, middle)
    return low, high


def joined(found: list, gap: Fraction) -> list[tuple[Fraction, Fraction, bool]]:
    """Return intervals in order, those that touch made one."""
    result: list[tuple[Fraction, Fraction, bool]] = []
    for low, high, simple in sorted(found):
        if result and low - result[-1][1] <= gap:
            result[-1] = (result[-1][0], max(high, result[-1][1]), False)
        else:
            result.append((low, high, simple))
    return result


def refined(p: Balls, low: Fraction, high: Fraction, simple: bool, arithmetic: Any, bits: int) -> Root:
    """Return the root in an interval, by Newton's method on the derivative of which it is a simple root."""
    around = number((low + high) / 2, arithmetic) + number((high - low) / 2, arithmetic) * arithmetic.unit
    order, chain = 1, [list(p), derivative(p)]
    while not simple and len(chain[-1]) > 1 and not sign(value(chain[-1], around)):
        order += 1
        chain.append(derivative(chain[-1]))
    mp = MPContext()
    mp.prec = bits
    f, slope = ([middle(c, mp) for c in q] for q in chain[-2:])
    centre = mp.mpf(low.numerator) / low.denominator + mp.mpf((high - low).numerator) / (high - low).denominator / 2
    for _ in range(12):
        steep = value(slope, centre)
        if steep == 0:
            break
        centre -= value(f, centre) / steep
    exact = fraction(centre)
    if not low <= exact <= high:
        return Root((low + high) / 2, (high - low) / 2, order)
    reach = Fraction(1, 2 ** (bits // 2))
    ends = [sign(value(chain[-2], number(exact + d, arithmetic))) for d in (-reach, reach)]
    return Root(exact, reach if ends[0] * ends[1] < 0 else (high - low), order)


def middle(ball: Any, mp: Any) -> Any:
    """Return the midpoint of a ball, or a plain number, as an mpmath number of that context."""
    if hasattr(ball, "man_exp"):
        mantissa, exponent = ball.mid().man_exp()
        return mp.ldexp(mp.mpf(int(mantissa)), int(exponent))
    return mp.mpf(ball.mid if hasattr(ball, "mid") else ball)


def fraction(x: Any) -> Fraction:
    """Return an mpmath number as the fraction that it is."""
    s, mantissa, exponent, _ = x._mpf_
    return Fraction(-mantissa if s else mantissa) * Fraction(2) ** exponent
