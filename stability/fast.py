"""Growth rates of many waves in NumPy near the limit of the hardware: 9 ns a sample.

Per direction a handful of real polynomials in the wavenumber, per block of samples one small matrix product each, then
some fifteen passes over arrays that fit the cache. Two modes: lambda = Tr/2 + sqrt(Q) with the root of positive real
part, whose square is |Q|/2 + Re Q/2 or (Im Q/2)^2 over that; minimum and maximum choose, so nothing branches.

Rejected, in ns a sample: complex `sqrt` (12 to 22), `hypot` (20), `where` (3), Horner's rule by ufuncs (16 against 10),
blocks of 2^14 samples (11 against 8.7: the calls' overhead), one matrix product for all polynomials (3 against 1.7).

Where the terms of D lie within 1e-70 to 1e70 1/s nothing overflows in float64, and wavenumbers of 1e-6 to 1e12 /m are
far inside. What does overflow comes out as NaN and is left open like a sample near neutrality.
"""

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from stability.errors import SceneError
from stability.spectrum import Polynomial, Series, add, multiply, real_imaginary, stability_polynomial

BLOCK = 2**16  # samples: the arrays of a block stay in the caches (8.7 ns a sample; 2^15: 10.3, 2^17: 9.5)
COLUMNS = 2**13  # wavenumbers: rows this long suit BLAS, and their powers take 0.7 MiB
# Growth rates below this part of |Tr| are left to `spectrum`. Trace and root are each within four roundings, so what
# stays has an error of 4e-16 |Tr|, its sign with a factor of 5e8 to spare, and a relative error of 2e-9 at worst.
# Share left open on the paper's hopper (wavenumbers 1 to 1e5), and worst relative error of the others: 2^-12: 18 %,
# 8e-13; 2^-16: 2.8 %, 2e-11; 2^-20: 0.17 %, 2e-10; 2^-22: 0.04 %, 6e-10. One that is left open costs 500 ns.
NEAR = 2.0**-22
CHOOSE = 2.0**60  # times Re Q: above |Q| unless the two squares are equal to rounding
TIE = 2.0**-48  # real parts closer than this part of the modulus: the imaginary part decides which one leads
LARGEST = 126  # binary exponent: float32 ends at 2^128
DRAFT_TINY = 1e-30  # float32: smaller terms are dropped, they would be subnormal and slow
ABSENT = 2**13  # binary exponents below -2^13 do not occur in float64
ERROR = {"standard": "4e-15 ||D||", "draft": "1e-6 ||D||"}


def scaled(factor: float, polynomial: Polynomial) -> Polynomial:
    """Return a multiple of a polynomial."""
    return {n: factor * c for n, c in polynomial.items()}


def moduli(polynomial: Polynomial) -> Polynomial:
    """Return the polynomial of the moduli of the coefficients."""
    return {n: abs(c) for n, c in polynomial.items()}


def of_pair(coefficients: dict[str, Series], speed: Any) -> dict[str, Polynomial]:
    """Return Re Tr, Re Q, Im Q, and Im Tr with the Doppler shift, each twice what is needed."""
    (trace, turn), (gap, twist) = (real_imaginary(coefficients[part]) for part in ("trace", "discriminant"))
    shift = add((1, turn), (-2, {1: speed}))
    return {"trace": trace, "gap": gap, "twist": twist, "shift": shift}


def of_single(coefficients: dict[str, Series], speed: Any) -> dict[str, Polynomial]:
    """Return the numerators of growth rate and frequency, their common denominator, and the size of the first."""
    (r, i), (a, b), (c, d) = (real_imaginary(coefficients[part]) for part in ("regular", "numerator", "denominator"))
    below = add((1, multiply(c, c)), (1, multiply(d, d)))
    shifted = add((1, i), (-1, {1: speed}))
    R, A, B, C, D = map(moduli, (r, a, b, c, d))
    return {
        "growth": scaled(-1, stability_polynomial(coefficients)),
        "frequency": add((1, multiply(shifted, below)), (-1, multiply(b, c)), (1, multiply(a, d))),
        "below": below,
        "near": scaled(NEAR, add((1, multiply(R, below)), (1, multiply(A, C)), (1, multiply(B, D)))),
    }


# Degree of each part in D: draft scales every wavenumber by a power of two that bounds D there.
DEGREE = {"trace": 1, "gap": 2, "twist": 2, "shift": 1, "growth": 1, "frequency": 1, "below": 0, "near": 1}


@dataclass(frozen=True)
class Table:
    """The polynomials of some directions at some wavenumbers, each a pair of factors (rows, k), (k, columns)."""

    factors: dict[str, tuple[np.ndarray, np.ndarray]]
    unit: np.ndarray | None = None  # of the results, per wavenumber

    def evaluate(self, part: str, rows: slice, out: np.ndarray) -> np.ndarray:
        """Write the values of a polynomial into ``out``."""
        coefficients, powers = self.factors[part]
        return np.matmul(coefficients[rows], powers, out=out)


def rows_of(polynomial: Polynomial, rows: int) -> np.ndarray:
    """Return coefficients as one row a direction; an empty polynomial is a constant zero."""
    found = np.zeros((rows, max(1, len(polynomial))))
    for i, c in enumerate(polynomial.values()):
        found[:, i] = c
    return found


