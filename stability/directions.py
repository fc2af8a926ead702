"""det(lambda E - L) over all directions: where the laws of short waves may change, and the laws themselves.

The coefficient of ``lambda^j s^m`` is a form of degree m in the direction (X, Y), which runs over the projective line
in two charts, (1, t) and (t, 1) in axes turned by `TURN`, so that no special direction lies at a chart's end. Laws can
change only where a *deciding form* vanishes: a corner coefficient of the Newton polygon (a mode goes to another
exponent), the resultant that puts a root on the imaginary axis, or the discriminant where roots leave it in pairs.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from typing import Any

from stability import polynomials
from stability.layers import Layer, layers
from stability.polynomials import Polynomial
from stability.puiseux import Law, Numbers, Terms, laws, polygon
from stability.realroots import Balls, isolated, number, shifted, vanishes

TURN = (Fraction(20, 29), Fraction(21, 29))  # cosine and sine of 46.4 degrees, exact

Form = Polynomial  # {(power of X, power of Y): ball}


@dataclass(frozen=True)
class Special:
    """A direction in which a deciding form vanishes: a root in a chart, and its angle in degrees, in [0, 180)."""

    chart: int
    root: Any
    angle: float


class Directions:
    """The characteristic polynomial of one pencil over all directions, in balls."""

    def __init__(self, evolves: tuple[int, ...], pencil: tuple, numbers: Numbers):
        self.numbers = numbers
        self.arithmetic = numbers.arithmetic
        forms: dict[tuple[int, int], Form] = {}
        for (j, m, k), c in polynomials.symbol(evolves, pencil).items():
            forms.setdefault((j, m), {})[m - k, k] = 0 * self.arithmetic.unit + c
        self.forms = {key: form for key, form in forms.items() if not vanishes(list(form.values()))}

    def terms(self, x: Any, y: Any) -> Terms:
        """Return the terms of waves along (x, y), balls of any length: 1 unless exponents alone are wanted."""
        found = {}
        for (j, m), form in self.forms.items():
            total = sum((c * x**a * y**b for (a, b), c in form.items()), 0 * self.arithmetic.unit)
            found[j, Fraction(m), 0] = self.turned(total, m)
        return found

    def turned(self, real: Any, m: int) -> Any:
        """Return i^m times a real ball."""
        zero, minus = 0 * real, -real
        return self.arithmetic.complex(*((real, zero), (zero, real), (minus, zero), (zero, minus))[m % 4])

    def along(self, angle: float) -> Terms:
        """Return the terms of waves at an angle in degrees, taken as the float64 number that it is."""
        a = self.arithmetic
        return self.terms(*a.direction(self.numbers.exactly(angle), a))

    def laws(self, angle: float) -> list[Law]:
        """Return the laws of all modes in a direction."""
        return laws(self.along(angle), self.numbers)

    def chart(self, form: Mapping[tuple, Any], which: int) -> Balls:
        """Return a form as a polynomial in the chart's coordinate, with the degree of the form."""
        c, s = (number(f, self.arithmetic) for f in TURN)
        degree = sum(next(iter(form)))
        zero = 0 * self.arithmetic.unit
        X, Y = ([c, -s], [s, c]) if which == 0 else ([-s, c], [c, s])
        powers_x, powers_y = ([[zero + 1]] for _ in range(2))
        for _ in range(degree):
            powers_x.append(convolved(powers_x[-1], X))
            powers_y.append(convolved(powers_y[-1], Y))
        found = [zero] * (degree + 1)
        for (a, b), value in form.items():
            for i, p in enumerate(convolved(powers_x[a], powers_y[b])):
                found[i] = found[i] + value * p
        return found

    def angle(self, chart: int, t: Any) -> float:
        """Return the angle in degrees, in [0, 180), of a coordinate."""
        mp = self.numbers.mp
        turn = mp.atan2(
            mp.mpf(TURN[1].numerator) / TURN[1].denominator, mp.mpf(TURN[0].numerator) / TURN[0].denominator
        )
        t = mp.mpf(t.numerator) / t.denominator
        local = mp.atan2(t, 1) if chart == 0 else mp.atan2(1, t)
        return float(mp.degrees(turn + local) % 180)

    @cached_property
    def deciding(self) -> list[Form]:
        """The deciding forms of the polygon of almost every direction."""
        found, cornered = [], set()
        for edge in polygon(dict.fromkeys(self.forms)):
            members = {j: self.forms[key] for j, key in self.members(edge).items()}
            cornered |= {self.members(edge)[0], self.members(edge)[max(members)]}
            if edge.exponent.denominator == 1 and max(members) > 1:
                found.append(crossing(members, int(edge.exponent) % 2 == 1))
        forms = [self.forms[key] for key in sorted(cornered)] + found
        return [f for f in forms if f and sum(next(iter(f))) and not vanishes(list(f.values()))]

    @cached_property
    def degenerate(self) -> bool:
        """Whether some edge has a double root in every direction: its laws are then sampled, not decided once."""
        for edge in polygon(dict.fromkeys(self.forms)):
            members = {j: self.forms[key] for j, key in self.members(edge).items()}
            if edge.exponent.denominator == 1 and max(members) > 1:
                form = crossing(members, int(edge.exponent) % 2 == 1)
                if not form or vanishes(list(form.values())):
                    return True
        return False

    @cached_property
    def highest(self) -> Fraction:
        """The highest exponent of any mode in almost every direction."""
        return max((edge.exponent for edge in polygon(dict.fromkeys(self.forms))), default=Fraction(0))

    def members(self, edge: Any) -> dict[int, tuple[int, int]]:
        """Return the keys of the forms on an edge by power of gamma."""
        j0 = edge.lowest
        m0 = max(m for j, m in self.forms if j == j0)
        return {j: (j + j0, int(m0 - edge.exponent * j)) for j in edge.terms}

    @cached_property
    def special(self) -> list[Special]:
        """The directions where a deciding form vanishes, by angle; everywhere else none does, certainly."""
        found: list[Special] = []
        ends = {0: (Fraction(-1), Fraction(1)), 1: (Fraction(-1), Fraction(1))}
        for form in self.deciding:
            for chart, (low, high) in ends.items():
                for root in isolated(self.chart(form, chart), low, high, self.arithmetic, self.numbers.bits):
                    near = [s for s in found if s.chart == chart and abs(s.root.centre - root.centre) <= 4 * max(
                        s.root.radius, root.radius)]  # fmt: skip
                    if not near:
                        found.append(Special(chart, root, self.angle(chart, root.centre)))
        return sorted(found, key=lambda s: s.angle)

    def nearby(self, special: Special) -> Terms:
        """Return the terms about a special direction, theta being the distance in its chart's coordinate."""
        a, root = self.arithmetic, special.root
        t = number(root.centre, a) + number(root.radius, a) * a.unit
        length = a.sqrt(1 + t * t)
        found: Terms = {}
        for (j, m), form in self.forms.items():
            for k, c in enumerate(shifted(self.chart(form, special.chart), t)):
                found[j, Fraction(m), k] = self.turned(c / length**m, m)
        return found

    def layers(self, special: Special) -> list[Layer]:
        """Return the growing layers about a special direction."""
        return layers(self.nearby(special), self.numbers)

    def arcs(self) -> list[tuple[float, float]]:
        """Return the open arcs between special directions, in degrees; the last one may end beyond 180."""
        angles = [s.angle for s in self.special]
        if not angles:
            return [(0.0, 180.0)]
        return list(zip(angles, [*angles[1:], angles[0] + 180], strict=True))


