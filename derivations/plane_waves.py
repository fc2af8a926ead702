"""Section 3: plane waves, (L2) to (L3.2) and M_ijkl, against the pencil the package derives."""

from collections.abc import Callable
from itertools import product

from sympy import Expr, I, Matrix, diag, eye, solve, symbols

from derivations.algebra import ANYTHING, compare, decide
from derivations.frames import FLAT_SMOOTH, TWO, UNIT, XI, dirac, symmetriser, velocity, xi
from derivations.verdict import Kind, Verdict, inspected, show
from stability.closures.base import Closure
from stability.closures.drucker_prager import RIGID_PLASTIC
from stability.linearise import along, pencil
from stability.symbols import A, gradient, k, mu, symbol, u, v
from stability.tangent import blocks, tangent

TITLE = "Plane waves (section 3)"
Fourth = Callable[[int, int, int, int], Expr]  # M_ijkl


def printed_M(i: int, j: int, k_: int, l: int) -> Expr:
    """Return M_ijkl as printed below (L2.3)."""
    return symmetriser(i, j, l, k_) - A[i, l] * A[j, k_]


def right_M(i: int, j: int, k_: int, l: int) -> Expr:
    """Return M_ijkl with the second pair of indices in the right order."""
    return symmetriser(i, j, l, k_) - A[i, k_] * A[j, l]


def printed_B(closure: Closure = RIGID_PLASTIC) -> Matrix:
    """Return B_i of (L2.2), Fr = 1."""
    return Matrix(
        [sum(k * along(closure, A[i, j], j) + I * (k * A[i, j] - dirac(i, j)) * xi[j] for j in TWO) for i in TWO]
    )


def printed_C(M: Fourth = right_M, closure: Closure = RIGID_PLASTIC) -> Matrix:
    """Return C_ij of (L2.3), Fr = 1, for a given M_ijkl."""

    def entry(i: int, j: int) -> Expr:
        inertia = -(gradient(velocity[i])[j] + I * (xi[0] * u + xi[1] * v) * dirac(i, j))
        return inertia + sum(
            xi[l] * (-mu * M(i, j, m, l) * xi[m] + I * along(closure, mu * M(i, j, m, l), m)) for m in TWO for l in TWO
        )

    return Matrix(2, 2, entry)


def plane_waves() -> list[Verdict]:
    """Return the verdicts on (L2) to (L2.3) and M_ijkl."""
    P = pencil(RIGID_PLASTIC)
    C, B, row, corner = blocks(RIGID_PLASTIC, P.L(XI))
    swapped = printed_C(lambda i, j, m, l: printed_M(i, j, l, m))
    error = I / 2 * (xi[0] * gradient(mu)[1] - xi[1] * gradient(mu)[0])
    indices = list(product(TWO, repeat=4))
    package = Matrix([blocks(RIGID_PLASTIC, P.L2[m][l])[0][i, j] / mu for i, j, m, l in indices])
    all_right, all_printed = (Matrix([M(*index) for index in indices]) for M in (right_M, printed_M))
    twice = [
        sum(xi[m] * xi[l] * (printed_M(i, j, m, l) - right_M(i, j, m, l)) for m in TWO for l in TWO)
        for i in TWO
        for j in TWO
    ]
    return [
        decide(
            "L2",
            "`λ a_i = B_i α + C_ij a^j`",
            "the first two rows of the package's pencil `λ E a = L(ξ) a`, E = diag(1, 1, 0)",
            [P.E == diag(1, 1, 0)],
        ),
        compare(
            "L2.1",
            "`ξ·a = 0`",
            (xi.T, I * row),
            note="the third row, which does not see α",
            proofs=[corner.is_zero_matrix],
        ),
        compare(
            "L2.2",
            "`B_i = Fr⁻² (k ∇^j A_ij + i(k A_ij − δ_ij) ξ^j)`",
            (printed_B(), B),
            note="exact about any smooth background, tr A ≠ 0 included",
        ),
        compare(
            "L2.3",
            "`C_ij = −(∇_j u_i + i ξ·u δ_ij) + Fr⁻² ξ^l(−μ M_ijkl ξ^k + i ∇^k(μ M_ijkl))`",
            (printed_C(printed_M), C),
            FLAT_SMOOTH,
            right="if M_ijkl is corrected (next row): then exact, in the printed order of indices",
            corrected=printed_C(),
            slip=Kind.HOLDS_IF,
            note="with the printed M_ijkl, C_12 and C_21 err by `±(i/2)(ξ_x ∂_yμ − ξ_y ∂_xμ)` where tr A = 0; "
            "exchanging k and l here does not repair it",
            proofs=[
                FLAT_SMOOTH.vanishes((printed_C(printed_M) - C) - Matrix([[0, error], [-error, 0]])),
                ANYTHING.vanishes(printed_C() - C),
                not FLAT_SMOOTH.vanishes(swapped - C),
            ],
        ),
        compare(
            "M_ijkl",
            "`M_ijkl = δ_i(j δ_l)k − A_il A_jk`",
            (all_printed, package),
            UNIT,
            right="`M_ijkl = δ_i(j δ_l)k − A_ik A_jl`",
            corrected=all_right,
            note="no effect on `ξ^k ξ^l M_ijkl`, hence none on (L5), (P4) to (P9)",
            names=["M_" + "".join(str(i + 1) for i in index) for index in indices],
            proofs=[ANYTHING.vanishes(Matrix(twice))],
        ),
    ]


