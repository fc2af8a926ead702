"""Determinants of polynomials against SymPy and NumPy."""

from fractions import Fraction

import numpy as np
import pytest
from numpy.testing import assert_allclose
from sympy import Matrix, Poly, eye, symbols

from stability import polynomials


def random_pencil(n: int, seed: int) -> tuple:
    """Return L2[a][b], L1[a] and L0 of random small fractions, some of them absent."""
    rng = np.random.default_rng(seed)

    def matrix() -> tuple:
        entries = rng.integers(-3, 4, (n, n))
        return tuple(tuple(Fraction(int(e), 2) if e else 0 for e in row) for row in entries)

    return ((matrix(), matrix()), (matrix(), matrix())), (matrix(), matrix()), matrix()


@pytest.mark.parametrize("n", [1, 2, 3, 4])
def test_the_symbol_is_the_characteristic_polynomial_of_the_pencil(n):
    lam, x, y = symbols("lam x y")
    second, first, zeroth = pencil = random_pencil(n, n)
    evolves = (1, 0, 1, 1)[:n]
    L = sum((a * b * Matrix(second[i][j]) for i, a in enumerate((x, y)) for j, b in enumerate((x, y))), Matrix(zeroth))
    L += x * Matrix(first[0]) + y * Matrix(first[1])  # x, y stand for s chi
    E = eye(n)
    for i in range(n):
        E[i, i] = evolves[i]
    expected = Poly((lam * E - L).det(), lam, x, y).as_dict()
    found = {(j, m - k, k): c for (j, m, k), c in polynomials.symbol(evolves, pencil).items() if c}
    assert found == {key: Fraction(int(c.p), int(c.q)) for key, c in expected.items()}


def test_coefficients_may_be_arrays_over_many_points():
    rng = np.random.default_rng(0)
    L = rng.normal(size=(5, 3, 3))
    entries = [[L[:, i, j] for j in range(3)] for i in range(3)]
    found = polynomials.characteristic((1, 1, 1), entries, 1.0)
    for point in range(5):
        assert_allclose([np.broadcast_to(found[j], 5)[point] for j in (3, 2, 1, 0)], np.poly(L[point]), rtol=1e-12)


def test_terms_that_are_absent_stay_absent():
    assert polynomials.determinant([[{}, {(1,): 2}], [{(0,): 3}, {}]], {(0,): 1}) == {(1,): -6}
    assert polynomials.determinant([[{}, {}], [{(0,): 3}, {}]], {(0,): 1}) == {}
    assert polynomials.absent(0) and not polynomials.absent(np.zeros(2))
