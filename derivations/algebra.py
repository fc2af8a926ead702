"""Exact comparison: what vanishes modulo what is given, and seeded rational points at which two forms differ."""

import re as regex
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from random import Random

from sympy import Basic, Expr, Matrix, N, Rational, Symbol, expand, fraction, im, re, rem, sympify, together

from derivations.verdict import Kind, UnprovedError, Verdict

DIGITS = 30
GREEK = {
    "mu": "μ",
    "eta": "μ",
    "epsilon": "ε",
    "delta": "δ",
    "alpha": "α",
    "theta": "θ",
    "Psi": "Ψ",
    "xi": "ξ",
    "N": "‖V‖",
}


@dataclass(frozen=True)
class Given:
    """What is known about the letters.

    Attributes
    ----------
    substitution : letters that are replaced at once
    relations : ``(letter, polynomial that vanishes)``, monic up to a number in that letter
    rational : the same relations solved: every letter in them as a rational function of free parameters
    """

    substitution: Mapping[Symbol, Expr] = field(default_factory=dict)
    relations: tuple[tuple[Symbol, Expr], ...] = ()
    rational: Mapping[Symbol, Expr] = field(default_factory=dict)

    def remainder(self, expression: Expr) -> Expr:
        """Return the numerator of the expression modulo the relations; zero exactly where the expression vanishes."""
        numerator = expand(fraction(together(sympify(expression).xreplace(dict(self.substitution))))[0])
        for letter, vanishing in self.relations:
            numerator = expand(rem(numerator, vanishing, letter))
        return numerator

    def vanishes(self, expression: Expr | Matrix) -> bool:
        """Return whether the expression, or every entry of the matrix, is zero by what is given."""
        return all(self.remainder(e) == 0 for e in entries(expression))

    def point(self, expressions: Iterable[Basic], seed: int = 0) -> dict[Symbol, Expr]:
        """Return rational values, drawn between 0 and 1 where free, for all letters of the expressions."""
        rng = Random(seed)
        wanted = set().union(*(e.free_symbols for e in expressions))
        tied = {s: e.xreplace(dict(self.rational)) for s, e in (dict(self.rational) | dict(self.substitution)).items()}
        needed = {s for w in wanted for s in (tied[w].free_symbols if w in tied else {w})}
        # random() alone is promised to repeat between versions of Python.
        free = {s: Rational(1 + int(9 * rng.random()), 10 + int(10 * rng.random())) for s in sorted(needed, key=str)}
        return {w: sympify(tied[w]).xreplace(free) if w in tied else free[w] for w in sorted(wanted, key=str)}


ANYTHING = Given()


def entries(expression: Expr | Matrix) -> list[Expr]:
    """Return the entries of a matrix, or the expression itself."""
    return list(expression) if hasattr(expression, "shape") else [sympify(expression)]


def digits(value: Expr, count: int = DIGITS) -> str:
    """Return a real or complex number with the given number of digits."""
    value = sympify(value)
    real, imaginary = re(value), im(value)
    if imaginary == 0:
        return decimal(real, count)
    sign = "−" if imaginary < 0 else "+"
    return (f"{decimal(real, count)} {sign} " if real != 0 else sign.strip("+")) + f"{decimal(abs(imaginary), count)} i"


def decimal(value: Expr, count: int) -> str:
    """Return a real number with the given number of digits, or with as few as are exact."""
    text = str(N(value, count))
    short = text.rstrip("0").rstrip(".") if "." in text and "e" not in text else text
    return (short if value.is_Rational and Rational(short) == value else text).replace("-", "−")


def written(point: Mapping[Symbol, Expr]) -> str:
    """Return a point as text, its letters in the paper's alphabet."""
    text = ", ".join(f"{s} = {value}" for s, value in point.items()).replace("-", "−")
    return regex.sub("[A-Za-z]+", lambda word: GREEK.get(word[0], word[0]), text)


def counterexample(printed: Expr, derived: Expr, given: Given = ANYTHING, seed: int = 0) -> str:
    """Return a point at which two expressions differ, with both values."""
    point = given.point([sympify(printed), sympify(derived)], seed)
    left, right = (expand(sympify(e).xreplace(point), complex=True) for e in (printed, derived))
    if expand(left - right) == 0:
        raise UnprovedError(f"no difference at {written(point)}")
    return f"at {written(point)}: printed {digits(left)}, right {digits(right)}"


def compare(
    label: str,
    printed: str,
    forms: tuple,
    given: Given = ANYTHING,
    right: str = "",
    corrected: Expr | Matrix | None = None,
    slip: Kind = Kind.MISPRINT,
    modulo: str = "",
    note: str = "",
    proofs: Iterable[bool] = (),
    names: Sequence[str] = (),
    seed: int = 0,
) -> Verdict:
    """Judge a printed equation against what the package's expressions give.

    Parameters
    ----------
    forms : the printed form and the derived one, expressions or matrices of the same shape
    corrected : the form to be given in place of the print; it must agree with the derived one
    slip : the verdict if the print is refuted: HOLDS_IF where `right` states the condition
    modulo : the identities used, in words
    proofs : facts that the note states; all must be true
    names : of the entries, where "entry 12" would not do
    seed : of the rational point of a counter-example
    """
    if not all(bool(p) for p in proofs):
        raise UnprovedError(f"{label}: the note states what is not so")
    claim, derived = forms
    by = f" modulo {modulo}" if modulo else ""
    pairs = list(zip(entries(claim), entries(derived), strict=True))
    wrong = [i for i, (one, other) in enumerate(pairs) if not given.vanishes(one - other)]
    if not wrong:
        return Verdict(label, Kind.HOLDS, printed, right, joined(f"printed − derived = 0{by}", note))
    if corrected is None or not all(given.vanishes(c - d) for c, (_, d) in zip(entries(corrected), pairs, strict=True)):
        raise UnprovedError(f"{label}: neither the print nor its correction agrees with the derived form")
    worst = min(wrong, key=lambda i: len((pairs[i][0] - pairs[i][1]).free_symbols))
    if len(pairs) == 1:
        where = ""
    elif names or derived.shape[1] == 1:
        where = f"{names[worst]} " if names else f"component {worst + 1} "
    else:
        where = "entry {}{} ".format(*(i + 1 for i in divmod(worst, derived.shape[1])))
    evidence = joined(f"right − derived = 0{by}; printed − derived ≠ 0", note)
    return Verdict(label, slip, printed, right, evidence, where + counterexample(*pairs[worst], given, seed))


def decide(
    label: str,
    printed: str,
    evidence: str,
    proofs: Iterable[bool],
    refutation: tuple[bool, str] | None = None,
    right: str = "",
    slip: Kind = Kind.FAILS,
) -> Verdict:
    """Judge a statement by proofs of what is right and, if it is not what is printed, by a refutation of the print.

    Parameters
    ----------
    proofs : facts that must all be true for `right` to stand
    refutation : whether the printed statement is violated at a point, and that point with its values
    """
    if not all(bool(p) for p in proofs):
        raise UnprovedError(f"{label}: a step of the proof does not hold")
    if refutation is None:
        return Verdict(label, Kind.HOLDS, printed, right, evidence)
    violated, where = refutation
    if not bool(violated):
        raise UnprovedError(f"{label}: the counter-example does not refute the print")
    return Verdict(label, slip, printed, right, evidence, where)


def joined(*parts: str) -> str:
    """Return the parts that are not empty, as one sentence."""
    return "; ".join(p for p in parts if p)
