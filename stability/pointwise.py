"""Closure -> flux, supply and their exact derivatives in the raw state, as the text of a generated module.

What the time-stepper needs at each of its points: F(q, g), S(q, g) and the moduli dF/dq, dF/dg, dS/dq, dS/dg, those
entries alone that are not identically zero. The stress is the closure's own; there is no second definition of it.

Where ||V|| may vanish, as it does between shear bands, it is bounded below by a floor d. With m = max(||V||, d),

    (||V||^2 + m^2)/(2 m)    is ||V|| above the floor and the parabola (||V||^2 + d^2)/(2 d) that touches it below.

Its derivative by m is zero above (m = ||V||) and m does not vary below, so that differentiating at fixed m is exact.
"""

from itertools import product
from typing import Any

from sympy import Expr, Pow, Symbol, log

from stability import emit
from stability.closures.base import Closure, norm
from stability.closures.plane_flow import V
from stability.symbols import body_force, gradient, p, symbol

AXES = (0, 1)
m = symbol("m")
FLOORED_NORM = (norm(V) ** 2 + m**2) / (2 * m)

Entries = dict[tuple, Expr]


def written_out(closure: Closure, expression: Expr) -> Expr:
    """Return an expression in the raw state alone, with the norm of the strain rate bounded below."""
    for letter, definition in reversed([*closure.letters.items()]):
        expression = expression.subs(letter, definition)
    return expression.subs(norm(V), FLOORED_NORM)


def derivatives(law: Entries, by: dict[int, Symbol]) -> Entries:
    """Return the non-zero derivatives of every entry; the index of the variable comes last."""
    found = {(*i, j): e.diff(s) for (i, e), (j, s) in product(law.items(), by.items())}
    return {i: e for i, e in found.items() if e != 0}


def entry_name(table: str, index: tuple) -> str:
    """Return the name of an entry in generated code."""
    return f"{table.lower()}_{''.join(map(str, index))}"


def needs_pressure(expression: Expr) -> bool:
    """Return whether an expression exists for p > 0 only: it has a root, a logarithm or a quotient of p."""
    powers = (e.args for e in expression.atoms(Pow) if p in e.free_symbols)
    whole = all(exponent.is_Integer and exponent >= 0 for _, exponent in powers)
    return not whole or any(p in e.free_symbols for e in expression.atoms(log))


def source(closure: Closure) -> str:
    """Return the generated module of a closure for the time-stepper."""
    rows = range(len(closure.q))
    flux = {(i, a): written_out(closure, closure.flux[i, a]) for i in rows for a in AXES}
    supply = {(i,): written_out(closure, closure.supply[i]) for i in rows}
    q = dict(enumerate(closure.q))
    g = [{j: gradient(c)[b] for j, c in q.items()} for b in AXES]
    tables: dict[str, Entries] = {"FLUX": flux, "SUPPLY": supply}
    tables |= {"FLUX_Q": derivatives(flux, q), "SUPPLY_Q": derivatives(supply, q)}
    tables |= {f"FLUX_G{b}": derivatives(flux, g[b]) for b in AXES}
    tables |= {f"SUPPLY_G{b}": derivatives(supply, g[b]) for b in AXES}
    unpack = [
        f"({', '.join(map(str, closure.q))},) = q",
        *(f"({', '.join(map(str, g[b].values()))},) = g[{b}]" for b in AXES),
        f"({', '.join(map(str, body_force))},) = body_force",
        f"({''.join(f'{r.symbol}, ' for r in closure.parameters)}) = parameters",
    ]

    def function(name: str, *wanted: str) -> str:
        stage = [(entry_name(n, i), e) for n in wanted for i, e in tables[n].items()]
        groups = [f"({''.join(entry_name(n, i) + ', ' for i in tables[n])})" for n in wanted]
        return emit.function(name, "q, g, m, parameters, body_force", unpack, [stage], f"({', '.join(groups)},)")

    strain = emit.function("strain_rate_norm", "g", unpack[1:3], [[("strain", norm(V))]], "strain")
    constants: dict[str, Any] = {n: tuple(i) for n, i in tables.items()}
    return emit.module(
        closure,
        [
            strain,
            function("flux", "FLUX"),
            function("supply", "SUPPLY"),
            function("flux_moduli", "FLUX", "FLUX_Q", "FLUX_G0", "FLUX_G1"),
            function("supply_moduli", "SUPPLY", "SUPPLY_Q", "SUPPLY_G0", "SUPPLY_G1"),
        ],
        FIELDS=tuple(tuple(map(str, f)) if isinstance(f, tuple) else str(f) for f in closure.fields),
        EVOLVES=closure.evolves,
        NEEDS_PRESSURE=any(needs_pressure(e) for table in tables.values() for e in table.values()),
        BOUNDED=tuple(n for n in ("FLUX", "SUPPLY") if any(m in e.free_symbols for e in tables[n].values())),
        **constants,
    )
