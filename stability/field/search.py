"""The fastest wave about each of many base states: first guesses, then Newton's method in direction and wavenumber.

Guesses are a fan of directions at several wavenumbers, and the waves of `guides` where closed forms give them. From the
best guess on, Newton's method with exact derivatives climbs to the top, in two to five steps; no further at a time than
a trusted distance, which shrinks where growth falls and doubles where it rises.
"""

from collections.abc import Sequence
from dataclasses import dataclass, fields

import numpy as np

from stability.field.guides import Guide
from stability.field.waves import Waves

FAN, FINE = 24, 72  # directions of the half circle: growth varies over some 20 degrees, with three modes over 5
COLUMNS, FEW = 8, 5  # wavenumbers from end to end, without and with a guide to the best one
STEPS = 24  # at most: curved ridges take up to twenty
TOLERANCE = 1e-6  # of the growth rate: a step that promises less is the last one, and leaves an error of 1e-11 or so
ROUNDING = 1e-13  # of the largest eigenvalue: gains below it cannot be seen
SHRINK = 4.0  # of the trusted distance after a step that led down
TIE = 1e-9  # of a growth rate: of hills that are equally high but for roundings, the first one is climbed
APART, FAR = 1.5, 1.5  # between hills at least: spacings of the directions, or of the wavenumbers, looked at
RIVAL = 0.5  # of the best guess: hills that are lower by more are not climbed
CROWD = 0.7  # of the points, when more are still climbing none is left behind: taking some costs as much as a step


@dataclass(frozen=True)
class Fastest:
    """The fastest wave at each point: growth (1/s), wavenumber (1/m), angle (radians)."""

    growth: np.ndarray
    wavenumber: np.ndarray
    angle: np.ndarray


@dataclass(frozen=True)
class Guess:
    """Waves at each point, (point,) or (point, n): growth rate, its rank among guesses, and the width of the hill."""

    rank: np.ndarray
    growth: np.ndarray
    angle: np.ndarray
    wavenumber: np.ndarray
    width: np.ndarray

    def take(self, rows: np.ndarray, columns: np.ndarray) -> "Guess":
        """Return one wave for each of some points."""
        return Guess(*(getattr(self, f.name)[rows, columns] for f in fields(self)))

    @classmethod
    def joined(cls, guesses: Sequence["Guess"]) -> "Guess":
        """Return the waves of all guesses."""
        return cls(*(np.concatenate([getattr(g, f.name) for g in guesses], axis=1) for f in fields(cls)))


def fan(count: int) -> np.ndarray:
    """Return directions (1, count) over half a circle, radians; not along axes, where symmetric states are special."""
    return (np.pi / count * (np.arange(count) + 0.4871))[None]


def usable(growth: np.ndarray, instead: float = -np.inf) -> np.ndarray:
    """Return growth rates with what is not a number out of the way."""
    return np.where(np.isfinite(growth), growth, instead)


def fastest(waves: Waves, guide: Guide, low: np.ndarray, high: np.ndarray, watch: bool = True) -> Fastest:
    """Return the fastest wave with a wavenumber from low to high (point,).

    One array for both ends asks for directions alone. ``watch``: whether to look beside the directions of a guide.
    """
    alone = low is high
    led = guide.guided if alone else guide.ranked  # to the top of the highest hill, but for lower orders
    span = np.zeros(waves.count) if alone else np.log(high / low)
    count = 1 if alone else FEW if led else COLUMNS
    columns = [low * np.exp(span * part) for part in np.linspace(0, 1, count)]
    if guide.ranked and not alone:
        columns.append(guide.wavenumber(low, high))
    fine = alone and waves.modes > 2  # with three modes hills stand as near as 5 degrees
    directions = fan(FINE if fine else FAN) if watch or not led else None
    seen = Guess.joined([one for column in columns for one in looked(waves, guide, column, directions, led)])
    rows, best = np.arange(waves.count), first(seen.rank)
    stretch = np.maximum(span / COLUMNS / 2, np.finfo(float).tiny)
    found = climbed(waves, seen.take(rows, best), stretch, low, high, alone)
    if not watch or (alone and led):
        return found
    # Another hill may turn out higher once one is up there: the best guess that stands elsewhere is climbed too.
    near = np.pi / (FAN if directions is None else directions.size)
    rank = np.where(elsewhere(seen, seen.take(rows, best), near, span / COLUMNS), seen.rank, -np.inf)
    top = seen.rank[rows, best]
    some = np.flatnonzero(rank.max(axis=1) > top - RIVAL * abs(usable(top, 0.0)))
    if some.size:
        rival, low = seen.take(some, first(rank[some])), low[some]
        other = climbed(waves.take(some), rival, stretch[some], low, low if alone else high[some], alone)
        higher = other.growth > found.growth[some]
        for f in fields(found):
            getattr(found, f.name)[some[higher]] = getattr(other, f.name)[higher]
    return found


