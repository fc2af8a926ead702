"""Laws of short waves of polynomials that are factored by hand."""

from fractions import Fraction

import pytest

from stability.balls import enclosing
from stability.layers import layers
from stability.puiseux import Numbers, laws, polygon, shift, strongest

BITS = 256


@pytest.fixture
def numbers():
    return Numbers(enclosing(BITS), BITS)


def terms(numbers, table):
    """Return {(j, e, k): complex ball} of {(j, e, k): (real, imaginary part)}, none of them exact."""
    n = numbers.arithmetic.number
    return {key: numbers.arithmetic.complex(n(re) / 7 * 7, n(im)) for key, (re, im) in table.items()}


def test_the_edges_of_a_polygon_carry_its_exponents():
    # lambda^3 + lambda^2 q^2 + lambda q^3 + q^3: slopes 0, 1 and 2
    found = polygon({(3, 0): 1, (2, 2): 1, (1, 3): 1, (0, 3): 1})
    assert [(e.exponent, e.lowest) for e in found] == [(0, 0), (1, 1), (2, 2)]


def test_every_mode_has_its_law(numbers):
    # (lambda + 3 q^2)(lambda - 2 q)(lambda - 5)
    c = {(3, 0): 1, (2, 2): 3, (2, 1): -2, (2, 0): -5, (1, 3): -6, (1, 2): -15, (1, 1): 10, (0, 3): 30}
    found = sorted(laws(terms(numbers, {(*k, 0): (v, 0) for k, v in c.items()}), numbers), key=lambda x: x.exponent)
    assert [(x.exponent, round(float(x.coefficient), 30), x.sign) for x in found] == [(0, 5, 1), (1, 2, 1), (2, -3, -1)]
    assert strongest(found).exponent == 1


def test_a_neutral_root_is_taken_off_until_a_real_part_is_left(numbers):
    # (lambda - i q - 2)(lambda + i q + 1/q) = lambda^2 + lambda (1/q - 2) + q^2 - i - 2 i q - 2/q
    c = {(2, 0): (1, 0), (1, -1): (1, 0), (1, 0): (-2, 0), (0, 2): (1, 0)}
    c |= {(0, 0): (0, -1), (0, 1): (0, -2), (0, -1): (-2, 0)}
    found = laws(terms(numbers, {(*k, 0): v for k, v in c.items()}), numbers)
    assert sorted((x.exponent, round(float(x.coefficient), 20), x.depth) for x in found) == [(-1, -1, 1), (0, 2, 1)]


def test_an_undamped_mode_has_no_law(numbers):
    found = laws(terms(numbers, {(2, 0, 0): (1, 0), (0, 2, 0): (1, 0)}), numbers)  # lambda^2 = -q^2
    assert [x.sign for x in found] == [0, 0] and strongest(found).exponent == float("-inf")


def test_a_shift_removes_what_cancels(numbers):
    found = shift(terms(numbers, {(2, 0, 0): (1, 0), (0, 2, 0): (1, 0)}), numbers.arithmetic.complex(0, 1), Fraction(1))
    assert set(found) == {(2, 0, 0), (1, 1, 0)}


def test_a_layer_grows_where_every_fixed_direction_decays(numbers):
    # lambda = 2 X - X^2 with X = q^2 theta: theta = q^-2 grows at 1, all else decays or is neutral
    found = layers(terms(numbers, {(1, 0, 0): (1, 0), (0, 2, 1): (-2, 0), (0, 4, 2): (1, 0)}), numbers)
    assert [(x.exponent, x.narrowing) for x in found] == [(0, 2)]
    assert abs(found[0].coefficient - 1) < 1e-20 and abs(found[0].tau - 1) < 1e-9


def test_a_layer_is_found_behind_a_neutral_frequency(numbers):
    # lambda = 3 i q + 1 - q^2 theta^2
    found = layers(
        terms(numbers, {(1, 0, 0): (1, 0), (0, 1, 0): (0, -3), (0, 0, 0): (-1, 0), (0, 2, 2): (1, 0)}), numbers
    )
    assert [(x.exponent, x.narrowing, x.depth) for x in found] == [(0, 1, 1)]
    assert abs(found[0].coefficient - 1) < 1e-20


def test_roots_come_with_discs_that_hold_them(numbers):
    n = numbers.arithmetic.complex
    found = numbers.roots([n(-2, 0), n(0, 0), n(1, 0)])
    assert all(abs(abs(z) - numbers.mp.sqrt(2)) <= r < 1e-60 for z, r in found)
