"""What the text and the captions say of the radial background: its delta, its mu, and figure P2.1."""

from mpmath import mp
from sympy import Expr, Rational, atan, cos, diff, pi, sqrt, symbols

from derivations.algebra import ANYTHING, decide, digits
from derivations.background import GEOMETRY, HOPPER, PRECISION, at, derivatives, eigenvalues, letters_of, state
from derivations.radial import PLAIN, Z, plain, s, z
from derivations.verdict import Kind, Verdict, show
from stability.closures.drucker_prager import PERTURBED
from stability.flows.radial_hopper import RADIAL_HOPPER, RADIAL_HOPPER_COMPATIBLE, F, g, pressure, r_0, speed, w
from stability.symbols import A, epsilon, hessian, p, q, r, symbol

TITLE = "What the text says of the radial background (sections 5 and 6)"
KNOWN = letters_of(RADIAL_HOPPER, HOPPER)
lap_p = sum(derivatives(RADIAL_HOPPER)[hessian(p)[i][i]] for i in (0, 1))
norm_V = sqrt(2) * speed(r, 0) / r  # on the axis V = diag(1, -1) speed/r


def number(expression: Expr) -> mp.mpf:
    """Return a SymPy number as one of mpmath."""
    return mp.mpf(str(expression.evalf(PRECISION)))


def sign_of_laplacian() -> bool:
    """Return whether Lap p0 is a positive factor times h(z) = z^3 - w^2 beta z^(w+2) - 4(1 - beta), z = r/r_0."""
    beta = symbol("beta")
    h = z**3 - w**2 * beta * Z * z**2 - 4 * (1 - beta)
    factor = PLAIN[g] / (PLAIN[r_0] * (1 - s) * (w - 1) * z**4)
    return ANYTHING.vanishes(plain(lap_p).subs(F, sqrt((1 - beta) * (w + 2) / (w - 1))) - factor * h)


def crest(ratio: mp.mpf) -> tuple[mp.mpf, mp.mpf]:
    """Return z and h at the only maximum of h, for r_1/r_0 = ratio and the w of the example."""
    exponent = number(KNOWN[w])
    beta = (ratio ** (1 - exponent) - ratio ** (-2 - exponent)) / (1 - ratio ** (-2 - exponent))  # from F^2 after (R8)
    top = (3 / (exponent**2 * (exponent + 2) * beta)) ** (1 / (exponent - 1))
    return top, top**3 - exponent**2 * beta * top ** (exponent + 2) - 4 * (1 - beta)


def small_negative_delta() -> Verdict:
    """Return the verdict on "the initial smooth background solution will have small, negative values of delta"."""
    ends = [
        (epsilon * lap_p / norm_V).xreplace(letters_of(RADIAL_HOPPER, HOPPER | at(radius))).evalf(PRECISION)
        for radius in (Rational(1, 2), Rational(3, 2))
    ]
    with mp.workdps(50):
        top, height = crest(mp.mpf(3))
        tall_top, tall = crest(mp.mpf(10))
        end = mp.findroot(lambda ratio: crest(ratio)[1], 5)
        where = f"r₁/r₀ = 10: h = {mp.nstr(tall, 30)} at r/r₀ = {mp.nstr(tall_top, 30)}"
        values = mp.nstr(end, 6), mp.nstr(height, 6).replace("-", "−"), mp.nstr(number(KNOWN[w]), 6)
    return decide(
        "δ of the radial flow",
        "the initial smooth background solution will have small, negative values of δ",
        "Δp₀ has the sign of `h = z³ − w²β z^(w+2) − 4(1−β)`, z = r/r₀, `1 − β = (w−1)F²/(w+2)`; its only maximum is "
        f"{values[1]} for r₁/r₀ = 3. {GEOMETRY}: `εΔp₀/‖V‖` is {digits(ends[0], 3)} at r₀, {digits(ends[1], 3)} at r₁ "
        f"(ε = 2·10⁻⁵ s)",
        [sign_of_laplacian(), height < 0, 1 < top < 3, 1 < tall_top < 10, all(-1 / 500 < e < 0 for e in ends)],
        (tall > 0, where),
        right=f"if the hopper is not tall: r₁/r₀ < {values[0]} at w = {values[2]}; "
        "in a taller one p₀ ~ r half-way up, and δ > 0 there",
        slip=Kind.HOLDS_IF,
    )


