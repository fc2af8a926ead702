"""SymPy expressions -> the text of a generated module (stage 1 of `codegen`)."""

from collections.abc import Iterable
from typing import Any

from sympy import Expr, ImmutableMatrix, Symbol, cse, numbered_symbols
from sympy.printing.precedence import PRECEDENCE
from sympy.printing.str import StrPrinter

from stability import records
from stability.closures.base import Closure
from stability.closures.checks import ELEMENTARY, KNOWN
from stability.errors import SceneError
from stability.flows.base import Flow
from stability.linearise import Pencil, imbalance, letter_gradients, letters, pencil
from stability.parameters import Parameter
from stability.structure import galilean, modes
from stability.symbols import body_force, gradient, hessian
from stability.tangent import MATRICES, NoClosedFormError, Pair, Single, reduced_form, truncated

FUNCTIONS = " ".join(("sqrt", *(f.__name__ for f in ELEMENTARY), "pi", "rational"))


class Printer(StrPrinter):
    """Prints arithmetic that means the same for floats, mpmath numbers and balls."""

    def _print_Rational(self, e: Any) -> str:
        # A denominator 2^n is exact in every arithmetic; any other quotient must be formed in the arithmetic itself.
        return repr(int(e.p) / int(e.q)) if e.q & (e.q - 1) == 0 and abs(e.p) < 2**53 else f"rational({e.p}, {e.q})"

    def _print_Exp1(self, e: Any) -> str:
        return "exp(1)"

    def _print_Function(self, e: Any) -> str:
        if not isinstance(e, ELEMENTARY):  # a flow's own, or one that SymPy made of a closure's: `checks` saw neither
            raise SceneError(f"{e} cannot be computed: {KNOWN}")
        return super()._print_Function(e)

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


def closed_forms(closure: Closure) -> dict[str, Pair | Single]:
    """Return the reduced forms of D, D' and M, or nothing where the pencil itself must be solved."""
    try:
        return {matrix: reduced_form(closure, matrix) for matrix in MATRICES}
    except NoClosedFormError:
        return {}


def closure_source(closure: Closure) -> str:
    """Return the generated module of a closure."""
    own_letters = [(str(s), e) for s, e in letters(closure).items()]
    gradients = [(str(s), e) for s, e in letter_gradients(closure).items()]
    unpack = [unpacking(closure.fields), *parameter_lines(closure.parameters)]

    def of_state(name: str, results: list[tuple[str, Expr]], result: str, more: str = "") -> str:
        """Return a function of the jet: letters, their gradients, then the results."""
        slopes = needed(gradients, symbols_of(e for _, e in results))
        used = needed(own_letters, symbols_of(e for _, e in (*results, *slopes)))
        extra = [f"{nested([str(s) for s in body_force])} = {more}"] if more else []
        arguments = ", ".join(filter(None, ("state", "parameters", more)))
        return function(name, arguments, unpack + extra, [used, slopes, results], result)

    balance = [(f"balance_{i}", e) for i, e in enumerate(imbalance(closure))]
    forms = closed_forms(closure)
    count, rank = (2 if isinstance(forms["full"], Pair) else 1, 0) if forms else modes(closure)
    return module(
        closure,
        [
            *(of_state(matrix, *form_text(form)) for matrix, form in forms.items()),
            of_state("pencil", *pencil_text(pencil(closure))),
            *([of_state("pencil_truncated", *pencil_text(truncated(closure)))] if forms else ()),
            of_state("imbalance", balance, nested([name for name, _ in balance]), more="body_force"),
            function("letters", "state, parameters", unpack, [own_letters], named(own_letters)),
        ],
        FORM=type(forms["full"]).__name__ if forms else "General",
        MODES=count,
        RANK=rank,
        GALILEAN=galilean(closure),
    )


def form_text(form: Pair | Single) -> tuple[list[tuple[str, Expr]], str]:
    """Return the assignments of all coefficients of a reduced form, and the text of the dict of its series."""
    assignments: list[tuple[str, Expr]] = []
    parts = []
    for part, series in vars(form).items():
        names = {n: f"{part}_{n}".replace("-", "m") for n in sorted(series)}
        assignments += [(names[n], series[n]) for n in names]
        parts.append(f"{part!r}: {{{', '.join(f'{n}: {name}' for n, name in names.items())}}}")
    return assignments, "{" + ", ".join(parts) + "}"


def pencil_text(P: Pencil) -> tuple[list[tuple[str, Expr]], str]:
    """Return the assignments of the entries of L2, L1 and L0, and the text of their nested tuple."""
    axes = (0, 1)
    assignments: list[tuple[str, Expr]] = []

    def matrix(name: str, entries: ImmutableMatrix) -> str:
        names = [[f"{name}_{i}{j}" for j in range(entries.cols)] for i in range(entries.rows)]
        assignments.extend((names[i][j], entries[i, j]) for i in range(entries.rows) for j in range(entries.cols))
        return nested(names)

    second = ", ".join(f"({', '.join(matrix(f'L2_{a}{b}', P.L2[a][b]) for b in axes)})" for a in axes)
    first = ", ".join(matrix(f"L1_{a}", P.L1[a]) for a in axes)
    return assignments, f"(({second}), ({first}), {matrix('L0', P.L0)})"


def named(assignments: list[tuple[str, Expr]]) -> str:
    """Return the text of a dict from names to the variables of those names."""
    return "{" + ", ".join(f"{name!r}: {name}" for name, _ in assignments) + "}"


def flow_source(flow: Flow) -> str:
    """Return the generated module of a flow."""
    constants = [(str(s), e) for s, e in flow.letters.items()]
    jets = [(str(s), e) for s, e in flow.jet().items()]
    unpack = [*parameter_lines(flow.parameters), *(f"{r.symbol} = point[{r.word!r}]" for r in flow.point)]
    state = "{" + ", ".join(f"{str(f)!r}: {nested(jet_names(f))}" for f in flow.fields) + "}"
    force = [(str(s), e) for s, e in zip(body_force, flow.body_force, strict=True)]
    # Letters such as Psi_w only exist (asin of at most one) where the conditions on the bare parameters hold.
    bare = [c for c in flow.conditions if not c[0].free_symbols & flow.letters.keys()]
    derived = [c for c in flow.conditions if c not in bare]
    functions = [
        function(
            "state", "point, parameters", unpack, [needed(constants, symbols_of(e for _, e in jets)), jets], state
        ),
        function("body_force", "point, parameters", unpack, [force], nested([s for s, _ in force])),
        function("letters", "point, parameters", unpack, [constants], named(constants)),
        function("conditions", "point, parameters", unpack, [], conditions(bare)),
        function("letter_conditions", "point, parameters", unpack, [constants], conditions(derived)),
    ]
    return module(flow, functions)


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
    """Return a whole module: constants, then ``build(arithmetic)``."""
    names = [f.split("(")[0].split()[-1] for f in functions]
    unpack = "\n".join(f"    {name} = arithmetic.{name}" for name in FUNCTIONS.split())
    exported = ", ".join(f"{n!r}: {n}" for n in names)
    return (
        records.source(entry, **constants)
        + f"\n\ndef build(arithmetic):\n{unpack}\n\n"
        + "\n".join(functions)
        + f"\n    return {{{exported}}}\n"
    )


def source(entry: Closure | Flow) -> str:
    """Return the module text of a closure or of a flow."""
    return closure_source(entry) if isinstance(entry, Closure) else flow_source(entry)
