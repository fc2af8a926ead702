"""The least value of a regularising parameter that cures a point of a flow, and from where to where values cure.

Stage 1  a scan over the bracket, in float64: which values cure; nothing is taken for granted between or beyond them
Stage 2  bisection at both ends of the lowest run of values that do, in float64
Stage 3  without a bound on growth, both ends again in ball arithmetic; with one, a proof that the failing values fail
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import partial
from math import isfinite, nan, pi, sqrt
from numbers import Real
from typing import Any, NoReturn

from stability import codegen
from stability.bracketing import apart, halved, scanned
from stability.closures import CLOSURES
from stability.cured import Cure
from stability.errors import SceneError
from stability.finite import strain_rate
from stability.model import Model
from stability.opened import Point, decays, endless, exceeds, fastest_of, largest, stable
from stability.parameters import bracketed, meant

KINEMATICS = "What still grows does so no faster than ||V||: the kinematics of the longest waves."
ENDLESS = "The longest waves grow fastest: no width is singled out, and about a frozen base state they mean little."
SEARCHED = "That values cure is a search over all waves in float64, not a proof."
JUDGED = "Of the other values tried, float64 judged those that are clear."


@dataclass(frozen=True)
class Run:
    """The lowest run of values that cure: its ends, and the neighbours that do not; None where the bracket ends."""

    tried: tuple[float, float, int]
    below: float | None
    above: float
    last: float
    beyond: float | None
    again: tuple[tuple[float, float], ...]


def smallest_cure(
    closure: Any,
    flow: Any,
    parameters: Mapping,
    point: Mapping,
    parameter: str = "epsilon",
    growth: float = 0.0,
    rtol: float = 1e-6,
    bracket: tuple[float, float] | None = None,
    longest: float | None = None,
) -> Cure:
    """Return the least value of a parameter found to make a point stable to short waves, or to bound the growth of all.

    Parameters
    ----------
    closure, flow, parameters, point : as in `stability.well_posedness`; ``parameters`` without the open one
    parameter : word of the parameter that regularises: ``epsilon``, ``kinematic_viscosity``, ...; a part of it will do
        where one parameter of the closure alone has it in its name, as ``viscosity``
    growth : 1/s. 0: no short wave may grow, which ball arithmetic decides. More: no wave of any length may grow faster
    rtol : how close two neighbours are of which one cures and the other does not, relative
    bracket : positive values between which to look; None: the parameter's range, from 1e-15 to 1e15 where it is open
    longest : m, of the waves that are looked at: about a frozen base state, waves longer than the flow mean nothing.
        None: the distance over which the pressure (or another scalar field) changes by itself, p/|grad p|; in a uniform
        flow a thousand times the length at which the terms of the waves' equations balance

    Returns
    -------
    `Cure`: the lowest run of curing values among those of a scan over the bracket, with both of its ends. A parameter
    may cure up to some value only, or between two; nothing is said about values between those tried, nor outside the
    bracket. With ``growth`` 0 the ends are certified where the verdicts there are. Else it is certified that the
    neighbours beyond the ends do not cure, by one wave that grows faster, enclosed in balls; that the ends do is a
    search over all waves, which is not a proof.

    Raises
    ------
    SceneError : no such parameter, or no value tried that cures
    """
    model = Model(closure, flow)
    own = [r.word for r in codegen.load(CLOSURES, closure, codegen.RECORDS)["PARAMETERS"]]
    record = model.parameters[meant(parameter, model.parameters, own)]
    if not (isinstance(growth, Real) and isfinite(growth) and growth >= 0):
        raise SceneError(f"growth = {growth!r} 1/s lies outside [0, inf) 1/s")
    if not 1e-14 <= rtol < 1:
        raise SceneError(f"rtol = {rtol!r} lies outside [1e-14, 1): float64 holds no more digits")
    low, high = bracketed(record, bracket)
    if longest is not None and not (isfinite(longest) and longest > 0):
        raise SceneError(f"longest = {longest!r} m lies outside (0, inf) m")
    if record.word in parameters:
        raise SceneError(
            f"{record.word} = {parameters[record.word]!r} is what is asked for: leave it out of parameters"
        )
    at = Point(closure, flow, parameters, point, record.word, longest)
    at.base(sqrt(low) * sqrt(high))  # everything that is wrong with the question is said here

    about = (record.word, record.unit, float(growth))
    if growth:
        found = first_run(lambda value: bool(largest(at, value, growth)[0] <= growth), low, high, rtol)
        return bounded(at, found, about) if found else refused(at, record.described, about, low, high)
    strict, note = partial(stable, at), JUDGED
    found = first_run(partial(decays, at), low, high, rtol)
    found = found and ended(found, strict, rtol)
    if found is None:  # what float64 saw is wrong, or nothing cures: balls alone
        found, note = first_run(strict, low, high, rtol), "All values tried were decided in balls."
    return decided(at, found, about, note) if found else refused(at, record.described, about, low, high)


def first_run(cures: Callable[[float], bool], low: float, high: float, rtol: float) -> Run | None:
    """Return the lowest run of values that cure, or None."""
    values, runs = scanned(cures, low, high)
    if not runs:
        return None
    (i, j), last = runs[0], len(values) - 1
    above, below = halved(cures, values[i], values[i - 1], rtol) if i else (values[0], None)
    end, beyond = halved(cures, values[j], values[j + 1], rtol) if j < last else (values[-1], None)
    again = tuple((values[a], values[b]) for a, b in runs[1:])
    return Run((values[0], values[-1], len(values)), below, above, end, beyond, again)


def ended(run: Run, cures: Callable[[float], bool], rtol: float) -> Run | None:
    """Return a run with its ends as a stricter judge sees them, or None where that judge sees another run.

    Where the looser one was wrong about an end, that end gives way by twice as much each time, and bisection follows.
    """
    ends: list[tuple[float, float | None]] = []
    for good, bad in ((run.above, run.below), (run.last, run.beyond)):
        if bad is None:
            if not cures(good):
                return None
            ends.append((good, None))
            continue
        found = apart(cures, good, bad, rtol)
        if found is None:
            return None
        ends.append(halved(cures, *found, 2 * rtol))
    (above, below), (last, beyond) = ends
    return replace(run, below=below, above=above, last=last, beyond=beyond)


def refused(at: Point, described: str, about: tuple[str, str, float], low: float, high: float) -> NoReturn:
    """Raise the sentence that says that nothing tried cures."""
    _, unit, growth = about
    what = f"keeps the growth of every wave within {growth:g} 1/s" if growth else "makes short waves decay"
    text = f"no value tried from {low:g} to {high:g} {unit} of {described} {what}"
    rate = strain_rate(at.base(high)) or 0.0
    if 0 < growth < rate:
        text += f": the longest waves grow at up to ||V|| = {rate:.4g} 1/s by the kinematics alone; ask for more growth"
    raise SceneError(text)


def decided(at: Point, run: Run, about: tuple[str, str, float], note: str) -> Cure:
    """Return the cure of short waves, its ends decided by `well_posedness`."""
    ends = run.below, run.above, run.last, run.beyond
    found = {value: at.verdict(value) for value in ends if value is not None}
    proven = [value is not None and found[value].certified for value in ends]
    grows = nan if run.below is None else fastest_of(found[run.below])
    return answer(at, run, about, grows, (proven[0], proven[1]), (proven[2], proven[3]), note)


def bounded(at: Point, run: Run, about: tuple[str, str, float]) -> Cure:
    """Return the cure of all waves; that a value does not cure is certified where one wave's growth is enclosed."""
    growth = about[2]
    waves = [None if value is None else largest(at, value, growth) for value in (run.below, run.beyond)]
    fails = [
        value is not None and wave is not None and exceeds(at, value, wave, growth)
        for value, wave in zip((run.below, run.beyond), waves, strict=True)
    ]
    grows = waves[0][0] if waves[0] else nan
    return answer(at, run, about, grows, (fails[0], False), (False, fails[1]), SEARCHED)


def answer(
    at: Point, run: Run, about: tuple, grows: float, certified: tuple[bool, bool], upper: tuple[bool, bool], note: str
) -> Cure:
    """Return the cure with what still grows at its least value."""
    wave = largest(at, run.above, about[2])
    rate, wavenumber, angle = wave
    long = rate > 0 and endless(at, run.above, wave)
    why = KINEMATICS if rate <= (strain_rate(at.base(run.above)) or 0.0) else ENDLESS
    alone = rate > 0 and not long
    name, unit, growth = about
    return Cure(
        name, unit, growth, run.tried, run.below, run.above, run.last, run.beyond, run.again, grows, rate,
        wavenumber if alone else None, angle if alone else None,
        2 * pi / wavenumber if alone and isfinite(wavenumber) else None,
        certified, upper, (why, note) if long else (note,),
    )  # fmt: skip
