"""Section 6: the list of three cases after (P9), and the text about it.

With a = delta - d the sign of Det D' is that of g(d) = (1 + 2L) d^2 + a^2 - k a, a parabola in d; a direction of the
wave exists for d wherever a^2 + d^2 <= 1.
"""

from mpmath import mp
from sympy import Expr, Rational, diff, discriminant, expand, lambdify, limit, pi, sin, solve, sqrt

from derivations.algebra import ANYTHING, decide, digits
from derivations.frames import UNIT, a, b, d, delta
from derivations.truncated import D
from derivations.verdict import Kind, Verdict, inspected, show
from stability.symbols import epsilon, k, mu, q, symbol

TITLE = "The three cases of Det D' (section 6)"
L, y = symbol("L"), symbol("y")
scaled = D.subs(mu, 2 * L / (epsilon * q**2)) * epsilon  # depends on L = Lambda epsilon alone
g = expand(((1 + 2 * L) * d**2 + a**2 - k * a).subs(a, delta - d))
DISCRIMINANT = discriminant(g, d)
BEST = solve(diff(g, d), d)[0]  # the direction of the least Det D'
BAND = solve(DISCRIMINANT, L)[0]  # L*
LOWER, UPPER = sorted(solve(DISCRIMINANT.subs(L, 0), delta), key=lambda e: e.subs(k, 1))
EXAMPLE = {k: Rational(4, 5)}


def foundation() -> list[bool]:
    """Return the facts that the cases rest on."""
    inside = (a**2 + d**2).subs(a, delta - d)
    edge = (k**2 - 4 * delta * (delta - k) * (1 + 2 * L)) - DISCRIMINANT
    return [
        UNIT.vanishes(scaled.det() - L * ((1 + 2 * L) * d**2 + a**2 - k * a)),
        UNIT.vanishes(1 - a**2 - d**2 - 2 * b**2),
        ANYTHING.vanishes(edge),
        ANYTHING.vanishes(LOWER + k / (2 * (sqrt(2) + 1))),
        ANYTHING.vanishes(UPPER - k * (1 + sqrt(2)) / 2),
        ANYTHING.vanishes(inside.subs(d, BEST).subs(L, 0) - (4 * delta**2 + k**2) / 8),
    ]


def least(values: dict) -> tuple[Expr, str]:
    """Return the least Det D' eps^2/L over all directions, with the point where it is taken."""
    values = EXAMPLE | values
    best = BEST.subs(values)
    if (delta - best).subs(values) ** 2 + best**2 > 1:  # no such direction: the nearer end of the range
        root = sqrt(2 - values[delta] ** 2)
        best = (values[delta] - root) / 2
    low = g.subs(values).subs(d, best)
    at = ", ".join(f"{s} = {v}" for s, v in ((k, values[k]), ("δ", values[delta]), (L, values[L]), ("d", best)))
    return low, f"{at}: Det D' = {digits(low)} L/ε²".replace("-", "−").replace("sqrt", "√")


def first() -> Verdict:
    """Return the verdict on case 1."""
    low, where = least({delta: Rational(-1, 10), L: Rational(1, 10)})
    return decide(
        "case 1",
        "`0 ≥ δ > −k/(2(√2+1))`: Det D' ≥ 0 for all wavenumbers and directions",
        "Det D' = `(L/ε²)g(d)`, discriminant `k² − 4δ(δ−k)(1+2L)` > 0 iff L < L*; the best d obeys a² + d² ≤ 3k²/16 "
        "< 1",
        [
            *foundation(),
            BAND.subs({k: 1, delta: Rational(-1, 10)}) > 0,
            (BEST**2).subs(L, 0).subs(delta, LOWER).expand() == k**2 / 8,
            (delta - BEST).subs({L: 0, delta: 0}) == k / 4,
        ],
        (low < 0, where),
        right="`0 > δ > −k/(2(√2+1))`: negative for some direction iff 0 < L < L* "
        "(exchanged with case 2; δ = 0 belongs to case 3)",
    )


