"""The two loops over elements compiled by numba (extra ``fast``): balances, and blocks of the Jacobian.

The closure's functions are the generated ones of `law`, with numbers in place of arrays; `balance` and `blocks` below
are what `problem` does with whole arrays, element by element, and nothing leaves the processor's caches in between.
Sums run in one order on one core: the same input gives the same result to the last bit, and NumPy's but for rounding.

Compiling takes 6 s, once: machine code is kept beside the generated modules (`codegen.cache_folder`), under a name that
signs their text, this file and numba. After that it costs 0.6 s a process, numba's import. So it is chosen from `PAYS`
elements on, whatever the length of a run: one that goes on from a checkpoint must not change its way. It is switched
off by ``Problem(..., compiled=False)``, and by numba's own ``NUMBA_DISABLE_JIT=1``.
"""

import hashlib
import os
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from importlib.metadata import version
from importlib.util import find_spec
from pathlib import Path
from types import FunctionType, SimpleNamespace
from typing import Any

import numpy as np

from stability import codegen
from stability.closures import CLOSURES

PAYS = 2000  # elements: on so many a run of 200 steps saves twice what the import costs
FIELDS = 3
AT_POINT = "q, g, ax, ay, floor, parameters, body_force"
# What `glue` writes for each closure, and `balance` and `blocks` call.
fill_flux: Any = None
fill_flux_moduli: Any = None
fill_supply: Any = None
fill_supply_moduli: Any = None


def pays(elements: int) -> bool:
    """Return whether a mesh is large enough, and numba there."""
    return elements >= PAYS and os.environ.get("NUMBA_DISABLE_JIT", "0") == "0" and find_spec("numba") is not None


@dataclass(frozen=True, eq=False)
class Loops:
    """The compiled loops with all that they need of a problem but the unknowns; walls and sources are not in them.

    Attributes
    ----------
    kernels : the compiled `balance` and `blocks`
    elements : (elements, 4) nodes
    position : (elements, 4, 4) places among the ``size`` blocks of the pattern
    mesh, law : as `balance` reads them
    """

    kernels: tuple[Callable, Callable]
    elements: np.ndarray
    position: np.ndarray
    size: int
    mesh: tuple
    law: tuple

    @classmethod
    def of(cls, problem: Any) -> "Loops":
        """Return the loops of a `Problem`, which stands a layer above."""
        law, volumes, elements = problem.law, problem.volumes, np.ascontiguousarray(problem.mesh.elements)
        base_q, base_g = problem.state(np.zeros((FIELDS, 1)), np.zeros((2, FIELDS, 1)))
        smoothing = np.zeros(len(elements)) if problem.smoothing is None else problem.smoothing
        mesh = (
            volumes.face.shape,
            *map(by_element, (volumes.face.slope, volumes.area, problem.supply_slope, volumes.volume)),
            np.ascontiguousarray(smoothing, dtype=float),
        )
        numbers = (tuple(map(float, law.values)), tuple(map(float, law.body_force)), float(law.floor))
        place = np.ascontiguousarray(problem.pattern.position.reshape(4, 4, -1).transpose(2, 0, 1))
        background = (tuple(base_q[:, 0]), tuple(map(tuple, base_g[..., 0])))
        return cls(kernels(law.closure), elements, place, len(problem.pattern.row), mesh, (*numbers, *background))

    def balance(self, q: np.ndarray) -> np.ndarray:
        """Return what flows out of every control volume less what is supplied there, (n, 3)."""
        return self.kernels[0](np.ascontiguousarray(q), self.elements, self.mesh, self.law)

    def blocks(self, q: np.ndarray) -> np.ndarray:
        """Return its derivative as blocks (3, 3, blocks) of the pattern."""
        return self.kernels[1](
            np.ascontiguousarray(q), self.elements, self.position, self.size, self.mesh, self.law
        ).transpose(1, 2, 0)


def by_element(values: np.ndarray) -> np.ndarray:
    """Return an array (..., elements) as (elements, ...), so that an element's numbers lie together."""
    return np.ascontiguousarray(np.moveaxis(values, -1, 0))


@cache
def kernels(closure: Any) -> tuple[Callable, Callable]:
    """Return `balance` and `blocks` compiled for a closure; numba is imported here."""
    from numba import njit

    generated = codegen.load(CLOSURES, closure, codegen.POINTWISE)
    path = kept(closure, glue(generated))
    outer = njit(error_model="numpy", nogil=True, cache=path is not None)
    return loops(generated, str(path or "<generated>"), njit(error_model="numpy"), outer)


