"""The paper's equations, derived again: every label has its verdict, and no verdict changes unseen."""

from functools import cache
from importlib import import_module

import pytest
from sympy import Rational, Symbol, symbols

from derivations import GROUPS
from derivations.__main__ import README, TARGET, readme
from derivations.algebra import ANYTHING, Given, compare, decide, digits
from derivations.frames import AT_YIELD, FLAT, FLAT_SMOOTH, PRINCIPAL, UNIT
from derivations.report import document
from derivations.verdict import Kind, UnprovedError, Verdict

# Every \label of an equation in the paper, in the order of print.
LABELS = """
    I0 I1 I2 I2.5 I4 I5 I6 I7 I7.1
    L0 L0.1 L1 L1.1 L2 L2.1 L2.2 L2.3 L3 L3.1 L3.2 L4 L5
    P1 P1.1 P1.2 P1.3 P2 P2.1 P3 P4 P4.5 P5 P6 P7 P8T P8D P9
    R2 R7 R8 R9 R10
""".split()

# All that is not plainly right, by kind; everything else HOLDS.
NOT_PLAIN = {
    Kind.HOLDS_IF: [
        '"strictly hyperbolic"',
        "L2.3",
        "zeros of (L5)",
        "figure L1, caption",
        "yield of (P1)",
        '"collapsing the wedge"',
        "after (P9): positive eigenvalue",
        "after (P9): ill-posed",
        "D, 0 < δ < k",
        "D', δ = 0",
        "axisymmetric extension in 3-D",
        "Ψ_w",
        "δ of the radial flow",
        "μ largest near the centre",
        *("runs: first where μ is largest", "runs: jumps, or steep waves"),
    ],
    Kind.MISPRINT: [
        *("I4", "I6", "L0", "M_ijkl", "IPRF", "denominator of (L5)", "P1.2", "P2.1", "P8D", "P9"),
        *("case 2, band", "case 3", "figure P1, caption", "Ψ", "R7", "R9"),
    ],
    Kind.FAILS: ["L4, second line", "(P5), (P6) with (P1.2)", "case 1", "case 2"],
}
HOLDING = 61


@cache
def verdicts(group: str) -> list[Verdict]:
    return import_module(f"derivations.{group}").verdicts()


def everything() -> list[Verdict]:
    return [v for group in GROUPS for v in verdicts(group)]


@pytest.mark.parametrize("group", GROUPS)
def test_group_proves_its_verdicts(group):
    found = verdicts(group)
    assert found
    for v in found:
        assert v.label and v.printed and v.evidence
        assert v.kind is Kind.HOLDS or v.right, f"{v.label}: what is right instead?"
        if v.kind is not Kind.HOLDS and "by inspection" not in v.evidence:
            assert v.counterexample, f"{v.label}: refuted without a counter-example"


def test_every_labelled_equation_has_exactly_one_verdict():
    found = [v.label for v in everything()]
    assert [label for label in LABELS if found.count(label) != 1] == []
    assert len(found) == len(set(found))


def test_three_cases_w_F_Psi_and_statements_have_verdicts():
    found = {v.label for v in everything()}
    assert {"case 1", "case 2", "case 2, band", "case 3", "w", "F²", "Ψ", "Ψ_w", "M_ijkl", "L4, second line"} <= found
    assert {"(P5) is always negative", "Det M is non-negative", "denominator of (L5)", "δ of the radial flow"} <= found


def test_kinds_are_the_pinned_ones():
    assert {kind: [v.label for v in everything() if v.kind is kind] for kind in NOT_PLAIN} == NOT_PLAIN
    assert sum(v.kind is Kind.HOLDS for v in everything()) == HOLDING


def test_only_texts_are_judged_by_inspection():
    assert [v.label for v in everything() if "by inspection" in v.evidence] == ["IPRF", "figure P1, caption"]


def test_verdicts_file_is_what_the_derivations_give():
    groups = {import_module(f"derivations.{group}").TITLE: verdicts(group) for group in GROUPS}
    assert TARGET.read_text(encoding="utf-8") == document(groups), "run: python -m derivations"
    assert README.read_text(encoding="utf-8") == readme(groups), "run: python -m derivations"


@pytest.mark.parametrize("given", [UNIT, FLAT, FLAT_SMOOTH, PRINCIPAL, AT_YIELD])
def test_rational_points_satisfy_the_relations(given):
    for letter, vanishing in given.relations:
        point = given.point([vanishing, letter], seed=5)
        assert vanishing.xreplace(point) == 0


x, y = symbols("x y")


def test_compare_calls_a_right_form_right():
    v = compare("e", "p", ((x + y) ** 2, x**2 + 2 * x * y + y**2))
    assert v.kind is Kind.HOLDS and v.counterexample == ""


def test_compare_uses_the_relations():
    unit = Given(relations=((y, x**2 + y**2 - 1),))
    assert compare("e", "p", (x**2 + y**2, Rational(1)), unit).kind is Kind.HOLDS


def test_compare_finds_a_misprint_and_quotes_both_values():
    v = compare("e", "p", (2 * x, x), right="x", corrected=x)
    assert v.kind is Kind.MISPRINT
    assert v.counterexample.startswith("at x = ") and "printed" in v.counterexample and "right" in v.counterexample


def test_compare_refuses_a_correction_that_is_wrong_too():
    with pytest.raises(UnprovedError, match="e: neither the print nor its correction"):
        compare("e", "p", (2 * x, x), corrected=3 * x)


def test_compare_refuses_a_note_that_is_not_so():
    with pytest.raises(UnprovedError, match="note states what is not so"):
        compare("e", "p", (x, x), proofs=[False])


def test_decide_refuses_a_broken_proof_and_an_idle_counterexample():
    with pytest.raises(UnprovedError, match="a step of the proof"):
        decide("e", "p", "why", [True, False])
    with pytest.raises(UnprovedError, match="does not refute"):
        decide("e", "p", "why", [True], (False, "nowhere"))


def test_vanishing_is_exact():
    assert ANYTHING.vanishes((x**2 - y**2) / (x - y) - x - y)
    assert not ANYTHING.vanishes(x - Rational(10**30 + 1, 10**30) * x)


def test_numbers_have_thirty_digits_or_are_exact():
    assert digits(Rational(1, 3)) == "0." + 30 * "3"
    assert digits(Rational(-3, 4)) == "−0.75"
    assert Symbol("x") not in ANYTHING.point([x]).values()