def looked(waves: Waves, guide: Guide, wavenumber: np.ndarray, directions: np.ndarray | None, led: bool) -> list[Guess]:
    """Return the guide's waves at a wavenumber, and the two highest hills of a fan of directions."""
    ring, found = waves.at(wavenumber), []
    if guide.kind != "none":
        angles, widths = guide.directions(wavenumber)
        growth = usable(ring.growth(angles))
        found.append(Guess(growth, growth, angles, np.broadcast_to(wavenumber[:, None], growth.shape), widths))
    if directions is not None:
        growth = usable(ring.growth(directions))
        rank, rows = growth if led else crested(growth), np.arange(waves.count)
        one = first(rank)
        hill = (rank >= np.roll(rank, 1, axis=1)) & (rank >= np.roll(rank, -1, axis=1))
        hill[rows, one] = False
        i = np.stack([one, first(np.where(hill, rank, -np.inf))], axis=1)
        width = np.array(np.pi / directions.size / 2)
        picked = (rank[rows[:, None], i], growth[rows[:, None], i], directions[0, i], wavenumber[:, None], width)
        found.append(Guess(*(np.broadcast_to(a, i.shape) for a in picked)))
    return found


def first(rank: np.ndarray) -> np.ndarray:
    """Return the index of the highest rank of each point, the first one where roundings tell them apart."""
    top = rank.max(axis=1, keepdims=True)
    return (rank >= top - TIE * abs(usable(top, 0.0))).argmax(axis=1)


def turned(one: np.ndarray, other: np.ndarray) -> np.ndarray:
    """Return the angle between two directions, from -pi/2 to pi/2."""
    return (one - other + np.pi / 2) % np.pi - np.pi / 2


def elsewhere(seen: Guess, best: Guess, near: float, spacing: np.ndarray) -> np.ndarray:
    """Return which of the waves stand on another hill than the best one, as far as direction and wavenumber tell."""
    far = abs(np.log(seen.wavenumber / best.wavenumber[:, None])) > FAR * spacing[:, None]
    return far & (spacing[:, None] > 0) | (abs(turned(seen.angle, best.angle[:, None])) > APART * near)


def crested(growth: np.ndarray) -> np.ndarray:
    """Return the tops of the parabolas through neighbouring directions: of two hills, the higher one is climbed."""
    left, right = np.roll(growth, 1, axis=1), np.roll(growth, -1, axis=1)
    with np.errstate(all="ignore"):
        bend = left - 2 * growth + right
        top = growth - (right - left) ** 2 / (8 * bend)
    return np.where((growth >= left) & (growth >= right) & (bend < 0) & np.isfinite(top), top, growth)


