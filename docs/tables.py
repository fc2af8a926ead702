"""Writes the tables of docs/closures.md from `stability.well_posedness`: python -m docs.tables (half a minute)."""

from collections.abc import Iterator
from math import acos, pi, sin, sqrt, tan
from pathlib import Path

import stability as st
from stability.verdict import Kind, Verdict
from tests.closures.benchmarks import BENCHMARKS, BULK, COULOMB, CRITICAL, GLASS, at

DOCUMENT = Path(__file__).with_name("closures.md")
BEGIN, END = "<!-- {name}: written by `python -m docs.tables`, held by a test -->\n", "<!-- end -->\n"
CLOSE = 1e-12  # relative: what numbers that were given with 15 digits must meet, and how near a threshold is tried
HALF = tan(17 * pi / 180)  # tan(varphi/2) at 34 degrees
MU = sqrt(2) * sin(34 * pi / 180)  # k p/||V|| of `COULOMB`


def verdict(closure: str, flow: str, parameters: dict) -> Verdict:
    """Return the verdict at a state whose numbers may be text."""
    return st.well_posedness(closure, flow, {word: float(value) for word, value in parameters.items()}, {})


def table(head: str, rows: Iterator[tuple]) -> str:
    """Return a Markdown table whose columns have names without commas."""
    names = head.split(", ")
    lines = [names, ["---"] * len(names), *rows]
    return "".join(f"| {' | '.join(map(str, line))} |\n" for line in lines)


def exponents() -> Iterator[tuple]:
    """Yield the rows of the table of growth exponents."""
    for b in BENCHMARKS:
        found = verdict(b.closure, b.flow, b.parameters)
        stated = "decays" if b.exponent is None else b.exponent
        computed = "decays" if found.kind is Kind.STABLE else found.exponent
        law = power(found.coefficient, found.exponent)
        where = "" if found.kind is Kind.STABLE else f"{found.worst_angle:.8g}°{narrowing(found)}"
        certified = "yes" if found.certified else "no"
        source = st.CLOSURES[b.closure].source
        yield f"`{b.closure}`", source, b.state, stated, computed, str(found.kind), law, where, certified, b.why


def power(coefficient: float, exponent: object) -> str:
    """Return a law of growth as text."""
    return f"{coefficient:.8g}" + ("" if exponent == 0 else " q" if exponent == 1 else f" q^{exponent}")


def narrowing(found: Verdict) -> str:
    """Return how directions close in on a single one."""
    return f", within q^-{found.width}" if found.width else ""


def acceptance() -> Iterator[tuple]:
    """Yield the rows of the table of published and stated numbers."""
    for closure, what, stated, found in (*numbers(), *thresholds(), cutoff()):
        yield f"`{closure}`", what, stated, *found


def compared(stated: str, value: float) -> tuple[str, str]:
    """Return a computed number and how far it is from the stated one."""
    off = abs(value / float(stated) - 1)
    return f"{value:.15g}", "below 1e-14" if off < 1e-14 else f"{off:.1g}"


def numbers() -> Iterator[tuple]:
    """Yield numbers that a verdict holds."""
    found = verdict("rigid_plastic", "uniform_strain", COULOMB)
    for what, stated, value in (
        ("largest growth over μ q²", "0.0467356247925884", found.coefficient / MU),
        ("its direction (deg)", "36.0989355774566", found.worst_angle),
        ("lower end of the wedge, cos 2φ = sin φ_f (deg)", "28", found.wedge[0][0]),
        ("upper end of the wedge, cos 2φ = 0 (deg)", "45", found.wedge[0][1]),
    ):
        yield "rigid_plastic", what, stated, compared(stated, value)
    beads = GLASS | {"static_friction": tan(20.9 * pi / 180), "dynamic_friction": tan(32.76 * pi / 180)}
    beads |= {"reference_inertial_number": "0.279"}
    found = verdict("mu_i", "uniform_strain", beads | at("1e-3"))
    mu = beads["static_friction"] + (beads["dynamic_friction"] - beads["static_friction"]) / (1 + 0.279 / 1e-3)
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


