"""Section 3: growth rate and ill-posedness of rigid-plastic flow, (L4) and (L5)."""

from sympy import Expr, I, Matrix, Poly, Rational, cancel, cos, diff, eye, fraction, pi, sin, sqrt, together

from derivations.algebra import ANYTHING, compare, decide, digits
from derivations.background import GEOMETRY, at, eigenvalues, state
from derivations.frames import (
    AT_YIELD,
    FLAT,
    FLAT_SMOOTH,
    K_DRAG,
    TWO,
    X,
    Y,
    c,
    chi,
    contracted,
    s_f,
    tensor_A,
    velocity,
    xi,
)
from derivations.plane_waves import printed_B, printed_C
from derivations.verdict import Kind, UnprovedError, Verdict, show
from stability.closures.drucker_prager import RIGID_PLASTIC
from stability.flows.radial_hopper import RADIAL_HOPPER
from stability.linearise import along
from stability.symbols import A, gradient, k, mu, q, symbol, u, v
from stability.tangent import WAVE, tangent

TITLE = "Growth rate of rigid-plastic flow (section 3)"
SMOOTH = "`A:A = 1, tr A = 0`, their gradients and div u = 0"


def slope(expression: Expr, axis: int) -> Expr:
    """Return the derivative along the base state."""
    return along(RIGID_PLASTIC, expression, axis)


def second_line(factor: Expr, missing: Expr) -> Expr:
    """Return the second line of (L4) times xi.B, Fr = 1, with q_k read as -mu xi_k + i d_k mu.

    ``factor`` multiplies the second term in the bracket and ``missing`` is added: 1 and 0 as printed.
    """
    B = printed_B()
    q_ = [-mu * xi[m] + I * gradient(mu)[m] for m in TWO]
    bracket = sum(
        xi[i]
        * B[j]
        * (
            gradient(velocity[i])[j]
            + factor * sum(A[i, m] * xi[l] * slope(A[j, l], m) for m in TWO for l in TWO)
            + A[i, j] * sum(xi[l] * (A[l, m] * q_[m] + I * mu * slope(A[l, m], m)) for m in TWO for l in TWO)
        )
        for i in TWO
        for j in TWO
    )
    return -I * (u * xi[0] + v * xi[1]) * (xi.T * B)[0] + bracket + missing


def trace() -> list[Verdict]:
    """Return the verdicts on both lines of (L4)."""
    B, C = printed_B(), printed_C()
    along_xi = (xi.T * B)[0]
    names = Matrix(2, 2, [symbol(f"C_{i}{j}") for i in "xy" for j in "xy"]), Matrix([symbol("B_x"), symbol("B_y")])
    short = ((eye(2) - names[1] * xi.T / (xi.T * names[1])[0]) * names[0]).trace()
    first = names[0].trace() - (xi.T * names[0] * names[1])[0] / (xi.T * names[1])[0]
    times = C.trace() * along_xi - (xi.T * C * B)[0]  # (xi.B) Tr D
    grad_mu = Matrix(gradient(mu))
    gap = I / 2 * ((xi.T * grad_mu)[0] * along_xi - (xi.T * xi)[0] * (B.T * grad_mu)[0])
    return [
        compare("L4", "`Tr D = Tr C − C_ij ξ^i B^j/(ξ·B)`", (first, short), note="from (L3.1)"),
        compare(
            "L4, premises",
            "`A_ij = A_ji`, `A_ii = 0`, `Tr(A_ik A_kj) = 1`",
            (Matrix([tensor_A.trace(), (tensor_A * tensor_A).trace(), A[0, 1]]), Matrix([0, 1, A[1, 0]])),
            FLAT,
            note="the package's relations of the rigid-plastic closure",
        ),
        compare(
            "L4, second line",
            "`−i u·ξ + ξ^i B^j/(ξ·B) (∇_j u_i + A_ik ξ^l ∇^k A_jl + A_ij ξ_l(A^lk q_k + i μ ∇_k A^lk)`",
            (second_line(Rational(1), Rational(0)), times),
            FLAT_SMOOTH,
            right="`−i u·ξ + (ξ·B)⁻¹ {ξ^i B^j [∇_j u_i "
            "+ Fr⁻²(iμ A_ik ξ^l ∇^k A_jl + A_ij ξ_l(A^lk q_k + iμ ∇_k A^lk))] "
            "+ (i/2)Fr⁻²[(ξ·∇μ)(ξ·B) − ξ² B·∇μ]}`, `q_k = −μ ξ_k + i ∇_k μ`",
            corrected=second_line(I * mu, gap),
            slip=Kind.FAILS,
            modulo=SMOOTH,
            note="compared after multiplication by ξ·B, Fr = 1; q_k is undefined and is read as on the right; iμ, "
            "Fr⁻² and the whole last term are missing, a bracket is not closed; iμ alone does not repair it",
            proofs=[not FLAT_SMOOTH.vanishes(second_line(I * mu, Rational(0)) - times)],
        ),
    ]


def short_wave() -> Expr:
    """Return the coefficient of q^2 in Tr D at large q, from the full tangent matrix in the frame of the wave."""
    numerator, denominator = (Poly(e, q) for e in fraction(together(tangent(RIGID_PLASTIC, WAVE_Q).trace())))
    if numerator.degree() - denominator.degree() != 2:
        raise UnprovedError("Tr D does not grow as q^2")
    return numerator.LC() / denominator.LC()


WAVE_Q = (q * WAVE[0], q * WAVE[1])


