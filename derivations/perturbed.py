"""Section 4: the singularly perturbed equations, (P1) to (P4.5)."""

from sympy import I, Matrix, Rational, eye

from derivations.algebra import ANYTHING, Given, compare, decide, digits
from derivations.constitutive import contraction, short
from derivations.frames import K_DRAG, TWO, UNIT, XI, X, Y, a, b, chi, d, delta, tensor_A, xi
from derivations.plane_waves import printed_B, printed_C, printed_M
from derivations.verdict import Kind, Verdict, show
from stability.closures.drucker_prager import PERTURBED, RIGID_PLASTIC, stress
from stability.closures.plane_flow import V
from stability.linearise import imbalance, pencil
from stability.symbols import epsilon, gradient, hessian, k, mu, norm_V, p, q, symbol, u, v
from stability.tangent import blocks, tangent

TITLE = "Singularly perturbed equations (section 4)"
NORM = Given(relations=((norm_V, norm_V**2 - sum(e**2 for e in V)),))
trace = V.trace()
deviator = V - trace / 2 * eye(2)
laplacian_p = hessian(p)[0][0] + hessian(p)[1][1]


def equations() -> list[Verdict]:
    """Return the verdicts on (P1), (P1.1) and on what they say of yield."""
    laws, rigid = (short(imbalance(c)) for c in (PERTURBED, RIGID_PLASTIC))
    fast = tangent(PERTURBED, (q, 0), "truncated").trace().subs(mu, 0)
    in_letters = -p * K_DRAG  # p(1 - kA)
    mean = in_letters.trace() / 2
    excess = contraction(in_letters - mean * eye(2), in_letters - mean * eye(2)) - k**2 * mean**2
    gap = k**2 * p**2 * delta * (4 * k - delta * (2 + k**2)) / 4
    example = gap.subs({k: Rational(4, 5), p: 1, delta: Rational(1, 2)})
    return [
        compare(
            "P1",
            "`Du^i/Dt = g^i − ∇_j(p δ^ij − k p A^ij)`",
            (laws[:2, :], rigid[:2, :]),
            note="the momentum of (I7) with A = V/‖V‖ of the full V; a model of its own, not the flow rule (P1.2)",
        ),
        compare(
            "P1.1",
            "`∇_i u^i = ε Δp`",
            (trace - epsilon * laplacian_p, laws[2]),
            note="the damping sign: alone it gives the rate `−(1 − ka)/ε`, a = χ·A·χ; ε is a time",
            proofs=[ANYTHING.vanishes(fast + (1 - k * a) / epsilon)],
        ),
        decide(
            "yield of (P1)",
            "(P1), (P1.1) satisfy the yield condition (I2)",
            "with the full A the mean stress is `p(1 − kδ/2)` and the yield function about it `k²p² δ(4k − δ(2 + "
            "k²))/4`: violated for 0 < δ < 4k/(2 + k²)",
            [
                NORM.vanishes(short(stress) - in_letters.xreplace(dict(zip(tensor_A, V / norm_V, strict=True)))),
                UNIT.vanishes(mean - p * (1 - k * (a + d) / 2)),
                UNIT.vanishes(excess - gap.subs(delta, a + d)),
            ],
            (example > 0, f"k = 4/5, δ = 1/2, p = 1: yield function +{digits(example)}"),
            right="if A in (P1) is the deviator's, as in (P1.2)",
            slip=Kind.HOLDS_IF,
        ),
    ]


