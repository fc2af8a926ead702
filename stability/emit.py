"""SymPy expressions -> the text of a generated module (stage 1 of `codegen`)."""

from collections.abc import Iterable, Mapping
from typing import Any

from sympy import Expr, Symbol, cse, numbered_symbols
from sympy.printing.precedence import PRECEDENCE
from sympy.printing.str import StrPrinter

from stability.closures.base import Closure
from stability.flows.base import Flow
from stability.linearise import imbalance, letter_gradients, letters, pencil
from stability.parameters import Parameter
from stability.symbols import body_force, gradient, hessian
from stability.tangent import MATRICES, reduced_form

BACKEND = "sqrt sin cos tan asin atan exp log pi rational"


class Printer(StrPrinter):
    """Prints arithmetic that means the same for floats, mpmath numbers and balls."""

    def _print_Rational(self, e: Any) -> str:
        # A denominator 2^n is exact in every arithmetic; any other quotient must be formed in the arithmetic itself.
        return repr(int(e.p) / int(e.q)) if e.q & (e.q - 1) == 0 and abs(e.p) < 2**53 else f"rational({e.p}, {e.q})"

    def _print_Pow(self, e: Any, rational: bool = False) -> str:
        base, exponent = e.as_base_exp()
        text = self.parenthesize(base, PRECEDENCE["Atom"], strict=True)
        if not (2 * exponent).is_Integer:
            return f"{text}**{self.parenthesize(exponent, PRECEDENCE['Atom'], strict=True)}"
        if exponent < 0:
            return f"(1/{text if exponent == -1 else self._print(base**-exponent)})"
        whole, half = divmod(int(2 * exponent), 2)
        factors = [text] * whole + [f"sqrt({self._print(base)})"] * half
        return factors[0] if len(factors) == 1 else f"({'*'.join(factors)})"


def statements(assignments: list[tuple[str, Expr]], prefix: str) -> list[str]:
    """Return assignments as lines, each common subexpression named just before its first use."""
    shared, results = cse([e for _, e in assignments], symbols=numbered_symbols(prefix, real=True))
    pending, lines = dict(shared), []
    show = Printer().doprint

    def state(name: str, expression: Expr) -> None:
        for s in sorted(expression.free_symbols & pending.keys(), key=str):
            if s in pending:
                state(str(s), pending.pop(s))
        lines.append(f"{name} = {show(expression)}")

    for (name, _), expression in zip(assignments, results, strict=True):
        state(name, expression)
    return lines


def needed(assignments: list[tuple[str, Expr]], wanted: set[str]) -> list[tuple[str, Expr]]:
    """Return those assignments, in order, that the wanted names depend on."""
    kept = []
    for name, expression in reversed(assignments):
        if name in wanted:
            kept.append((name, expression))
            wanted = wanted | {str(s) for s in expression.free_symbols}
    return kept[::-1]


def function(name: str, arguments: str, unpack: list[str], stages: list[list[tuple[str, Expr]]], result: str) -> str:
    """Return the text of a function: unpack, then the stages one after another."""
    lines = [*unpack]
    for i, stage in enumerate(stages):
        lines += statements(stage, f"t{i}_")
    body = "\n".join(f"        {line}" for line in (*lines, f"return {result}"))
    return f"    def {name}({arguments}):\n{body}\n"


def symbols_of(expressions: Iterable[Expr]) -> set[str]:
    """Return the names of all symbols in the expressions."""
    return {str(s) for e in expressions for s in e.free_symbols}


def parameter_lines(records: Iterable[Parameter]) -> list[str]:
    """Return the lines that name every parameter by its letter."""
    return [f"{r.symbol} = parameters[{r.word!r}]" for r in records]


def jet_names(component: Symbol) -> tuple:
    """Return the nested names of value, gradient and second gradient of one component."""
    return (
        str(component),
        tuple(map(str, gradient(component))),
        tuple(tuple(map(str, row)) for row in hessian(component)),
    )


def state_names(fields: Iterable) -> tuple:
    """Return the nested names of the jet: per field (value, gradient, second gradient), vectors component first."""
    return tuple(tuple(zip(*map(jet_names, f), strict=True)) if isinstance(f, tuple) else jet_names(f) for f in fields)


def nested(names: Any) -> str:
    """Return a nested tuple of names as source text."""
    return names if isinstance(names, str) else f"({', '.join(map(nested, names))},)"


def unpacking(fields: Iterable) -> str:
    """Return the line that names every component of a jet."""
    return f"{nested(state_names(fields))} = state"


def series_text(series: Mapping[int, Expr], name: str) -> tuple[list[tuple[str, Expr]], str]:
    """Return the assignments of a series' coefficients and the text of the dict that holds them."""
    names = {n: f"{name}_{n}".replace("-", "m") for n in sorted(series)}
    return [(names[n], series[n]) for n in names], "{" + ", ".join(f"{n}: {v}" for n, v in names.items()) + "}"


