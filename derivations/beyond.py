"""What the paper only supposes: the short waves of the full D, and that Det D' alone decides."""

from functools import cache

from sympy import Expr, I, Integer, Matrix, Poly, Rational, expand, sqrt, together

from derivations.algebra import ANYTHING, Given, decide, digits
from derivations.cases import L, scaled
from derivations.frames import BY, FLAT_SMOOTH, UNIT, WAVE, a, b, d
from derivations.verdict import Kind, Verdict, show
from stability.closures.drucker_prager import PERTURBED
from stability.symbols import epsilon, gradient, k, mu, norm_V, q, symbol, u, v
from stability.tangent import tangent

TITLE = "Beyond the paper: short waves of the full D (section 6)"
i_q = symbol("s")  # i|xi|: in powers of it D is real
NULL = Given({d: Integer(0)}, ((b, a**2 + 2 * b**2 - 1),))  # the directions where Det M = 0, with a = delta
n, t = Matrix([a, 2 * b]), Matrix([2 * b, -a])  # null vector of M and its normal, each of square 2 - delta^2
square = 2 - a**2


@cache
def series() -> dict[int, Matrix]:
    """Return the full D in powers of i|xi|, in the null direction and in the frame of the flow."""
    D = Matrix(tangent(PERTURBED, WAVE)).subs({u: 0, v: 0, q: i_q / I})  # -i u.xi only shifts the frequency
    D = D.applyfunc(lambda e: expand(together(e))).xreplace({d: 0})
    return {power: D.applyfunc(lambda e, power=power: e.coeff(i_q, power)) for power in (2, 1, 0, -1)}


def form(left: Matrix, matrix: Matrix, right: Matrix) -> Expr:
    """Return left.matrix.right over the squares of n and t."""
    return (left.T * matrix * right)[0] / square


def slow_mode() -> tuple[Expr, Expr]:
    """Return the first two terms of the slow eigenvalue, lambda = i|xi| first + second + O(1/|xi|)."""
    D = series()
    first = form(n, D[1], n)
    second = form(n, D[0], n) - 2 * form(n, D[1], t) * form(t, D[1], n) / (mu * square)
    return first, second


def satisfied(first: Expr, second: Expr) -> list[bool]:
    """Return whether the characteristic polynomial of D vanishes down to |xi|^2, where lambda = s first + second."""
    D = series()
    T = {m: D[m].trace() for m in D}
    mix = {}
    for i, one in D.items():
        for j, other in D.items():
            mix[i + j] = mix.get(i + j, 0) + one[0, 0] * other[1, 1] - one[0, 1] * other[1, 0]
    orders = {
        4: mix[4],
        3: mix[3] - T[2] * first,
        2: mix[2] - T[2] * second - T[1] * first + first**2,
    }
    return [NULL.vanishes(e) for e in orders.values()]


def bounded_growth() -> Verdict:
    """Return the verdict on the short waves of the full D for 0 < delta < k."""
    first, second = slow_mode()
    # V = ||V|| A
    rates = {gradient(u)[0]: norm_V * a, gradient(v)[1]: 0, gradient(v)[0]: 2 * norm_V * b - gradient(u)[1]}
    D1 = series()[1]
    limit = a * (k - a) / (epsilon * square) - a * norm_V - 2 * form(n, D1, t) * form(t, D1, n) / (mu * square)
    values = numbers((10**4, 10**8), second.xreplace(rates))
    return decide(
        "D, 0 < δ < k",
        "(supposed from D') ill-posed along the directions where Det M vanishes",
        "D = q²D₂ + iqD₁ + D₀ + (i/q)D₋₁; D₂n = 0, t ⊥ n. `λ = iq n·D₁n + Re λ + O(1/q)` annuls the characteristic "
        "polynomial of the package's D at q⁴, q³, q², any smooth background; in powers of iq all is real. Near the "
        "null direction D₂ has separated eigenvalues, the slow one ≤ 0: the bound is uniform in direction. Error "
        "O(q⁻²)",
        [
            *satisfied(first, second),
            NULL.vanishes((second - limit).xreplace(rates)),
            NULL.vanishes(form(n, series()[2], n)),
            NULL.vanishes(form(t, series()[2], t) - mu * square / 2),
        ],
        values,
        right="if unstable at arbitrarily short waves is meant, and ε is small; not in Hadamard's sense: growth "
        "stays bounded, `Re λ → δ(k−δ)/(ε(2−δ²)) − δ‖V‖ − 2(n·D₁t)(t·D₁n)/(μ(2−δ²))` there, −∞ elsewhere",
        slip=Kind.HOLDS_IF,
    )