def convolved(one: Balls, other: Balls) -> Balls:
    """Return the product of two polynomials with all their degrees kept."""
    found = [0 * one[0]] * (len(one) + len(other) - 1)
    for i, a in enumerate(one):
        for j, b in enumerate(other):
            found[i + j] = found[i + j] + a * b
    return found


def crossing(members: dict[int, Form], odd: bool) -> Form:
    """Return the form that vanishes where a root of an edge's real polynomial meets the imaginary axis of lambda.

    With an odd exponent lambda ~ i gamma: roots leave the axis in pairs, at zeros of the discriminant. With an even one
    they cross it at zeros of the resultant of the even and the odd part; without odd part, again in pairs.
    """
    if odd:
        return discriminant(members)
    even = {j // 2: f for j, f in members.items() if j % 2 == 0}
    rest = {j // 2: f for j, f in members.items() if j % 2 == 1}
    if not rest:
        return discriminant(even) if max(even) > 1 else {}
    return resultant(even, rest)


def discriminant(p: dict[int, Form]) -> Form:
    """Return the resultant of a polynomial and its derivative."""
    if max(p) < 2:
        return {}
    return resultant(p, {j - 1: {key: j * c for key, c in f.items()} for j, f in p.items() if j})


def resultant(p: dict[int, Form], q: dict[int, Form]) -> Form:
    """Return the determinant of Sylvester's matrix."""
    m, n = max(p), max(q)
    if n == 0:
        return q[0]
    matrix: list[list[Polynomial]] = []
    for f, degree, count in ((p, m, n), (q, n, m)):
        for i in range(count):
            matrix.append([f.get(degree - (j - i), {}) if 0 <= j - i <= degree else {} for j in range(m + n)])
    return polynomials.determinant(matrix, {(0, 0): 1})
