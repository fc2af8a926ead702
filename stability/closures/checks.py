"""What a closure must be before anything is derived from it, each fault as one sentence that says what to do.

A fault that came through would be a traceback out of SymPy, or worse a wrong number: in generated code a parameter that
shares its letter with the pressure is the pressure.
"""

import re
from collections.abc import Iterator, Mapping
from keyword import iskeyword
from typing import Any

import sympy
from sympy import Expr, MatrixBase, Number, S, Symbol, asin, atan, cos, exp, log, sin, tan
from sympy.functions.elementary.hyperbolic import HyperbolicFunction

from stability.parameters import Parameter
from stability.symbols import body_force, gradient, hessian, symbol

ELEMENTARY = (sin, cos, tan, asin, atan, exp, log)  # the functions of every arithmetic, beside the square root
KINKED = (
    sympy.Abs, sympy.Max, sympy.Min, sympy.Piecewise, sympy.sign, sympy.Heaviside, sympy.floor, sympy.ceiling,
)  # fmt: skip
ARITHMETIC = (Symbol, sympy.Add, sympy.Mul, sympy.Pow, *ELEMENTARY)
KNOWN = f"generated code has powers, pi, sqrt, {', '.join(f.__name__ for f in ELEMENTARY)}"
# What generated code calls its own: arguments, functions, common subexpressions, the letters m_0, m_1, ..., results.
RESERVED = re.compile(
    "state|parameters|body_force|point|arithmetic|m|strain|sqrt|pi|rational|"
    + "|".join(f.__name__ for f in ELEMENTARY)
    + r"|t\d_\d+|m_\d+(_[xy])?"
    + r"|(L[012]|balance|trace|determinant|discriminant|regular|numerator|denominator|flux|supply)_\w*\d"
)


def problems(closure: Any) -> Iterator[str]:
    """Yield what is wrong with a closure, one sentence each; those after the first may be its consequences."""
    yield from unlike_text(closure)
    who = f"closure {closure.name}"
    for stage in (wrong_fields, wrong_laws, wrong_parameters, wrong_letters, wrong_names, wrong_symbols, wrong_terms):
        for problem in stage(closure):
            yield f"{who}{problem}"


def shown(value: Any) -> str:
    """Return a value and its type as text of at most a line."""
    text = " ".join(str(value).split())
    return f"{text[:57] + '...' if len(text) > 60 else text} (of type {type(value).__name__})"


def unlike_text(closure: Any) -> Iterator[str]:
    """Yield the name, title or source that is no text."""
    for word in ("name", "title", "source"):
        if not isinstance(value := getattr(closure, word), str) or not value:
            yield f"closure: {word} must be text that is not empty, got {shown(value)}"


def wrong_fields(closure: Any) -> Iterator[str]:
    """Yield what is no field: a field is a symbol of the package, or a pair of them."""
    form = 'give symbols such as stability.symbols.p or symbol("phi"), and pairs of them for vectors'
    if not isinstance(closure.fields, tuple) or not closure.fields:
        yield f": fields must be a tuple, got {shown(closure.fields)}: {form}"
        return
    for f in closure.fields:
        if isinstance(f, tuple) and len(f) != 2:
            yield f": the vector {f} of fields has {len(f)} components: {form}"
        for c in f if isinstance(f, tuple) else (f,):
            if not isinstance(c, Symbol):
                yield f": fields holds {shown(c)}: {form}"
            elif c != symbol(c.name):
                yield foreign(c.name)


def foreign(name: str) -> str:
    """Return the sentence about a symbol that has the right name and other assumptions."""
    return (
        f': {name} is not the real symbol of that name, which is another: make it by stability.symbols.symbol("{name}")'
    )


def wrong_laws(closure: Any) -> Iterator[str]:
    """Yield what is no balance law: entries of E, flux and supply, as many as there are components."""
    if not isinstance(closure.evolves, tuple | list) or not all(e in (0, 1) for e in closure.evolves):
        yield f": evolves = {closure.evolves} may hold 1 (evolution) and 0 (constraint) only"
        return
    for word in ("flux", "supply"):
        if not isinstance(value := getattr(closure, word), MatrixBase):
            yield f": {word} must be a SymPy matrix, got {shown(value)}: write ImmutableMatrix(...)"
            return
    n = len(closure.q)
    if not (len(closure.evolves) == n == len(closure.supply) and closure.flux.shape == (n, 2)):
        yield (
            f": {n} components of q need {n} entries of E and S and an {n} x 2 flux, "
            f"got {len(closure.evolves)}, {len(closure.supply)} and {closure.flux.shape}"
        )


def wrong_parameters(closure: Any) -> Iterator[str]:
    """Yield what is no record of a parameter."""
    form = "give Parameter(word, symbol, unit, low, high, meaning, source) for each, in a tuple: (ONE,) or (ONE, TWO)"
    if not isinstance(closure.parameters, tuple | list):
        yield f": parameters must be a tuple, got {shown(closure.parameters)}: {form}"
        return
    words = set()
    for record in closure.parameters:
        if not isinstance(record, Parameter):
            yield f": parameters holds {shown(record)}: {form}"
        elif record.word in words:
            yield f": two parameters have the word {record.word!r}: give each its own"
        else:
            words.add(record.word)


