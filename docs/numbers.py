"""The rows of the table of published numbers in docs/closures.md: what is stated, what is computed, how far apart."""

from collections.abc import Callable, Iterator
from dataclasses import replace
from math import acos, pi, sin, sqrt, tan
from typing import Any

from mpmath import mp, mpf
from sympy import diff, lambdify, log, simplify

import stability as st
from docs.space import rows as rows_in_space
from stability.closures.base import Closure
from stability.closures.compressible_i import COMPRESSIBLE_I, laws
from stability.closures.mu_i_phi_i import PARAMETERS, bulk_frictional
from stability.closures.mu_i_regularised import high, low
from stability.symbols import p, symbol
from stability.verdict import Kind, Verdict
from tests.closures.benchmarks import BULK, CIDR, COULOMB, CRITICAL, FLUIDITY, GLASS, MICROPOLAR, at

CLOSE = 1e-12  # relative: what numbers that were given with 15 digits must meet, and how near a threshold is tried
HALF = tan(17 * pi / 180)  # tan(varphi/2) at 34 degrees
MU = sqrt(2) * sin(34 * pi / 180)  # k p/||V|| of `COULOMB`
BEADS = GLASS | {"static_friction": tan(20.9 * pi / 180), "dynamic_friction": tan(32.76 * pi / 180)}
BEADS |= {"reference_inertial_number": "0.279"}
HIGH = GLASS | {"high_rate_friction": "0.05"}
LOW = HIGH | {"low_rate_exponent": "1.9", "branch_inertial_number": "0.0039717826838072"}  # where mu(I) turns
SLOW = {"strain_rate": 1e-30, "pressure": 1e-30}  # mu is of order one, inertia of the base flow 1e-30
IN_PLANE = Closure(
    name="in_plane", title="mu_i_phi_i with a 2-D deviator", source="as mu_i_phi_i", **bulk_frictional(2),
    parameters=PARAMETERS,
)  # fmt: skip
SOFTENED = replace(  # the third condition of 2017 holds wherever C > 0, so what it forbids has C < 0
    COMPRESSIBLE_I,
    name="softened",
    parameters=tuple(replace(r, low=-1e6) if r.symbol == "C_0" else r for r in COMPRESSIBLE_I.parameters),
)
Row = tuple[str, str, str, tuple[str, str]]


def verdict(closure: Any, flow: str, parameters: dict) -> Verdict:
    """Return the verdict at a state whose numbers may be text."""
    return st.well_posedness(closure, flow, {word: float(value) for word, value in parameters.items()}, {})


def acceptance() -> Iterator[tuple]:
    """Yield the rows of the table of published and stated numbers."""
    for group in (numbers, rows_in_space, turning, regularised, conditions, bands):
        for closure, what, stated, found in group():
            yield f"`{closure}`" if closure in st.CLOSURES else closure, what, stated, *found


def compared(stated: str, value: float) -> tuple[str, str]:
    """Return a computed number and how far it is from the stated one."""
    off = abs(value / float(stated) - 1)
    return f"{value:.15g}", "below 1e-14" if off < 1e-14 else f"within {CLOSE:g}" if off < CLOSE else f"{off:.1g}"


def numbers() -> Iterator[Row]:
    """Yield numbers that a verdict holds."""
    found = verdict("rigid_plastic", "uniform_strain", COULOMB)
    for what, stated, value in (
        ("largest growth over μ q²", "0.0467356247925884", found.coefficient / MU),
        ("its direction (deg)", "36.0989355774566", found.worst_angle),
        ("lower end of the wedge, cos 2φ = sin φ_f (deg)", "28", found.wedge[0][0]),
        ("upper end of the wedge, cos 2φ = 0 (deg)", "45", found.wedge[0][1]),
    ):
        yield "rigid_plastic", what, stated, compared(stated, value)
    found = verdict("mu_i", "uniform_strain", BEADS | at("1e-3"))
    mu = BEADS["static_friction"] + (BEADS["dynamic_friction"] - BEADS["static_friction"]) / (1 + 0.279 / 1e-3)
    value = found.coefficient / (mu * 2 / (1e-3 / 2))  # mu p/||D||
    stated = "0.0184797007567896"
    yield "mu_i", "growth over η q² of glass beads, I = 0.001", stated, compared(stated, value)
    dilation = 0.2 * sqrt(2 / (1 + 0.2**2))
    state = CRITICAL | {"pressure": "0.8", "delta": dilation}
    found = verdict("critical_state", "uniform_fraction", state)
    stated = "0.489897948556636"
    yield "critical_state", "slope √(φ Y_φ f/ρ) of 0.6, 2, 0.2, 1", stated, compared(stated, found.coefficient)
    slow = {word: float(v) for word, v in (COULOMB | {"friction_angle": 30, "strain_rate": 1e-30}).items()}
    rate = st.eigenvalues("double_shearing", "uniform_strain", slow, {}, 100.0, 180 / pi, digits=30)[0].real
    stated = "83.3524600575843"
    yield "double_shearing", "growth at q = 100, θ = 1 rad, s = 1/2", stated, compared(stated, float(rate))
    found = verdict("deviatoric", "uniform_strain", COULOMB | {"epsilon": "1e-3", "delta": "0.3"})
    stated = f"{MU / 4 * 0.3 * (sqrt(2 - 0.3**2) - 0.3):.15g}"  # Lambda = mu q^2/2
    yield "deviatoric", "(Λ/2)∣δ∣(√(2 − δ²) − ∣δ∣)/q² at δ = 0.3", stated, compared(stated, found.coefficient)
    found = verdict("nonlocal", "uniform_fluidity", FLUIDITY)
    stated = f"{float(FLUIDITY['pressure']) / float(FLUIDITY['granular_fluidity']):.15g}"
    everywhere = found.kind is Kind.STABLE and found.worst_angle is None
    value, off = compared(stated, -found.coefficient)
    yield "nonlocal", "decay p/g over q²", stated, (f"{value}{', in every direction' * everywhere}", off)


