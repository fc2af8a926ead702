"""Directions that close in on a special one as waves get shorter: theta = tau q^-m, in the terms of `puiseux`.

At a corner (n, m) of the three-dimensional Newton polygon three terms or more lead together in gamma and tau, and the
largest Re gamma over tau is what the fastest of the neighbouring directions does. Between corners the laws are powers
of tau, which are largest at a corner.
"""

from dataclasses import dataclass
from fractions import Fraction
from itertools import combinations
from math import inf
from typing import Any

import numpy as np

from stability.puiseux import DEPTH, LOWEST, Numbers, Terms, clusters, flat, listed, nonzero, polygon, shift


@dataclass(frozen=True)
class Layer:
    """What the directions do that approach a special one as ``theta = tau q^-narrowing``."""

    exponent: Fraction
    narrowing: Fraction
    tau: float
    coefficient: Any
    radius: Any
    depth: int


def pareto(terms: Terms) -> Terms:
    """Return the terms that can lead for some theta = tau q^-m, m > 0: no other has more q and less theta."""
    return {
        (j, e, k): c
        for (j, e, k), c in terms.items()
        if not any(i == j and (f, m) != (e, k) and f >= e and m <= k for i, f, m in terms)
    }


def corners(terms: Terms) -> list[tuple[Fraction, Fraction, Terms]]:
    """Return (n, m, terms) of every corner with m > 0: where three terms lead together and tau matters."""
    points, found = list(terms), {}
    for (j, e, k), (j2, e2, k2), (j3, e3, k3) in combinations(points, 3):
        # j n + e - k m equal for the three
        a, b, c, d = j - j2, k2 - k, j - j3, k3 - k
        r, s = Fraction(e2 - e), Fraction(e3 - e)
        cross = a * d - b * c
        if not cross:
            continue
        n, m = (r * d - b * s) / cross, (a * s - c * r) / cross
        if m <= 0 or (n, m) in found or n < LOWEST:
            continue
        weight = {p: p[0] * n + p[1] - p[2] * m for p in points}
        top = max(weight.values())
        if weight[j, e, k] == top:
            found[n, m] = {p: terms[p] for p in points if weight[p] == top}
    return [(n, m, face) for (n, m), face in found.items()]


def layers(terms: Terms, numbers: Numbers, below: Any = inf, depth: int = 0) -> list[Layer]:
    """Return the growing layers about theta = 0, for modes whose exponent is less than ``below``."""
    terms, found = nonzero(terms), []
    for n, m, face in corners(pareto(terms)):
        if n < below and len({j for j, *_ in face}) > 1:
            best = largest(face, n, m, numbers, depth)
            found += [best] if best else []
    if depth >= DEPTH:
        return found
    for edge in polygon(flat(terms)):
        if not LOWEST <= edge.exponent < below:
            continue
        zero = numbers.complexly(numbers.mp.mpc(0))
        for z, r, _ in clusters(numbers.roots(listed(edge, zero))):
            if abs(z.real) <= r != numbers.mp.inf:
                rest = shift(terms, numbers.complexly(z, r), edge.exponent)
                found += layers(rest, numbers, edge.exponent, depth + 1)
    return found


def largest(face: Terms, n: Fraction, m: Fraction, numbers: Numbers, depth: int) -> Layer | None:
    """Return the largest growth over tau at a corner, or None if there is none or it lies at its ends."""
    degree = max(j for j, *_ in face)
    lowest = min(j for j, *_ in face)
    mp = numbers.mp
    table = [(j - lowest, k, numbers.centre(c)) for (j, _, k), c in face.items()]

    def growth(tau: Any) -> Any:
        c = [mp.mpc(0)] * (degree - lowest + 1)
        for j, k, a in table:
            c[j] += a * mp.mpf(tau) ** k
        c = c[::-1]
        while c and c[0] == 0:
            c.pop(0)
        if len(c) < 2:
            return -mp.inf
        return max(z.real for z in mp.polyroots(c, maxsteps=500, extraprec=60, error=False))

    # The scale of tau: where two terms of one power of lambda, or two ends, are equal.
    scales = [
        float((abs(a) / abs(b)) ** (mp.mpf(1) / (k2 - k)))
        for (_, k, a) in table for (_, k2, b) in table if k2 > k and a and b
    ]  # fmt: skip
    if not scales:
        return None
    mp.prec = 100
    try:
        low, high = min(scales) / 1e3, max(scales) * 1e3
        half = np.geomspace(low, high, 160)
        grid = np.concatenate([-half[::-1], [0.0], half])
        values = fan(table, degree - lowest, grid)
        best = int(np.argmax(values))
        if not 0 < best < len(grid) - 1 or not values[best] > 0:
            return None
        tau = maximum(growth, mp.mpf(grid[best - 1]), mp.mpf(grid[best]), mp.mpf(grid[best + 1]), mp, 45)
    finally:
        mp.prec = numbers.bits
    x = numbers.exactly(tau)
    f: dict[int, Any] = {}
    for (j, _, k), c in face.items():
        f[j - lowest] = f.get(j - lowest, 0 * c) + c * x**k
    zero = numbers.complexly(mp.mpc(0))
    z, r = max(numbers.roots([f.get(j, zero) for j in range(max(f) + 1)]), key=lambda disc: disc[0].real)
    return Layer(n, m, float(tau), z.real, r, depth) if z.real > r else None


def fan(table: list, degree: int, tau: np.ndarray) -> np.ndarray:
    """Return the largest real part of the roots at each tau, in float64: where to look closer."""
    c = np.zeros((len(tau), degree + 1), complex)
    for j, k, a in table:
        c[:, j] += complex(a) * tau**k
    with np.errstate(all="ignore"):
        companion = np.zeros((len(tau), degree, degree), complex)
        companion[:, np.arange(1, degree), np.arange(degree - 1)] = 1
        companion[:, :, -1] = -c[:, :-1] / c[:, -1:]
    fine = np.asarray(np.isfinite(companion).all(axis=(1, 2)))
    found = np.linalg.eigvals(np.where(fine[:, None, None], companion, 0)).real.max(axis=1)
    return np.where(fine, found, -np.inf)


def maximum(f: Any, a: Any, b: Any, c: Any, mp: Any, steps: int = 80) -> Any:
    """Return where f is largest in (a, c): golden section, 5 steps a digit; f itself is then known to twice as many."""
    ratio = (mp.sqrt(5) - 1) / 2
    low, high = a, c
    one, two = high - ratio * (high - low), low + ratio * (high - low)
    f1, f2 = f(one), f(two)
    for _ in range(steps):
        if f1 >= f2:
            high, two, f2 = two, one, f1
            one = high - ratio * (high - low)
            f1 = f(one)
        else:
            low, one, f1 = one, two, f2
            two = low + ratio * (high - low)
            f2 = f(two)
    best = (low + high) / 2
    return b if f(b) >= f(best) else best
