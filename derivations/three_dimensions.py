"""Rigid-plastic flow in three dimensions: (L5) for any direction of space, and which uniform flows are well-posed.

The package's closures are plane. Here the stress is written with three components, differentiated entry by entry, and
the pressure eliminated by the constraint, as in (L3.1).
"""

from functools import cache

from sympy import Expr, I, Matrix, Poly, Rational, cancel, diff, eye, sqrt, symbols

from derivations.algebra import ANYTHING, Given, decide, digits
from derivations.verdict import Kind, Verdict, show
from stability.closures.base import norm, strain_rate
from stability.symbols import k, mu, norm_V, p, q

TITLE = "Rigid-plastic flow in three dimensions (beyond section 3)"
THREE = range(3)
grad_u = Matrix(3, 3, lambda i, j: symbols(f"u{i}_{j}", real=True))
a, b, c, d, e, f = symbols("a b c d e f", real=True)
A = Matrix([[a, b, c], [b, d, e], [c, e, f]])  # V/||V|| in the frame of the wave: chi is the first axis
UNIT = Given(relations=((c, a**2 + d**2 + f**2 + 2 * b**2 + 2 * c**2 + 2 * e**2 - 1),))
y, kappa = symbols("y kappa", real=True)  # y = cos^2 of the angle between chi and the axis; kappa = k/sqrt 6


@cache
def modulus(i: int, j: int, l: int, m: int) -> Expr:
    """Return d(stress_ij)/d(d_m u_l) where V = ||V|| A."""
    V = strain_rate(grad_u)
    size = norm(V)
    derivative = diff(-k * p * V[i, j] / size, grad_u[l, m]).subs(size, norm_V)
    in_letters = derivative.xreplace({grad_u[r, s]: norm_V * A[r, s] for r in THREE for s in THREE})
    return cancel(in_letters.subs(p, mu * norm_V / k))


def transverse() -> Matrix:
    """Return the 2 x 2 matrix of the disturbances across chi, the pressure eliminated; its eigenvalues are lambda."""
    # lambda a_i = -i xi_j d(stress_ij): -(iq)^2 from the gradient, -iq from the pressure
    C = Matrix(3, 3, lambda i, l: q**2 * modulus(i, 0, l, 0))
    B = -I * q * (eye(3)[:, 0] - k * A[:, 0])
    return C[1:, 1:] - B[1:, :] * C[0, 1:] / B[0]


def rate(along: Expr, square: Expr) -> Expr:
    """Return the larger eigenvalue over mu q^2 from chi.A chi and |A chi|^2."""
    return -(Rational(1, 2) - (square - along**2) / (1 - k * along))


def symbol_in_space() -> Verdict:
    """Return the verdict on (L5) in three dimensions."""
    D = transverse()
    tau = Matrix([b, c])  # the part of A chi across chi
    closed = mu * q**2 * rate(a, a**2 + b**2 + c**2)
    flat = rate(a, Rational(1, 2)).subs(a, symbols("c_2") / sqrt(2))
    c2 = symbols("c_2")
    return decide(
        "(L5) in three dimensions",
        "(not in the paper) −μq²[1/2 − (∣Aχ∣² − (χ·Aχ)²)/(1 − kχ·Aχ)] for velocities along Aχ − (χ·Aχ)χ",
        "stress `p − kpV/‖V‖` differentiated in 3-D, modulo `A:A = 1`; the other velocity across χ gives −μq²/2; in "
        "plane strain `χ·Aχ = c/√2, ∣Aχ∣² = 1/2` (c from the extension axis) it is (L5)",
        [
            UNIT.vanishes(D * tau - closed * tau),
            UNIT.vanishes(D * Matrix([-c, b]) + mu * q**2 / 2 * Matrix([-c, b])),
            ANYTHING.vanishes(flat + c2 * (c2 - k / sqrt(2)) / (2 * (1 - k * c2 / sqrt(2)))),
        ],
    )


def axisymmetric(sign: int) -> tuple[Expr, Expr]:
    """Return numerator and denominator, over 1/2, of -rate for A = sign diag(2, -1, -1)/sqrt 6."""
    along = sign * (2 * y - (1 - y)) / sqrt(6)
    square = (4 * y + (1 - y)) / 6
    below = 1 - k * along
    above = (-2 * rate(along, square) * below).subs(k, sqrt(6) * kappa)
    return cancel(above), cancel(below.subs(k, sqrt(6) * kappa))


