"""Every family of extremes: zero wrong signs, 1e-11 on the guaranteed path, and a truth that three routes agree on."""

import numpy as np
import pytest
from mpmath import mp
from numpy.testing import assert_allclose

from stability.arithmetic import NUMPY
from tests.extremes import truth
from tests.extremes.meanings import HEAD, MEANINGS
from tests.extremes.methods import RTOL, Measured, measure
from tests.extremes.samples import FAMILIES, cases
from tests.extremes.table import COUNT, PAGE, parsed, row

QUICK = 180  # waves of each family: 3240 in all
LAPACK_SLACK = 10  # another LAPACK, or another libm, rounds differently: errors move within their order of magnitude
SURE = ("guaranteed", "certified signs")


def hold(measured: Measured) -> None:
    """Every sample has a truth, a value and a sign; none is wrong."""
    assert np.all(measured.sign != 0)
    for method in SURE:
        for n in np.flatnonzero(measured.wrong(method) | measured.missing(method)):
            case, i, j = measured.place(n)
            pytest.fail(f"{method}: {measured.found[method][n]!r} but {measured.high[n]!r}: {case.about(i, j)}")
    assert np.max(measured.error("guaranteed")) <= RTOL  # all of them, not only 99 %


def truths_agree(family: str, of: int, by_digits: int, by_pencil: int) -> None:
    """Balls, mpmath on the same expressions and the unreduced pencil give one number, on random samples."""
    chosen = list(cases(family, of))
    rng = np.random.default_rng(5)
    for route, count in ((truth.by_digits, by_digits), (truth.by_pencil, by_pencil)):
        for n in rng.choice(len(chosen), count):
            case, i, j = chosen[n], *(int(rng.integers(size)) for size in chosen[n].shape)
            ball = truth.by_balls(case.wave(i, j))[0][0]
            with mp.workdps(100):
                exact, other = truth.as_mpf(ball), mp.mpf(truth.agreed(case, i, j, route))
                assert abs(other - exact) <= 4 * truth.ROUTE_RTOL * abs(exact), f"{route.__name__}: {case.about(i, j)}"


@pytest.mark.parametrize("family", FAMILIES)
def test_no_sign_is_wrong_and_no_guarantee_is_broken(family):
    hold(measure(list(cases(family, QUICK))))


@pytest.mark.parametrize("family", FAMILIES)
def test_the_truth_is_the_same_by_other_arithmetic_and_by_other_formulas(family):
    truths_agree(family, QUICK, 4, 2)


@pytest.mark.slow
@pytest.mark.parametrize("family", FAMILIES)
def test_the_truth_is_the_same_on_hundreds_of_every_family(family):
    truths_agree(family, COUNT, 300, 50)


@pytest.mark.slow
@pytest.mark.parametrize("family", FAMILIES)
def test_the_page_says_what_comes_out_over_a_hundred_thousand_samples(family):
    measured = measure(list(cases(family, COUNT)), compare=True)
    hold(measured)
    printed, found = parsed(PAGE.read_text(encoding="utf-8"))[family], row(measured)
    assert printed["samples"] == [found["samples"]]
    for method in measured.found:
        wrong, missing, *quantiles = printed[method]
        # Wrong signs are few and random: a different rounding moves their count by its own fluctuation.
        assert_allclose(found[f"{method} wrong"], wrong, rtol=0.1, atol=3 + 2 * wrong**0.5 if method not in SURE else 0)
        assert_allclose(found[f"{method} no value"], missing, rtol=0.1, atol=3 if method not in SURE else 0)
        for name, value in zip(("median", "99 %", "max"), quantiles, strict=method != "certified signs"):
            if name != "max" and np.isfinite(value):
                assert value / LAPACK_SLACK <= found[f"{method} {name}"] <= value * LAPACK_SLACK, (method, name)


def test_the_page_has_the_words_and_every_family():
    text = PAGE.read_text(encoding="utf-8")
    assert text.startswith(HEAD) and all(meaning in text for meaning in MEANINGS.values())
    assert list(MEANINGS) == list(FAMILIES) == list(parsed(text))
    assert sum(row["samples"][0] for row in parsed(text).values()) >= 1e5


def reach(family: str) -> dict[str, np.ndarray]:
    """Return what the samples of a family come to: parameters and letters, one entry per case."""
    found = [case.parameters | case.point | case.base(NUMPY).letters() for case in cases(family, COUNT)]
    return {word: np.array([f[word] for f in found if word in f], dtype=float) for word in set().union(*found)}


def test_the_samples_reach_the_extremes_they_are_named_after():
    q = np.concatenate([case.wavenumber for case in cases("wavenumber", COUNT)])
    assert q.min() < 2e-6 and q.max() > 5e11
    with np.errstate(all="ignore"):
        assert reach("epsilon")["epsilon"].min() < 2e-12 and reach("epsilon")["epsilon"].max() > 0.5
        assert reach("viscosity")["mu"].min() < 2e-8 and reach("viscosity")["mu"].max() > 3e7
        assert np.min(2**0.5 - abs(reach("delta_sqrt_2")["delta"])) < 3e-14
        assert np.min(abs(reach("delta_zero")["delta"])) < 3e-14
        edge = reach("delta_k")
        assert np.min(abs(edge["delta"] - edge["k"])) < 3e-14
        assert reach("friction")["friction_angle"].min() < 2e-6 and reach("friction")["friction_angle"].max() > 89.998
        assert reach("arcs")["r"].min() < 0.5 + 2e-15 and reach("arcs")["r"].max() > 1.5 - 2e-15
        assert reach("still")["N"].min() < 1e-29