def climbed(waves: Waves, start: Guess, stretch: np.ndarray, low: np.ndarray, high: np.ndarray, alone: bool) -> Fastest:
    """Return the top of the hill on which a wave stands, or as far as `STEPS` lead; points leave when they are there.

    Directions are counted in widths of the hill, logarithms of wavenumbers in ``stretch``. At an end of the range of
    wavenumbers only the direction is moved.
    """
    found = Fastest(start.growth.copy(), start.wavenumber.copy(), start.angle.copy())
    open_, trust, turn = np.arange(waves.count), np.ones(waves.count), start.width
    angle, q = start.angle, start.wavenumber
    ring, noise = waves.at(q, not alone), ROUNDING * waves.bound(high)
    here, done = ring.peak(angle), np.zeros(waves.count, bool)
    for step in range(STEPS):
        pinned = alone | ((q <= low) & (here[2] < 0)) | ((q >= high) & (here[2] > 0))
        across, along, length, gain, sure = newton(here, turn, stretch, pinned, trust)
        last = ~(gain > TOLERANCE * abs(here[0]) + noise)
        ahead = angle + turn * across
        if not alone:
            q_ahead = np.clip(q * np.exp(stretch * along), low, high)
            ring = waves.at(q_ahead, True)
        there = ring.peak(ahead)
        better = (there[0] > here[0]) & ~done  # who is there does not move while others climb
        angle, here = np.where(better, ahead, angle), np.where(better, there, here)
        q = q if alone else np.where(better, q_ahead, q)
        trust = np.where(better, np.where(sure, trust, 2 * trust), np.minimum(trust, length) / SHRINK)
        done |= last
        keep = np.flatnonzero(~done)
        over = not keep.size or step == STEPS - 1
        if keep.size > CROWD * done.size and not over:
            continue
        fine = here[0] >= found.growth[open_]  # not where derivatives left float64's range
        for old, new in ((found.growth, here[0]), (found.wavenumber, q), (found.angle, angle % np.pi)):
            old[open_[fine]] = new[fine]
        if over:
            break
        open_, here = open_[keep], here[:, keep]
        waves, ring = (waves, ring.take(keep)) if alone else (waves.take(keep), ring)
        angle, q, low, high, turn, stretch, trust, noise, done = (
            a[keep] for a in (angle, q, low, high, turn, stretch, trust, noise, done)
        )
    return found


def newton(
    here: np.ndarray, turn: np.ndarray, stretch: np.ndarray, pinned: np.ndarray, trust: np.ndarray
) -> tuple[np.ndarray, ...]:
    """Return the step up in both units, its length and gain, and whether it ends on the top of a parabola.

    The step is |H|^-1 g, H the Hessian and |H| that with its eigenvalues made positive: Newton's where growth is
    concave, and uphill elsewhere; no longer than trusted.
    """
    _, a, q, aa, aq, qq = here
    a, q = a * turn, np.where(pinned, 0.0, q * stretch)
    aa, aq, qq = aa * turn**2, np.where(pinned, 0.0, aq * turn * stretch), np.where(pinned, -1.0, qq * stretch**2)
    with np.errstate(all="ignore"):
        determinant, trace = aa * qq - aq * aq, aa + qq
        size = np.where(determinant > 0, abs(trace), np.sqrt(trace * trace - 4 * determinant))  # |e1| + |e2|
        # |H| = (H^2 + |det H| 1)/(|e1| + |e2|), whose determinant is |det H|
        lift, one = abs(determinant), 1 / (size * abs(determinant))
        A, B, C = aa * aa + aq * aq + lift, aq * trace, qq * qq + aq * aq + lift
        across, along, steep = (C * a - B * q) * one, (A * q - B * a) * one, np.hypot(a, q)
        flat = ~(np.isfinite(across) & np.isfinite(along))
        if flat.any():
            pull = np.where(steep > 0, trust / steep, 0.0)
            across, along = np.where(flat, pull * a, across), np.where(flat, pull * q, along)
        length = np.hypot(across, along)
        sure = (determinant > 0) & (trace < 0) & (length <= trust) & ~flat
        factor = np.where(length > trust, trust / length, 1.0)
        across, along = across * factor, along * factor
        gain = np.where(sure, (a * across + q * along) / 2, steep * trust)
    return across, along, np.minimum(length, trust), gain, sure