def loops(generated: dict, origin: str, inner: Callable, outer: Callable) -> tuple[Callable, Callable]:
    """Return `balance` and `blocks` for the functions of a closure, through two decorators.

    Numba keeps machine code beside the file ``origin`` that a function says it comes from: each closure has its own.
    """
    space = {"__name__": __name__, "np": np, "value": value, "slopes": slopes, **generated["build"](scalars(inner))}
    exec(compile(glue(generated), origin, "exec"), space)  # noqa: S102
    space |= {name: inner(call) for name, call in space.items() if isinstance(call, FunctionType)}

    def of_closure(call: Any) -> Callable:
        return outer(FunctionType(call.__code__.replace(co_filename=origin), space, call.__name__))

    return of_closure(balance), of_closure(blocks)


def scalars(inner: Callable) -> SimpleNamespace:
    """Return the arithmetic of single numbers."""
    names = {"sqrt": "sqrt", "sin": "sin", "cos": "cos", "tan": "tan", "asin": "arcsin", "atan": "arctan"}
    functions = {name: getattr(np, other) for name, other in (names | {"exp": "exp", "log": "log"}).items()}
    return SimpleNamespace(**functions, pi=np.pi, rational=inner(lambda p, q: p / q))


def kept(closure: Any, text: str) -> Path | None:
    """Return the file beside which machine code is kept; None for a closure without a name, or where none can be."""
    if not isinstance(closure, str):
        return None
    signed = (codegen.signature(CLOSURES.place(closure)), version("numba"), text, Path(__file__).read_text("utf-8"))
    key = hashlib.sha256("\0".join(signed).encode()).hexdigest()
    path = codegen.cache_folder() / f"compiled_{closure}_{key[:16]}.py"
    try:
        if not path.exists():  # a file written anew would be a new one for numba
            codegen.write_atomically(path, text.encode())
        (path.parent / "__pycache__").mkdir(exist_ok=True)
    except OSError:
        return None
    return path if os.access(path.parent / "__pycache__", os.W_OK) else None


def glue(generated: dict) -> str:
    """Return the text of four functions that fill an array with flux or supply, or with their derivatives.

    Fluxes are those through an area vector (ax, ay). The array is (3,), or (3, 3, 3) for the derivatives of each row
    by q and by the two gradients of each field; entries that vanish identically are left alone.
    """
    lines = ["# Generated. Do not edit.", "def bounded(norm, floor):", "    return norm if norm > floor else floor"]
    for name, of_area in (("flux", True), ("supply", False)):
        m = "bounded(strain_rate_norm(g), floor)" if name.upper() in generated["BOUNDED"] else "floor"
        values = [(0, name.upper())], [(k, f"{name.upper()}_{by}") for k, by in enumerate(("Q", "G0", "G1"), start=1)]
        for call, tables in zip((name, f"{name}_moduli"), values, strict=True):
            sums: dict[tuple, list[str]] = {}
            for k, table in tables:
                for n, (i, *rest) in enumerate(generated[table]):
                    area = f"a{'xy'[rest.pop(0)]} * " if of_area else ""
                    place = (k - 1, i, *rest) if k else (i,)
                    sums.setdefault(place, []).append(f"{area}value[{k}][{n}]")
            lines += [f"def fill_{call}({AT_POINT}, out):"]
            lines += [f"    value = {call}(q, g, {m}, parameters, body_force)"]
            lines += [f"    out[{', '.join(map(str, place))}] = {' + '.join(terms)}" for place, terms in sums.items()]
    return "\n".join(lines) + "\n"


def value(shape: np.ndarray, s: int, corner: np.ndarray, base: tuple) -> tuple:
    """Return the three fields at point s: weights times values at the corners (4, 3), and the background's."""
    u, v, p = base
    for c in range(4):
        u += shape[s, c] * corner[c, 0]
        v += shape[s, c] * corner[c, 1]
        p += shape[s, c] * corner[c, 2]
    return u, v, p


def slopes(slope: np.ndarray, e: int, b: int, s: int, corner: np.ndarray, base: tuple) -> tuple:
    """Return the derivatives of the three fields along axis b at point s of element e."""
    u, v, p = base
    for c in range(4):
        u += slope[e, b, s, c] * corner[c, 0]
        v += slope[e, b, s, c] * corner[c, 1]
        p += slope[e, b, s, c] * corner[c, 2]
    return u, v, p