def thresholds() -> Iterator[tuple]:
    """Yield numbers at which a verdict turns, tried a relative `CLOSE` below and above."""
    glass = {**GLASS, "high_rate_friction": "0.05"}
    beads = GLASS | {"static_friction": tan(20.9 * pi / 180), "dynamic_friction": tan(32.76 * pi / 180)}
    beads |= {"reference_inertial_number": "0.279"}
    mu = 0.4 + 0.2 * 0.1 / (0.1 + 0.3)
    strength = f"{MU / 2 * HALF**2:.15g}"

    def viscous(value: float) -> dict:
        return COULOMB | {"kinematic_viscosity": value}

    def bulk(value: float) -> dict:
        return BULK | {"bulk_friction": value}

    for closure, flow, what, stated, state, above in (
        ("mu_i", "uniform_strain", "I from which glass beads are well-posed", "0.0193500918873711",
         lambda I: beads | at(I), Kind.STABLE),
        ("mu_i", "uniform_strain", "I up to which they are", "0.85226581486577",
         lambda I: beads | at(I), Kind.ILL_POSED),
        ("mu_i", "uniform_strain", "the same of 0.342, 0.557, 0.069", "0.0039717826838072",
         lambda I: GLASS | at(I), Kind.STABLE),
        ("mu_i", "uniform_strain", "and up to", "0.280165773750758", lambda I: GLASS | at(I), Kind.ILL_POSED),
        ("mu_i_regularised", "uniform_strain", "I where d(μp)/dp = 1 (the printed condition fails at 16.99)",
         "17.9066600426969", lambda I: glass | at(I), Kind.SINGULAR),
        ("mu_i_phi_i", "uniform_fraction", "μ_b = 1 − 7μ/6 at I = 0.1", f"{1 - 7 * mu / 6:.15g}", bulk, Kind.STABLE),
        ("viscous", "uniform_strain", "ν = (μ/2) tan²(φ_f/2)", strength, viscous, Kind.STABLE),
    ):  # fmt: skip
        kinds = [verdict(closure, flow, state(float(stated) * (1 + side * CLOSE))).kind for side in (-1, 1)]
        below = Kind.ILL_POSED if above is Kind.STABLE else Kind.STABLE
        turns = kinds == [below, above]
        yield closure, what, stated, (f"{kinds[0]}, then {kinds[1]}", f"within {CLOSE:g}" if turns else "does not turn")


def cutoff() -> tuple:
    """Return the row of the wavenumber at which a hyperstress ends the growth of Coulomb flow."""
    eta = 1e-4
    stated = f"{sqrt(MU / eta / 2) * HALF:.15g}"
    slow = {word: float(v) for word, v in (COULOMB | {"strain_rate": 1e-30, "pressure": 1e-30}).items()}
    worst = 90 / pi * acos(HALF)
    q = [float(stated) * (1 + side * CLOSE) for side in (-1, 1)]
    state = slow | {"hyperviscosity": eta}
    rates = [st.eigenvalues("hyperstress", "uniform_strain", state, {}, one, worst, digits=40)[0].real for one in q]
    turns = rates[0] > 0 > rates[1]
    said = ", then ".join("grows" if rate > 0 else "decays" for rate in rates)
    return (
        "hyperstress", "q_c = √(μ/(2η_g)) tan(φ_f/2) at η_g = 1e-4", stated,
        (said, f"within {CLOSE:g}" if turns else "does not turn"),
    )  # fmt: skip


TABLES = {
    "exponents": (
        "closure, source, state, n stated, n computed, verdict, fastest short waves (1/s), at, certified, why",
        exponents,
    ),
    "numbers": ("closure, what, stated, computed, relative difference", acceptance),
}


def document() -> str:
    """Return docs/closures.md with its tables computed anew."""
    text = DOCUMENT.read_text(encoding="utf-8")
    for name, (head, rows) in TABLES.items():
        begin = BEGIN.format(name=name)
        before, rest = text.split(begin)
        text = f"{before}{begin}\n{table(head, rows())}\n{END}{rest.split(END, 1)[1]}"
    return text


if __name__ == "__main__":
    DOCUMENT.write_text(document(), encoding="utf-8")