def turns(closure: Any, flow: str, stated: float, state: Callable, kinds: tuple[Kind, Kind]) -> tuple[str, str]:
    """Return the verdicts a relative `CLOSE` below and above a threshold, and whether they are the expected ones."""
    found = tuple(verdict(closure, flow, state(stated * (1 + side * CLOSE))).kind for side in (-1, 1))
    return f"{found[0]}, then {found[1]}", f"within {CLOSE:g}" if found == kinds else "does not turn"


def turning() -> Iterator[Row]:
    """Yield numbers at which a verdict turns."""
    mu = 0.4 + 0.2 * 0.1 / (0.1 + 0.3)
    strength = f"{MU / 2 * HALF**2:.15g}"

    def viscous(value: float) -> dict:
        return COULOMB | {"kinematic_viscosity": value}

    def bulk(value: float) -> dict:
        return BULK | {"bulk_friction": value}

    cures, ends = (Kind.ILL_POSED, Kind.STABLE), (Kind.STABLE, Kind.ILL_POSED)
    for closure, flow, what, stated, state, kinds in (
        ("mu_i", "uniform_strain", "I from which glass beads are well-posed", "0.0193500918873711",
         lambda I: BEADS | at(I), cures),
        ("mu_i", "uniform_strain", "I up to which they are", "0.85226581486577", lambda I: BEADS | at(I), ends),
        ("mu_i", "uniform_strain", "the same of 0.342, 0.557, 0.069", "0.0039717826838072",
         lambda I: GLASS | at(I), cures),
        ("mu_i", "uniform_strain", "and up to", "0.280165773750758", lambda I: GLASS | at(I), ends),
        ("mu_i_phi_i", "uniform_fraction", "μ_b = 1 − 7μ/6 at I = 0.1", f"{1 - 7 * mu / 6:.15g}", bulk, cures),
        (IN_PLANE, "uniform_fraction", "μ_b = 1 − μ at I = 0.1", f"{1 - mu:.15g}", bulk, cures),
        ("viscous", "uniform_strain", "ν = (μ/2) tan²(φ_f/2)", strength, viscous, cures),
    ):  # fmt: skip
        name = "`mu_i_phi_i` with the 2-D deviator" if closure is IN_PLANE else closure
        yield name, what, stated, turns(closure, flow, float(stated), state, kinds)


def friction(law: Callable, I: Any) -> tuple[mpf, mpf]:
    """Return mu and nu = I mu'/mu of a branch of the partially regularised mu(I), from the closure's expression."""
    x = symbol("I")
    given = dict(zip("mu_s mu_2 I_0 mu_inf alpha I_1".split(), (
        LOW[word] for word in ("static_friction", "dynamic_friction", "reference_inertial_number",
                               "high_rate_friction", "low_rate_exponent", "branch_inertial_number")
    ), strict=True))  # fmt: skip
    names = [symbol(name) for name in given]
    mu, slope = (lambdify([x, *names], e, "mpmath") for e in (law(x), x * diff(law(x), x)))
    values = [mpf(I), *map(mpf, given.values())]
    return mu(*values), slope(*values) / mu(*values)


def least_decay(mu: mpf, nu: mpf) -> mpf:
    """Return the largest growth over eta q^2 of mu(I), -[nu - K c + (1 - nu) c^2]/(2 (1 - K c)), c = cos 2phi."""
    K = mu * (1 - nu / 2)
    c = (1 - mp.sqrt(1 - K**2)) / K  # where its derivative vanishes
    return -(nu - K * c + (1 - nu) * c**2) / (2 * (1 - K * c))