def leading() -> list[Verdict]:
    """Return the verdicts on (L5), its denominator, its zeros and the wedges."""
    drag = -K_DRAG
    below = contracted(chi, drag, chi)
    printed = -mu * contracted(chi, tensor_A, chi) * contracted(chi, drag * tensor_A, chi) / below  # (L5)
    general = tangent(RIGID_PLASTIC, (q * X, q * Y), "leading").trace() / q**2
    in_frame = AT_YIELD.remainder
    closed = -mu / 2 * c * (c + s_f) / (1 + s_f * c)
    y, t = symbol("y"), symbol("t")  # t = tan(phi_f/2)
    rate = (closed / mu).subs(k, sqrt(2) * 2 * t / (1 + t**2))
    best, angle = rate.subs(c, -t), symbol("phi_f")
    lower = contracted(chi, drag, chi).subs({X: 1, Y: 0}).xreplace(AT_YIELD.substitution)  # 1 + s_f c
    right_angle = lower.subs({k: sqrt(2), c: -1})
    zero = (c * (c + s_f)).subs(k, sqrt(2) * sin(angle))
    plus, minus = (zero.subs(c, cos(2 * (pi / 4 + sign * angle / 2))) for sign in (1, -1))
    minus_value = closed.subs({k: sqrt(2) / 2, c: Rational(1, 2)})
    return [
        compare(
            "L5",
            "`−μ (χ·A·χ)(χ·(1−kA)A·χ)/(χ·(1−kA)·χ)`",
            (printed, general),
            FLAT,
            modulo="`A:A = 1, tr A = 0, χ² = 1`",
            note="the q² part of the full Tr D; the factor Fr⁻² is dropped; equals `−(μ/2) c(c + s_f)/(1 + s_f "
            "c)`, c = cos 2φ",
            proofs=[FLAT.vanishes(short_wave() - general.subs({X: 1, Y: 0})), in_frame(short_wave() - closed) == 0],
        ),
        decide(
            "denominator of (L5)",
            "always positive for angles of friction φ_f > 0",
            "it is `1 + s_f c = (1 − s_f) + s_f(1 + c)`",
            [ANYTHING.vanishes(lower - ((1 - s_f) + s_f * (1 + c))), lower.subs(k, 0) == 1],
            (right_angle <= 0, f"φ_f = 90°, c = −1: {digits(right_angle)}; φ_f = 0: {digits(lower.subs(k, 0))}"),
            right="positive for every φ_f < 90°, φ_f = 0 included",
            slip=Kind.MISPRINT,
        ),
        decide(
            "zeros of (L5)",
            "χ along the velocity (±45°) or the stress characteristics, (±φ_f + 90°)/2 from the "
            "principal stress directions",
            "`c(c + s_f) = 0`; 45° − φ_f/2 is the angle from the minor axis",
            [plus.trigsimp() == 0 or plus.rewrite(cos).simplify() == 0],
            (minus.subs(angle, pi / 6) != 0, f"φ_f = 30°, φ = 45° − φ_f/2 = 30°: (L5)/μ = {digits(minus_value / mu)}"),
            right="if χ is the *normal* of the characteristic, at ±45° or ±(45° + φ_f/2) from the *major* axis",
            slip=Kind.HOLDS_IF,
        ),
        decide(
            "wedges of (L5)",
            "unstable at short waves between stress and velocity characteristic directions",
            "(L5) > 0 iff −s_f < c < 0, i.e. `45° < φ < 45° + φ_f/2`: four wedges; largest `(μq²/2) tan²(φ_f/2)` at "
            "`c = −tan(φ_f/2)`; growth ~ q², so Hadamard ill-posed",
            # For 0 < y < 1: inside the wedge, beyond its stress edge, beyond its velocity edge.
            [
                ANYTHING.vanishes((closed / mu).subs(c, -s_f * y) - s_f**2 * y * (1 - y) / (2 * (1 - s_f**2 * y))),
                ANYTHING.vanishes((closed / mu).subs(c, -s_f - y) + y * (s_f + y) / (2 * (1 - s_f * (s_f + y)))),
                ANYTHING.vanishes((closed / mu).subs(c, y) + y * (s_f + y) / (2 * (1 + s_f * y))),
                cancel(diff(rate, c).subs(c, -t)) == 0,
                cancel(best - t**2 / 2) == 0,
            ],
        ),
    ]


def figure_L1() -> Verdict:
    """Return the verdict on the caption of figure L1."""
    background = state(RADIAL_HOPPER, at(1))
    # On the axis the major principal stress acts along e_theta: phi = 0 is the wave angle 90 degrees.
    long_wave, short_wave_ = (
        eigenvalues(RIGID_PLASTIC, background, wavenumber, pi / 2)[0].as_real_imag()[0]
        for wavenumber in (Rational(1, 10), 1000)
    )
    return decide(
        "figure L1, caption",
        "inside the wedges λ_2 > 0, outside λ_2 < 0",
        "Tr D on the radial background, r = 1 m, θ = 0, direction φ = 0 (outside the wedges), " + GEOMETRY,
        [short_wave_ < 0],
        (long_wave > 0, f"|ξ| = 0.1 /m: Re λ_2 = {digits(long_wave)} /s; |ξ| = 1000 /m: {digits(short_wave_)} /s"),
        right="for |ξ| large; at wavelengths beyond the hopper's size λ_2 > 0 outside too",
        slip=Kind.HOLDS_IF,
    )


def verdicts() -> list[Verdict]:
    """Return the verdicts of this group."""
    return [*trace(), *leading(), figure_L1()]


if __name__ == "__main__":
    show(verdicts())
