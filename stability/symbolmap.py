"""Short waves at very many points at once, in float64: the leading symbol over a fan of directions.

For each edge of the Newton polygon, ``lambda ~ gamma |xi|^n`` with gamma a root of the edge's terms. Which terms there
are is the closure's own and the same at every point; their values are arrays over points. A point counts as growing
with exponent n where max Re gamma exceeds what roundings of its terms could make. Neutral edges, null directions and
the layers about them are left to `judge`, which takes one point at a time.
"""

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from stability import polynomials
from stability.model import Base, Model
from stability.puiseux import Edge, polygon
from stability.roots import roots

DIRECTIONS = 90  # of the half circle; the largest coefficient is then polished by a parabola
ROUNDING = 1e-9  # of the largest modulus of gamma: below this a real part is rounding
POINTS = 2**11  # at once: arrays over directions and points stay in cache


@dataclass(frozen=True)
class SymbolMap:
    """What short waves do at each point, arrays of one shape.

    ``exponent`` is the largest n > 0 with which some direction grows, 0 where none does; ``coefficient`` is the largest
    Re gamma of that edge over the directions (of the highest edge, and not positive, where exponent is 0);
    ``wave_angle`` in degrees, in [0, 180), is where; ``share`` is the part of the directions that grow.
    """

    exponent: np.ndarray
    coefficient: np.ndarray
    wave_angle: np.ndarray
    share: np.ndarray


def symbol_map(closure: Any, flow: Any, parameters: dict, point: dict, directions: int = DIRECTIONS) -> SymbolMap:
    """Return the exponents and largest coefficients of Hadamard growth at an array of points.

    Parameters
    ----------
    closure, flow, parameters : as in `stability.well_posedness`
    point : coordinates of the flow's point; arrays of one shape
    directions : how many directions of the half circle are looked at

    Returns
    -------
    `SymbolMap`, float64 and not certified
    """
    base = Model(closure, flow).base(parameters, {w: np.asarray(v, float) for w, v in point.items()})
    shape = np.broadcast_shapes(*(np.shape(v) for v in point.values())) if point else ()
    return of_base(base, shape, directions)


def of_base(base: Base, shape: tuple[int, ...], directions: int = DIRECTIONS) -> SymbolMap:
    """Return the map of base states that are arrays of that shape, whatever flow or field they come from."""
    angles = 180 / directions * np.arange(directions)
    cosine, sine = np.cos(np.deg2rad(angles)), np.sin(np.deg2rad(angles))
    size = int(np.prod(shape))
    flat = replace(base, state=raveled(base.state)).resting()[0]
    found = np.empty((4, size))
    for start in range(0, size, POINTS):
        part = slice(start, min(start + POINTS, size))
        forms: dict[tuple[int, int], list] = {}
        for (j, m, k), c in polynomials.symbol(base.model.evolves, flat.at(part).pencil()).items():
            forms.setdefault((j, m), []).append((k, c))
        values = {}
        for (j, m), terms in forms.items():
            table = np.stack([np.broadcast_to(np.asarray(c, float), part.stop - start) for _, c in terms])
            powers = np.stack([cosine ** (m - k) * sine**k for k, _ in terms], axis=1)
            if np.any(table):
                values[j, m] = np.einsum("dk,kp->dp", powers, table)  # BLAS threads would wait for each other
        found[:, part] = block(values, angles)
    return SymbolMap(*(row.reshape(shape) for row in found))


def raveled(tensor: Any) -> Any:
    """Return nested arrays, each as one row of points; numbers stay."""
    if isinstance(tensor, tuple):
        return tuple(map(raveled, tensor))
    return np.ravel(tensor) if np.ndim(tensor) else tensor


def block(forms: dict[tuple[int, int], np.ndarray], angles: np.ndarray) -> np.ndarray:
    """Return exponent, coefficient, angle and share for some points, from forms (direction, point)."""
    edges = [e for e in polygon(dict.fromkeys(forms)) if e.exponent > 0][::-1]
    size = next(iter(forms.values())).shape[1]
    exponent, best, angle, share = (np.zeros(size) for _ in range(4))
    open_ = np.ones(size, bool)
    for i, edge in enumerate(edges):
        growth = along(forms, edge)
        index = growth.argmax(axis=0)
        some = open_ & (growth[index, np.arange(size)] > 0)
        take = some | (open_ & (i == 0))
        value, place = polished(growth, index, angles)
        best, angle = np.where(take, value, best), np.where(take, place, angle)
        exponent = np.where(some, float(edge.exponent), exponent)
        share = np.where(some, np.mean(growth > 0, axis=0), share)
        open_ &= ~some
        if not open_.any():
            break
    return np.stack([exponent, best, angle, share])


def along(forms: dict[tuple[int, int], np.ndarray], edge: Edge) -> np.ndarray:
    """Return max Re gamma (direction, point); zero where that is rounding."""
    height = max(m for j, m in forms if j == edge.lowest)
    c: list = [0] * (max(edge.terms) + 1)
    turns = []
    for i in edge.terms:
        m = int(height - edge.exponent * i)
        c[i] = forms[edge.lowest + i, m]
        turns.append((i, (1, 1j, -1, -1j)[m % 4]))
    with np.errstate(all="ignore"):
        if len(c) == 2:
            ratio = -turns[0][1] / turns[1][1]
            return ratio.real * (c[0] / c[1]) if ratio.real else np.zeros_like(c[0])
        shape = next(iter(forms.values())).shape
        for i, turn in turns:
            c[i] = (turn * c[i]).ravel()
        gamma = roots(c)
        top, size = gamma.real.max(axis=0), abs(gamma).max(axis=0)
    return np.where(abs(top) > ROUNDING * size, top, 0.0).reshape(shape)


def polished(growth: np.ndarray, index: np.ndarray, angles: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the top of the parabola through the largest value and its neighbours, and where it is."""
    n, columns = len(angles), np.arange(growth.shape[1])
    left, top, right = (growth[(index + i) % n, columns] for i in (-1, 0, 1))
    bend = left - 2 * top + right
    with np.errstate(all="ignore"):
        step = np.where(bend < 0, (left - right) / (2 * bend), 0.0)
    step = np.clip(np.nan_to_num(step), -0.5, 0.5)
    return top - step * (left - right) / 4, (angles[index] + step * (angles[1] - angles[0])) % 180