def balance(q: np.ndarray, elements: np.ndarray, mesh: tuple, law: tuple) -> np.ndarray:
    """Return the balances (n, 3)."""
    shape, slope, area, supply_slope, volume, smoothing = mesh
    parameters, force, floor, base_q, base_g = law
    found = np.zeros(q.shape)
    corner, local, flux, supply = np.empty((4, 3)), np.empty((4, 3)), np.zeros(3), np.zeros(3)
    for e in range(elements.shape[0]):
        for j in range(4):
            for i in range(3):
                corner[j, i] = q[elements[e, j], i]
                local[j, i] = 0.0
        for s in range(4):
            ax, ay = area[e, 0, s], area[e, 1, s]
            own = value(shape, s, corner, base_q)
            g = slopes(slope, e, 0, s, corner, base_g[0]), slopes(slope, e, 1, s, corner, base_g[1])
            fill_flux(own, g, ax, ay, floor, parameters, force, flux)
            flux[2] -= smoothing[e] * (ax * g[0][2] + ay * g[1][2])
            own = corner[s, 0] + base_q[0], corner[s, 1] + base_q[1], corner[s, 2] + base_q[2]
            g = slopes(supply_slope, e, 0, s, corner, base_g[0]), slopes(supply_slope, e, 1, s, corner, base_g[1])
            fill_supply(own, g, 0.0, 0.0, floor, parameters, force, supply)
            for i in range(3):
                local[s, i] += flux[i] - volume[e, s] * supply[i]  # leaves corner s, enters corner s + 1
                local[(s + 1) % 4, i] -= flux[i]
        for j in range(4):
            for i in range(3):
                found[elements[e, j], i] += local[j, i]
    return found


def blocks(q: np.ndarray, elements: np.ndarray, position: np.ndarray, size: int, mesh: tuple, law: tuple) -> np.ndarray:
    """Return the blocks (size, 3, 3) of the Jacobian."""
    shape, slope, area, supply_slope, volume, smoothing = mesh
    parameters, force, floor, base_q, base_g = law
    found = np.zeros((size, 3, 3))
    corner, local = np.empty((4, 3)), np.empty((3, 3, 4, 4))
    flux, supply = np.zeros((3, 3, 3)), np.zeros((3, 3, 3))
    for e in range(elements.shape[0]):
        for j in range(4):
            for i in range(3):
                corner[j, i] = q[elements[e, j], i]
        local[:] = 0.0
        for s in range(4):
            ax, ay, after = area[e, 0, s], area[e, 1, s], (s + 1) % 4
            own = value(shape, s, corner, base_q)
            g = slopes(slope, e, 0, s, corner, base_g[0]), slopes(slope, e, 1, s, corner, base_g[1])
            flux[1, 2, 2] = flux[2, 2, 2] = 0.0
            fill_flux_moduli(own, g, ax, ay, floor, parameters, force, flux)
            flux[1, 2, 2] -= smoothing[e] * ax
            flux[2, 2, 2] -= smoothing[e] * ay
            for i in range(3):
                for j in range(3):
                    by_q, by_x, by_y = flux[0, i, j], flux[1, i, j], flux[2, i, j]
                    for c in range(4):
                        d = by_q * shape[s, c] + by_x * slope[e, 0, s, c] + by_y * slope[e, 1, s, c]
                        local[i, j, s, c] += d  # leaves corner s, enters corner s + 1
                        local[i, j, after, c] -= d
            own = corner[s, 0] + base_q[0], corner[s, 1] + base_q[1], corner[s, 2] + base_q[2]
            g = slopes(supply_slope, e, 0, s, corner, base_g[0]), slopes(supply_slope, e, 1, s, corner, base_g[1])
            fill_supply_moduli(own, g, 0.0, 0.0, floor, parameters, force, supply)
            for i in range(3):
                for j in range(3):
                    local[i, j, s, s] -= volume[e, s] * supply[0, i, j]
                    by_x, by_y = volume[e, s] * supply[1, i, j], volume[e, s] * supply[2, i, j]
                    if by_x != 0.0 or by_y != 0.0:
                        for c in range(4):
                            local[i, j, s, c] -= by_x * supply_slope[e, 0, s, c] + by_y * supply_slope[e, 1, s, c]
        for s in range(4):
            for c in range(4):
                b = position[e, s, c]
                for i in range(3):
                    for j in range(3):
                        found[b, i, j] += local[i, j, s, c]
    return found
