"""How a verdict reads."""

from dataclasses import replace
from fractions import Fraction

import pytest
from matplotlib.mathtext import MathTextParser

from stability.verdict import Beside, Kind, Verdict, spelled

ILL = Verdict(Kind.ILL_POSED, Fraction(2), ((28.0, 45.0),), 36.1, 3.5e-7, cause=("the friction",), certified=True)


def test_a_verdict_is_a_sentence():
    assert str(ILL) == (
        "ill-posed: short waves grow without bound, as 3.5e-07 m^2/s |xi|^2, at 36.1 deg; growing directions: 28 to 45 "
        "deg; caused by the friction. Signs are certified."
    )


def test_growing_directions_without_width_say_so():
    bounded = Verdict(Kind.BOUNDED, 0, ((45.0, 45.0), (135.0, 135.0)), 45.0, 7.5, width=Fraction(1))
    assert "short waves grow as 7.5 1/s, at 45 deg" in str(bounded)
    assert "those that close in on 45, 135 deg as |xi|^-1" in str(bounded)
    assert str(bounded).endswith("Signs are not certified.")


def test_every_kind_has_a_text():
    assert "no wavelength was found to grow" in str(Verdict(Kind.STABLE, 2, (), 0.0, -1.0, finite=(-1.0, 1.0, 0.0)))
    assert str(Verdict(Kind.UNDECIDED, notes=("too hard",))) == "undecided: too hard."
    assert "undetermined along 90 deg alone" in str(Verdict(Kind.SINGULAR, wedge=((90.0, 90.0),)))
    assert "undetermined in every direction" in str(Verdict(Kind.SINGULAR))
    assert "growing directions: all" in str(Verdict(Kind.ILL_POSED, 1, ((0.0, 360.0),), 0.0, 1.0))


@pytest.mark.parametrize(
    ("exponent", "law", "latex"),
    [
        (0, "3 1/s", r"3\ \mathrm{1/s}"),
        (1, "3 m/s |xi|", r"3\ \mathrm{m/s}\,|\boldsymbol{\xi}|"),
        (2, "3 m^2/s |xi|^2", r"3\ \mathrm{m^{2}/s}\,|\boldsymbol{\xi}|^{2}"),
        (-2, "3 m^-2/s |xi|^-2", r"3\ \mathrm{m^{-2}/s}\,|\boldsymbol{\xi}|^{-2}"),
        (Fraction(2, 3), "3 m^(2/3)/s |xi|^(2/3)", r"3\ \mathrm{m^{2/3}/s}\,|\boldsymbol{\xi}|^{2/3}"),
    ],
)
def test_a_coefficient_has_the_unit_that_makes_a_rate_of_the_law(exponent, law, latex):
    assert (spelled(3.0, exponent), spelled(3.0, exponent, latex=True)) == (law, latex)


def test_a_direction_is_named_only_where_there_is_a_worst_one():
    alike = Verdict(Kind.STABLE, 2, (), None, -1.0)
    assert "-1 m^2/s |xi|^2, alike in all directions." in str(alike) and r"\theta" not in alike.latex


@pytest.mark.parametrize(
    ("growth", "rate", "longest", "says"),
    [
        (3.0, 1.0, False, "; but at wavenumber 5 1/m and 30 deg waves grow at 3 1/s"),
        (0.4, 1.0, False, "waves grow at 0.4 1/s, no faster than the base flow deforms (||V|| = 1 1/s)"),
        (0.4, None, False, "; but at wavenumber 5 1/m and 30 deg waves grow at 0.4 1/s"),
        (0.7, 1.0, True, "; what grows are the longest waves, by the base flow's own kinematics (||V|| = 1 1/s)"),
        (
            80.0,
            1.0,
            True,
            "; growth rises towards long waves: 80 1/s at wavenumber 5 1/m and 30 deg, the longest tried",
        ),
    ],
)
def test_finite_waves_are_called_what_they_are(growth, rate, longest, says):
    found = Verdict(Kind.STABLE, 2, (), 0.0, -1.0, finite=(growth, 5.0, 30.0), strain_rate=rate, longest=longest)
    assert says in str(found)


def test_a_range_that_passes_0_is_wide():
    assert Verdict(Kind.ILL_POSED, 1, ((152.0, 208.0), (332.0, 28.0)), 0.0, 1.0).directions == (
        "152 to 208 deg, 332 to 28 deg"
    )


BESIDE = Beside(9.1, 1, Fraction(2), Fraction(1), 0.5)
SINGULAR = Verdict(Kind.SINGULAR, wedge=((9.1, 9.1),), vanishing=(1, 2), beside=BESIDE, cause=("the pressure",))


def test_a_singular_symbol_names_its_coefficient_and_what_is_beside():
    assert str(SINGULAR) == (
        "singular symbol: the constraints leave a mode undetermined along 9.1 deg alone: there the coefficient of "
        "lambda |xi|^2 in det(lambda E - L) vanishes, made of the pressure; at an angle theta beside 9.1 deg, towards "
        "larger angles, waves grow as 0.5 m^2/s |xi|^2 theta^-1 (theta in radians): at any one wavelength without "
        "bound."
    )
    assert r"\left[\lambda|\boldsymbol{\xi}|^{2}\right]\det(\lambda E - L) = 0" in SINGULAR.latex
    assert r"\sim 0.5\ \mathrm{m^{2}/s}\,|\boldsymbol{\xi}|^{2}\,|\theta-9.1^\circ|^{-1}" in SINGULAR.latex


@pytest.mark.parametrize(
    ("power", "coefficient", "says", "shown"),
    [
        (0, 0.5, "beside 9.1 deg waves grow as 0.5 m^2/s |xi|^2", r"|^{2},\quad \theta\to"),
        (1, -0.5, "beside these directions all waves decay", r"\lambda < 0\text{ beside}"),
        (0, 0.0, "beside these directions waves neither grow nor decay", r"\lambda = 0\text{ beside}"),
    ],
)
def test_waves_beside_a_singular_direction_may_be_harmless(power, coefficient, says, shown):
    one = Beside(9.1, 1, Fraction(2), Fraction(power), coefficient)
    assert str(one) == says and shown in one.latex


def test_a_further_law_of_the_source_is_named():
    found = replace(ILL, siblings=("low (branch of low I)",))
    assert str(found).endswith("certified. The same source has a further law, for other states: low (branch of low I).")


def test_latex_shows_the_law():
    assert r"\sim 3.5\cdot 10^{-7}\ \mathrm{m^{2}/s}\,|\boldsymbol{\xi}|^{2}" in ILL.latex
    assert ILL._repr_latex_() == f"${ILL.latex}$" and Verdict(Kind.SINGULAR).latex == r"\text{singular symbol}"


@pytest.mark.parametrize("found", [ILL, SINGULAR], ids=["law", "singular"])
def test_latex_is_understood_by_a_typesetter(found):
    MathTextParser("path").parse(f"${found.latex.replace('boldsymbol', 'mathbf')}$")
