"""Section 4: the flow rule (P1.2) that the text offers for (P1), and a third one: what they do to short waves.

The closures are written down here as the package writes its own; pencil and tangent matrix are the package's.
"""

from sympy import Rational, eye, sqrt

from derivations.algebra import Given, compare, decide, digits
from derivations.frames import ANGLES, PRINCIPAL, UNIT, WAVE, Lambda, a, b, c, d, delta, s
from derivations.verdict import Kind, Verdict, show
from stability.closures.base import Closure, norm
from stability.closures.drucker_prager import LETTERS, PERTURBED
from stability.closures.plane_flow import V, grad_p, momentum_and_mass, velocity
from stability.symbols import A, epsilon, k, mu, norm_V, p
from stability.tangent import tangent

TITLE = "Two flow rules (sections 4 and 7)"
deviator = V - V.trace() / 2 * eye(2)
C = s * c


def perturbed(name: str, size, letters: dict) -> Closure:
    """Return the perturbed closure (P1), (P1.1) with the stress p - k p dev V/size."""
    laws = momentum_and_mass(p * eye(2) - k * p * deviator / size, velocity - epsilon * grad_p)
    return Closure(
        name=name, title=name, source="paper, (P1.2)", **laws, parameters=PERTURBED.parameters, letters=letters
    )


DEVIATORIC = perturbed("deviatoric", norm(V), LETTERS)  # (P1.2) with (I5), its sign corrected
SELF_NORMED = perturbed(
    "self_normed",
    norm(deviator),
    {
        k: LETTERS[k],
        norm_V: norm(deviator),
        A[0, 0]: deviator[0, 0] / norm_V,
        A[0, 1]: deviator[0, 1] / norm_V,
        mu: k * p / norm_V,
    },
)
PURE_SHEAR = Given(relations=((b, 2 * a**2 + 2 * b**2 - 1),))


def stress_of_P5() -> list[Verdict]:
    """Return the verdicts on "the stress is defined by equation (P1.2)" after (P6)."""
    M, D = (tangent(DEVIATORIC, WAVE, matrix) for matrix in ("leading", "truncated"))
    printed_trace = -Lambda * (2 + delta * C)  # (P5)
    right_trace = -Lambda * (1 + delta * (delta + C) / 2)
    right_det = Lambda**2 / 2 * delta * (delta + C)
    pure = [
        PRINCIPAL.vanishes(M.det() - right_det),
        PRINCIPAL.vanishes(D.trace() - right_trace + (1 + k * C / 2) / epsilon),
        PRINCIPAL.vanishes(D.det() - right_det - Lambda / (2 * epsilon) * (C**2 + k * C + delta**2)),
    ]
    return [
        compare(
            "(P5), (P6) with (P1.2)",
            "in (P5), (P6) the stress is defined by (P1.2)",
            (printed_trace, M.trace()),
            PRINCIPAL,
            right="(P5) to (P9) are those of (P1), full A; "
            "(P1.2) gives `Tr M = −Λ(1 + δ(δ+C)/2)`, `Det M = (Λ²/2) δ(δ+C)`",
            corrected=right_trace,
            slip=Kind.FAILS,
            modulo=ANGLES,
            proofs=pure,
            note="(P1.2) also gives `Tr D' = Tr M − (1 + kC/2)/ε`, `Det D' = Det M + (Λ/2ε)(C² + kC + δ²)`; "
            "the rules agree where δ = 0 and ξ·a = 0",
        ),
    ]


def wedge() -> Verdict:
    """Return the verdict on "collapsing the wedge of wave directions" (Discussion)."""
    full, M = (tangent(closure, WAVE, "leading") for closure in (PERTURBED, DEVIATORIC))
    positive = -Lambda * delta * (delta + C) / 2
    worst = positive.subs(c, -1).subs(s, sqrt(2 - delta**2)) / Lambda
    example = worst.subs(delta, Rational(1, 2))
    own = tangent(SELF_NORMED, WAVE, "leading")
    sum_of_squares = [
        UNIT.vanishes(full.trace() + Lambda * (1 + 2 * b**2 + 2 * d**2)),
        UNIT.vanishes(full.det() - 2 * Lambda**2 * d**2),
    ]
    return decide(
        '"collapsing the wedge"',
        "the perturbation regularises the ill-posedness by collapsing the wedge of unstable directions",
        "M ≤ 0 for the full rule; for (P1.2) M has the eigenvalues −Λ and `−Λδ(δ+C)/2` > 0 in a wedge, up to "
        "`∣δ∣(√(2−δ²) − ∣δ∣)Λ/2`; none if ∣δ∣ ≥ 1; dev V over its own norm leaves an eigenvalue 0 of M in every "
        "direction",
        [
            *sum_of_squares,
            PRINCIPAL.vanishes(M.trace() - (-Lambda + positive)),
            PRINCIPAL.vanishes(M.det() + Lambda * positive),
            worst.subs(delta, 1) == 0,
            PURE_SHEAR.vanishes(own.det()),
            PURE_SHEAR.vanishes(own.trace() + Lambda),
        ],
        (example > 0, f"(P1.2), δ = 1/2, C = −√(2−δ²): λ/Λ = +{digits(example)} at every wavelength"),
        right="if A in (P1) is V/‖V‖ of the full V; with the deviator of (P1.2) the problem is Hadamard ill-posed for "
        "every 0 < ∣δ∣ < 1",
        slip=Kind.HOLDS_IF,
    )


def verdicts() -> list[Verdict]:
    """Return the verdicts of this group."""
    return [*stress_of_P5(), wedge()]


if __name__ == "__main__":
    show(verdicts())
