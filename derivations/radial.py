"""Appendix: the approximate radial solution, (R2) to (R10), Psi, w and F^2."""

from functools import cache

from sympy import Expr, N, cancel, cos, diff, factor_list, log, series, sin, solve, sqrt, symbols, tan

from derivations.algebra import ANYTHING, compare, decide, digits
from derivations.background import GEOMETRY, HOPPER, PRECISION, at, derivatives, letters_of, residual, state
from derivations.constitutive import short
from derivations.verdict import Kind, Verdict, show
from stability.closures.drucker_prager import LETTERS as CLOSURE_LETTERS
from stability.closures.drucker_prager import RIGID_PLASTIC
from stability.flows.radial_hopper import (
    LETTERS,
    RADIAL_HOPPER,
    F,
    Psi_w,
    g,
    pressure,
    pressure_regrouped,
    r_0,
    r_1,
    speed,
    theta_w,
    varphi_w,
    w,
)
from stability.linearise import imbalance
from stability.symbols import gradient, k, norm_V, r, symbol, theta, u, v, varphi

TITLE = "Approximate radial solution (appendix)"
G, R0 = symbols("G R_0", positive=True)  # g = G^2, r_0 = R_0^2: no root is left
z, Z, K, s = symbol("z"), symbol("Z"), symbol("K"), symbol("s_f")  # z = r/r_0, Z = z^w
PLAIN = {g: G**2, r_0: R0**2, sin(varphi): s}


def plain(expression: Expr) -> Expr:
    """Return an expression of the radial solution as a rational function of z, Z and the constants."""
    positive = symbols("z", positive=True)
    rational = expression.subs(theta, 0).subs(r, positive * r_0).xreplace(PLAIN)
    return rational.replace(
        lambda e: e.is_Pow and e.base == positive and e.exp.has(w), lambda e: Z * positive ** (e.exp - w)
    ).xreplace({positive: z})


@cache
def axis_balance(direction: int = -1) -> Expr:
    """Return what radial momentum lacks on the axis, for a prefactor K of (R7) and a sign of u in (R9)."""
    turned = -direction  # the package's flow is inward
    factor = {"u": turned, "v": turned, "p": K / (G**2 * R0**2)}
    values = {s_: plain(e) * factor.get(str(s_)[0], 1) for s_, e in derivatives(RADIAL_HOPPER).items()}
    values[norm_V] = sqrt(2) * turned * values[gradient(u)[0]]  # V = diag(1, -1) u_x on the axis
    values[k] = CLOSURE_LETTERS[k].xreplace(PLAIN)
    return cancel(short(imbalance(RIGID_PLASTIC))[0].xreplace(values))


def exponent(rate: Expr) -> Expr:
    """Return the w that the balance on the axis asks for, if the stress ratio tan 2Psi has this slope in theta."""
    homogeneous = axis_balance().as_numer_denom()[0].expand().coeff(Z)  # the term in (r/r_0)^w
    condition = next(f for f, _ in factor_list(homogeneous)[1] if f.has(w, s) and not f.has(F))
    return solve(condition.subs(Psi_w, rate * theta_w / 2), w)[0]


