"""How the modes of a wave behave as it gets shorter: Newton polygons of det(lambda E - L), in balls.

A polynomial ``{(j, e, k): c}`` is the sum of ``c lambda^j q^e theta^k``, with q = |xi| and theta the distance from a
direction, 0 where k stays 0. On an edge of its polygon ``lambda ~ gamma q^n`` with gamma a root of the edge's terms. A
root on the imaginary axis is taken off, ``lambda = gamma q^n + ...``, and the polygon of the rest decides.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from math import inf
from typing import Any

from mpmath import MPContext

from stability.realroots import middle, sign

DEPTH = 4  # how often a neutral root is taken off; each time the exponent falls by at least 1/6 for six modes
LOWEST = -6  # laws that fall faster are not followed
Terms = dict[tuple, Any]  # {(j, e, k): complex ball}


@dataclass(frozen=True)
class Law:
    """``Re lambda ~ coefficient q^exponent``; the coefficient's sign is certain if ``radius`` is smaller.

    ``depth`` counts the neutral roots that were taken off before. Exponent -inf: no growth or decay to `LOWEST`; the
    eigenvalue is zero at depth 0.
    """

    exponent: Fraction | float
    coefficient: Any
    radius: Any
    depth: int
    frequency: Any = 0

    @property
    def sign(self) -> int:
        """The certain sign of the growth rate, or 0."""
        return 0 if abs(self.coefficient) <= self.radius else 1 if self.coefficient > 0 else -1


@dataclass(frozen=True)
class Edge:
    """An edge of the polygon: its exponent n, the lowest power of lambda, and the terms by power of lambda above it."""

    exponent: Fraction
    lowest: int
    terms: dict[int, Any]


class Numbers:
    """One precision: balls, and mpmath numbers for their midpoints."""

    def __init__(self, arithmetic: Any, bits: int):
        self.arithmetic, self.bits = arithmetic, bits
        self.mp = MPContext()
        self.mp.prec = bits

    def exactly(self, x: Any) -> Any:
        """Return a real mpmath number, or a float, as the ball that it is."""
        s, mantissa, exponent, _ = self.mp.mpf(x)._mpf_
        n = self.arithmetic.number
        power = n(2) ** abs(int(exponent))
        whole = n(-int(mantissa) if s else int(mantissa))
        return whole * power if exponent >= 0 else whole / power

    def complexly(self, z: Any, radius: Any = 0) -> Any:
        """Return a complex mpmath number as a ball, with that radius in both parts."""
        more = self.exactly(radius) * self.arithmetic.unit
        return self.arithmetic.complex(self.exactly(z.real) + more, self.exactly(z.imag) + more)

    def centre(self, z: Any) -> Any:
        """Return the midpoint of a complex ball."""
        return self.mp.mpc(middle(z.real, self.mp), middle(z.imag, self.mp))

    def size(self, z: Any) -> Any:
        """Return an upper bound of the modulus of a complex ball."""
        total = self.mp.mpf(0)
        for part in (z.real, z.imag):
            bound = abs(part)
            top = bound.abs_upper() if hasattr(bound, "abs_upper") else bound.b
            total += middle(top, self.mp)
        return total * (1 + self.mp.mpf(2) ** (4 - self.bits))

    def roots(self, coefficients: list) -> list[tuple[Any, Any]]:
        """Return approximations of all roots and radii of discs around them whose union holds the exact ones (Smith).

        A disc that meets no other holds exactly one. Complex balls, constant term first.
        """
        degree = len(coefficients) - 1
        centres = [self.centre(c) for c in coefficients]
        if degree == 1:
            found = [-centres[0] / centres[1]]
        else:
            found = self.mp.polyroots(centres[::-1], maxsteps=500, extraprec=self.bits // 2, error=False)
        balls = [self.complexly(z) for z in found]
        discs = []
        for i, z in enumerate(balls):
            total = 0 * z
            for c in reversed(coefficients):
                total = total * z + c
            below = coefficients[-1]
            for k, other in enumerate(balls):
                if k != i:
                    below = below * (z - other)
            lost = not (sign(below.real) or sign(below.imag))
            discs.append((found[i], self.mp.inf if lost else degree * self.size(total / below)))
        return discs


def nonzero(terms: Terms) -> Terms:
    """Return the terms that are certainly different from zero; the others vanish for all that can be told."""
    return {key: c for key, c in terms.items() if sign(c.real) or sign(c.imag)}


def hull(heights: Mapping[int, Fraction]) -> list[int]:
    """Return the corners of the upper hull of points (j, e)."""
    corners: list[int] = []
    for j in sorted(heights):
        while len(corners) > 1:
            a, b = corners[-2:]
            if (heights[b] - heights[a]) * (j - a) > (heights[j] - heights[a]) * (b - a):
                break
            corners.pop()
        corners.append(j)
    return corners


def polygon(terms: Mapping[tuple, Any]) -> list[Edge]:
    """Return the edges by rising exponent, of terms {(j, e): anything}."""
    heights: dict[int, Fraction] = {}
    for j, e in terms:
        heights[j] = max(heights.get(j, Fraction(e)), Fraction(e))
    corners, edges = hull(heights), []
    for a, b in zip(corners, corners[1:], strict=False):
        n = (heights[a] - heights[b]) / (b - a)
        on = {j: terms[j, e] for j, e in terms if a <= j <= b and e + n * j == heights[a] + n * a}
        edges.append(Edge(n, a, {j - a: c for j, c in sorted(on.items())}))
    return edges


def flat(terms: Terms) -> dict[tuple, Any]:
    """Return the terms at theta = 0."""
    return {(j, e): c for (j, e, k), c in terms.items() if k == 0}


def listed(edge: Edge, zero: Any) -> list:
    """Return the coefficients of an edge's polynomial in gamma, constant term first."""
    return [edge.terms.get(i, zero) for i in range(max(edge.terms) + 1)]


