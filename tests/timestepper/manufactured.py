"""Problems with exact answers: smooth fields, and the sources that make them solutions of a closure's equations."""

from collections.abc import Callable
from dataclasses import replace
from functools import cache

import numpy as np
from sympy import Expr, Symbol, cos, exp, lambdify, sin

from stability.closures import CLOSURES
from stability.closures.base import norm
from stability.closures.plane_flow import V
from stability.linearise import imbalance
from stability.symbols import body_force, gradient, hessian, p, symbol, u, v, x, y
from stability.timestepper.constraints import held_at
from stability.timestepper.hopper import smoothing
from stability.timestepper.law import Law
from stability.timestepper.mesh import Mesh, mesh_of_cells, mesh_of_edges, points
from stability.timestepper.problem import Problem

t = symbol("t")
PARAMETERS = {"friction_angle": np.deg2rad(34), "epsilon": 0.05}
FORCE = (-1.0, 0.5)

# Extension along x and compression along y with waves on them, 0.7 < ||V|| < 2.1: the floor plays no part. Not
# solenoidal, so that the mass row has a source as well.
SMOOTH = {
    u: x + sin(2 * x + y - t) / 4,
    v: -y + cos(x - 2 * y + 2 * t) / 5 + x / 3,
    p: 2 + sin(2 * x + 2 * y + t) / 2 + x * y / 3,
}
# The same without divergence, which is what an incompressible closure asks for where it has no source of mass.
_stream = x * y + exp(-t / 2) * sin(x + 2 * y) / 6
SOLENOIDAL = SMOOTH | {u: _stream.diff(y), v: -_stream.diff(x)}


@cache
def _numeric(expressions: tuple[Expr, ...]) -> Callable:
    return lambdify((x, y, t), expressions, "numpy", cse=True)


def columns(expressions: tuple[Expr, ...], nodes: np.ndarray, time: float) -> np.ndarray:
    """Return expressions in x, y and t at the nodes, (n, expressions)."""
    values = _numeric(expressions)(*nodes.T, time)
    return np.stack([np.broadcast_to(value, len(nodes)) for value in values], axis=1)


def jet(fields: dict[Symbol, Expr]) -> dict[Symbol, Expr]:
    """Return what the symbols of value, gradient and second gradient stand for."""
    found = dict(fields)
    for f, e in fields.items():
        for a, s in enumerate((x, y)):
            found[gradient(f)[a]] = e.diff(s)
            found |= {hessian(f)[a][b]: e.diff(s, r) for b, r in enumerate((x, y))}
    return found


@cache
def _source(closure: str, fields: tuple, steady: bool) -> tuple[Expr, ...]:
    law, fields = CLOSURES[closure], dict(fields)
    constants = {symbol(r.symbol): PARAMETERS[r.word] for r in law.parameters}
    known = jet(fields) | constants | dict(zip(body_force, FORCE, strict=True))
    left = list(imbalance(law))
    for letter, definition in reversed(law.letters.items()):
        left = [e.subs(letter, definition) for e in left]
    left = [e.subs(known) for e in left]
    rate = [0 if steady else m * fields[c].diff(t) for m, c in zip(law.evolves, law.q, strict=True)]
    return tuple(a + b for a, b in zip(left, rate, strict=True))


def strain_rate_norm(fields: dict, nodes: np.ndarray, time: float) -> np.ndarray:
    """Return the exact ||V|| at the nodes."""
    return columns((norm(V).subs(jet(fields)),), nodes, time)[:, 0]


def boundary(mesh: Mesh) -> np.ndarray:
    """Return all nodes on the boundary."""
    edges = np.concatenate(list(mesh.boundaries.values()))
    return np.unique(mesh.elements[edges[:, :1], (edges[:, 1:] + np.arange(2)) % 4])


def square(n: int, bend: float = 0.08) -> Mesh:
    """Return n x n quadrilaterals on the unit square, bent smoothly inside and along the sides."""
    X, Y = np.meshgrid(*2 * [np.linspace(0, 1, n + 1)], indexing="ij")
    wave = bend * np.sin(2 * np.pi * X) * np.sin(np.pi * Y)
    slide = bend * np.sin(np.pi * X) * np.sin(2 * np.pi * Y)
    return mesh_of_cells(np.stack([X + wave, Y + slide - wave / 2], axis=-1), half=True)


def wedge(n: int, kind: str) -> Mesh:
    """Return a half wedge of n x n cells or, for "diamond", of some n x n elements."""
    n = n // 2 if kind == "diamond" else n
    radii, angles = (np.linspace if kind == "polar" else np.geomspace)(0.5, 1.0, n + 1), np.linspace(0, 0.5, n + 1)
    nodes = points(radii, angles, half=True)
    if kind != "diamond":
        return mesh_of_cells(nodes, half=True)
    middles = np.sqrt(radii[:-1] * radii[1:]), (angles[:-1] + angles[1:]) / 2
    return mesh_of_edges(nodes, points(*middles, half=True), half=True)


def problem(closure: str, fields: dict, mesh: Mesh, steady: bool = False, floor: float = 0.05, **options) -> Problem:
    """Return the problem that the fields solve up to the error of the mesh, its boundary values held."""
    rim, q = boundary(mesh), (fields[u], fields[v], fields[p])
    source = _source(closure, tuple(fields.items()), steady)
    law, initial = Law(closure, PARAMETERS, FORCE, floor), columns(q, mesh.nodes, 0.0)
    if not law.pressure_diffuses:
        options = {"smoothing": smoothing(law, mesh, initial)} | options
    return Problem(
        mesh=mesh,
        law=law,
        initial=initial,
        constraints=held_at(rim, lambda time: columns(q, mesh.nodes[rim], time)),
        source=lambda time: columns(source, mesh.nodes, time),
        **options,
    )


def exact(fields: dict, problem: Problem, time: float) -> np.ndarray:
    """Return the exact u, v, p at the nodes."""
    return columns((fields[u], fields[v], fields[p]), problem.mesh.nodes, time)


def solved_exactly(problem: Problem, fields: dict) -> Problem:
    """Return a problem whose nodal values are those of the fields at all times, but for the error of time steps."""
    q = (fields[u], fields[v], fields[p])
    rates = tuple(e.diff(t) for e in q)
    unforced = replace(problem, source=None)

    def source(time: float) -> np.ndarray:
        nodes = problem.mesh.nodes
        left = unforced.balance(columns(q, nodes, time), time)
        return (left + unforced.mass * columns(rates, nodes, time)) / unforced.volume[:, None]

    return replace(problem, source=source)


def error(problem: Problem, q: np.ndarray, expected: np.ndarray) -> np.ndarray:
    """Return the root mean square errors of u, v and p, weighted with the control volumes."""
    return np.sqrt((problem.volume[:, None] * (q - expected) ** 2).sum(axis=0) / problem.volume.sum())


def orders(sizes: list[float], errors: list[np.ndarray]) -> np.ndarray:
    """Return the slopes of log error against log size, a least-squares fit per field."""
    return np.polyfit(np.log(sizes), np.log(errors), 1)[0]
