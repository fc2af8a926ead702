"""Section 2: the equations of rigid-plastic flow, (I0) to (I7.1)."""

from sympy import Expr, Matrix, cancel, eye, sin, solve, symbols, tan

from derivations.algebra import ANYTHING, Given, compare, decide, digits
from derivations.background import HOPPER, at, state
from derivations.frames import AT_YIELD, FLAT, a, c, s_f
from derivations.verdict import Kind, Verdict, show
from stability.closures.drucker_prager import LETTERS, RIGID_PLASTIC, stress
from stability.closures.plane_flow import V, grad_u, velocity
from stability.flows.radial_hopper import RADIAL_HOPPER, varphi_w
from stability.linearise import along, imbalance
from stability.symbols import body_force, gradient, k, mu, norm_V, p, symbol, u, v, varphi
from stability.tangent import WAVE, blocks, truncated

TITLE = "Equations of rigid-plastic flow (section 2)"
sigma, rho, speed = symbol("sigma"), symbol("rho"), symbol("U")
eta = symbol("eta")  # mu of (I4) and (I5): rho times the kinematic mu of (I7) and after
incompressible = {gradient(v)[1]: -gradient(u)[0]}
square = sum(e**2 for e in V.xreplace(incompressible))
NORM = Given(relations=((norm_V, norm_V**2 - square),), substitution=incompressible)
W = "at div u = 0, modulo `‖V‖² = V:V`"  # how the evidence names NORM


def short(expression: Matrix) -> Matrix:
    """Return the expression with ||V|| as a letter."""
    return expression.subs(LETTERS[norm_V], norm_V)


def momentum(flux: Matrix) -> Matrix:
    """Return u.grad u + div flux - g, the momentum balance of a steady flow."""
    div = Matrix([sum(along(RIGID_PLASTIC, flux[i, j], j) for j in (0, 1)) for i in (0, 1)])
    return short(grad_u * velocity + div - Matrix(body_force.tolist()))


def contraction(one: Matrix, other: Matrix) -> Expr:
    """Return one_ij other_ij."""
    return sum(one.multiply_elementwise(other))


def balances() -> list[Verdict]:
    """Return the verdicts on mass and momentum (I0), (I1), (I7), (I7.1)."""
    laws = short(imbalance(RIGID_PLASTIC))
    mass = grad_u.trace()
    V_over_norm = V / LETTERS[norm_V]
    return [
        compare("I0", "`∇_i u^i = 0`", (mass, laws[2]), note="the package's balance of mass"),
        compare(
            "I1",
            "`ρ Du^i/Dt + ∇_j σ^ij = ρ g^i`",
            (momentum(stress), laws[:2, :]),
            note="σ/ρ is the package's stress; positive in compression: at rest `∇p = g`",
        ),
        compare(
            "I7",
            "`Du^i/Dt = g^i − ∇_j(p δ^ij − k p A^ij)`",
            (momentum(p * eye(2) - k * p * V_over_norm), laws[:2, :]),
            note="follows from (I1), (I5) and (I4) with its sign corrected",
        ),
        compare("I7.1", "`∇_i u^i = 0`", (mass, laws[2])),
    ]


def yield_and_flow_rule() -> list[Verdict]:
    """Return the verdicts on (I2), (I2.5), (I4) and (I5)."""
    principal = sigma_1, sigma_2, sigma_3 = symbols("sigma_1:4", real=True)
    plane = solve(sigma_2 - sum(principal) / 3, sigma_2)[0]  # sigma_2 = sigma
    yielding = sum((e - sigma) ** 2 for e in principal) - LETTERS[k] ** 2 * sigma**2  # (I2)
    in_plane = yielding.subs(sigma_2, sigma).subs(sigma, plane)
    printed = (sigma_1 - sigma) ** 2 + (sigma_3 - sigma) ** 2 - 2 * sigma**2 * sin(varphi) ** 2  # (I2.5)
    coulomb = ((sigma_1 - sigma_3) / 2) ** 2 - (plane * sin(varphi)) ** 2
    package = rho * short(stress).subs(k, eta / rho * norm_V / p).subs(p, sigma / rho)  # mu = k p/||V||
    plus, minus = sigma * eye(2) + eta * V, sigma * eye(2) - eta * V
    flow_rule = [
        NORM.vanishes(-contraction(form, V) - sign * eta * norm_V**2) for form, sign in ((plus, -1), (minus, 1))
    ]
    on_yield = solve(eta**2 * norm_V**2 - k**2 * sigma**2, eta)
    positive = next(e for e in on_yield if e.subs({k: 1, sigma: 1, norm_V: 1}) > 0)
    return [
        decide(
            "I2",
            "`(σ_1−σ)² + (σ_2−σ)² + (σ_3−σ)² ≤ k²σ²`, `k = √2 sin φ_f`",
            "in plane strain it is Mohr–Coulomb, `(σ_1−σ_3)/2 = σ sin φ_f`: symbolic zero",
            [ANYTHING.vanishes(in_plane - 2 * coulomb)],
        ),
        compare(
            "I2.5",
            "`(σ_1−σ)² + (σ_3−σ)² = 2σ² sin² φ_f`, `σ_2 = σ = (σ_1+σ_3)/2`",
            (printed.subs(sigma, plane), in_plane),
            proofs=[plane == (sigma_1 + sigma_3) / 2],
        ),
        compare(
            "I4",
            "`σ_ij = σ δ_ij + μ V_ij`",
            (plus, package),
            right="`σ_ij = σ δ_ij − μ V_ij`",
            corrected=minus,
            proofs=flow_rule,
            note=f"the dissipation `−σ_ij V_ij` of the print is `−μ‖V‖² < 0` ({W}), and (I7) has −",
        ),
        compare(
            "I5",
            "`μ = k σ/‖V‖`",
            (k * sigma / norm_V, positive),
            note="the positive root of `μ²‖V‖² = k²σ²`, whatever the sign in (I4); from (I7) on `μ = k p/‖V‖`",
        ),
    ]


