"""Roots of polynomials that were multiplied out of known factors, in either ball arithmetic."""

from fractions import Fraction
from math import sqrt

import pytest

from stability import balls
from stability.balls import enclosing
from stability.realroots import changes, derivative, isolated, multiplied, shifted, trimmed, value, vanishes

BITS = 320


@pytest.fixture(params=["Arb", "intervals"])
def arithmetic(request, monkeypatch):
    if request.param == "intervals":
        monkeypatch.setattr(balls, "available", lambda: False)
    elif not balls.available():
        pytest.skip("python-flint is not installed")
    return enclosing(BITS)


def product(arithmetic, *factors):
    """Return the product of factors given by rational coefficients, times sqrt 2."""
    n = arithmetic.number
    p = [arithmetic.sqrt(n(2))]
    for factor in factors:
        p = multiplied(p, [n(c.numerator) / c.denominator for c in map(Fraction, factor)])
    return p


def test_simple_and_double_roots_are_told_apart(arithmetic):
    third = Fraction(1, 3)
    p = product(arithmetic, (-third, 1), (-third, 1), (Fraction(7, 10), 1), (Fraction(-7001, 10000), 1), (1, 0, 1))
    found = isolated(p, Fraction(-1), Fraction(1), arithmetic, BITS)
    assert [r.multiplicity for r in found] == [1, 2, 1]
    expected = (Fraction(-7, 10), third, Fraction(7001, 10000))
    assert all(abs(r.centre - e) <= r.radius < Fraction(1, 10**30) for r, e in zip(found, expected, strict=True))


def test_a_polynomial_without_roots_in_the_interval_has_none(arithmetic):
    p = product(arithmetic, (1, 0, 1), (-2, 1))  # i, -i and 2
    assert isolated(p, Fraction(-1), Fraction(1), arithmetic, BITS) == []
    assert changes(p, Fraction(-1), Fraction(1), arithmetic) == 0
    assert len(isolated(p, Fraction(1), Fraction(3), arithmetic, BITS)) == 1


def test_an_irrational_root_is_enclosed(arithmetic):
    found = isolated(product(arithmetic, (-2, 0, 1)), Fraction(0), Fraction(2), arithmetic, BITS)
    assert abs(float(found[0].centre) - sqrt(2)) < 1e-15 and found[0].radius < Fraction(1, 2**140)


def test_a_leading_coefficient_that_vanishes_in_rounding_is_dropped(arithmetic):
    n = arithmetic.number
    tiny = arithmetic.sqrt(n(2)) * arithmetic.sqrt(n(2)) - 2
    assert len(trimmed([n(1), n(2), tiny])) == 2 and vanishes([tiny]) and not vanishes([tiny, n(1)])


def test_shift_value_and_derivative():
    p = [1, -3, 2]  # (1 - x)(1 - 2x)
    assert shifted(p, 1) == [0, 1, 2]
    assert value(p, Fraction(1, 2)) == 0 and derivative(p) == [-3, 4]
