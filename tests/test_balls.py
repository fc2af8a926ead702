"""Arb balls and mpmath intervals: every result encloses the exact number, and the precision is the one asked for."""

from fractions import Fraction

import numpy as np
import pytest
from mpmath import mp, mpf

from stability import balls
from stability.arithmetic import multiprecision
from stability.balls import arb_balls, enclosing, exact, exact_float, float_enclosure, intervals

EXACT = multiprecision(120)
ARITHMETICS = {"arb": arb_balls, "intervals": intervals}
both = pytest.mark.parametrize("arithmetic", ARITHMETICS.values(), ids=ARITHMETICS.keys())


def holds(ball, a, value) -> bool:
    """Return whether a ball's float64 enclosure contains a number, given with 115 digits behind the point or more."""
    centre, radius = float_enclosure(ball, a)
    return abs(mpf(centre) - value) <= mpf(radius) + mpf(10) ** -115


@both
def test_elementary_functions_enclose_60_digits(arithmetic):
    rng, a = np.random.default_rng(1), arithmetic(128)
    for _ in range(60):
        x = float(rng.uniform(0.01, 0.99))
        for name in ("sqrt", "sin", "cos", "tan", "asin", "atan", "exp", "log"):
            assert holds(getattr(a, name)(exact_float(x, a)), a, getattr(EXACT, name)(mpf(x))), name
        y = float(rng.normal())
        assert holds(exact_float(x, a) ** exact_float(y, a), a, mpf(x) ** mpf(y))


@both
@pytest.mark.parametrize("degrees", [0, 45, 90, 135, 180, 225, 270, 315, -45, 765, 30, 1e-9, 359.99999999999994])
def test_directions_enclose_the_truth(arithmetic, degrees):
    a = arithmetic(128)
    c, s = a.direction(exact_float(float(degrees), a), a)
    with mp.workdps(120):
        angle = mp.radians(mpf(float(degrees)))
        assert holds(c, a, EXACT.cos(angle)) and holds(s, a, EXACT.sin(angle))


@both
def test_decimals_are_read_exactly_and_floats_as_the_decimals_that_they_print_as(arithmetic):
    a = arithmetic(128)
    for value in (2e-5, "2e-5", np.float64(2e-5), Fraction(1, 50000)):
        assert exact(value) == Fraction(1, 50000)
        assert holds(a.number(value), a, mpf(2) / 10**5)
    assert exact(np.int64(3)) == exact("3") == 3


@both
def test_a_float_enclosure_is_about_the_float_and_not_about_its_decimal(arithmetic):
    a = arithmetic(128)
    centre, radius = float_enclosure(a.number(2e-5), a)
    assert centre == 2e-5
    assert abs(Fraction(2e-5) - Fraction("2e-5")) <= Fraction(radius) <= Fraction(2e-5) * Fraction(2) ** -52
    assert float_enclosure(exact_float(0.1, a), a) == (0.1, 0.0)
    huge = a.number(10) ** 400
    assert float_enclosure(huge, a) == (np.inf, np.inf)
    assert 0 < float_enclosure(1 / huge, a)[1] < 1e-300  # underflow is not an exact zero


def test_the_precision_is_the_one_asked_for_also_after_a_higher_one():
    from flint import ctx

    for bits in (128, 1024, 128, 256, 128):
        a = enclosing(bits)
        assert ctx.prec == bits and a.name == f"Arb, {bits} bits"
        assert float((a.number(1) / 3).rad()) > 2.0 ** (-bits - 4)


def test_without_python_flint_intervals_take_over(monkeypatch):
    monkeypatch.setattr(balls, "available", lambda: False)
    assert enclosing(128).name == "mpmath intervals, 128 bits"
