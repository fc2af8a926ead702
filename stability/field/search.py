"""The fastest wave about each of many base states: first guesses, then Newton's method in direction and wavenumber.

Guesses are a fan of directions at several wavenumbers, and the directions of `guides` where closed forms give them; the
fan is then sparse and only watches over long waves. From the best guess on, a window of 3 x 3 waves gives slope and
curvature; where the surface is not concave the window moves to its best wave.
"""

from dataclasses import dataclass

import numpy as np

from stability.field.guides import Guide
from stability.field.waves import Waves

FAN, SPARSE = 36, 8  # directions of the half circle without and with a guide; growth varies over some 20 degrees
COLUMNS, FEW = 8, 3  # wavenumbers from end to end, for guided directions or a full fan, and for a sparse one
STEPS = 16  # at most; three or four do where a guide starts, and curved ridges take up to ten
TOLERANCE = 1e-6  # of the growth rate: a step that promises less is the last one, and leaves an error of 1e-9 or so
SHRINK, LONGEST = 4.0, 1.5  # of the window after a step, and the longest step in windows
UNIT = np.array([-1.0, 0.0, 1.0])


@dataclass(frozen=True)
class Fastest:
    """The fastest wave at each point: growth (1/s), wavenumber (1/m), angle (radians)."""

    growth: np.ndarray
    wavenumber: np.ndarray
    angle: np.ndarray


def fan(count: int) -> np.ndarray:
    """Return directions (1, count) over half a circle, radians; not along axes, where symmetric states are special."""
    return (np.pi / count * (np.arange(count) + 0.4871))[None]


def usable(growth: np.ndarray) -> np.ndarray:
    """Return growth rates with what is not a number out of the way."""
    return np.where(np.isfinite(growth), growth, -np.inf)


def fastest(waves: Waves, guide: Guide, low: np.ndarray, high: np.ndarray, watch: bool = True) -> Fastest:
    """Return the fastest wave with a wavenumber from low to high (point,).

    One array for both ends asks for directions alone. ``watch``: whether to look beside the directions of a guide.
    """
    rows, alone = np.arange(waves.count), low is high
    span = np.zeros(waves.count) if alone else np.log(high / low)

    def wavenumbers(count: int) -> np.ndarray:
        return low[:, None] if alone else low[:, None] * np.exp(span[:, None] * np.linspace(0, 1, count))

    directions, columns = fan(SPARSE if guide.guided else FAN), wavenumbers(FEW if guide.guided else COLUMNS)
    turn, top = np.full(waves.count, np.pi / directions.size / 2), np.full(waves.count, -np.inf)
    at, q = np.zeros(waves.count), low
    if watch or not guide.guided:
        growth = usable(waves.growth(np.broadcast_to(directions, (waves.count, directions.size)), columns[:, None, :]))
        best = crested(growth).reshape(waves.count, -1).argmax(axis=1)
        i, j = best // columns.shape[1], best % columns.shape[1]
        top, at, q = growth[rows, i, j], directions[0, i], columns[rows, j]
    columns = wavenumbers(COLUMNS)
    guesses = [(*guide.directions(column), column) for column in columns.T] if guide.kind != "none" else []
    if guesses:
        angles = np.concatenate([a for a, _, _ in guesses], axis=1)
        widths = np.concatenate([w for _, w, _ in guesses], axis=1)
        values = np.repeat(columns, 2, axis=1)
        found = usable(waves.growth(angles, values[..., None])[..., 0])
        best = found.argmax(axis=1)
        better = found[rows, best] > top
        top, at, q, turn = (
            np.where(better, new[rows, best], old)
            for new, old in ((found, top), (angles, at), (values, q), (widths, turn))
        )
    stretch = span / (COLUMNS - 1) / 2
    return climbed(waves, Fastest(top, q, at), turn, stretch, low, high, alone)


def crested(growth: np.ndarray) -> np.ndarray:
    """Return the tops of the parabolas through neighbouring directions: of two hills, the higher one is climbed."""
    left, right = np.roll(growth, 1, axis=1), np.roll(growth, -1, axis=1)
    with np.errstate(all="ignore"):
        bend = left - 2 * growth + right
        top = growth - (right - left) ** 2 / (8 * bend)
    return np.where((growth >= left) & (growth >= right) & (bend < 0) & np.isfinite(top), top, growth)


