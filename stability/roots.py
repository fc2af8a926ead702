"""Roots of complex polynomials at very many points at once, in float64: closed forms for up to three, else eigenvalues.

A polynomial is the list of its coefficients, arrays or numbers, constant term first. Errors are roundings of the
largest root, whatever the root; `fastest` takes most of them off the one that it returns.
"""

from collections.abc import Sequence
from typing import Any

import numpy as np

THIRD = np.exp(2j * np.pi / 3)  # a cube root of 1
POLISH = 1e-2  # of the root: a longer Newton step corrects no rounding


def roots(c: Sequence[Any]) -> np.ndarray:
    """Return the roots (root, point...) of polynomials of degree 1 and more; not finite where there are fewer."""
    if len(c) == 2:
        return np.asarray(-c[0] / c[1])[None].astype(complex)
    if len(c) == 3:
        half = np.asarray(c[1] / (2 * c[2]), complex)
        root = np.sqrt(half * half - c[0] / c[2])
        root = np.where(np.real(half * root.conj()) > 0, -root, root)
        far = root - half
        return np.stack([far, np.where(far == 0, 0, c[0] / c[2] / np.where(far == 0, 1, far))])
    if len(c) == 4:
        shift, u, v = cardano(c)
        return np.stack([u + v, u * THIRD + v / THIRD, u / THIRD + v * THIRD]) - shift
    return companion(c)


def companion(c: Sequence[Any]) -> np.ndarray:
    """Return the roots of polynomials of any degree as eigenvalues."""
    n = len(c) - 1
    shape = np.broadcast_shapes(*(np.shape(e) for e in c))
    matrix = np.zeros((*shape, n, n), complex)
    matrix[..., np.arange(1, n), np.arange(n - 1)] = 1
    for i in range(n):
        matrix[..., i, -1] = -c[i] / c[n]
    fine = np.asarray(np.isfinite(matrix).all(axis=(-2, -1)))
    found = np.linalg.eigvals(np.where(fine[..., None, None], matrix, 0))
    found[~fine] = np.nan
    return np.moveaxis(found, -1, 0)


def cardano(c: Sequence[Any]) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return b/3, u and v of a cubic ``x^3 + b x^2 + ...``, whose roots are ``w u + v/w - b/3`` with w^3 = 1."""
    b, d, e = (np.asarray(c[i] / c[3], complex) for i in (2, 1, 0))
    shift = b / 3
    p, q = d / 3 - shift * shift, (shift * (2 * shift * shift - d) + e) / 2
    root = np.sqrt(q * q + p * p * p)
    cube = np.where(np.real(q.conj() * root) > 0, -root, root) - q  # the larger of two: nothing cancels
    size, turn = np.cbrt(abs(cube)), np.angle(cube) / 3
    u = size * np.cos(turn) + 1j * (size * np.sin(turn))
    return shift, u, np.where(size > 0, -p / np.where(size > 0, u, 1), 0)


def largest(c: Sequence[Any]) -> np.ndarray:
    """Return the largest real part of the roots, without the roots where that is cheaper."""
    if len(c) == 2:
        return np.real(-c[0] / c[1])
    if len(c) == 3:
        half = c[1] / (2 * c[2])
        square = half * half - c[0] / c[2]
        real, imaginary = square.real, square.imag
        root = np.sqrt((np.sqrt(real * real + imaginary * imaginary) + abs(real)) / 2)
        root = np.where(real > 0, root, abs(imaginary) / (2 * np.where(root == 0, 1, root)))
        return root - half.real
    if len(c) == 4:
        shift, u, v = cardano(c)
        both = u.real + v.real
        return np.maximum(both, np.sqrt(0.75) * abs(u.imag - v.imag) - both / 2) - shift.real
    return roots(c).real.max(axis=0)


def fastest(c: Sequence[Any]) -> np.ndarray:
    """Return the root with the largest real part, with the accuracy of the coefficients where it is a simple one."""
    found = roots(c)
    z = found[0]
    for other in found[1:]:
        z = np.where(other.real > z.real, other, z)
    if len(c) < 4:
        return z
    value, slope = horner(c, z)
    step = value / np.where(slope == 0, np.inf, slope)
    return np.where(abs(step) <= POLISH * abs(z), z - step, z)


def horner(c: Sequence[Any], z: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return a polynomial and its derivative at a point."""
    value, slope = c[-1] + 0 * z, 0 * z
    for e in c[-2::-1]:
        slope = slope * z + value
        value = value * z + e
    return value, slope
