"""Roots of many polynomials at once, against NumPy's eigenvalues of companion matrices and exact factors."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from stability.roots import fastest, horner, largest, roots

POINTS = 200


def polynomials(degree: int) -> tuple[list, np.ndarray]:
    """Return random polynomials, constant term first, and their roots by `numpy.roots` (root, point), sorted."""
    rng = np.random.default_rng(degree)
    c = rng.normal(size=(degree + 1, POINTS)) + 1j * rng.normal(size=(degree + 1, POINTS))
    return list(c), np.stack([np.sort_complex(np.roots(one)) for one in c[::-1].T], axis=1)


@pytest.mark.parametrize("degree", [1, 2, 3, 4, 5])
def test_roots_of_many_polynomials(degree):
    c, expected = polynomials(degree)
    assert_allclose(np.sort_complex(roots(c).T).T, expected, rtol=1e-11)  # condition of the worst of 200: some 1e4
    assert_allclose(largest(c), expected.real.max(axis=0), rtol=1e-11, atol=1e-11)
    assert_allclose(fastest(c), expected[expected.real.argmax(axis=0), np.arange(POINTS)], rtol=1e-11)


@pytest.mark.parametrize("degree", [1, 2, 3, 4])
def test_roots_keep_the_shape_of_their_points(degree):
    c = [np.ones((2, 3))] * degree + [2.0]
    assert roots(c).shape == (degree, 2, 3) and largest(c).shape == fastest(c).shape == (2, 3)


def test_a_slow_root_beside_fast_ones_keeps_its_digits():
    slow, fast = 1e-6 + 2e-6j, -1e6 + 3e5j
    pair = [np.array([slow * fast]), np.array([-slow - fast]), np.array([1.0 + 0j])]
    assert_allclose(fastest(pair), slow, rtol=1e-14)  # a quotient of two numbers that are each exact to roundings
    other = fast.conjugate() * 2
    cubic = [-other * pair[0], pair[0] - other * pair[1], pair[1] - other, pair[2]]
    # a cubic's closed form errs by 1e-16 of the fast root, 1e-4 of the slow one; one Newton step squares that
    assert_allclose(fastest(cubic), slow, rtol=1e-7)


@pytest.mark.parametrize("root", [0.0, 2.0, -1.0 + 1j])
def test_multiple_roots_are_found_to_the_root_of_the_roundings(root):
    c = [np.full(3, e, complex) for e in np.polynomial.polynomial.polyfromroots([root] * 3)]
    assert_allclose(roots(c), root, atol=1e-5)  # 1e-16 to the power 1/3
    assert_allclose(largest(c), np.real(root), atol=1e-5)


def test_a_polynomial_without_a_leading_term_has_no_finite_roots():
    with np.errstate(all="ignore"):
        assert not np.isfinite(roots([np.ones(1), np.ones(1), np.zeros(1), np.zeros(1)])).any()


def test_value_and_derivative_are_those_of_the_polynomial():
    value, slope = horner([1.0, -2.0, 3.0], np.array([2.0, -1.0]))  # 1 - 2 z + 3 z^2
    assert_allclose(value, [9.0, 6.0])
    assert_allclose(slope, [10.0, -8.0])