def climbed(
    waves: Waves, start: Fastest, turn: np.ndarray, stretch: np.ndarray, low: np.ndarray, high: np.ndarray, alone: bool
) -> Fastest:
    """Return the top of the hill on which a wave stands, or as far as `STEPS` lead; points leave when they are there.

    At an end of the range of wavenumbers only the direction is moved.
    """
    best = Fastest(start.growth.copy(), start.wavenumber.copy(), start.angle.copy())
    top, every = Fastest(best.growth, best.wavenumber.copy(), best.angle.copy()), waves  # where the last steps lead
    open_, n = np.arange(waves.count), 1 if alone else 3
    centre, middle, floor, roof = best.angle.copy(), np.log(best.wavenumber), np.log(low), np.log(high)
    for _ in range(STEPS):
        rows = np.arange(open_.size)
        angles = centre[:, None] + turn[:, None] * UNIT
        logs = middle[:, None] + (stretch[:, None] * UNIT if n == 3 else 0.0)
        inside = np.clip(logs, floor[:, None], roof[:, None])
        values = np.exp(inside)
        growth = usable(waves.growth(angles, values[:, None, :]))
        found = growth.reshape(rows.size, -1).argmax(axis=1)
        i, j = found // n, found % n
        value = growth[rows, i, j]
        better = value > best.growth[open_]
        some = open_[better]
        best.growth[some] = value[better]
        best.angle[some], best.wavenumber[some] = angles[rows, i][better], values[rows, j][better]
        cut, wave = (inside != logs).any(axis=1), inside[rows, j]
        end = alone | (cut & ((wave == floor) | (wave == roof)))  # the wavenumber stays
        across, along, gain, fine = newton(growth, np.where(end, j, n // 2), np.broadcast_to(end, rows.shape))
        fine &= end | ~cut
        reached = best.growth[open_]
        last = fine & (gain <= TOLERANCE * abs(reached)) & (value >= reached - TOLERANCE * abs(reached))
        last &= (abs(across) < 1) & (abs(along) < 1)
        ahead = fine & (better | last)  # a window without a better wave was led astray: back to the best one
        centre = np.where(ahead, centre + turn * across, best.angle[open_])
        middle = np.where(ahead & ~end, middle + stretch * along, np.log(best.wavenumber[open_]))
        middle = np.clip(middle, floor, roof)
        near = np.where(ahead, (abs(across) < 1) & (abs(along) < 1), (i == 1) & (end | (j == n // 2)))
        factor = np.where(near | ~better, 1 / SHRINK, np.where(ahead, 2.0, 1.0))  # a long slope is followed faster
        turn, stretch = turn * factor, stretch * factor
        done = open_[last]
        top.angle[done], top.wavenumber[done] = centre[last], np.exp(middle[last])
        keep = np.flatnonzero(~last)
        if not keep.size:
            break
        if keep.size < rows.size:
            open_, waves = open_[keep], waves.take(keep)
            centre, middle, floor, roof, turn, stretch = (a[keep] for a in (centre, middle, floor, roof, turn, stretch))
    found = usable(every.growth(top.angle[:, None], top.wavenumber[:, None, None])[:, 0, 0])
    better = found > best.growth
    growth, q, angle = (
        np.where(better, new, old)
        for new, old in ((found, best.growth), (top.wavenumber, best.wavenumber), (top.angle, best.angle))
    )
    return Fastest(growth, q, angle % np.pi)


def newton(growth: np.ndarray, column: np.ndarray, end: np.ndarray) -> tuple[np.ndarray, ...]:
    """Return the step to the top of the parabola through a window (in windows), its gain, and where it has one.

    Where ``end``, the parabola through the directions at one column alone.
    """
    rows = np.arange(growth.shape[0])
    f = growth if growth.shape[2] == 3 else np.repeat(growth, 3, axis=2)
    with np.errstate(all="ignore"):
        left, mid, right = (f[rows, i, column if growth.shape[2] == 3 else 1] for i in range(3))
        g, gg = (right - left) / 2, right - 2 * mid + left
        h, hh = (f[:, 1, 2] - f[:, 1, 0]) / 2, f[:, 1, 2] - 2 * f[:, 1, 1] + f[:, 1, 0]
        gh = (f[:, 2, 2] - f[:, 2, 0] - f[:, 0, 2] + f[:, 0, 0]) / 4
        h, hh, gh = np.where(end, 0.0, h), np.where(end, -1.0, hh), np.where(end, 0.0, gh)
        determinant = gg * hh - gh * gh
        fine = (gg < 0) & (determinant > 0) & np.isfinite(determinant)
        across, along = (gh * h - hh * g) / determinant, (gh * g - gg * h) / determinant
        across, along = (np.clip(np.where(fine, step, 0.0), -LONGEST, LONGEST) for step in (across, along))
        return across, along, (g * across + h * along) / 2, fine
