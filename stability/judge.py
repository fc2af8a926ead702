"""Short waves about a frozen base state: the verdict, and the law of every direction.

Stage 1  the base state and its pencil in balls, for an observer who moves along (`model`)
Stage 2  det(lambda E - L) as forms in the direction; the special directions, certainly isolated (`directions`)
Stage 3  one direction of each arc between them stands for all: laws of its modes (`puiseux`)
Stage 4  the special directions, and those that approach them as |xi| grows (layers)
Stage 5  the fastest law of all, its largest coefficient over the directions, and what it comes from
Stage 6  all of it again with twice the bits: a coefficient that vanishes must go on vanishing

A ball that holds zero with b bits at hand is a number that vanishes to about b bits of what was added up for it; no
arithmetic can tell more of a number that is not rational. Stage 6 and the note of the verdict are what this rests on.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from fractions import Fraction
from math import inf
from typing import Any

import numpy as np

from stability import codegen, finite
from stability.balls import enclosing
from stability.causes import causes, makers, silent
from stability.closures import CLOSURES
from stability.directions import Directions
from stability.errors import SceneError, StabilityError
from stability.layers import maximum
from stability.model import Base, Model
from stability.puiseux import Law, Numbers, laws, strongest
from stability.singular import beside
from stability.verdict import Kind, Verdict
from stability.wedges import both_ways, merged

BITS = (256, 512, 1024)  # each step must repeat what the one before found
ALIKE = 1e-12  # relative: coefficients that agree in all digits that are printed have no direction
SAMPLES = 24  # directions of an arc on which a neutral root was taken off: not decided by the deciding forms


@dataclass(frozen=True)
class Candidate:
    """A law of growth: over an arc, or of directions that close in on one."""

    exponent: Any
    coefficient: Any
    arc: tuple[float, float]
    angle: float
    width: Fraction
    depth: int
    alike: bool = False  # in all directions of its exponent

    @property
    def key(self) -> tuple:
        """What another precision must find again."""
        return self.exponent, self.width, self.coefficient > 0, round(self.angle, 6), self.depth


@dataclass(frozen=True)
class Findings:
    """What one precision found: candidates for the fastest growth, directions with too few modes, whether sampled."""

    candidates: list[Candidate]
    lost: tuple[float, ...]
    sampled: bool
    missing: bool


def ball_base(closure: Any, flow: Any, parameters: dict, point: dict, bits: int) -> Base:
    """Return the base state at one point in balls, for an observer who moves along."""
    if any(np.ndim(value) for value in point.values()):
        raise SceneError(f"a verdict holds at one point: give numbers instead of arrays for {', '.join(point)}")
    with np.errstate(all="ignore"):
        return Model(closure, flow, enclosing(bits)).base(parameters, point).resting()[0]


def examined(base: Base, matrix: str, bits: int) -> tuple[Directions, Findings]:
    """Return what can be said with that many bits."""
    d = Directions(base.model.evolves, base.pencil(matrix), Numbers(base.model.arithmetic, bits))
    modes = max((j for j, _ in d.forms), default=-1)
    if modes < 1 or modes < base.model.modes:
        return d, Findings([], (), False, True)
    candidates, sampled, lost = [], False, []
    for low, high in d.arcs():
        found = d.laws(middle_of(low, high))
        hidden = undecided_between(d, found)
        sampled |= hidden
        candidates += list(over_arc(d, low, high, found, hidden))
    for s in d.special:
        near = d.nearby(s)
        found = laws(near, d.numbers)
        if len(found) < modes:
            lost.append(s.angle)
            continue
        law, here = strongest(found), (s.angle, s.angle)
        close = [Candidate(x.exponent, x.coefficient, here, s.angle, x.narrowing, x.depth) for x in d.layers(s)]
        if not any(law.exponent <= c.exponent for c in close):  # a layer knows of its own middle
            close.append(Candidate(law.exponent, law.coefficient, here, s.angle, Fraction(0), law.depth))
        candidates += close
    return d, Findings(candidates, tuple(lost), sampled, False)


def undecided_between(d: Directions, found: list[Law]) -> bool:
    """Return whether one direction does not stand for its arc: what is behind a neutral root may change within it.

    Growth of the highest exponent there is decides an arc whatever other modes do; a mode at rest stays at rest.
    """
    if d.degenerate:
        return True
    law = strongest(found)
    if law.sign > 0 and not law.depth and law.exponent == d.highest:
        return False
    return any(law.depth or not (law.sign or law.exponent == -inf) for law in found)


def middle_of(low: float, high: float) -> float:
    """Return a direction inside an arc, not the middle: symmetric states like to be special there."""
    return low + 0.4871 * (high - low)


def over_arc(d: Directions, low: float, high: float, found: list[Law], hidden: bool) -> Iterator[Candidate]:
    """Yield the strongest law of an arc; of every sampled direction where neutral roots hide what happens between."""
    directions = [middle_of(low, high)]
    if hidden:
        directions += [low + (high - low) * (i + 0.5) / SAMPLES for i in range(SAMPLES)]
    for angle in directions:
        law = strongest(found if angle == directions[0] else d.laws(angle))
        yield Candidate(law.exponent, law.coefficient, (low, high), angle, Fraction(0), law.depth)


def fastest(candidates: list[Candidate]) -> Candidate:
    """Return the candidate of largest growth; of no growth, that of slowest decay."""
    growing = [c for c in candidates if c.coefficient > 0]
    if growing:
        return max(growing, key=lambda c: (c.exponent, c.coefficient))
    return min(candidates, key=lambda c: (c.exponent, -c.coefficient))


def same(one: Findings, other: Findings) -> bool:
    """Return whether two precisions found the same."""
    plain = [sorted((c.key for c in f.candidates), key=str) for f in (one, other)]
    return plain[0] == plain[1] and len(one.lost) == len(other.lost) and one.missing == other.missing


def well_posedness(closure: Any, flow: Any, parameters: dict, point: dict, matrix: str = "full") -> Verdict:
    """Return what the shortest waves do at a point of a flow.

    Parameters
    ----------
    closure, flow : registered names, ``my_file.py:NAME``, or a `Closure` and a `Flow`
    parameters : words to numbers, SI units, angles in degrees; taken as the decimals that they print as
    point : coordinates of the flow's point (angles in degrees), {} for a uniform flow
    matrix : "full", or "truncated" for D' (P7) of closures with two velocities and one constraint

    Returns
    -------
    `Verdict`; ``print`` it, or look at its ``kind``, ``exponent``, ``wedge``, ``worst_angle`` and ``coefficient``

    Raises
    ------
    SceneError : a parameter or a point outside its range, a flow without a field that the closure needs
    """
    before: Findings | None = None
    for bits in BITS:
        base = ball_base(closure, flow, parameters, point, bits)
        try:
            d, found = examined(base, matrix, bits)
        except (ArithmeticError, StabilityError) as e:
            if isinstance(e, SceneError):
                raise
            before = None
            reason = f"{type(e).__name__}: {e}"
            continue
        if before is not None and same(before, found):
            verdict = replace(concluded(d, found, base, matrix), siblings=siblings(closure))
            if verdict.kind is Kind.SINGULAR or verdict.kind is Kind.ILL_POSED:
                return verdict
            return searched(verdict, base, d, (closure, flow, parameters, point, matrix))
        before, reason = found, "two precisions disagree about which coefficients vanish"
    return Verdict(Kind.UNDECIDED, notes=(f"{reason} (up to {BITS[-1]} bits)",))


def searched(verdict: Verdict, base: Base, d: Directions, question: tuple) -> Verdict:
    """Return the verdict with the fastest wave of any length, from a search in float64."""
    closure, flow, parameters, point, matrix = question
    with np.errstate(all="ignore"):  # a state beyond float64 has no finite growth rate, which is said
        found, longest = finite.largest(Model(closure, flow).base(parameters, point), d, matrix)
    notes = verdict.notes
    if found is None:
        notes += ("float64 does not hold this state: waves of finite length were not searched",)
    rate = finite.strain_rate(base) if matrix == "full" else None
    return replace(verdict, finite=found, longest=longest, strain_rate=rate, notes=notes)


def siblings(closure: Any) -> tuple[str, ...]:
    """Return the other closures of a registered one's module and source: branches of one law, each for its states."""
    if closure not in CLOSURES:
        return ()

    def record(name: str) -> dict:
        return codegen.load(CLOSURES, name, codegen.RECORDS)

    module = CLOSURES.place(closure).split(":")[0]
    near = [n for n in CLOSURES if n != closure and CLOSURES.place(n).split(":")[0] == module]
    alike = [n for n in near if record(n)["SOURCE"] == record(closure)["SOURCE"]]
    return tuple(f"{n} ({record(n)['TITLE']})" for n in alike)


