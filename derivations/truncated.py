"""Section 6: the truncation D' (P7), its trace and determinant, (P8T) to (P9), and the sentences after (P9)."""

from sympy import Rational, eye, sqrt

from derivations.algebra import ANYTHING, compare, decide, digits
from derivations.frames import (
    ANGLES,
    BY,
    K_DRAG,
    PRINCIPAL,
    UNIT,
    WAVE,
    Lambda,
    X,
    Y,
    a,
    b,
    c,
    chi,
    d,
    delta,
    s,
)
from derivations.leading import M
from derivations.verdict import Kind, Verdict, show
from stability.closures.drucker_prager import PERTURBED
from stability.symbols import epsilon, k, mu, q
from stability.tangent import tangent

TITLE = "The truncation D' (section 6)"
D = tangent(PERTURBED, WAVE, "truncated")
C = s * c
L = Lambda * epsilon


def equations() -> list[Verdict]:
    """Return the verdicts on (P7) to (P9) and the sentences after (P9)."""
    wave = (q * X, q * Y)
    printed_D = tangent(PERTURBED, wave, "leading") + K_DRAG * chi * chi.T / epsilon  # (P7)
    printed_trace = M.trace() - (1 + k / 2 * (C - delta)) / epsilon  # (P8T)
    bracket = C**2 + k * C + delta * (delta - k)
    printed_det = M.det() + Lambda / epsilon * bracket  # (P8D)
    null = {d: 0, b: sqrt((1 - a**2) / 2), a: delta}  # Det M = 0: d = 0, hence a = delta
    there = D.det().subs(null).subs(null).factor()
    printed_there = 2 * Lambda / epsilon * delta * (delta - k)  # (P9)
    example = {k: Rational(6, 5), delta: Rational(11, 10), mu: 1, q: 1}
    det_M_least = (Lambda**2 / 2 * (delta - s) ** 2).subs(s, sqrt(2 - delta**2)).subs(example)  # at C = -s
    return [
        compare(
            "P7",
            "`D'_ij = M_ij + (1/ε)(k A_ik − δ_ik) χ^k χ_j`",
            (printed_D, tangent(PERTURBED, wave, "truncated")),
            UNIT,
            modulo="`χ² = 1`",
            note="Fr = 1; in general Fr⁻² on both terms",
        ),
        compare(
            "P8T",
            "`Tr D' = Tr M − (1/ε)(1 + (k/2)(√(2−δ²) cos 2φ − δ))`",
            (printed_trace, D.trace()),
            PRINCIPAL,
            modulo=ANGLES,
        ),
        compare(
            "P8D",
            "`Det D' = Det M + (Λ/ε)((2−δ²)cos² 2φ + k√(2−δ²) cos 2φ + δ(δ−k))`",
            (printed_det, D.det()),
            PRINCIPAL,
            right="`Det D' = Det M + (Λ/2ε)(...)`, the same bracket",
            corrected=M.det() + Lambda / (2 * epsilon) * bracket,
            modulo=ANGLES,
            note="= `(L/ε²)[(1 + 2L)d² + a² − ka]`, L = Λε",
            proofs=[UNIT.vanishes(D.det() - L / epsilon**2 * ((1 + 2 * L) * d**2 + a**2 - k * a))],
        ),
        compare(
            "P9",
            "`Det D' ~ (2Λ/ε) δ(δ−k)` where Det M = 0",
            (printed_there, there),
            right="`Det D' = (Λ/ε) δ(δ−k)`, exactly and at every wavelength",
            corrected=Lambda / epsilon * delta * (delta - k),
            note="d = 0, a = δ, 2b² = 1 − δ²",
        ),
        decide(
            "after (P9): positive eigenvalue",
            "D' has a positive eigenvalue where Det M vanishes, if 0 < δ < k",
            "Det D' < 0 by (P9); d = 0 needs `2b² = 1 − δ² ≥ 0`",
            [ANYTHING.vanishes(there - Lambda / epsilon * delta * (delta - k))],
            (
                det_M_least > 0,
                f"k = 6/5, δ = 11/10, Λ = 1/2: the least Det M over all directions is {digits(det_M_least)}",
            ),
            right="if also δ ≤ 1: above, Det M never vanishes",
            slip=Kind.HOLDS_IF,
        ),
        bounded(),
    ]


def bounded() -> Verdict:
    """Return the verdict on "ill-posed along these directions": D' never grows faster than k^2/(4 epsilon)."""
    drag = (D - M).applyfunc(lambda e: e * epsilon)  # epsilon (kA - 1) chi chi^T
    bound = k**2 / 4
    form = bound * eye(2) - (drag + drag.T) / 2  # >= 0, with M <= 0, implies Re lambda(D') <= k^2/(4 epsilon)
    return decide(
        "after (P9): ill-posed",
        "(P1), (P1.1) can become ill-posed along the directions where Det M vanishes",
        f"M is symmetric, ≤ 0; `k²/4 − ε sym((1/ε)(kA−1)χχᵀ)` has determinant `(k²/4)[(k/2 − a)² + b² + d²]` and trace "
        f"`[(k − a)² + 1 + 2b² + d²]/2`, both ≥ 0 modulo {BY}",
        [
            M.is_symmetric(),
            UNIT.vanishes(M.trace() + Lambda * (1 + 2 * b**2 + 2 * d**2)),
            UNIT.vanishes(M.det() - 2 * Lambda**2 * d**2),
            UNIT.vanishes(form.det() - bound * ((k / 2 - a) ** 2 + b**2 + d**2)),
            UNIT.vanishes(form.trace() - ((k - a) ** 2 + 1 + 2 * b**2 + d**2) / 2),
        ],
        growth_at(Rational(4, 5), Rational(2, 5)),
        right="if the definition of section 3 is meant (unstable at arbitrarily short waves); not in Hadamard's sense: "
        "`Re λ(D') ≤ k²/(4ε)` for every δ, direction and wavelength",
        slip=Kind.HOLDS_IF,
    )


def growth_at(friction: Rational, dilation: Rational) -> tuple[bool, str]:
    """Return whether epsilon lambda stays below k^2/4 in the null direction at L = 10^3 and 10^9."""
    b_null = sqrt((1 - dilation**2) / 2)
    values = []
    for L_value in (10**3, 10**9):
        here = {k: friction, a: dilation, b: b_null, d: 0, epsilon: 1, mu: 2 * L_value, q: 1}
        half = (D.trace() / 2).subs(here)
        values.append((half + sqrt(half**2 - D.det().subs(here))).evalf(60))
    where = (
        f"k = {friction}, δ = {dilation}, direction Det M = 0: ελ = {digits(values[0])} at L = 10³, "
        f"{digits(values[1])} at L = 10⁹; k²/4 = {digits(friction**2 / 4)}"
    )
    return 0 < values[0] < values[1] < friction**2 / 4, where


def verdicts() -> list[Verdict]:
    """Return the verdicts of this group."""
    return [*equations()]


if __name__ == "__main__":
    show(verdicts())