def largest_mu() -> Verdict:
    """Return the verdict on "near the center of the hopper ... where mu is largest"."""
    slope = diff(pressure(r) / norm_V, r).xreplace(KNOWN)  # mu = k p/||V||
    with mp.workdps(50):

        def at_radius(radius: mp.mpf) -> mp.mpf:
            return number(slope.subs(r, str(radius)))

        root = mp.findroot(at_radius, (mp.mpf("1.2"), mp.mpf("1.25")), solver="secant")
        signs = [at_radius(mp.mpf(radius)) > 0 for radius in ("0.6", "0.9", "1.2", "1.23", "1.4")]
        place = mp.nstr(root, 30)
    return decide(
        "μ largest near the centre",
        "near the center of the hopper, where μ is largest",
        f"`μ = k p₀/‖V‖` on the axis; {GEOMETRY}",
        [signs == [True, True, True, False, False]],
        (abs(root - 1) > 0.2, f"maximum at r = {place} m; half-way is 1 m"),
        right='if "centre" means the interior: on the axis μ has its maximum between the arcs, above half-way',
        slip=Kind.HOLDS_IF,
    )


def figure_P2_1() -> Verdict:
    """Return the verdict on figure P2.1: no direction is unstable as |xi| grows."""
    rates = {}
    for flow in (RADIAL_HOPPER, RADIAL_HOPPER_COMPATIBLE):
        here = state(flow, at(1), PERTURBED)
        null = atan(sqrt(-here[A[1, 1]] / here[A[0, 0]]))  # tau.A.tau = 0: Det M = 0
        rates[flow] = [
            eigenvalues(PERTURBED, here, 10**n, angle)[0].as_real_imag()[0]
            for n in (10, 12)
            for angle in (null, pi - null)
        ]
    radial, compatible = rates[RADIAL_HOPPER], rates[RADIAL_HOPPER_COMPATIBLE]
    return decide(
        "figure P2.1",
        "the unstable region disappears as |ξ| → ∞ (ε = 2·10⁻⁵ s)",
        f"{GEOMETRY}, full D at r = 1 m, θ = 0, in the directions Det M = 0: Re λ → {digits(radial[2], 12)} /s, or "
        f"{digits(compatible[2], 12)} /s with u + ε∇p₀, which satisfies (P1.1). The text says determinant, the "
        "caption eigenvalue: for the complex D only the latter decides",
        [
            all(e < 0 for e in radial + compatible),
            *(abs(e[0] - e[2]) < 1e-12 for e in rates.values()),
            *(abs(e[2] - e[3]) < 1e-12 for e in rates.values()),
        ],
    )


def troughs() -> Verdict:
    """Return the verdict on "in the troughs of the plane-wave-like pressure disturbance, delta is positive"."""
    distance, amplitude = symbol("distance"), symbols("amplitude", positive=True)
    wave = -amplitude * cos(q * distance)  # least at 0
    return decide(
        "δ > 0 in the troughs",
        "in the troughs of the pressure disturbance δ is positive",
        "`ε Δp` of `−cos(ξ·x)` is +εξ² at the trough, and outweighs the background's once the disturbance is large",
        [wave.diff(distance, 2).subs(distance, 0) == amplitude * q**2],
    )


def verdicts() -> list[Verdict]:
    """Return the verdicts of this group."""
    return [small_negative_delta(), largest_mu(), figure_P2_1(), troughs()]


if __name__ == "__main__":
    show(verdicts())
