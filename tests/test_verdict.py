"""How a verdict reads."""

from fractions import Fraction

from stability.verdict import Kind, Verdict

ILL = Verdict(Kind.ILL_POSED, Fraction(2), ((28.0, 45.0),), 36.1, 3.5e-7, cause=("the friction",), certified=True)


def test_a_verdict_is_a_sentence():
    assert str(ILL) == (
        "ill-posed: short waves grow without bound, as 3.5e-07 |xi|^2, at 36.1 deg; growing directions: 28 to 45 deg; "
        "caused by the friction. Signs are certified."
    )


def test_growing_directions_without_width_say_so():
    bounded = Verdict(Kind.BOUNDED, 0, ((45.0, 45.0), (135.0, 135.0)), 45.0, 7.5, width=Fraction(1))
    assert "short waves grow as 7.5, at 45 deg" in str(bounded)
    assert "those that close in on 45, 135 deg as |xi|^-1" in str(bounded)
    assert str(bounded).endswith("Signs are not certified.")


def test_every_kind_has_a_text():
    assert "no wavelength was found to grow" in str(Verdict(Kind.STABLE, 2, (), 0.0, -1.0, finite=(-1.0, 1.0, 0.0)))
    assert str(Verdict(Kind.UNDECIDED, notes=("too hard",))) == "undecided: too hard."
    assert "undetermined along 90 deg alone" in str(Verdict(Kind.SINGULAR, wedge=((90.0, 90.0),)))
    assert "growing directions: all" in str(Verdict(Kind.ILL_POSED, 1, ((0.0, 360.0),), 0.0, 1.0))


def test_latex_shows_the_law():
    assert r"\sim 3.5\cdot 10^{-7}\,|\boldsymbol{\xi}|^{2}" in ILL._repr_latex_()
    assert ILL._repr_latex_().startswith("$") and r"\text{singular symbol}" in Verdict(Kind.SINGULAR)._repr_latex_()
