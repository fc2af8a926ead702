"""Ranges of directions on the whole circle: opposite ones grow alike."""

from typing import Any


def both_ways(angles: Any) -> list[float]:
    """Return directions with their opposites, in [0, 360)."""
    return sorted((a + turn) % 360 for a in angles for turn in (0, 180))


def merged(arcs: list[tuple[float, float]], within: set[float]) -> tuple[tuple[float, float], ...]:
    """Return arcs with their opposites, joined at special directions that grow too; both ends in [0, 360)."""
    joined: list[tuple[float, float]] = []
    for low, high in sorted(set(arcs)):
        if joined and joined[-1][1] == low and low in within:
            joined[-1] = joined[-1][0], high
        else:
            joined.append((low, high))
    if len(joined) > 1 and joined[-1][1] == joined[0][0] + 180 and joined[0][0] in within:
        joined = [*joined[1:-1], (joined[-1][0], joined[0][1] + 180)]
    if any(b - a > 180 or (b - a == 180 and (a in within or a == 0)) for a, b in joined):
        return ((0.0, 360.0),)
    return tuple(sorted({((a + turn) % 360, (b + turn) % 360) for a, b in joined for turn in (0, 180)}))