def concluded(d: Directions, found: Findings, base: Base, matrix: str) -> Verdict:
    """Return the verdict from what was found twice."""
    if found.missing:
        few = "det(lambda E - L) has too low a degree in every direction"
        return Verdict(Kind.SINGULAR, cause=tuple(silent(base, matrix)), notes=(few,))
    if found.lost:
        lost = [s for s in d.special if s.angle in found.lost]
        top = max(d.forms)
        return Verdict(
            Kind.SINGULAR, wedge=tuple((a, a) for a in both_ways(found.lost)), vanishing=top, beside=beside(d, lost),
            cause=tuple(makers(base, matrix, d, top)), notes=("a mode goes to infinity in these directions",),
        )  # fmt: skip
    best = fastest(found.candidates)
    notes = [f"coefficients that vanish to {d.numbers.bits} bits of their terms count as zero"]
    if found.sampled:
        notes.append(f"neutral leading orders: {SAMPLES} directions of each arc were tried, not all of them")
    if best.coefficient <= 0:
        if best.exponent > -inf and best.arc[0] < best.arc[1]:
            best = peak(d, [c for c in found.candidates if c.exponent == best.exponent and c.arc[0] < c.arc[1]], best)
        exponent, coefficient = (None, None) if best.exponent == -inf else (best.exponent, float(best.coefficient))
        angle = None if exponent is None or best.alike else best.angle % 180
        if excess := finite.excess(d, 0, 0):
            notes.append(excess)
        return Verdict(
            Kind.STABLE, exponent, (), angle, coefficient, certified=not (found.sampled or excess), notes=tuple(notes)
        )
    alike = [c for c in found.candidates if c.coefficient > 0 and c.exponent == best.exponent]
    wide = [c.arc for c in alike if c.arc[0] < c.arc[1]]
    wedge = merged(wide or [c.arc for c in alike], {c.angle for c in alike if c.arc[0] == c.arc[1]} if wide else set())
    if best.arc[0] < best.arc[1]:
        best = peak(d, [c for c in alike if c.arc[0] < c.arc[1]], best)
    if excess := finite.excess(d, best.exponent, best.coefficient):
        notes.append(excess)
    kind = Kind.ILL_POSED if best.exponent > 0 else Kind.BOUNDED
    place = best.angle if best.arc[0] < best.arc[1] else next(s for s in d.special if s.angle == best.angle)
    cause = tuple(causes(base, matrix, d, place, best.exponent))
    worst = None if best.alike else best.angle % 180
    return Verdict(
        kind, best.exponent, wedge, worst, float(best.coefficient), best.width, cause,
        certified=not (found.sampled or excess), notes=tuple(notes),
    )  # fmt: skip