def elimination() -> list[Verdict]:
    """Return the verdicts on (L3), (L3.1) and (L3.2), by eliminating alpha from the pencil."""
    C, B, row, _ = blocks(RIGID_PLASTIC, pencil(RIGID_PLASTIC).L(XI))
    alpha = symbol("alpha")
    a = Matrix(symbols("a_x a_y"))
    C_, B_ = Matrix(2, 2, symbols("C_xx C_xy C_yx C_yy")), Matrix(symbols("B_x B_y"))
    names = dict(zip((*C_, *B_), (*C, *B), strict=True))  # the algebra in short names, the values at the end
    found = solve((xi.T * (B_ * alpha + C_ * a))[0], alpha)[0]  # xi.a = 0 at all times
    derived_D = (B_ * found + C_ * a).jacobian(a)
    printed_D = (eye(2) - B_ * xi.T / (B_.T * xi)[0]) * C_
    package = tangent(RIGID_PLASTIC, XI)
    zero_vector = C_.adjugate() * B_  # D C^-1 B = 0
    return [
        decide(
            "L3",
            "`λ a^i = D_ij a^j`; D has the eigenvalue λ_1 = 0, λ_2 = Tr D",
            "`ξ·D = 0`; the vector of λ_1 is `C⁻¹B` and `ξ·C⁻¹B ≠ 0`",
            [
                ANYTHING.vanishes(xi.T * printed_D),
                ANYTHING.vanishes(printed_D * zero_vector),
                not ANYTHING.vanishes(xi.T * zero_vector),
            ],
            right="λ_1 is spurious: its vector breaks ξ·a = 0",
        ),
        compare(
            "L3.1",
            "`D_ij = (δ_ik − B_i ξ^k/(B·ξ)) C_kj`",
            (printed_D, derived_D),
            note="and it is the package's tangent matrix",
            proofs=[ANYTHING.vanishes(e.xreplace(names) - f) for e, f in zip(printed_D, package, strict=True)],
        ),
        inspected(
            "IPRF",
            Kind.MISPRINT,
            "unique solution of the IPRF equations",
            "IRPF",
            "rigid-plastic flow is IRPF elsewhere",
        ),
        compare("L3.2", "`α = −C_ij ξ^i a^j/(B·ξ)`", (-(xi.T * C_ * a)[0] / (B_.T * xi)[0], found)),
    ]


def verdicts() -> list[Verdict]:
    """Return the verdicts of this group."""
    return [*plane_waves(), *elimination()]


if __name__ == "__main__":
    show(verdicts())
