"""Polynomials as ``{exponents: coefficient}`` and determinants of matrices of them, over any numbers.

Coefficients are fractions, balls, mpmath numbers or arrays over many points: only ``+``, ``-`` and ``*`` are asked of
them. Terms whose coefficient is the number 0 are left out, so that what is structurally absent costs nothing.
"""

from collections.abc import Sequence
from typing import Any

import numpy as np

Exponents = tuple[int, ...]
Polynomial = dict[Exponents, Any]


def absent(value: Any) -> bool:
    """Return whether a coefficient is the plain number zero (an array, a ball or a rounded zero is not)."""
    return isinstance(value, int | float) and value == 0


def times(one: Polynomial, other: Polynomial) -> Polynomial:
    """Return the product of two polynomials."""
    found: Polynomial = {}
    for i, a in one.items():
        for j, b in other.items():
            n = tuple(k + m for k, m in zip(i, j, strict=True))
            found[n] = found[n] + a * b if n in found else a * b
    return found


def plus(one: Polynomial, other: Polynomial, sign: int = 1) -> Polynomial:
    """Return the sum of two polynomials, or their difference."""
    found = dict(one)
    for n, b in other.items():
        b = b if sign > 0 else -b
        found[n] = found[n] + b if n in found else b
    return found


def determinant(matrix: Sequence[Sequence[Polynomial]], one: Polynomial) -> Polynomial:
    """Return the determinant by expanding along rows, each set of columns once: n 2^n products, no division."""
    n = len(matrix)
    minors: dict[int, Polynomial] = {0: one}  # of the rows so far and a set of columns, as bits
    for row in matrix:
        grown: dict[int, Polynomial] = {}
        for columns, minor in minors.items():
            for j in range(n):
                if columns >> j & 1 or not row[j]:
                    continue
                sign = -1 if (columns >> (j + 1)).bit_count() % 2 else 1  # columns to the right of j
                key = columns | 1 << j
                grown[key] = plus(grown.get(key, {}), times(row[j], minor), sign)
        minors = grown
    return minors.get((1 << n) - 1, {})


def characteristic(evolves: Sequence[int], L: Sequence[Sequence[Any]], one: Any) -> dict[int, Any]:
    """Return ``{j: coefficient of lambda^j}`` of det(lambda E - L) for a matrix of numbers."""
    n = len(evolves)
    matrix: list[list[Polynomial]] = [
        [{(0,): -L[i][j]} if not absent(L[i][j]) else {} for j in range(n)] for i in range(n)
    ]
    for i, on in enumerate(evolves):
        if on:
            matrix[i][i][1,] = one
    return {n: c for (n,), c in determinant(matrix, {(0,): one}).items()}


def symbol(evolves: Sequence[int], pencil: tuple) -> Polynomial:
    """Return det(lambda E - L) as ``{(j, m, k): coefficient}`` of ``lambda^j s^m chi_x^(m-k) chi_y^k``, s = i|xi|.

    ``pencil`` is (L2[a][b], L1[a], L0), nested, of real numbers, balls, fractions or arrays over points.
    """
    two, (one_x, one_y), zero = pencil
    n = len(evolves)
    matrix: list[list[Polynomial]] = [[{} for _ in range(n)] for _ in range(n)]
    for i in range(n):
        for j in range(n):
            mixed = two[0][1][i][j] + two[1][0][i][j]
            entries = {
                (0, 2, 0): two[0][0][i][j], (0, 2, 1): mixed, (0, 2, 2): two[1][1][i][j],
                (0, 1, 0): one_x[i][j], (0, 1, 1): one_y[i][j], (0, 0, 0): zero[i][j],
            }  # fmt: skip
            matrix[i][j] = {key: -c for key, c in entries.items() if not absent(c)}
        if evolves[i]:
            matrix[i][i][1, 0, 0] = 1
    return determinant(matrix, {(0, 0, 0): 1})


def stacked(coefficients: Sequence[Any]) -> np.ndarray:
    """Return coefficients that may be numbers or arrays as one array, the coefficient first."""
    return np.stack(np.broadcast_arrays(*(np.asarray(c, float) for c in coefficients)))
