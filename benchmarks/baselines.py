"""What users do without the package: its own D through `sympy.lambdify`, then eigenvalues.

The letters of D (mu, A_xx, their gradients, ...) are numbers here, worked out beforehand and free of charge: writing
them out on the flow makes D three hundred times longer (`on_flow`).
"""

from collections.abc import Callable
from functools import cache
from typing import Any

import numpy as np

import stability as st
from benchmarks.cases import Case
from stability.model import Model

Entries = Callable[..., np.ndarray]


@cache
def lambdified(closure: str, cse: bool = False) -> tuple[Entries, tuple[str, ...]]:
    """Return D as a function (xi_x, xi_y, *letters) -> (2, 2, ...), and the names of the letters."""
    import sympy

    D = st.tangent_matrix(closure)
    waves = ("xi_x", "xi_y")
    letters = tuple(sorted({str(s) for s in D.free_symbols} - set(waves)))
    arguments = [sympy.Symbol(name, real=True) for name in (*waves, *letters)]
    return sympy.lambdify(arguments, D, cse=cse), letters


@cache
def on_flow(closure: str, flow: str) -> Callable:
    """Return the D of a user who has everything written out on the flow: (xi_x, xi_y, words...) -> (2, 2, ...)."""
    import sympy

    D = st.tangent_matrix(closure, flow)
    records = {r.symbol: r.word for r in (*st.CLOSURES[closure].parameters, *st.FLOWS[flow].parameters)}
    records |= {r.symbol: r.word for r in st.FLOWS[flow].point}
    names = sorted(D.free_symbols, key=str)
    compute = sympy.lambdify(names, D, cse=True)

    def entries(xi_x: np.ndarray, xi_y: np.ndarray, values: dict) -> np.ndarray:
        given = {"xi_x": xi_x, "xi_y": xi_y}
        return compute(*(given[str(s)] if str(s) in given else values[records[str(s)]] for s in names))

    return entries


def _flat(names: Any, values: Any) -> dict:
    if isinstance(names, str):
        return {names: values}
    return {k: v for pair in zip(names, values, strict=True) for k, v in _flat(*pair).items()}


def letter_values(case: Case) -> dict[str, Any]:
    """Return every letter of D at the case's positions: numbers, or arrays (positions, 1, 1)."""
    import sympy

    from stability.emit import state_names
    from stability.linearise import letter_gradients, letters

    closure = st.CLOSURES[case.closure]
    base = Model(case.closure, case.flow).base(case.parameters, case.point)
    values = _flat(state_names(closure.fields), base.state)
    model = Model(case.closure, case.flow)
    values |= {record.symbol: base.parameters[word] for word, record in model.parameters.items()}
    for letter, definition in (*letters(closure).items(), *letter_gradients(closure).items()):
        names = sorted(definition.free_symbols, key=str)
        values[str(letter)] = sympy.lambdify(names, definition)(*(values[str(s)] for s in names))
    return {name: v[:, None, None] if np.ndim(v) else v for name, v in values.items()}


def wavevectors(case: Case) -> tuple[np.ndarray, np.ndarray]:
    """Return the components of every wavevector of a case, (directions, wavenumbers)."""
    angle = np.deg2rad(case.wave_angle)[:, None]
    return case.wavenumber * np.cos(angle), case.wavenumber * np.sin(angle)


def tangent(case: Case, cse: bool = False) -> Callable[[], np.ndarray]:
    """Return the call that evaluates D on a whole map, (2, 2, ..., directions, wavenumbers)."""
    compute, names = lambdified(case.closure, cse)
    values = letter_values(case)
    given = [values[n] for n in names]
    return lambda: compute(*wavevectors(case), *given)


def by_eigvals(D: np.ndarray) -> np.ndarray:
    """Return the leading growth rate from LAPACK."""
    return np.linalg.eigvals(np.moveaxis(D, (0, 1), (-2, -1))).real.max(axis=-1)


def by_formula(D: np.ndarray) -> np.ndarray:
    """Return the leading growth rate from the quadratic formula."""
    (a, b), (c, d) = D
    return ((a + d) / 2).real + np.abs(np.sqrt(((a - d) / 2) ** 2 + b * c).real)


def norms(D: np.ndarray) -> np.ndarray:
    """Return the spectral norm of each D: the scale of its rounding errors."""
    return np.linalg.norm(np.moveaxis(D, (0, 1), (-2, -1)), 2, axis=(-2, -1))