def discriminant(quadratic: Expr) -> Expr:
    """Return the discriminant in y."""
    two, one, zero = Poly(quadratic, y).all_coeffs()
    return one**2 - 4 * two * zero


def extension() -> Verdict:
    """Return the verdict on axisymmetric extension."""
    above, below = axisymmetric(1)
    worst = (1 + kappa) / 2  # vertex of the parabola, in (0, 1) for kappa < 1
    least = above.subs(y, worst)
    at = {kappa: Rational(2, 5)}  # k = 0.98
    return decide(
        "axisymmetric extension in 3-D",
        "(supposed from plane strain) rigid-plastic flow is ill-posed whatever the flow",
        "κ = k/√6, y = cos² of the angle to the axis: λ < 0 iff `3y² − 3(1+κ)y + 1 + κ > 0`, denominator `1 − κ(3y−1)` "
        "> 0. Discriminant `(1+κ)(9κ−3)` < 0 iff κ < 1/3; else least at y = (1+κ)/2 in (0, 1), where it is "
        "`(1+κ)(1−3κ)/4` and the denominator `(1+κ)(2−3κ)/2` > 0, as k ≤ √2 < 2√6/3",
        [
            ANYTHING.vanishes(above - (3 * y**2 - 3 * (1 + kappa) * y + 1 + kappa)),
            ANYTHING.vanishes(below - (1 - kappa * (3 * y - 1))),
            ANYTHING.vanishes(discriminant(above) - (1 + kappa) * (9 * kappa - 3)),
            ANYTHING.vanishes(diff(above, y).subs(y, worst)),
            ANYTHING.vanishes(least - (1 + kappa) * (1 - 3 * kappa) / 4),
            ANYTHING.vanishes(below.subs(y, worst) - (1 + kappa) * (2 - 3 * kappa) / 2),
            # the denominator is linear in y: at both ends it is positive for 0 <= kappa < 1/3
            ANYTHING.vanishes(below.subs(y, 0) - (1 + kappa)),
            ANYTHING.vanishes(below.subs(y, 1) - (1 - 2 * kappa)),
            sqrt(2) < 2 * sqrt(6) / 3,
            above.subs(y, worst).subs(at) < 0,
        ],
        (
            all(above.subs(kappa, Rational(1, 4)).subs(y, Rational(n, 10)) > 0 for n in range(11)),
            f"k = √6/4: least value of the numerator {digits(least.subs(kappa, Rational(1, 4)))}, at y = 5/8",
        ),
        right="axisymmetric extension is well-posed if k < √(2/3), ill-posed if k > √(2/3); at equality λ/q² reaches 0",
        slip=Kind.HOLDS_IF,
    )


def compression() -> Verdict:
    """Return the verdict on axisymmetric compression."""
    above, below = axisymmetric(-1)
    return decide(
        "axisymmetric compression in 3-D",
        "(not in the paper) axisymmetric compression is well-posed for every angle of friction",
        "λ < 0 iff `3y² − 3(1−κ)y + 1 − κ > 0`; its discriminant `−3(1−κ)(1+3κ)` < 0 and the denominator `1 + κ(3y−1) "
        "≥ 1 − κ` > 0, as κ = k/√6 ≤ 1/√3",
        [
            ANYTHING.vanishes(above - (3 * y**2 - 3 * (1 - kappa) * y + 1 - kappa)),
            ANYTHING.vanishes(discriminant(above) + 3 * (1 - kappa) * (1 + 3 * kappa)),
            ANYTHING.vanishes(below - (1 - kappa) - 3 * kappa * y),
            sqrt(2) / sqrt(6) < 1,
        ],
    )


def plane_strain() -> Verdict:
    """Return the verdict on plane strain."""
    s, z = symbols("s z", positive=True)  # s = k/sqrt 2; 0 < z < 1
    inside = rate(s * z / sqrt(2), Rational(1, 2)).subs(k, sqrt(2) * s)
    return decide(
        "plane strain in 3-D",
        "(section 3) ill-posed for every angle of friction",
        "χ in the plane of flow, `χ·Aχ = sz/√2` with 0 < z < 1, s = k/√2: `λ = (μq²/2) s² z(1−z)/(1 − s²z)` > 0",
        [ANYTHING.vanishes(inside - s**2 * z * (1 - z) / (2 * (1 - s**2 * z)))],
    )


def verdicts() -> list[Verdict]:
    """Return the verdicts of this group."""
    return [symbol_in_space(), extension(), compression(), plane_strain()]


if __name__ == "__main__":
    show(verdicts())