def flow_rule() -> list[Verdict]:
    """Return the verdicts on (P1.2), (P1.3), |delta| <= sqrt 2 and (P4.5)."""
    power = {sign: -contraction(sign * mu * deviator, V) for sign in (1, -1)}
    point = {gradient(u)[0]: 1, gradient(u)[1]: 0, gradient(v)[0]: 0, gradient(v)[1]: 0, mu: 1}
    shear = contraction(mu * deviator, mu * deviator).subs(mu, k * p / norm_V)  # (I5)
    printed = k**2 * p**2 * (1 - (trace / norm_V) ** 2 / 2)
    full_shear = contraction(short(stress) - p * eye(2), short(stress) - p * eye(2))
    mass = short(imbalance(PERTURBED))[2]
    return [
        decide(
            "P1.2",
            "`σ_ij − p δ_ij = + μ(V_ij − Tr V δ_ij/2)`",
            "the dissipation `−(σ_ij − p δ_ij)V_ij` is `∓μ(‖V‖² − (Tr V)²/2)`, − as printed: the slip of (I4)",
            [NORM.vanishes(power[sign] + sign * mu * (norm_V**2 - trace**2 / 2)) for sign in (1, -1)],
            (
                power[1].subs(point) < 0,
                f"∂_x u = 1, the rest 0, μ = 1: dissipation {digits(power[1].subs(point))} "
                f"as printed, {digits(power[-1].subs(point))} right",
            ),
            right="`σ_ij/ρ − p δ_ij = − μ(V_ij − Tr V δ_ij/2)`",
            slip=Kind.MISPRINT,
        ),
        compare(
            "P1.3",
            "`k²p² ≥ (σ_ij − p δ_ij)² = k²p²(1 − δ²/2)`",
            (printed, shear),
            NORM,
            modulo="`‖V‖² = V:V`",
            note="for (P1.2), δ = Tr V/‖V‖; for (P1) itself it is k²p² identically",
            proofs=[NORM.vanishes(full_shear - k**2 * p**2)],
        ),
        decide(
            "∣δ∣ ≤ √2",
            "`∣δ∣ ≤ √2`",
            "`2 − (tr A)² = (A_xx − A_yy)² + 4A_xy²` modulo `A:A = 1`",
            [UNIT.vanishes(2 - (a + d) ** 2 - (a - d) ** 2 - 4 * b**2)],
        ),
        compare(
            "P4.5",
            "`δ = ε Δp/‖V‖`",
            (epsilon * laplacian_p / norm_V, (trace - mass) / norm_V),
            note="= tr A, which is what enters D, wherever the background satisfies (P1.1)",
        ),
    ]


def plane_waves() -> list[Verdict]:
    """Return the verdicts on (P2) to (P4)."""
    C, B, row, corner = blocks(PERTURBED, pencil(PERTURBED).L(XI))
    square = (xi.T * xi)[0]
    alpha = symbol("alpha")
    found = corner[0] * alpha / I  # 0 = row.a + corner alpha with row = -i xi
    wave = (q * X, q * Y)
    leading = Matrix(
        2, 2, lambda i, j: -mu * q**2 * sum(printed_M(i, j, m, l) * chi[m] * chi[l] for m in TWO for l in TWO)
    )
    return [
        compare(
            "P2",
            "`λ a_i = B_i α + C_ij a^j`",
            (printed_C(closure=PERTURBED).row_join(printed_B(PERTURBED)), C.row_join(B)),
            note="with (L2.2) and (L2.3), M_ijkl corrected",
        ),
        compare(
            "P2.1",
            "`ξ·a = −i ε ξ² α`",
            (-I * epsilon * square * alpha, found),
            right="`ξ·a = + i ε ξ² α`",
            corrected=I * epsilon * square * alpha,
            note="the third row of the pencil",
            proofs=[ANYTHING.vanishes(row + I * xi.T)],
        ),
        compare(
            "P3",
            "`D_ij = C_ij − i B_i ξ_j/(ε ξ²)`",
            (C - I * B * xi.T / (epsilon * square), tangent(PERTURBED, XI)),
            note='needs the right sign of (P2.1); the text\'s "eliminate α from (P2)" should cite (P2.1)',
        ),
        compare(
            "P4",
            "`M_ij = −(μξ²/Fr²) M_ijkl χ^k χ^l`",
            (leading, tangent(PERTURBED, wave, "leading")),
            note="Fr = 1; the slip in M_ijkl does not matter here",
        ),
    ]


def verdicts() -> list[Verdict]:
    """Return the verdicts of this group."""
    rule = flow_rule()
    return [*equations(), *rule[:-1], *plane_waves(), rule[-1]]


if __name__ == "__main__":
    show(verdicts())