def regularised() -> Iterator[Row]:
    """Yield what holds of both branches of the partially regularised mu(I)."""
    with mp.workdps(40):
        for I in ("0.0039717826838072", "1e-30", "1e-300"):
            mu, nu = friction(low, I)
            stated = mp.nstr(least_decay(mu, nu), 15)
            found = verdict("mu_i_regularised_low", "uniform_strain", LOW | at(I))
            value = float(found.coefficient / (mu * 2 / (mpf(I) / 2)))  # eta = mu p/||D||, p = 2 and ||D|| = I/2
            what = f"growth over η q² at I = {I if float(I) < 1e-3 else 'I_1'}"
            said = compared(stated, value)
            yield "mu_i_regularised_low", what, stated, (f"{said[0]}, {found.kind}", said[1])
        printed, values = "16.9918747418162", []
        for side in (-1, 1):
            mu, nu = friction(high, mpf(printed) * (1 + side * CLOSE))
            values.append(4 * nu**2 - 4 * nu + mu**2 * (1 - nu / 2) ** 2)
    kinds = (Kind.STABLE, Kind.STABLE)
    said, off = turns("mu_i_regularised", "uniform_strain", float(printed), lambda I: HIGH | at(I), kinds)
    words = ", then ".join("holds" if v <= 0 else "fails" for v in values)
    off = off if words == "holds, then fails" else "does not turn"
    yield "mu_i_regularised", "I where the printed condition fails", printed, (f"{words}; {said}", off)
    stated, kinds = "17.9066600426969", (Kind.STABLE, Kind.SINGULAR)
    found = turns("mu_i_regularised", "uniform_strain", float(stated), lambda I: HIGH | at(I), kinds)
    yield "mu_i_regularised", "I where directions fail, d(μp)/dp = 1", stated, found


def conditions() -> Iterator[Row]:
    """Yield the three conditions of the compressible I-dependent rheology."""
    I = symbol("I")
    Y, f = laws(I)
    first = simplify((diff(Y, p) - I / (2 * p) * diff(Y, I) - f - I * diff(f, I)).rewrite(log))
    what = "Y_p − (I/2p) Y_I − f − I f_I"
    yield "compressible_i", what, "0", (str(first), "exact" if first == 0 else "differs")

    def strength(value: float) -> dict:
        return CIDR | {"dynamic_strength": value}

    def compaction(value: float) -> dict:
        return CIDR | {"critical_pressure": value}

    equal = CIDR["static_strength"]
    found = turns("compressible_i", "uniform_fraction", float(equal), strength, (Kind.ILL_POSED, Kind.BOUNDED))
    yield "compressible_i", "α_2 = α_1, where Y_I = 0", equal, found
    given = {name: float(CIDR[word]) for name, word in (
        ("alpha_1", "static_strength"), ("alpha_2", "dynamic_strength"), ("I_0", "reference_inertial_number"),
        ("p", "pressure"),
    )}  # fmt: skip
    given["I"] = float(CIDR["strain_rate"]) * sqrt((2 - float(CIDR["delta"]) ** 2) / given["p"])  # 2 d ||D||/sqrt p
    slope = (I * diff(f, I)).subs({symbol(name): value for name, value in given.items()}).evalf(30)
    end = f"{-4 * given['p'] / float(slope):.15g}"  # -2/C = (I/2p) f_I
    found = turns(SOFTENED, "uniform_fraction", float(end), compaction, (Kind.ILL_POSED, Kind.STABLE))
    yield "compressible_i", "C < 0 where f_p − (I/2p) f_I = 0", end, found


def crosses(closure: str, state: dict, end: float) -> tuple[str, str]:
    """Return what the wave of Coulomb flow's worst direction does a relative `CLOSE` longer and shorter than one."""
    given = {word: float(v) for word, v in (COULOMB | SLOW | state).items()}
    worst = 90 / pi * acos(HALF)
    q = [end * (1 + side * CLOSE) for side in (-1, 1)]
    rates = [st.eigenvalues(closure, "uniform_strain", given, {}, one, worst, digits=40)[0].real for one in q]
    said = ", then ".join("grows" if rate > 0 else "decays" for rate in rates)
    return said, f"within {CLOSE:g}" if rates[0] > 0 > rates[1] else "does not turn"


def bands() -> Iterator[Row]:
    """Yield the wavenumbers at which bands end that a regularisation leaves of Coulomb flow."""
    eta, T = 1e-4, HALF**2
    stated = f"{sqrt(MU / eta / 2) * HALF:.15g}"
    what = "q_c = √(μ/(2η_g)) tan(φ_f/2) at η_g = 1e-4"
    yield "hyperstress", what, stated, crosses("hyperstress", {"hyperviscosity": eta}, float(stated))
    for c in (0.5, 1.0):
        stated = f"{2 * pi / sqrt(2 * c * T / (c - T)):.15g}"
        state = MICROPOLAR | {"coupling": c}
        found = crosses("cosserat", state, 2 * pi / float(stated) / float(MICROPOLAR["internal_length"]))
        what = f"narrowest band 2π√((c − T)/(2cT)) over l, T = tan²(φ_f/2), c = {c:g}"
        yield "cosserat", what, stated, found