def wrong_letters(closure: Any) -> Iterator[str]:
    """Yield what is no letter with a definition in the fields and earlier letters, or no relation between letters."""
    if not isinstance(closure.letters, Mapping):
        yield f": letters must be a dict {{symbol: definition}}, got {shown(closure.letters)}"
        return
    later = set(closure.letters)
    for letter, definition in closure.letters.items():
        if not isinstance(letter, Symbol) or not isinstance(definition, Expr):
            yield f": letters must be a dict {{symbol: definition}}, got {shown(letter)} and {shown(definition)}"
            return
        if letter != symbol(letter.name):
            yield foreign(letter.name)
        if unknown := sorted(map(str, definition.free_symbols & later)):
            yield f": the letter {letter} is defined by {', '.join(unknown)}: put letters after those that define them"
        later.discard(letter)
    for relation in closure.relations:
        pair = relation if isinstance(relation, tuple) and len(relation) == 2 else (None, None)
        if pair[0] not in closure.letters or not isinstance(pair[1], Expr):
            yield f": relations holds {shown(relation)}: give (letter, polynomial that vanishes) for each"


def names(closure: Any) -> Iterator[tuple[str, str]]:
    """Yield every name that a closure brings into generated code, with what it stands for."""
    for s in body_force:
        yield str(s), "the body force"
    for c in closure.q:
        yield str(c), f"the field {c}"
        second = {str(h) for row in hessian(c) for h in row}
        yield from ((name, f"the gradient of {c}") for name in (*map(str, gradient(c)), *sorted(second)))
    for letter in closure.letters:
        yield str(letter), f"the letter {letter}"
        yield from ((str(d), f"the gradient of {letter}") for d in gradient(letter))
    for record in closure.parameters:
        yield record.symbol, f"the parameter {record.word}"


def wrong_names(closure: Any) -> Iterator[str]:
    """Yield what generated code cannot call by its name, or would take for something else."""
    found: dict[str, str] = {}
    if bad := sorted({n for n, _ in names(closure) if not n.isidentifier() or iskeyword(n) or RESERVED.fullmatch(n)}):
        yield f": {bad} cannot be names in generated code: choose other letters"
    for name, role in names(closure):
        if name in found:
            yield f": {found[name]} and {role} share the symbol {name!r}: choose another one for one of them"
        found[name] = role


def entries(closure: Any) -> Iterator[tuple[str, Expr]]:
    """Yield every expression of a closure with where it stands."""
    for word in ("flux", "supply"):
        matrix = getattr(closure, word)
        yield from ((f"{word}[{i}, {j}]", matrix[i, j]) for i in range(matrix.rows) for j in range(matrix.cols))
    yield from ((f"the letter {letter}", definition) for letter, definition in closure.letters.items())
    yield from ((f"the relation of {letter}", vanishing) for letter, vanishing in closure.relations)


def wrong_symbols(closure: Any) -> Iterator[str]:
    """Yield symbols that are not declared, or not those that were declared under that name."""
    known = {*closure.q, *closure.g, *closure.letters, *body_force, *(symbol(r.symbol) for r in closure.parameters)}
    used = {s for _, e in entries(closure) for s in e.free_symbols} - known
    declared = set(map(str, known))
    yield from (foreign(name) for name in sorted(map(str, used)) if name in declared)
    if undeclared := sorted({*map(str, used)} - declared):
        yield f" uses undeclared symbols {undeclared}: declare each as a parameter, a field or a letter"


def wrong_terms(closure: Any) -> Iterator[str]:
    """Yield terms that no arithmetic has, or that have no derivative."""
    for place, expression in entries(closure):
        for node in sympy.preorder_traversal(expression):
            if reason := unfit(node):
                yield f": {place} holds {shown(node)}{reason}"
                return


def unfit(node: Any) -> str | None:
    """Return why a node of an expression cannot be compiled, and what to do; None if it can."""
    if isinstance(node, ARITHMETIC) or (isinstance(node, Number) and node.is_finite) or node in (S.Pi, S.Exp1):
        return None
    if isinstance(node, Number) or node is S.ComplexInfinity:
        return ", which is no finite number: look for a division by zero"
    if node is S.ImaginaryUnit:
        return ", but laws are real: look for a root or a logarithm of a negative number"
    if isinstance(node, KINKED):
        return (
            ", which is not smooth, and a wave asks for derivatives: write one closure for each smooth branch, or a "
            "smooth law, such as sqrt(x**2 + c**2) for |x|"
        )
    how = "exp, as .rewrite(exp) does" if isinstance(node, HyperbolicFunction) else "these"
    return f", but {KNOWN}: write it by {how}"
