"""Waves beside a direction in which the symbol is singular: a mode that the constraints leave undetermined there.

Its growth rate goes to infinity with the direction, ``Re lambda ~ c |xi|^n theta^-r`` at an angle theta. The laws of
two angles, far smaller than float64 resolves and far larger than the error of the root's centre, tell r. The root's own
ball is left out: about a double root it is wider than the angles, although the centre is as good.
"""

from collections.abc import Iterator
from dataclasses import replace
from fractions import Fraction
from math import inf

from stability.directions import Directions, Special
from stability.puiseux import Law, laws, strongest
from stability.verdict import Beside

NEAR, NEARER = 64, 84  # theta = 2^-NEAR
DENOMINATOR = 6  # of r, for as many modes


def beside(d: Directions, lost: list[Special]) -> Beside:
    """Return the fastest waves beside some singular directions: those that grow most steeply, if any do."""
    found = [one for s in lost for one in sides(d, s)]
    growing = [one for one in found if one.coefficient > 0]
    if growing:  # mirror images differ in their last digits: the first of them
        return max(growing, key=lambda one: (one.power, one.exponent, float(f"{one.coefficient:.9g}"), -one.angle))
    return min(found, key=lambda one: (abs(one.coefficient) > 0, one.exponent))


def sides(d: Directions, special: Special) -> Iterator[Beside]:
    """Yield the law of the waves on either side of a direction, in angles."""
    mp, turned = d.numbers.mp, 1 if special.chart == 0 else -1  # the second chart's coordinate falls as angles rise
    t = mp.mpf(special.root.centre.numerator) / special.root.centre.denominator
    for side in (-1, 1):
        far, near = (at(d, special, side * mp.ldexp(1, -n)) for n in (NEAR, NEARER))
        if not near.sign or not far.sign:
            yield Beside(special.angle, side * turned, near.exponent, Fraction(0), 0.0)
            continue
        power = Fraction(float(mp.log(abs(near.coefficient / far.coefficient), 2) / (NEARER - NEAR)))
        power = power.limit_denominator(DENOMINATOR)
        theta = mp.ldexp(1, -NEARER) / (1 + t * t)  # the angle that belongs to the step of the coordinate
        coefficient = float(near.coefficient * theta ** (mp.mpf(power.numerator) / power.denominator))
        yield Beside(special.angle, side * turned, near.exponent, power, coefficient)


def at(d: Directions, special: Special, step: object) -> Law:
    """Return the strongest law at a step of the chart's coordinate away from a special direction."""
    exact = d.numbers.exactly(step)
    special = replace(special, root=replace(special.root, radius=Fraction(0)))
    here: dict = {}
    for (j, e, k), c in d.nearby(special).items():
        here[j, e, 0] = here.get((j, e, 0), 0 * c) + c * exact**k
    found = laws(here, d.numbers)
    return strongest(found) if found else Law(-inf, 0, 0, 0)
