"""Certified signs: equal to the truth, ties undecided with their enclosure, and the same without python-flint."""

import numpy as np
import pytest

from stability import balls, certified
from stability.balls import LAST_BITS
from stability.bounded import Bounded
from stability.certified import Certain, Certifier, Tally, arithmetic_note, rounded
from tests.extremes import truth
from tests.extremes.samples import cases

UNIFORM = {"friction_angle": 34.0, "epsilon": 2e-5, "delta": 0.0, "strain_rate": 1.0, "pressure": 1.0}
FAMILIES = ("wavenumber", "det_m_zero", "neutral", "out_of_range")


def true_signs(case) -> np.ndarray:
    return truth.as_floats(truth.by_balls(case))[0].reshape(case.shape)


@pytest.mark.parametrize("family", FAMILIES)
def test_signs_equal_the_truth_and_every_sample_is_counted_once(family):
    for case in cases(family, 300):
        tally = Tally()
        assert np.array_equal(
            Certifier(*case.question).signs(case.wavenumber, case.wave_angle, tally), true_signs(case)
        )
        assert sum(tally.by.values()) == case.wave_angle.size * case.wavenumber.size
        assert not tally.undecided and "undecided" not in tally.by


@pytest.mark.parametrize("family", FAMILIES)
def test_intervals_of_mpmath_give_the_same_signs_and_say_so(family, monkeypatch):
    expected = [(case, true_signs(case)) for case in cases(family, 60)]
    for module in (balls, certified):
        monkeypatch.setattr(module, "available", lambda: False)
    assert arithmetic_note() == "mpmath intervals (python-flint is not installed: slower)"
    names = set()
    for case, signs in expected:
        tally = Tally()
        assert np.array_equal(Certifier(*case.question).signs(case.wavenumber, case.wave_angle, tally), signs)
        names |= set(tally.by)
    assert all(name == "float64" or name.startswith("mpmath intervals, ") for name in names)


@pytest.mark.parametrize("matrix", ["leading", "truncated"])
def test_an_exact_tie_is_undecided_with_its_enclosure(matrix):
    # a = d = 0 at 45 degrees without dilation: Det M = 0 and Det D' = 0, so both have an exact zero eigenvalue there
    tally = Tally()
    one = Certifier("perturbed", "uniform_strain", UNIFORM, {}, matrix)
    signs = one.signs(np.array([1.0, 1e3]), np.array([45.0, 10.0]), tally)
    assert signs[0].tolist() == [0, 0] and 0 not in signs[1]
    assert tally.by["undecided"] == 2 and tally.undecided == [(45.0, 1.0), (45.0, 1000.0)]
    for centre, radius in tally.enclosures:
        assert abs(centre) <= radius < 2.0 ** (-LAST_BITS // 4)  # zero is inside, and next to nothing else
    assert sum(tally.by.values()) == 4


def test_only_chosen_samples_go_beyond_float64():
    case = next(iter(cases("neutral", 30)))
    tally = Tally()
    chosen = np.zeros(case.shape, bool)
    chosen[0, :7] = True
    signs = Certifier(*case.question).signs(case.wavenumber, case.wave_angle, tally, chosen)
    assert sum(tally.by.values()) == 7
    assert np.array_equal(signs[chosen], true_signs(case)[chosen])


def test_turning_by_whole_turns_changes_no_sign():
    one = Certifier("perturbed", "uniform_strain", UNIFORM, {})
    q, angle = np.geomspace(1e-3, 1e8, 23), np.array([10.0, 44.0, 50.0, 1e20])
    assert np.array_equal(one.signs(q, angle, Tally()), one.signs(q, np.fmod(angle + 0.0, 360), Tally()))


def test_a_rounded_ball_is_bounded_about_the_float():
    a = balls.enclosing(128)
    found = rounded((a.number(0.1), 2), a)
    assert isinstance(found[0], Bounded) and found[1] == 2
    assert 0 < found[0].error < 1e-17  # 0.1 is not a float


@pytest.mark.parametrize(
    ("coefficients", "wavenumber", "sign"),
    [
        ({0: 1.0, 2: -1.0}, 0.5, 1),
        ({0: 1.0, 2: -1.0}, 2.0, -1),
        ({0: 1.0, 2: -1.0}, 1.0, 0),  # a root exactly on the sample
        ({0: 1e-300, 2: -1e300}, 1e-170, 0),  # the second term, 1e-40, underflows to zero on the way
        ({0: 1.5e308, 2: -1.7e308, 4: 1.5e308, 6: -1.4e308}, 1.0, 0),  # the sum overflows on the way to -1e307
        ({0: 0.0}, 1.0, 0),
    ],
)
def test_a_polynomial_s_sign_is_certain_or_zero(coefficients, wavenumber, sign):
    bounded = {n: Bounded(np.array([c])) for n, c in coefficients.items()}
    with np.errstate(all="ignore"):
        polynomial = Certain.of(bounded, 1)
        assert polynomial.signs(slice(None), polynomial.powers(np.array([wavenumber]))).tolist() == [[sign]]
