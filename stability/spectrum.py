"""Numerically stable eigenvalues and stability verdicts from the reduced forms of `tangent`.

A series ``{n: c_n}`` stands for ``sum c_n (i q)^n`` with real c_n: even orders make its real part, odd ones its
imaginary part, both polynomials ``{n: c}`` in the wavenumber q. Coefficients and q are floats, NumPy arrays that
broadcast, or mpmath numbers; ``xp`` is the matching namespace (NumPy unless told).

Rejected for float64, with the share of wrong signs at the extremes of every parameter (docs/extremes.md):
`numpy.linalg.eigvals` (1.5 %), the quadratic formula (0.8 %). Both lose the growth rate where Det M vanishes.
"""

from math import inf
from typing import Any

import numpy as np

Series = dict[int, Any]
Polynomial = dict[int, Any]

NEWTON_STEPS = 2  # one leaves errors of 1e-8 where the quotient Det/larger had lost half its digits
# Below this |root of the discriminant|/|Tr| the moduli differ by less than 5/3: T/2 - root no longer cancels, and
# Newton's method would divide by the small root.
NEARLY_DOUBLE = 1 / 8
TIE = 2.0**-50  # four roundings of a conjugate pair's common real part


def real_imaginary(series: Series) -> tuple[Polynomial, Polynomial]:
    """Return real and imaginary part of a series as polynomials in q: i^n is 1, i, -1, -i in turn."""
    real = {n: c if n % 4 == 0 else -c for n, c in series.items() if n % 2 == 0}
    return real, {n: c if n % 4 == 1 else -c for n, c in series.items() if n % 2 == 1}


def evaluate(polynomial: Polynomial, wavenumber: Any) -> Any:
    """Return the value of a polynomial whose orders are all even or all odd, by Horner's rule in q^2."""
    if not polynomial:
        return 0 * wavenumber
    highest, lowest = max(polynomial), min(polynomial)
    square, total = wavenumber * wavenumber, polynomial[highest]
    for n in range(highest - 2, lowest - 1, -2):
        total = total * square + polynomial.get(n, 0)
    return total * wavenumber**lowest if lowest >= 0 else total / wavenumber**-lowest


def multiply(*polynomials: Polynomial) -> Polynomial:
    """Return the product of polynomials."""
    result: Polynomial = {0: 1}
    for polynomial in polynomials:
        grown: Polynomial = {}
        for i, a in result.items():
            for j, b in polynomial.items():
                grown[i + j] = grown.get(i + j, 0) + a * b
        result = grown
    return result


def add(*terms: tuple[float, Polynomial]) -> Polynomial:
    """Return the linear combination of polynomials."""
    result: Polynomial = {}
    for factor, polynomial in terms:
        for n, c in polynomial.items():
            result[n] = result.get(n, 0) + factor * c
    return result


def values(series: Series, wavenumber: Any) -> tuple[Any, Any]:
    """Return real and imaginary part of a series at a wavenumber."""
    real, imaginary = real_imaginary(series)
    return evaluate(real, wavenumber), evaluate(imaginary, wavenumber)


def pair(form: dict[str, Series], wavenumber: Any, xp: Any = np) -> tuple[Any, Any]:
    """Return the two eigenvalues, the one of larger modulus first.

    The larger one is free of cancellation (half the trace plus the root of the discriminant on its side); the smaller
    one is Det/larger, polished by Newton steps in real arithmetic, because the rounding error of a complex quotient
    is relative to its modulus and would drown a small growth rate beside a large frequency.
    """
    (tr, ti), (dr, di) = (values(form[part], wavenumber) for part in ("trace", "determinant"))
    gap, twist = values(form["discriminant"], wavenumber)
    trace, root = tr + 1j * ti, xp.sqrt(gap + 1j * twist)
    same_side = tr * root.real + ti * root.imag >= 0
    root = xp.where(same_side, root, -root)
    large = trace / 2 + root
    double = abs(root) < NEARLY_DOUBLE * abs(trace)
    small = xp.where(double, trace / 2 - root, (dr + 1j * di) / xp.where(large == 0, 1, large))
    x, y = small.real, small.imag
    for _ in range(NEWTON_STEPS):
        f_r, f_i, s_r, s_i = characteristic((tr, ti), (dr, di), x, y)
        size = s_r * s_r + s_i * s_i
        size = xp.where(double | (size == 0), inf, size)
        x, y = x - (f_r * s_r + f_i * s_i) / size, y - (f_i * s_r - f_r * s_i) / size
    small = x + 1j * y
    return trace - small, small


def characteristic(trace: tuple, determinant: tuple, x: Any, y: Any) -> tuple[Any, Any, Any, Any]:
    """Return real and imaginary part of ``f = lambda^2 - Tr lambda + Det`` and of its slope, at lambda = x + i y."""
    (tr, ti), (dr, di) = trace, determinant
    return dr + (x * (x - tr) - y * (y - ti)), di + (y * (x - tr) + x * (y - ti)), 2 * x - tr, 2 * y - ti


