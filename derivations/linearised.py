"""Section 3: scaling and linearisation, (L0) to (L1.1) and delta A, by differentiating the package's balance laws."""

from sympy import Expr, Matrix, symbols

from derivations.algebra import ANYTHING, Given, compare
from derivations.frames import TWO, dirac, symmetriser, velocity
from derivations.verdict import Verdict, show
from stability.closures.drucker_prager import LETTERS, RIGID_PLASTIC
from stability.closures.plane_flow import V
from stability.linearise import imbalance
from stability.symbols import A, body_force, gradient, hessian, k, norm_V, p, symbol

TITLE = "Scaling and linearised equations (section 3)"


def scaling() -> list[Verdict]:
    """Return the verdicts on (L0) and (L0.1)."""
    u_0, g, length = symbols("u_0 g L", positive=True)
    rate = u_0 / length
    units = {
        p: g * length,
        norm_V: rate,
        **dict.fromkeys((*body_force, *gradient(p)), g),
        **dict.fromkeys(velocity, u_0),
    }
    units |= {s: rate for f in velocity for s in gradient(f)}
    units |= {s: rate / length for f in velocity for s in sum(hessian(f), ())}
    laws = imbalance(RIGID_PLASTIC).subs(LETTERS[norm_V], norm_V)
    scaled = laws.xreplace({s: unit * s for s, unit in units.items()})  # each quantity is its unit times its hat
    forces = laws[:2, :].subs(dict.fromkeys(velocity, 0))  # div(p - kpA) - g
    inertia = laws[:2, :] - forces
    froude = u_0**2 / (g * length)
    scaled_forces = scaled[:2, :].subs(dict.fromkeys(velocity, 0))
    scaled_inertia = (scaled[:2, :] - scaled_forces) * length / u_0**2
    return [
        compare(
            "L0",
            "`∂û^i/∂t̂ + û^j ∇̂_j u^i = Fr⁻² (g^i/g − ∇̂_j[P̂ δ_ij − k p̂ A_ij])`, `Fr = u₀/√(gL)`",
            (u_0 * inertia, scaled_inertia),
            right="`û^j ∇̂_j û^i` on the left, `p̂` for `P̂` on the right",
            corrected=inertia,  # as printed, u without its hat is u_0 times its hat
            proofs=[ANYTHING.vanishes(scaled_forces * length / u_0**2 - forces / froude)],
            note="the package's balance with `û = u/u₀, p̂ = p/gL, x̂ = x/L, t̂ = t u₀/L`; P̂ is not defined",
        ),
        compare("L0.1", "`∇̂_i û^i = 0`", (laws[2], scaled[2] / rate)),
    ]


def linearisation() -> list[Verdict]:
    """Return the verdicts on (L1), (L1.1) and delta A, by differentiating the package's fluxes along a disturbance."""
    closure = RIGID_PLASTIC
    disturbance = {s: symbol(f"δ{s}") for s in (*closure.q, *closure.g)}
    contains_norm = Given(relations=((norm_V, norm_V**2 - sum(e**2 for e in V)),))

    def variation(expression: Expr) -> Expr:
        terms = sum(expression.diff(s) * ds for s, ds in disturbance.items())
        return terms.subs(LETTERS[norm_V], norm_V)

    here = {A[i, j]: V[i, j] / norm_V for i in TWO for j in TWO}
    grad = [[disturbance[s] for s in gradient(f)] for f in velocity]  # grad[l][k] = d_k delta u^l
    delta_A = Matrix(
        2,
        2,
        lambda i, j: sum((symmetriser(i, m, l, j) - A[i, j] * A[m, l]) * grad[l][m] for m in TWO for l in TWO) / norm_V,
    ).xreplace(here)
    derived_A = Matrix(2, 2, lambda i, j: variation(V[i, j] / LETTERS[norm_V]))
    dp = disturbance[p]
    flux = Matrix(2, 2, lambda i, j: k * (dp * V[i, j] / norm_V + p * delta_A[i, j]) - dp * dirac(i, j))
    inertia = Matrix(
        [sum(velocity[j] * grad[i][j] + disturbance[velocity[j]] * gradient(velocity[i])[j] for j in TWO) for i in TWO]
    )
    printed = flux.row_join(-inertia)
    package = (-closure.flux[:2, :]).row_join(Matrix(closure.supply[:2]))
    modulo = "`‖V‖² = V:V`"
    return [
        compare(
            "L1",
            "`∂δu^i/∂t + u·∇δu^i + δu·∇u^i = Fr⁻² ∇_j(k(δp A^ij + p δA^ij) − δp δ^ij)`",
            (printed, package.applyfunc(variation)),
            contains_norm,
            modulo=modulo,
            note="flux by flux, Fr = 1: the variation of the package's stress and inertia",
        ),
        compare(
            "L1.1",
            "`∇·δu = 0`",
            (
                grad[0][0] + grad[1][1],
                sum(variation(closure.flux[2, j]).coeff(disturbance[f]) * grad[j][j] for j, f in enumerate(velocity)),
            ),
        ),
        compare(
            "δA",
            "`δA_ij = (δ_i(k δ_l)j − A_ij A_kl) ∇^k δu^l/‖V‖`",
            (delta_A, derived_A),
            contains_norm,
            modulo=modulo,
        ),
    ]


def verdicts() -> list[Verdict]:
    """Return the verdicts of this group."""
    return [*scaling(), *linearisation()]


if __name__ == "__main__":
    show(verdicts())