def shift(terms: Terms, gamma: Any, n: Fraction) -> Terms:
    """Return the terms in lambda' with lambda = gamma q^n + lambda', without those that vanish."""
    found: Terms = {}
    for (j, e, k), c in terms.items():
        power, binomial = c, 1
        for i in range(j, -1, -1):  # lambda'^i (gamma q^n)^(j - i)
            key = (i, e + n * (j - i), k)
            found[key] = found[key] + binomial * power if key in found else binomial * power
            power = power * gamma
            binomial = binomial * i // (j - i + 1)
    return nonzero(found)


def clusters(discs: list) -> list[tuple[Any, Any, int]]:
    """Return (centre, radius, count) of discs, those that overlap made one."""
    found: list[tuple[Any, Any, int]] = []
    for z, r in discs:
        merged = (z, r, 1)
        for other in [o for o in found if abs(o[0] - z) <= o[1] + r]:
            found.remove(other)
            merged = (merged[0], abs(other[0] - merged[0]) + other[1] + merged[1], merged[2] + other[2])
        found.append(merged)
    return found


def laws(terms: Terms, numbers: Numbers, below: Any = inf, depth: int = 0) -> list[Law]:
    """Return the law of every mode at theta = 0 whose exponent is less than ``below``, one `Law` a mode."""
    here = nonzero({key: c for key, c in terms.items() if key[2] == 0})
    if not here:
        return []
    edges = polygon(flat(here))
    found = [Law(-inf, 0, 0, depth)] * (min(j for j, *_ in here) if below == inf else 0)
    for edge in edges:
        if not LOWEST <= edge.exponent < below:
            continue
        zero = numbers.complexly(numbers.mp.mpc(0))
        for z, r, count in clusters(numbers.roots(listed(edge, zero))):
            if abs(z.real) > r:
                found += [Law(edge.exponent, z.real, r, depth, z.imag)] * count
            elif depth >= DEPTH or r == numbers.mp.inf:
                found += [Law(-inf, 0, 0, depth + 1)] * count
            else:
                rest = laws(shift(here, numbers.complexly(z, r), edge.exponent), numbers, edge.exponent, depth + 1)
                found += (rest + [Law(-inf, 0, 0, depth + 1)] * count)[:count]
    return found


def strongest(found: list[Law]) -> Law:
    """Return the law of fastest growth at short waves: certain growth of the highest exponent, else what is nearest."""
    growing = [law for law in found if law.sign > 0]
    if growing:
        return max(growing, key=lambda law: (law.exponent, law.coefficient))
    neutral = [law for law in found if law.sign == 0]
    return neutral[0] if neutral else min(found, key=lambda law: (law.exponent, -law.coefficient))
