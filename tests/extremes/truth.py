"""The leading growth rate to 60 digits, by three routes.

`by_balls`     Arb on the generated expressions, the precision doubled until the enclosure is 1e-60 relative: every
               sample
`by_digits`    mpmath on the same expressions, the digits doubled until two runs agree to 1e-30: a random part, another
               arithmetic
`by_pencil`    mpmath on the pencil's Schur complement in the unturned frame, no closed form but that of a 2 x 2 matrix:
               a random part, other formulas
"""

from functools import lru_cache
from math import inf

import numpy as np
from flint import arb
from mpmath import mp

from stability import spectrum
from stability.arithmetic import multiprecision
from stability.balls import enclosing, exact_float
from stability.enclosures import ball_pair
from tests.extremes.case import Case

FIRST_BITS, LAST_BITS = 320, 8192
RADIUS_BITS = 200  # 1e-60 relative
ROUTE_RTOL = 1e-30  # what two precisions, and two routes, must agree to


def leading(reals: list):
    """Return the largest of some balls, or None if their order is open."""
    best = reals[0]
    for other in reals[1:]:
        if other > best:
            best = other
        elif not other < best and not best.overlaps(other):
            return None
    return best


def of_form(form, q) -> arb | None:
    """Return the leading real part as a ball at the form's precision."""
    if "trace" not in form.coefficients:
        return spectrum.single_parts(form.coefficients, q)[0]
    return leading([real for real, _ in ball_pair(form, q)])


def by_balls(case: Case) -> list[list[arb]]:
    """Return the leading growth rates [direction][wavenumber] as balls of 1e-60 relative radius, but for ties."""
    found: list[list] = [[None] * case.wavenumber.size for _ in case.wave_angle]
    missing = {(i, j) for i in range(case.shape[0]) for j in range(case.shape[1])}
    bits = FIRST_BITS
    while missing and bits <= LAST_BITS:
        a = enclosing(bits)
        with np.errstate(all="ignore"):
            base = case.base(a)
        for i in sorted({i for i, _ in missing}):
            form = base.form(exact_float(float(case.wave_angle[i]), a))
            for j in [j for k, j in missing if k == i]:
                ball = of_form(form, exact_float(float(case.wavenumber[j]), a))
                found[i][j] = ball if ball is not None else arb(0, 1)
                if ball is not None and ball.rel_accuracy_bits() >= RADIUS_BITS:
                    missing.discard((i, j))
        bits *= 2
    return found


def as_floats(balls: list[list[arb]]) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return sign (0 for a tie), nearest float and the rest of every truth: two floats hold 32 of its digits."""
    flat = [ball for row in balls for ball in row]
    sign = np.array([1 if b > 0 else -1 if b < 0 else 0 for b in flat])
    high = np.array([float(b.mid()) for b in flat])
    low = np.array([float((b - arb(h)).mid()) if abs(h) < inf else 0.0 for b, h in zip(flat, high, strict=True)])
    return sign, high, low


def as_mpf(ball: arb):
    """Return the centre of a ball exactly."""
    mantissa, exponent = ball.mid().man_exp()
    return mp.ldexp(mp.mpf(int(mantissa)), int(exponent))


@lru_cache(maxsize=256)
def base_in_digits(case: Case, digits: int):
    return case.base(multiprecision(digits))


def agreed(case: Case, i: int, j: int, route):
    """Return the result of a route once two precisions agree."""
    digits, before = 80, None
    while digits <= 5120:
        found = route(case, digits, i, j)
        if before is not None and abs(found - before) <= ROUTE_RTOL * abs(found):
            return found
        before, digits = found, 2 * digits
    raise ArithmeticError(f"no digit agrees with 5120 digits: {case.about(i, j)}")


def wave(case: Case, a, i: int, j: int) -> tuple:
    return exact_float(float(case.wave_angle[i]), a), exact_float(float(case.wavenumber[j]), a)


def by_digits(case: Case, digits: int, i: int, j: int):
    """Return the leading growth rate by the toolkit's closed forms in mpmath."""
    angle, q = wave(case, multiprecision(digits), i, j)
    return max(e.real for e in base_in_digits(case, digits).form(angle).eigenvalues(q))


def by_pencil(case: Case, digits: int, i: int, j: int):
    """Return the leading growth rate of the 3 x 3 pencil, the pressure eliminated in the flow's own frame."""
    a = multiprecision(digits)
    angle, q = wave(case, a, i, j)
    L2, L1, L0 = base_in_digits(case, digits).pencil()
    xi = (q * a.cos(angle * a.pi / 180), q * a.sin(angle * a.pi / 180))

    def entry(m: int, n: int):
        second = sum(xi[b] * xi[c] * L2[b][c][m][n] for b in (0, 1) for c in (0, 1))
        return a.complex(L0[m][n] - second, sum(xi[b] * L1[b][m][n] for b in (0, 1)))

    L = [[entry(m, n) for n in range(3)] for m in range(3)]
    if (
        case.closure == "rigid_plastic"
    ):  # D = (1 - B xi/(B.xi)) C has the trace for its one eigenvalue beside the spurious zero
        B, row = [L[m][2] for m in (0, 1)], L[2]
        along = sum(B[m] * row[m] for m in (0, 1))
        return (L[0][0] + L[1][1] - sum(row[m] * L[m][n] * B[n] for m in (0, 1) for n in (0, 1)) / along).real
    D = [[L[m][n] - L[m][2] * L[2][n] / L[2][2] for n in (0, 1)] for m in (0, 1)]
    half, root = (D[0][0] + D[1][1]) / 2, a.sqrt(((D[0][0] - D[1][1]) / 2) ** 2 + D[0][1] * D[1][0])
    return max((half + root).real, (half - root).real)