def peak(d: Directions, alike: list[Candidate], best: Candidate) -> Candidate:
    """Return the direction of largest coefficient over the arcs, to float64, or that it is the same in all."""

    def coefficient(angle: float) -> Any:
        found = [law.coefficient for law in d.laws(angle) if law.exponent == best.exponent]
        return max(found, default=-inf)

    arcs = sorted({c.arc for c in alike})
    grids = [[low + (high - low) * (i + 0.5) / SAMPLES for i in range(SAMPLES)] for low, high in arcs]
    table = [[coefficient(a) for a in grid] for grid in grids]
    most, least = max(map(max, table)), min(map(min, table))
    if most - least <= ALIKE * abs(most):
        return replace(best, alike=True)
    for (low, high), grid, values in zip(arcs, grids, table, strict=True):
        i = max(range(SAMPLES), key=values.__getitem__)
        step = (high - low) / SAMPLES
        mp = d.numbers.mp
        ends = max(low, grid[i] - step), grid[i], min(high, grid[i] + step)
        left, centre, right = map(mp.mpf, ends)
        angle = float(maximum(coefficient, left, centre, right, mp))
        value = coefficient(angle)
        if value > best.coefficient * (1 + mp.mpf(10) ** -25):
            best = replace(best, coefficient=value, angle=angle, arc=(low, high))
    return best


def short_wave(
    closure: Any, flow: Any, parameters: dict, point: dict, wave_angle: Any, matrix: str = "full"
) -> tuple[np.ndarray, np.ndarray]:
    """Return n and c of ``Re lambda ~ c |xi|^n``, the law of the fastest mode, for each direction on its own.

    Parameters
    ----------
    wave_angle : degrees from the flow's axis, an array of any shape; the others as in `well_posedness`

    Returns
    -------
    (exponent, coefficient), float arrays of the shape of wave_angle; -inf and 0 for a neutral mode
    """
    angles = np.asarray(wave_angle, float)
    base = ball_base(closure, flow, parameters, point, BITS[0])
    d = Directions(base.model.evolves, base.pencil(matrix), Numbers(base.model.arithmetic, BITS[0]))
    found = [strongest(laws_) if (laws_ := d.laws(a)) else Law(np.nan, np.nan, 0, 0) for a in angles.ravel()]
    exponent, coefficient = (np.array([float(getattr(law, w)) for law in found]) for w in ("exponent", "coefficient"))
    return exponent.reshape(angles.shape), coefficient.reshape(angles.shape)