def stress_angle() -> list[Verdict]:
    """Return the verdicts on (R2), Psi, w, (R8) and Psi_w."""
    u_r = -speed(r, theta)
    # Stress and strain rate are coaxial: this is 2 sigma_rt/(sigma_rr - sigma_tt).
    ratio = diff(u_r, theta) / r / (diff(u_r, r) - u_r / r)
    rate = diff(ratio, theta).subs(theta, 0)
    printed_w = 2 * s / (1 - s) * (1 + Psi_w / theta_w)
    angle = symbol("psi")
    # |sigma_rt| = tan(phi_w) sigma_tt at yield, times cos(phi_w).
    wall = sin(varphi) * sin(angle) * cos(varphi_w) - sin(varphi_w) * (1 + sin(varphi) * cos(angle))
    solved = sin(varphi) * sin(angle - varphi_w) - sin(varphi_w)
    values = letters_of(RADIAL_HOPPER, HOPPER)
    slip = {
        name: N(e.xreplace(PLAIN | {s: sin(varphi)}).xreplace(values), PRECISION)
        for name, e in (("printed", exponent(Psi_w / theta_w)), ("w", printed_w))
    }
    return [
        decide(
            "R2",
            "`Ψ = Ψ_1 (θ/θ_w) + O(θ³/θ_w³)`",
            "the stress ratio of the package's flow is odd in θ and linear at the axis",
            [ANYTHING.vanishes(ratio + ratio.subs(theta, -theta)), rate != 0],
        ),
        compare(
            "Ψ",
            "`Ψ = 2σ_rθ/(σ_rr − σ_θθ)`",
            (Psi_w / theta_w, rate),
            right="`tan 2Ψ = 2σ_rθ/(σ_rr − σ_θθ)`",
            corrected=2 * Psi_w / theta_w,
            note="slope in θ on the axis, from (R9): twice the printed one; balance there asks for the printed w "
            "with tan 2Ψ",
            proofs=[ANYTHING.vanishes(exponent(2 * Psi_w / theta_w) - printed_w)],
        ),
        compare(
            "w",
            "`w = 2 sin φ_f/(1 − sin φ_f) (1 + Ψ_w/θ_w)`",
            (printed_w, exponent(rate)),
            note="from radial momentum on the axis, radians; with the printed Ψ the balance would ask for "
            f"w = {digits(slip['printed'])} where the print has {digits(slip['w'])} ({GEOMETRY})",
        ),
        decide("R8", "`Ψ_1 = Ψ_w`", "(R2) at θ = θ_w", [ANYTHING.vanishes(rate * theta_w - 2 * Psi_w)]),
        decide(
            "Ψ_w",
            "Ψ_w is determined by the boundary condition (I6)",
            "`∣σ_rθ∣ = tan φ_w σ_θθ` at yield is `sin φ_f sin(2Ψ_w − φ_w) = sin φ_w`; φ_f = 34°, φ_w = 9°: "
            f"Ψ_w = {digits(values[Psi_w], 40)}",
            [
                ANYTHING.vanishes((wall - solved).expand(trig=True)),
                ANYTHING.vanishes(solved.subs(angle, 2 * LETTERS[Psi_w])),
            ],
            (
                values[w] > N(exponent(-rate).xreplace({s: sin(varphi)}).xreplace(values), PRECISION),
                "the printed sign of (I6) turns Ψ_w round: w = "
                f"{digits(N(exponent(-rate).xreplace({s: sin(varphi)}).xreplace(values), 60))} "
                f"instead of {digits(values[w])}",
            ),
            right="if (I6) has its right sign: `2Ψ_w = φ_w + arcsin(sin φ_w/sin φ_f)`",
            slip=Kind.HOLDS_IF,
        ),
    ]