def second() -> list[Verdict]:
    """Return the verdicts on case 2 and its band."""
    low, where = least({delta: Rational(-1, 4), L: Rational(1, 10)})
    high, where_high = least({delta: Rational(99, 100), L: Rational(1, 100)})
    printed = 2 * (k**2 - 4 * delta * (delta - k)) / (delta * (delta - k))
    # At L* the direction is d = 2 delta(delta - k)/(2 delta - k): inside the unit circle for delta = k(1 + y), k <= 1.
    d_star = BEST.subs(L, BAND).factor()
    room = (1 - (delta - d_star) ** 2 - d_star**2).subs(delta, k * (1 + y)).subs(k, 1).factor()
    quotient = (room * (1 + 2 * y) ** 2 / y).cancel()
    corner = {k: 1, L: 0}
    interior = ((delta - BEST) ** 2 + BEST**2).subs(L, 0).subs(delta, UPPER).expand()
    widest = solve(interior - 1, k)
    end = 1 / k + sqrt(1 - 1 / k**2)  # a = 1/k, b = 0
    at_end = (a**2 + d**2 - k * a).subs({a: 1 / k, d: end - 1 / k})
    example = {k: Rational(4, 5), delta: Rational(-1, 10)}
    return [
        decide(
            "case 2",
            "`δ > k` or `−k/(2(√2+1)) > δ`: Det D' can be negative in a band",
            "the discriminant is negative where 4δ(δ−k) > k²; for k ≤ 1 the best d stays in a² + d² ≤ 1",
            [
                *foundation(),
                ANYTHING.vanishes(quotient - (2 - y - 8 * y**2 - 4 * y**3)),
                quotient.subs(y, UPPER.subs(k, 1) - 1).evalf(30) > 0,  # and it decreases with y
                ((4 * delta**2 + k**2) / 8).subs(delta, UPPER).subs(corner).evalf(30) < 1,
                any((e**2 - 2 * (2 - sqrt(2))).simplify() == 0 for e in widest),
                at_end.expand() == 0,
            ],
            (low > 0 and high > 0, f"{where}; {where_high} (least over all directions)"),
            right="`δ ≤ −k/(2(√2+1))`: never negative; `k < δ < k(1+√2)/2`: negative iff 0 < L < L*; above: never. "
            "So for k ≤ 1; for k > √(2(2−√2)), φ_f > 49.94°, the upper end is `1/k + √(1 − 1/k²)`",
        ),
        decide(
            "case 2, band",
            "`0 < Λε < 2(k² − 4δ(δ−k))/(δ(δ−k))`",
            "the printed bound is 16 times the root of the discriminant; with (P8D) as printed the factor would be 8",
            [
                ANYTHING.vanishes(printed - 16 * BAND),
                ANYTHING.vanishes(
                    printed
                    - 8 * solve(discriminant(((1 + L) * d**2 + a**2 - k * a).subs(a, delta - d).expand(), d), L)[0]
                ),
            ],
            (
                printed.subs(example) != BAND.subs(example),
                f"k = 4/5, δ = −1/10: printed {digits(printed.subs(example))}, right {digits(BAND.subs(example))}",
            ),
            right="`0 < Λε < L* = (k² − 4δ(δ−k))/(8δ(δ−k))`",
            slip=Kind.MISPRINT,
        ),
    ]


def third() -> Verdict:
    """Return the verdict on case 3."""
    low, where = least({delta: Rational(-1, 4), L: Rational(1, 10)})
    steep, where_steep = least({k: Rational(6, 5), delta: Rational(11, 10), L: 100})
    return decide(
        "case 3",
        "`k ≥ δ < 0`: Det D' can be negative at any wavelength",
        "d = 0 gives g = δ(δ−k) at every L; δ = 0 gives −k²/(8(1+L)); δ = k has g = 0, g' < 0 at d = 0; "
        "the list is complete with its signs exchanged, and δ > 1 cannot have d = 0",
        [
            *foundation(),
            ANYTHING.vanishes(g.subs(d, 0) - delta * (delta - k)),
            ANYTHING.vanishes(g.subs(d, BEST).subs(delta, 0) + k**2 / (8 * (1 + L))),
            ANYTHING.vanishes(diff(g, d).subs({d: 0, delta: k}) + k),
            steep > 0,
        ],
        (low > 0, f"{where}; for the bound 1: {where_steep}"),
        right="`0 ≤ δ ≤ min(k, 1)`: negative for some direction at every wavelength, with bounded growth",
        slip=Kind.MISPRINT,
    )


def fastest_at_zero(friction_angle: Expr) -> tuple:
    """Return growth (in 1/epsilon), L and d of the fastest wave of D' at delta = 0."""
    rate = symbol("rate")
    at = {a: -d, b: sqrt((1 - 2 * d**2) / 2)}
    T, Delta = (e.subs(at).expand() for e in (scaled.trace(), scaled.det()))
    characteristic = rate**2 - T * rate + Delta
    equations = [characteristic, diff(characteristic, L), diff(characteristic, d)]
    with mp.workdps(40):
        f = lambdify((rate, L, d), [e.subs(k, sqrt(2) * sin(friction_angle)) for e in equations], "mpmath")
        return tuple(mp.findroot(f, (mp.mpf("0.0139"), mp.mpf("0.66"), mp.mpf("-0.12"))))


def text() -> list[Verdict]:
    """Return the verdicts on what the text makes of the cases."""
    growth, length, across = fastest_at_zero(34 * pi / 180)
    with mp.workdps(40):
        wavenumber, angle = mp.sqrt(2 * length), mp.degrees(mp.acos(across * mp.sqrt(2)) / 2)
        values = [mp.nstr(e, 30) for e in (growth, length, wavenumber, angle)]
    return [
        decide(
            "text after the list",
            "unstable at |ξ| ~ 1/√(με), well-posed",
            f"L* ~ k/(8∣δ∣) as δ → 0⁻; at δ = 0, φ_f = 34°, the fastest wave has ελ = {values[0]}, L = {values[1]}, "
            f"|ξ|√(με) = {values[2]}, φ = {values[3]}°",
            [limit(BAND * delta, delta, 0) + k / 8 == 0, abs(wavenumber - mp.mpf("1.15")) < mp.mpf("0.01")],
            right="and it contradicts case 1 as printed: the exchange confirmed",
        ),
        inspected(
            "figure P1, caption",
            Kind.MISPRINT,
            "There is now dependence on the direction",
            "There is no dependence on the direction",
            "the figure's axes are δ and Λε; its next words take the worst direction",
        ),
    ]


def verdicts() -> list[Verdict]:
    """Return the verdicts of this group."""
    return [first(), *second(), third(), *text()]


if __name__ == "__main__":
    show(verdicts())
