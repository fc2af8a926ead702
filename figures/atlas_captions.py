"""The captions of the figures over several closures: what is seen, then the inputs of every state."""

import textwrap
from collections.abc import Mapping, Sequence

from figures import inertial
from figures.atlas import Symbol
from figures.dilation import CRITICAL, PERTURBED
from stability.verdict import Verdict

UNITS = "Units: SI, pressure over density, angles in degrees."

A1 = """Growth of short waves over direction, one panel per registered closure, at its benchmark states. Abscissa:
direction of the wavevector from the axis of extension; opposite directions grow alike. Ordinate: Re lambda/|xi|^n over
the largest growth there is; where no short wave grows, over the largest decay. What lies below {lowest:g} is cut off.
Shaded: directions that grow with the exponent n of the panel, between the exact edges of its verdict, the darker the
larger n; dotted: directions on which growth closes in as waves get shorter. Circles: the worst direction (and its
mirror image) at its limiting growth. Dashed blue: a second state of the same closure. Curves are the limit of short
waves, but where a wavenumber is given: growth that is bounded, or closes in on one direction, is drawn at that wave. n
= 2 and n = 1: ill-posed in Hadamard's sense; 0: growth is bounded; -2: it vanishes as waves get shorter. {certified}
of the {count} verdicts are certified."""


def wrapped(parts: Sequence[str]) -> str:
    """Return paragraphs of a caption."""
    return "\n\n".join(textwrap.fill(" ".join(part.split()), 100) for part in parts) + "\n"


def inputs(parameters: Mapping) -> str:
    """Return parameters as text."""
    return ", ".join(f"{word.replace('_', ' ')} = {float(value):.12g}" for word, value in parameters.items())


def atlas(symbols: Sequence[Symbol], lowest: float) -> str:
    """Return the caption of A1."""
    certified = sum(s.verdict.certified for s in symbols)
    said = A1.format(lowest=lowest, certified=certified, count=len(symbols))
    states = [
        f"{s.benchmark.closure} ({s.benchmark.state}): {found(s)} State: {inputs(s.benchmark.parameters)}."
        for s in symbols
    ]
    return wrapped([said, *states, f"{UNITS} Assumed: all numbers, those of the closures' benchmarks."])


def found(s: Symbol) -> str:
    """Return what short waves do in one sentence."""
    v = s.verdict
    if not s.unstable:
        return f"every short wave decays, as |xi|^{v.exponent}."
    directions = v.directions if s.verdict.width else ", ".join(f"{a:.7g} to {b:.7g}" for a, b in v.wedge if a < 180)
    return f"growth {v.law} at {v.worst_angle:.7g} deg, directions {directions}."


MU_I = """Short waves of the mu(I) rheology, mu = mu_s + (mu_2 - mu_s)/(1 + I_0/I), on uniform plane strain. (a) Glass
beads, over the inertial number and the direction of the wavevector from the axis of extension (mirrored about 0 and 90
deg); colours: growth rate over eta |xi|^2 with eta = mu p/||D||; full lines: exact neutral curves, zeros of the
coefficient that decides the verdict, outside of which every wave decays. They close at I = {low:.15g} and I =
{high:.15g}, the published limits of well-posedness (dotted). (b) Over mu_s, with mu_2 - mu_s and I_0 of glass beads:
the largest growth over all directions, and the edge of the ill-posed region, where a wedge of directions opens (a
double root of the same coefficient). Circles: the printed condition 4 nu^2 - 4 nu + mu^2 (1 - nu/2)^2 = 0 with nu = I
mu'/mu. Above mu_s = {static:.6g}, where the region closes at I = {number:.4g}, the rheology is ill-posed at every I.
Growth is as |xi|^2 wherever there is any: ill-posed in Hadamard's sense."""


def mu_i(edges: tuple[float, float], closing: tuple[float, float]) -> str:
    """Return the caption of A2."""
    low, high = edges
    static, number = closing
    given = {k: v for k, v in inertial.state(1.0).items() if k != "strain_rate"}
    return wrapped([
        MU_I.format(low=low, high=high, static=static, number=number),
        f"State: {inputs(given)}; strain rate from I = sqrt(2) grain diameter ||V||/sqrt(solid fraction p). mu_s = tan "
        "20.9 deg, mu_2 = tan 32.76 deg and I_0 = 0.279 after Barker, Schaeffer, Bohorquez & Gray, J. Fluid Mech. 779, "
        "2015.",
        "Assumed: grain diameter, solid fraction and pressure, which only set the scale of eta.",
    ])  # fmt: skip


DILATION = """Critical-state plasticity (left) beside the perturbed system (right) over the rate of dilation delta = tr
V/||V||, which in both is delta = sqrt(2) sin(psi)/sqrt(1 + sin^2 psi) with the dilation angle psi. (a, b) Growth of
the fastest wave, over its wavenumber and times epsilon; black: the limit of short waves, (a) sqrt(phi Y_phi f/rho)
with f = sin(psi), (b) delta (k - delta)/(2 - delta^2); blue: three finite waves, the darker the shorter, with
directions where they grow; circles: verdicts. Shaded: rates of dilation at which short waves grow. (c, d) The fastest
direction from the axis of extension; black: 45 deg - psi/2, in which both leading matrices vanish. Parallel: the
leading matrix is never positive and vanishes in the same direction; short waves grow about that direction only where
the medium dilates, and only up to an upper limit: delta = 1, where the pressure vanishes, and delta = k = {k:.6g}. Not
parallel: growth is of exponent 1 on the left, without bound as waves get shorter (ill-posed in Hadamard's sense), in a
band of directions that narrows as |xi|^-1/2; on the right it is of exponent 0, bounded by a value of order 1/epsilon,
in a band that narrows as |xi|^-1. Growth sets in as the square root of delta on the left and in proportion to delta on
the right. At delta = 0 the verdicts are exponents {first} and {second}: the critical state itself is ill-posed, the
perturbed system is not. A critical state that compacts slowly, delta from {first_growth:.4g} to 0, keeps growth of
exponent 0 in wedges beside that direction (pale); in the perturbed system no short wave grows there. Between delta =
{low:.6g} and 0, and between k and {high:.6g}, long waves alone grow in the perturbed system (figure P1)."""


def judged(delta: float, v: Verdict) -> str:
    """Return a verdict at a rate of dilation; of decay only that it decays."""
    law = v.law if v.coefficient is not None and v.coefficient > 0 else ""
    return ", ".join(filter(None, (f"delta = {delta:.6g}: {v.kind}", law)))


def dilation(told: Mapping, k: float, first_growth: float) -> str:
    """Return the caption of A3 from the verdicts (delta, verdict) of each system."""
    first, second = (next(v.exponent for d, v in told[name] if d == 0) for name in ("critical_state", "perturbed"))
    low, high = -k / (2 * (1 + 2**0.5)), k * (1 + 2**0.5) / 2
    said = [f"Verdicts of {name}: {'; '.join(judged(*pair) for pair in found)}." for name, found in told.items()]
    return wrapped([
        DILATION.format(k=k, first_growth=first_growth, first=first, second=second, low=low, high=high),
        *said,
        *(f"State of {s.closure}: {inputs({w: v for w, v in s.constants.items() if w not in ('delta', 'pressure')})}; "
          f"{how}." for s, how in ((CRITICAL, "pressure from f = 2 critical friction (1 - p/C)"),
                                   (PERTURBED, f"pressure = {PERTURBED.constants['pressure']:g}; D' (P7)"))),
        f"{UNITS} Assumed: all numbers, those of the closures' benchmarks.",
    ])  # fmt: skip