def fields() -> list[Verdict]:
    """Return the verdicts on (R7), F^2, (R9) and (R10)."""
    bracket = (F**2 / (w + 2) - 1 / (w - 1)) * z**w + z / (w - 1) - F**2 / (w + 2) / z**2
    in_w = {Psi_w: theta_w * (w * (1 - s) / (2 * s) - 1)}
    prefactor = solve(axis_balance().subs(in_w).as_numer_denom()[0], K)
    printed_F2 = (w + 2) / (w - 1) * (1 - (r_0 / r_1) ** (w - 1)) / (1 - (r_0 / r_1) ** (w + 2))
    h = symbols("h", positive=True)  # r_0/r_1
    ahead = symbols("z", positive=True)
    regrouped = (pressure_regrouped(ahead * r_0) - pressure(ahead * r_0).subs(F, sqrt(printed_F2))).subs(r_0, h * r_1)
    at_inlet = pressure(r_1).subs(F, sqrt(printed_F2)).subs(r_0, h * r_1).subs((1 / h) ** w, h**-w)
    speed_out = sqrt(g * r_0) * F * (1 - 2 * theta_w * Psi_w * (theta / theta_w) ** 2) * r_0 / r
    here = derivatives(RADIAL_HOPPER)
    coaxial = cos(2 * Psi_w * theta / theta_w) ** (theta_w / Psi_w)  # f'/f = -2 tan 2 Psi
    shape = [
        ANYTHING.vanishes((diff(log(coaxial), theta) + 2 * tan(2 * Psi_w * theta / theta_w)).rewrite(sin).simplify()),
        ANYTHING.vanishes(series(coaxial, theta, 0, 3).removeO() - (1 - 2 * theta_w * Psi_w * (theta / theta_w) ** 2)),
    ]
    inward, outward = (residual(state(RADIAL_HOPPER, at(1), reverse=turn))[0] for turn in (False, True))
    off_axis = residual(state(RADIAL_HOPPER, at(1, 5)))
    exact = {K: G**2 * R0**2} | in_w
    return [
        compare(
            "R7",
            "`p_0 = 5_0/(1−sin φ_f) [(F²/(w+2) − 1/(w−1))(r/r_0)^w + (r/r_0)/(w−1) − (F²/(w+2))(r_0/r)²]`",
            (symbol("5_0"), prefactor[0].xreplace({G: sqrt(symbol("g")), R0: sqrt(symbol("r_0"))})),
            right="`p_0 = g r_0/(1−sin φ_f) [...]`, the same bracket",
            corrected=g * r_0,
            note="the only prefactor for which radial momentum holds on the axis, identically in r",
            proofs=[
                len(prefactor) == 1,
                regrouped.simplify() == 0,
                ANYTHING.vanishes(pressure(z * r_0) - g * r_0 / (1 - sin(varphi)) * bracket),
            ],
        ),
        compare(
            "F²",
            "`F² = ((w+2)/(w−1)) (1 − (r_0/r_1)^(w−1))/(1 − (r_0/r_1)^(w+2))`",
            (printed_F2, LETTERS[F] ** 2),
            note="the condition p_0(r_1) = 0; p_0(r_0) = 0 for any F",
            proofs=[at_inlet.simplify() == 0, ANYTHING.vanishes(pressure(r_0))],
        ),
        compare(
            "R9",
            "`u = + √(g r_0) F (1 − 2θ_wΨ_w (θ/θ_w)²) r_0/r`",
            (speed_out, here[u]),
            right="`u = − √(g r_0) F (...) r_0/r`: towards the apex",
            corrected=-speed_out,
            seed=2,
            proofs=[
                *shape,
                ANYTHING.vanishes(axis_balance().subs(exact)),
                not ANYTHING.vanishes(axis_balance(1).subs(exact)),
                abs(inward) < 1e-50,
            ],
            note="radial momentum on the axis vanishes identically with −; with + it lacks "
            f"{digits(outward)} m/s² at r = 1 m ({GEOMETRY}); the shape is right: cos(2Ψ)^(θ_w/Ψ_w) to O(θ²)",
        ),
        decide(
            "R10",
            "`v = 0`",
            "(I7.1) holds identically for (R9), (R10); off the axis momentum does not: at r = 1 m, θ = 5° the "
            f"θ-component lacks {digits(off_axis[1], 6)} m/s² ({GEOMETRY})",
            [here[v] == 0, simplified_divergence() == 0],
        ),
    ]


def simplified_divergence() -> Expr:
    """Return div u of the package's flow at a general point."""
    here = derivatives(RADIAL_HOPPER)
    return (here[gradient(u)[0]] + here[gradient(v)[1]]).simplify()


def verdicts() -> list[Verdict]:
    """Return the verdicts of this group."""
    return [*stress_angle(), *fields()]


if __name__ == "__main__":
    show(verdicts())