def wall_friction() -> Verdict:
    """Return the verdict on the Coulomb condition (I6): friction must not drive the material."""
    normal, shear = symbol("sigma_nn"), symbol("sigma_nt")
    # The wall pushes on the material with -sigma.n; the flow is -U t. Its power -sigma_ij n_i u_j is U sigma_nt.
    power = -shear * (-speed)
    friction = symbol("tan_phi_w")
    printed, corrected = (power.subs(shear, sign * friction * normal) for sign in (1, -1))
    wall = state(RADIAL_HOPPER, at(1, 15))
    at_wall = short(stress).xreplace(wall)
    ratio, limit = at_wall[0, 1] / at_wall[1, 1], tan(HOPPER[varphi_w])  # x = e_r = t, y = e_theta = n
    return decide(
        "I6",
        "`σ_ij n^i t^j = + tan φ_w σ_ij n^i n^j`, n outward, t against the flow",
        "the power of the wall on the material, `−σ_ij n_i u_j`, is `+U tan φ_w σ_nn > 0` as printed; "
        "right as printed only with t along the flow or n inward",
        [printed - speed * friction * normal == 0, corrected + speed * friction * normal == 0, ratio < 0],
        (
            ratio * limit < 0,
            "radial flow (R9) of the package, wall θ = θ_w, r = 1 m: "
            f"`σ_nt/σ_nn` = {digits(ratio)}, printed sign +{digits(limit)}",
        ),
        right="`σ_ij n^i t^j = − tan φ_w σ_ij n^i n^j`",
        slip=Kind.MISPRINT,
    )


def hyperbolic() -> Verdict:
    """Return the verdict on "strictly hyperbolic in the case of plane strain"."""
    series = truncated(RIGID_PLASTIC).series(WAVE)
    C, B, row = blocks(RIGID_PLASTIC, series[2])[0], *blocks(RIGID_PLASTIC, series[1])[1:3]
    # The principal symbol of the quasi-static equations.
    steady = Matrix.vstack(Matrix.hstack(C, B), Matrix.hstack(row, Matrix([[0]]))).det()
    angle_form = steady.xreplace(AT_YIELD.substitution).expand()
    factor = cancel(AT_YIELD.remainder(angle_form) / (c * (c + s_f)).expand())
    growth = -a * (a - k / 2)  # (L5) but for a positive factor
    return decide(
        '"strictly hyperbolic"',
        "(I7), (I7.1) are strictly hyperbolic in plane strain (refers to (I4))",
        "quasi-static principal symbol ∝ `c(c + s_f)`: four distinct real directions, ±45° and ±(45° + φ_f/2) from the "
        "major stress axis, for 0 < φ_f < 90°; in time Re λ ~ q² (L5)",
        [FLAT.vanishes(steady + mu * a * (a - k / 2)), not factor.has(c), factor != 0],
        (
            growth.subs({a: k / 4, k: 1}) > 0,
            f"a = k/4, k = 1: Re λ/(μq²) has the sign of {digits(growth.subs({a: k / 4, k: 1}))}",
        ),
        right="if the steady quasi-static equations are meant; the time-dependent ones are not hyperbolic",
        slip=Kind.HOLDS_IF,
    )


def verdicts() -> list[Verdict]:
    """Return the verdicts of this group."""
    balance, plastic = balances(), yield_and_flow_rule()
    return [*balance[:2], *plastic, wall_friction(), *balance[2:], hyperbolic()]


if __name__ == "__main__":
    show(verdicts())