def single(form: dict[str, Series], wavenumber: Any) -> Any:
    """Return the one eigenvalue of a constrained closure."""
    real, imaginary = single_parts(form, wavenumber)
    return real + 1j * imaginary


def single_parts(form: dict[str, Series], wavenumber: Any) -> tuple[Any, Any]:
    """Return real and imaginary part of ``regular - numerator/denominator``, formed in real arithmetic."""
    r, i = values(form["regular"], wavenumber)
    a, b = values(form["numerator"], wavenumber)
    c, d = values(form["denominator"], wavenumber)
    size = c * c + d * d
    return r - (a * c + b * d) / size, i - (b * c - a * d) / size


def stability_polynomial(form: dict[str, Series]) -> Polynomial:
    """Return the polynomial in q that is positive where the flow is stable and changes sign on the neutral curve.

    Two modes (Routh-Hurwitz with complex coefficients): both decay iff Re Tr < 0 and ``P T_R^2 + Q T_R T_I - Q^2 >
    0`` with Tr = T_R + i T_I and Det = P + i Q. For a real matrix the second is P > 0. One mode: ``-Re lambda
    |denominator|^2``.
    """
    if "trace" not in form:
        (r, _), (a, b), (c, d) = (real_imaginary(form[part]) for part in ("regular", "numerator", "denominator"))
        size = add((1, multiply(c, c)), (1, multiply(d, d)))
        return add((-1, multiply(r, size)), (1, multiply(a, c)), (1, multiply(b, d)))
    (tr, ti), (p, q) = (real_imaginary(form[part]) for part in ("trace", "determinant"))
    if not q and not ti:
        return p
    return add((1, multiply(p, tr, tr)), (1, multiply(q, tr, ti)), (-1, multiply(q, q)))


def margin(form: dict[str, Series], wavenumber: Any, xp: Any = np) -> Any:
    """Return the stability polynomial relative to the moduli of everything that was added up for it: within [-1, 1].

    Negative where some mode grows. Rounding can only turn the sign of values below some 1e-14. The factors are
    evaluated before they are multiplied, which loses less than the expanded polynomial.
    """

    def both(part: str) -> tuple:
        return *values(form[part], wavenumber), *moduli(form[part], wavenumber)

    if "trace" not in form:
        (r, _, R, _), (a, b, A, B), (c, d, C, D) = (both(part) for part in ("regular", "numerator", "denominator"))
        value, size = a * c + b * d - r * (c * c + d * d), A * C + B * D + R * (C * C + D * D)
    else:
        (t, i, T, J), (p, q, P, Q) = (both(part) for part in ("trace", "determinant"))
        value, size = p * t * t + q * t * i - q * q, P * T * T + Q * T * J + Q * Q
        value = xp.where(t < 0, value, -abs(value))
    return value / xp.where(size == 0, 1, size)


def moduli(series: Series, wavenumber: Any) -> tuple[Any, Any]:
    """Return the sums of the moduli of the terms of the real and of the imaginary part of a series."""
    real, imaginary = ({n: abs(c) for n, c in part.items()} for part in real_imaginary(series))
    return evaluate(real, wavenumber), evaluate(imaginary, wavenumber)


def leading_first(one: Any, other: Any, xp: Any = np) -> tuple[Any, Any]:
    """Return two eigenvalues by decreasing real part; parts equal to rounding tie, and the imaginary part decides."""
    gap = one.real - other.real
    tie = (abs(gap) <= TIE * abs(one)) & ((one.real > 0) == (other.real > 0))  # a growing mode always leads
    first = xp.where(tie, one.imag >= other.imag, gap > 0)
    return xp.where(first, one, other), xp.where(first, other, one)


def pencil_eigenvalues(E: Any, L: Any, modes: int | None = None) -> Any:
    """Return the finite generalised eigenvalues of ``lambda E a = L a`` by QZ, by decreasing real part.

    ``modes`` says how many there are; without it, those count whose reciprocal is not zero to rounding. The error is
    relative to ||L||: it checks the moderate cases and fails at the extremes.
    """
    from scipy.linalg import eigvals  # not needed by anything that runs often

    alpha, beta = eigvals(L, E, homogeneous_eigvals=True)
    if modes is None:
        finite = abs(beta) > 1e-12 * abs(alpha).max() / max(abs(L).max(), 1e-300)
    else:
        size = np.hypot(abs(alpha), abs(beta))
        finite = np.argsort(-abs(beta) / np.where(size == 0, 1, size))[:modes]
    with np.errstate(all="ignore"):
        found = alpha[finite] / beta[finite]
    return found[np.argsort(-found.real)]