def closure_source(closure: Closure) -> str:
    """Return the generated module of a closure."""
    named_letters = [(str(s), e) for s, e in letters(closure).items()]
    gradients = [(str(s), e) for s, e in letter_gradients(closure).items()]
    unpack = [unpacking(closure.fields), *parameter_lines(closure.parameters)]

    def staged(results: list[tuple[str, Expr]]) -> list:
        slopes = needed(gradients, symbols_of(e for _, e in results))
        own = needed(named_letters, symbols_of(e for _, e in (*results, *slopes)))
        return [own, slopes, results]

    functions = []
    for matrix in MATRICES:
        form = reduced_form(closure, matrix)
        parts = {part: series_text(getattr(form, part), part) for part in form.__dataclass_fields__}
        assignments = [a for assigned, _ in parts.values() for a in assigned]
        result = "{" + ", ".join(f"{part!r}: {text}" for part, (_, text) in parts.items()) + "}"
        functions.append(function(matrix, "state, parameters", unpack, staged(assignments), result))

    P = pencil(closure)
    n = range(len(closure.q))
    tables = (
        {f"L2_{a}{b}": P.L2[a][b] for a in (0, 1) for b in (0, 1)} | {f"L1_{a}": P.L1[a] for a in (0, 1)} | {"L0": P.L0}
    )
    entries = [(f"{t}_{i}{j}", m[i, j]) for t, m in tables.items() for i in n for j in n]
    rows = {t: nested([[f"{t}_{i}{j}" for j in n] for i in n]) for t in tables}
    result = (
        f"(({rows['L2_00']}, {rows['L2_01']}), ({rows['L2_10']}, {rows['L2_11']})), "
        f"({rows['L1_0']}, {rows['L1_1']}), {rows['L0']}"
    )
    functions.append(function("pencil", "state, parameters", unpack, staged(entries), result))

    balance = [(f"balance_{i}", e) for i, e in enumerate(imbalance(closure))]
    force = f"{nested(list(map(str, body_force)))} = body_force"
    functions.append(
        function(
            "imbalance",
            "state, parameters, body_force",
            [*unpack, force],
            staged(balance),
            nested([name for name, _ in balance]),
        )
    )
    values = "{" + ", ".join(f"{s!r}: {s}" for s, _ in named_letters) + "}"
    functions.append(function("letters", "state, parameters", unpack, [named_letters], values))
    return module(
        closure,
        functions,
        FORM=type(form).__name__,
        EVOLVES=closure.evolves,
        FIELDS=tuple(tuple(map(str, f)) if isinstance(f, tuple) else str(f) for f in closure.fields),
    )


def flow_source(flow: Flow) -> str:
    """Return the generated module of a flow."""
    constants = [(str(s), e) for s, e in flow.letters.items()]
    jets = [(str(s), e) for s, e in flow.jet().items()]
    unpack = [*parameter_lines(flow.parameters), *(f"{r.symbol} = point[{r.word!r}]" for r in flow.point)]
    state = "{" + ", ".join(f"{str(f)!r}: {nested(jet_names(f))}" for f in flow.fields) + "}"
    force = [(str(s), e) for s, e in zip(body_force, flow.body_force, strict=True)]
    values = "{" + ", ".join(f"{s!r}: {s}" for s, _ in constants) + "}"
    # Letters such as Psi_w only exist (asin of at most one) where the conditions on the bare parameters hold.
    bare = [c for c in flow.conditions if not c[0].free_symbols & flow.letters.keys()]
    derived = [c for c in flow.conditions if c not in bare]
    functions = [
        function(
            "state", "point, parameters", unpack, [needed(constants, symbols_of(e for _, e in jets)), jets], state
        ),
        function("body_force", "point, parameters", unpack, [force], nested([s for s, _ in force])),
        function("letters", "point, parameters", unpack, [constants], values),
        function("conditions", "point, parameters", unpack, [], conditions(bare)),
        function("letter_conditions", "point, parameters", unpack, [constants], conditions(derived)),
    ]
    return module(flow, functions, POINT=flow.point, AXIS=flow.axis)


def conditions(pairs: Iterable[tuple[Expr, str]]) -> str:
    """Return the text of a tuple of (sentence, whether it holds)."""
    return "(" + "".join(f"({text!r}, {condition(e)}), " for e, text in pairs) + ")"


def condition(relation: Expr) -> str:
    """Return a relation as text that also holds for arrays."""
    show = Printer().doprint
    if relation.func.__name__ == "And":
        return " & ".join(f"({condition(a)})" for a in relation.args)
    sign = {"Unequality": "!=", "StrictLessThan": "<", "LessThan": "<=", "StrictGreaterThan": ">", "GreaterThan": ">="}
    return f"{show(relation.lhs)} {sign[relation.func.__name__]} {show(relation.rhs)}"


def module(entry: Closure | Flow, functions: list[str], **constants: Any) -> str:
    """Return a whole module: constants, then ``build(backend)``."""
    constants = {
        "NAME": entry.name,
        "TITLE": entry.title,
        "SOURCE": entry.source,
        "PARAMETERS": entry.parameters,
        **constants,
    }
    names = [f.split("(")[0].split()[-1] for f in functions]
    unpack = "\n".join(f"    {name} = backend.{name}" for name in BACKEND.split())
    exported = ", ".join(f"{n!r}: {n}" for n in names)
    return (
        f'"""Generated from {entry.name} ({entry.source}). Do not edit."""\n'
        "from math import inf\nfrom stability.parameters import Parameter\n\n"
        + "\n".join(f"{name} = {value!r}" for name, value in constants.items())
        + f"\n\n\ndef build(backend):\n{unpack}\n\n"
        + "\n".join(functions)
        + f"\n    return {{{exported}}}\n"
    )


def source(entry: Closure | Flow) -> str:
    """Return the module text of a closure or of a flow."""
    return closure_source(entry) if isinstance(entry, Closure) else flow_source(entry)
