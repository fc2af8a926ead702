"""Section 4: trace and determinant of M, (P5), (P6), and what follows from them."""

from sympy import Matrix, symbols

from derivations.algebra import ANYTHING, Given, compare, decide
from derivations.frames import ANGLES, BY, PRINCIPAL, UNIT, WAVE, Lambda, S, b, c, d, delta, s, tensor_A
from derivations.verdict import Verdict, show
from stability.closures.drucker_prager import PERTURBED
from stability.tangent import tangent

TITLE = "Trace and determinant of M (section 4)"
M = tangent(PERTURBED, WAVE, "leading")


def verdicts() -> list[Verdict]:
    """Return the verdicts on (P5), (P6) and what follows from them."""
    printed_trace = -Lambda * (2 + delta * s * c)  # (P5)
    printed_det = Lambda**2 / 2 * (s * c + delta) ** 2  # (P6)
    # The major principal stress axis m lies at the angle -phi from chi: p(1 - kA) has its greater value along m.
    cosine, sine = symbols("cos_phi sin_phi", real=True)
    m = Matrix([cosine, -sine])
    A_phi = tensor_A.xreplace(PRINCIPAL.substitution).xreplace({c: cosine**2 - sine**2, S: 2 * sine * cosine})
    circle = Given(relations=((cosine, cosine**2 + sine**2 - 1),))
    zero = PRINCIPAL.substitution[d].subs(c, -delta / s)  # Det M = 2 Lambda^2 d^2
    reach = s**2 - delta**2 - 2 * (1 - delta**2)
    return [
        compare(
            "P5",
            "`Tr M = −Λ(2 + δ√(2−δ²) cos 2φ)`",
            (printed_trace, M.trace()),
            PRINCIPAL,
            modulo=ANGLES,
            note="full A; φ from the *major* principal stress axis: from the minor one cos 2φ changes sign",
            proofs=[circle.vanishes(A_phi * m - (delta - s) / 2 * m)],
        ),
        compare(
            "P6",
            "`Det M = (Λ²/2)(√(2−δ²) cos 2φ + δ)²`",
            (printed_det, M.det()),
            PRINCIPAL,
            modulo=ANGLES,
            note="= `2Λ²d²`: zero iff the wavefront is a line of zero extension",
        ),
        decide(
            "(P5) is always negative",
            "the trace of M is always negative",
            f"`Tr M = −Λ(1 + 2b² + 2d²)` modulo {BY}: a sum of squares",
            [UNIT.vanishes(M.trace() + Lambda * (1 + 2 * b**2 + 2 * d**2))],
        ),
        decide(
            "Det M is non-negative",
            "Det M is non-negative, strictly positive if ∣δ∣ > √(2−δ²)",
            f"`Det M = 2Λ²d²` modulo {BY}; d = (δ + C)/2 and ∣C∣ ≤ √(2−δ²)",
            [UNIT.vanishes(M.det() - 2 * Lambda**2 * d**2)],
        ),
        decide(
            "four zero directions",
            "one eigenvalue of M vanishes where cos 2φ = −δ/√(2−δ²), if ∣δ∣ < √(2−δ²): four directions",
            "d = 0 there; `(2 − δ²) − δ² = 2(1 − δ²)`, so four if ∣δ∣ < 1, two if ∣δ∣ = 1, none if ∣δ∣ > 1",
            [ANYTHING.vanishes(zero), PRINCIPAL.vanishes(reach)],
        ),
    ]


if __name__ == "__main__":
    show(verdicts())
