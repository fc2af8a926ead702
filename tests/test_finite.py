"""The search over all wavelengths, and the independent look at short waves."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from stability import finite
from stability.balls import enclosing
from stability.directions import Directions
from stability.model import Model
from stability.puiseux import Numbers
from tests import toys


def question(closure, **parameters):
    floats = Model(closure, toys.REST).base(parameters, {})
    balls = Model(closure, toys.REST, enclosing(256)).base(parameters, {})
    return floats, Directions(balls.model.evolves, balls.pencil(), Numbers(balls.model.arithmetic, 256))


def test_the_fastest_wave_of_a_parabola_is_found():
    base, d = question(toys.HYPERVISCOUS)  # q^2 - q^4/10
    (growth, wavenumber, _), longest = finite.largest(base, d, "full")
    assert_allclose((growth, wavenumber), (2.5, np.sqrt(5)), rtol=1e-7)
    assert not longest


def test_a_ridge_is_followed():
    base, d = question(toys.FLEETING, growth=3.0)  # 3 X - X^2, X = q^2 sin cos
    assert_allclose(finite.largest(base, d, "full")[0][0], 9 / 4, rtol=1e-12)


def test_growth_towards_long_waves_is_told_from_a_hump():
    # lambda = growth/2 +- ...: the longest waves of a damped wave with negative damping grow fastest
    base, d = question(toys.TELEGRAPH, growth=2.0)
    (growth, wavenumber, _), longest = finite.largest(base, d, "full")
    assert longest and wavenumber < 1
    assert_allclose(growth, 2, rtol=1e-3)


@pytest.mark.parametrize(
    ("growth", "where"),
    [
        ([0.7, 0.7, 0.5, -1], []),
        ([0.7, 0.7 + 1e-7, 0.5, -1], []),  # rounding on a plateau
        ([0.7, -0.1, 0.4, 0.2, -1], [2, 3]),
        ([-np.inf, -np.inf, 0.7, 0.5], []),  # beyond float64
        ([-2, -1, -0.5], []),
    ],
)
def test_a_hump_grows_faster_than_some_longer_wave(growth, where):
    assert np.flatnonzero(finite.humps(np.array(growth))).tolist() == where


def test_the_strain_rate_is_that_of_the_flow():
    given = {"friction_angle": 34, "delta": 0.3, "strain_rate": 2.5, "pressure": 1.0, "epsilon": 0.1}
    assert_allclose(finite.strain_rate(Model("perturbed", "uniform_strain").base(given, {})), 2.5, rtol=1e-14)
    assert finite.strain_rate(Model(toys.HALF, toys.REST).base({}, {})) is None


def test_scales_are_where_terms_balance():
    _, d = question(toys.HYPERVISCOUS)
    assert_allclose(finite.scales(d), np.sqrt(10), rtol=1)


@pytest.mark.parametrize(("allowed", "found"), [(2.25, False), (1.0, True), (0, True)])
def test_growth_beyond_the_law_is_reported(allowed, found):
    _, d = question(toys.FLEETING, growth=3.0)
    assert bool(finite.excess(d, 0, allowed)) is found


def test_no_growth_needs_no_law():
    _, d = question(toys.DIFFUSION, growth=1.0)
    assert finite.excess(d, 0, 0) == ""
    assert_allclose(float(finite.growth_at(d, 30.0, d.numbers.mp.mpf(5))), -25, rtol=1e-12)