def numbers(wavenumbers: tuple[int, int], limit: Expr) -> tuple[bool, str]:
    """Return whether Re lambda tends to the limit at a rational background, with the values."""
    D = Matrix(tangent(PERTURBED, WAVE))
    values = ANYTHING.point([D, limit], seed=3)
    values |= {
        a: Rational(1, 3),
        b: Rational(2, 3),
        d: Integer(0),
        k: Rational(4, 5),
        epsilon: Rational(1, 100),
        u: Integer(0),
        v: Integer(0),
    }
    values |= {gradient(u)[0]: values[norm_V] / 3, gradient(v)[1]: Integer(0)}
    values |= {gradient(v)[0]: values[norm_V] * Rational(4, 3) - values[gradient(u)[1]]}
    found = [greater(D.xreplace(values | {q: Integer(wavenumber)})) for wavenumber in wavenumbers]
    exact = limit.xreplace(values)
    text = ", ".join(f"{digits(e)} at q = 10^{len(str(w)) - 1}" for e, w in zip(found, wavenumbers, strict=True))
    where = f"a rational background, δ = 1/3, k = 4/5, ε = 1/100: Re λ = {text}; limit {digits(exact)}"
    return exact > 0 and abs(found[1] - exact) < 1e-12, where


def greater(D: Matrix) -> Expr:
    """Return the greater real part of the two eigenvalues."""
    half = D.trace() / 2
    root = sqrt((half**2 - D.det()).evalf(80)).evalf(80)
    return max((half + sign * root).evalf(80).as_real_imag()[0] for sign in (1, -1))


def at_yield() -> list[Verdict]:
    """Return the verdicts on delta = 0: the full D in the null directions, and D' at short waves."""
    second = slow_mode()[1].xreplace({d: Integer(0)})
    # A stays trace-free and of unit norm: with a = d = 0, b^2 = 1/2 it can only turn.
    b_only = Given(FLAT_SMOOTH.substitution | {a: Integer(0), d: Integer(0)}, ((b, 2 * b**2 - 1),))
    turning = [e.xreplace(FLAT_SMOOTH.substitution).xreplace({a: Integer(0)}) for e in (second, symbol("A_xx_x"))]
    rates = {gradient(u)[0]: Integer(0), gradient(v)[1]: Integer(0), gradient(v)[0]: 2 * norm_V * b - gradient(u)[1]}
    y, kappa = symbol("y"), symbol("kappa")
    at_zero = {a: -d, b: sqrt((1 - 2 * d**2) / 2)}
    T, Delta = (expand(e.subs(at_zero)) for e in (scaled.trace(), scaled.det()))
    scaling = {d: -k * y / (4 * L)}
    characteristic = ((kappa / L) ** 2 - T * kappa / L + Delta).subs(scaling)
    balance = expand(characteristic).coeff(L, 0) - (2 * kappa - k**2 * (2 * y - y**2) / 8)  # the rest is O(1/L)
    rates_of = [L_value * fastest(L_value, Rational(4, 5)) for L_value in (10**2, 10**6)]
    return [
        decide(
            "D → M",
            "the eigenvalues of D tend to those of M except in the four directions Det M = 0",
            "D − M = O(q), M ~ q²; about a trace-free background even there `Re λ → −(μ/2)(χ·∇(χ·A·χ))² ≤ 0`",
            [difference_degree() == 1, b_only.vanishes(turning[0].xreplace(rates) + mu / 2 * turning[1] ** 2)],
        ),
        decide(
            "D', δ = 0",
            "(case 3 as meant) the problem may be ill-posed",
            "d = −ky/(4L), ελ = κ/L: the characteristic polynomial tends to `2κ − (k²/8)(2y − y²)`, greatest at y = 1",
            [balance.expand() == 0],
            (
                abs(rates_of[1] - Rational(4, 5) ** 2 / 16) < 1e-6,
                f"k = 4/5: Lελ = {digits(rates_of[0])} at L = 10², {digits(rates_of[1])} at L = 10⁶; k²/16 = "
                f"{digits(Rational(1, 25))}",
            ),
            right="if unstable at every wavelength is meant; the growth decays, `ελ → k²/(16L)` as L → ∞",
            slip=Kind.HOLDS_IF,
        ),
    ]


def fastest(length: int, friction: Expr) -> Expr:
    """Return epsilon lambda of D' at delta = 0 in the direction of the least determinant."""
    best = -friction / (4 * (1 + length))
    here = {a: -best, d: best, b: sqrt((1 - 2 * best**2) / 2), k: friction, L: Integer(length)}
    return greater(scaled.applyfunc(expand).xreplace(here))


def difference_degree() -> int:
    """Return the power of q with which the full D departs from M."""
    entries = tangent(PERTURBED, WAVE) - tangent(PERTURBED, WAVE, "leading")
    return max(Poly(expand(e * q), q).degree() - 1 for e in entries)


def determinant_decides() -> Verdict:
    """Return the verdict on judging D' by its determinant."""
    trace, det = (e for e in (scaled.trace(), scaled.det()))
    # With T = epsilon Tr D' and Delta = epsilon^2 Det D'/L: Delta = -T - 2b^2 - L(1 + 2b^2) < 0 where T >= 0.
    return decide(
        "Det D' alone",
        "the stability of D' is read off Det D'",
        f"`ε²Det D'/L = −ε Tr D' − 2b² − L(1 + 2b²)` modulo {BY}: Tr D' ≥ 0 implies Det D' < 0",
        [UNIT.vanishes(det / L + trace + 2 * b**2 + L * (1 + 2 * b**2))],
    )


def verdicts() -> list[Verdict]:
    """Return the verdicts of this group."""
    return [bounded_growth(), *at_yield(), determinant_decides()]


if __name__ == "__main__":
    show(verdicts())