def powers_of(polynomials: dict[str, Polynomial], wavenumber: np.ndarray) -> dict[tuple, np.ndarray]:
    """Return the powers of the wavenumber that polynomials need, by their orders; those of `of_pair` are halved."""
    factor = 0.5 if "trace" in polynomials else 1.0
    found = {}
    for orders in {tuple(p) for p in polynomials.values()}:
        found[orders] = np.array([factor * wavenumber ** float(n) for n in orders] or [0 * wavenumber])
    return found


def table(polynomials: dict[str, Polynomial], rows: int, powers: dict) -> Table:
    """Return a table in float64."""
    return Table({name: (rows_of(p, rows), powers[tuple(p)]) for name, p in polynomials.items()})


def exponent(values: np.ndarray) -> np.ndarray:
    """Return the binary exponents of values that are not negative; that of zero is below all others."""
    return np.where(values == 0, -ABSENT, np.frexp(values)[1])


def draft_table(polynomials: dict[str, Polynomial], rows: int, powers: dict) -> Table:
    """Return a table in float32, where q^4 would overflow: terms and wavenumbers carry powers of two of their own."""
    parts = {name: (rows_of(p, rows), powers[tuple(p)]) for name, p in polynomials.items()}
    exponents = {name: exponent(np.abs(c).max(axis=0)) for name, (c, _) in parts.items()}

    def bound(name: str) -> np.ndarray:
        return exponent(np.ldexp(parts[name][1], exponents[name][:, None]).max(axis=0))

    denominator = bound("below") if "below" in parts else 0
    size = np.max([-(-(bound(n) - denominator) // DEGREE[n]) for n in parts if DEGREE[n]], axis=0)
    if np.max(size) > LARGEST:
        raise SceneError('accuracy = "draft" holds growth rates up to 1e38 1/s (float32), these waves exceed it')
    factors = {}
    for name, (c, p) in parts.items():
        terms = np.ldexp(p, exponents[name][:, None] - DEGREE[name] * size - denominator)
        terms[terms < DRAFT_TINY] = 0
        factors[name] = np.ldexp(c, -exponents[name]).astype(np.float32), terms.astype(np.float32)
    return Table(factors, np.ldexp(1.0, size).astype(np.float32))


@dataclass
class Scratch:
    """The arrays of one thread, allocated once."""

    dtype: Any
    arrays: dict[str, np.ndarray] = field(default_factory=dict)

    def __call__(self, name: str, shape: tuple[int, int], dtype: Any = None) -> np.ndarray:
        """Return the named array, of that shape and of unknown content."""
        size = shape[0] * shape[1]
        if name not in self.arrays or self.arrays[name].size < size:
            self.arrays[name] = np.empty(size, dtype or self.dtype)
        return self.arrays[name][:size].reshape(shape)


def pair(t: Table, rows: slice, growth: np.ndarray, frequency: np.ndarray | None, new: Scratch) -> np.ndarray | None:
    """Write growth rates of the leading of two modes; return where they hold, None if that was not asked (draft)."""
    shape, checked = growth.shape, t.unit is None
    R, I = (t.evaluate(part, rows, new(part, shape)) for part in ("gap", "twist"))
    A = new("A", shape)
    small = new("B", shape) if frequency is not None else I
    np.multiply(R, R, out=A)
    np.multiply(I, I, out=small)
    np.add(A, small, out=A)
    np.sqrt(A, out=A)
    np.multiply(R, CHOOSE, out=growth)
    np.abs(R, out=R)
    np.add(A, R, out=A)  # the square of the larger part of the root ...
    if not checked:
        np.maximum(A, np.finfo(A.dtype).tiny, out=A)
    np.divide(small, A, out=small)  # ... and of the smaller one
    if frequency is not None:
        np.negative(growth, out=R)
        np.minimum(R, A, out=R)
        np.maximum(R, small, out=R)
        np.sqrt(R, out=R)
        np.copysign(R, I, out=frequency)
    np.minimum(growth, A, out=growth)
    np.maximum(growth, small, out=growth)
    np.sqrt(growth, out=growth)
    T, tied = t.evaluate("trace", rows, A), None
    if frequency is not None and checked and t.factors["twist"][0].any():
        np.add(R, np.abs(T, out=I), out=R)
        tied = np.less(growth, np.multiply(R, TIE, out=R), out=new("tied", shape, bool))
    np.add(growth, T, out=growth)
    if frequency is not None:
        np.add(frequency, t.evaluate("shift", rows, I), out=frequency)
    if t.unit is not None:
        enlarge(t.unit, growth, frequency)
        return None
    np.multiply(T, -2 * NEAR, out=T)
    np.abs(growth, out=R)
    ok = np.greater_equal(R, T, out=new("ok", shape, bool))  # false for NaN too
    return ok if tied is None else np.greater(ok, tied, out=ok)


def enlarge(unit: np.ndarray, *results: np.ndarray | None) -> None:
    """Multiply results by their unit."""
    for out in results:
        if out is not None:
            np.multiply(out, unit, out=out)


def single(t: Table, rows: slice, growth: np.ndarray, frequency: np.ndarray | None, new: Scratch) -> np.ndarray | None:
    """Write growth rates of the one mode there is; return where they hold, None if that was not asked (draft)."""
    shape = growth.shape
    N, S = t.evaluate("growth", rows, new("gap", shape)), t.evaluate("below", rows, new("twist", shape))
    np.divide(N, S, out=growth)
    if frequency is not None:
        np.divide(t.evaluate("frequency", rows, new("A", shape)), S, out=frequency)
    if t.unit is not None:
        enlarge(t.unit, growth, frequency)
        return None
    np.abs(N, out=N)
    return np.greater_equal(N, t.evaluate("near", rows, S), out=new("ok", shape, bool))
