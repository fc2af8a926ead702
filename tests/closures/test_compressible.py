"""Compressible rheologies: bulk friction (Heyman et al. 2017) and the I-dependent conditions (Barker et al. 2017)."""

import pytest
from mpmath import mp, mpf
from sympy import Rational, Symbol, diff, simplify

from stability.closures.base import Closure
from stability.closures.compressible_i import I_0, C, alpha_1, alpha_2, laws
from stability.closures.critical_state import CRITICAL_STATE, Y
from stability.closures.dilatant_flow import dilatant
from stability.closures.mu_i_phi_i import PARAMETERS, bulk_frictional
from stability.symbols import p
from tests.closures.benchmarks import BULK, CIDR, CRITICAL
from tests.closures.evaluate import Waves

IN_PLANE = Closure(name="in_plane", title="2-D deviator", source="test", **bulk_frictional(2), parameters=PARAMETERS)
MU = mpf("0.4") + mpf("0.2") / 4  # mu(I = 0.1) with I_0 = 0.3


@pytest.mark.parametrize(
    ("closure", "threshold"),
    [("mu_i_phi_i", 1 - 7 * MU / 6), (IN_PLANE, 1 - MU)],
    ids=["three-dimensional deviator", "two-dimensional deviator"],
)
def test_the_least_bulk_friction_is_the_published_one(closure, threshold):
    with mp.workdps(60):
        mu = mpf("0.4") + mpf("0.2") * mpf("0.1") / (mpf("0.1") + mpf("0.3"))
        exact = 1 - 7 * mu / 6 if closure == "mu_i_phi_i" else 1 - mu
        assert abs(exact - threshold) < 1e-14
        for factor, unstable in (("0.999999999999", True), ("1.000000000001", False)):
            waves = Waves(closure, "uniform_fraction", BULK | {"bulk_friction": exact * mpf(factor)})
            leading = [waves.growth(angle) for angle in ("0", "1e-3", "1", "5", "20", "45", "70", "90")]
            assert (max(leading) > mpf(10) ** -20) == unstable  # a bounded rate is 1e-40 q^2
            assert leading[0] == max(leading) or not unstable  # the extension axis turns first


I = Symbol("I", positive=True)  # positive too, so that logarithms simplify


def test_the_first_condition_of_the_inertial_rheology_holds_identically():
    yield_stress, dilation = laws(I)
    left = diff(yield_stress, p) - I / (2 * p) * diff(yield_stress, I)
    assert simplify(left - dilation - I * diff(dilation, I)) == 0


@pytest.mark.parametrize("inertial_number", [Rational(1, 1000), Rational(1, 10), 1, 100])
def test_the_other_two_conditions_hold_at_every_rate(inertial_number):
    yield_stress, dilation = laws(I)
    at = {alpha_1: Rational(2, 5), alpha_2: Rational(3, 5), I_0: Rational(3, 10), I: inertial_number, C: 1}
    assert diff(yield_stress, I).subs(at).subs(p, Rational(1, 10)) > 0
    third = diff(dilation, p) - I / (2 * p) * diff(dilation, I)
    assert third.subs(C, 1).subs(at).subs(p, Rational(1, 10)) < 0


def leading(waves: Waves) -> mpf:
    """Return the largest growth over q^2 on a grid of directions."""
    return max(waves.growth(angle) for angle in range(-2, 95, 4))


@pytest.mark.parametrize("given", [{}, {"strain_rate": "1e-6"}, {"strain_rate": "100"}, {"delta": "-0.4"}])
def test_the_inertial_rheology_is_well_posed_at_every_rate(given):
    assert leading(Waves("compressible_i", "uniform_fraction", CIDR | given)) < mpf(10) ** -20


@pytest.mark.parametrize("broken", [{"dynamic_strength": "0.1"}, {"critical_pressure": "-1"}], ids=["Y_I", "f_p"])
def test_without_the_second_or_the_third_condition_it_is_ill_posed(broken):
    assert leading(Waves("compressible_i", "uniform_fraction", CIDR | broken)) > mpf(10) ** -6


def test_without_the_first_condition_plasticity_is_ill_posed():
    # Y_p = f + I f_I is normality where nothing depends on I: dilation less than normal makes the leading matrix
    # lopsided.
    skewed = Closure(
        name="skewed",
        title="non-associated",
        source="test",
        **dilatant(Y, Y.diff(p) - Rational(1, 4)),
        parameters=CRITICAL_STATE.parameters,
    )
    assert leading(Waves(skewed, "uniform_fraction", CRITICAL)) > mpf(10) ** -6
    assert leading(Waves("critical_state", "uniform_fraction", CRITICAL)) < mpf(10) ** -18
