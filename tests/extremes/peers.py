"""What a user would write without the toolkit, in float64: D by `lambdify`, then LAPACK or the quadratic formula."""

from functools import cache

import numpy as np
from sympy import lambdify

from stability import tangent_matrix
from stability.arithmetic import NUMPY
from stability.closures import CLOSURES
from stability.flows import FLOWS as REGISTERED_FLOWS
from stability.linearise import letter_gradients, letters
from stability.parameters import to_si
from stability.symbols import gradient, hessian, symbol
from tests.extremes.case import FLOWS, Case

XI = (symbol("xi_x"), symbol("xi_y"))


def jets(closure) -> list:
    """Return the symbols of value, gradient and second gradient of every field."""
    return [s for c in closure.q for s in (c, *gradient(c), *hessian(c)[0], hessian(c)[1][1])]


@cache
def in_letters(name: str):
    """Return one function per letter and letter gradient, of the raw state and those before it, and D of all."""
    closure = CLOSURES[name]
    constants = [symbol(r.symbol) for r in closure.parameters]
    raw = jets(closure) + constants
    named = letters(closure) | letter_gradients(closure)
    steps = [lambdify([*raw, *list(named)[:n]], e, "numpy") for n, e in enumerate(named.values())]
    return steps, lambdify([*raw, *named, *XI], list(tangent_matrix(name)), "numpy")


@cache
def written_out(name: str, flow: str):
    """Return D as a function of parameters, point and wave, every letter written out on the flow."""
    entry = FLOWS.get(flow) or REGISTERED_FLOWS[flow]
    records = {r.word: r for r in (*CLOSURES[name].parameters, *entry.parameters)}
    names = {word: symbol(r.symbol) for word, r in records.items()} | {
        r.word: point_symbol(r, entry) for r in entry.point
    }
    D = tangent_matrix(name, entry)
    return (
        list(names),
        records | {r.word: r for r in entry.point},
        lambdify([*names.values(), *XI], list(D), "numpy", cse=True),
    )


def point_symbol(record, entry):
    """Return the symbol under which a flow's expressions hold a coordinate (r is declared positive)."""
    used = set().union(*(e.free_symbols for e in entry.fields.values()))
    return next((s for s in used if str(s) == record.symbol), symbol(record.symbol))


def wavevectors(case: Case) -> tuple[np.ndarray, np.ndarray]:
    angle, q = np.deg2rad(case.wave_angle)[:, None], case.wavenumber
    return (np.cos(angle) * q).ravel(), (np.sin(angle) * q).ravel()


def stacked(entries: list, size: int) -> np.ndarray:
    return np.stack([np.broadcast_to(np.asarray(e, complex), size) for e in entries], axis=-1).reshape(size, 2, 2)


def matrices(case: Case) -> np.ndarray:
    """Return D of every wave from the letters' values."""
    base, closure = case.base(NUMPY), CLOSURES[case.closure]
    values: list = []
    for field, state in zip(closure.fields, base.state, strict=True):
        for c in range(2) if isinstance(field, tuple) else (None,):
            value, first, second = (part if c is None else part[c] for part in state)
            values += [value, *first, *second[0], second[1][1]]
    values += [base.parameters[r.word] for r in closure.parameters]
    steps, D = in_letters(case.closure)
    for step in steps:
        values.append(step(*values))
    xi = wavevectors(case)
    return stacked(D(*values, *xi), xi[0].size)


def matrices_on_flow(case: Case) -> np.ndarray:
    """Return D of every wave from the expression with every letter written out."""
    words, records, D = written_out(case.closure, case.flow)
    given = case.parameters | case.point
    values = to_si(records, {w: given[w] for w in words})
    xi = wavevectors(case)
    return stacked(D(*(values[w] for w in words), *xi), xi[0].size)


def lapack(D: np.ndarray, constrained: bool) -> np.ndarray:
    """Return the leading growth rate by `numpy.linalg.eigvals`; under the constraint the one of larger modulus."""
    growth = np.full(len(D), np.nan)
    fine = np.isfinite(D).all(axis=(1, 2))
    found = np.linalg.eigvals(D[fine])
    growth[fine] = chosen(found[:, 0], found[:, 1], constrained)
    return growth


def quadratic(D: np.ndarray, constrained: bool) -> np.ndarray:
    """Return the leading growth rate by T/2 +- sqrt(T^2/4 - det)."""
    half, determinant = (D[:, 0, 0] + D[:, 1, 1]) / 2, D[:, 0, 0] * D[:, 1, 1] - D[:, 0, 1] * D[:, 1, 0]
    root = np.sqrt(half**2 - determinant)
    return chosen(half + root, half - root, constrained)


def chosen(one: np.ndarray, other: np.ndarray, constrained: bool) -> np.ndarray:
    return np.where(abs(one) >= abs(other), one.real, other.real) if constrained else np.maximum(one.real, other.real)
