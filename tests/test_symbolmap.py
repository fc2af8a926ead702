"""Maps of the leading symbol against verdicts at single points."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

import stability as st
from stability.symbolmap import symbol_map
from tests import toys
from tests.conftest import HOPPER

POINTS = {"r": np.array([[0.7, 0.9], [1.1, 1.3]]), "theta": np.array([[0.0, 5.0], [-5.0, 10.0]])}


def test_the_map_agrees_with_the_verdict_at_each_point():
    found = symbol_map("rigid_plastic", "radial_hopper", HOPPER, POINTS, directions=360)
    for i in np.ndindex(2, 2):
        point = {w: float(v[i]) for w, v in POINTS.items()}
        verdict = st.well_posedness("rigid_plastic", "radial_hopper", HOPPER, point)
        assert found.exponent[i] == verdict.exponent
        assert_allclose(found.coefficient[i], verdict.coefficient, rtol=1e-3)  # a parabola over half degrees
    assert_allclose(found.share, 34 / 180, atol=4 / 360)  # four edges, each within one direction


def test_the_perturbed_system_has_no_hadamard_growth():
    found = symbol_map("perturbed", "radial_hopper", HOPPER | {"epsilon": 2e-5}, POINTS)
    assert np.all(found.exponent == 0) and np.all(found.coefficient <= 0) and np.all(found.share == 0)


@pytest.mark.parametrize(
    ("closure", "exponent", "coefficient"),
    [(toys.ELLIPTIC, 1, 1), (toys.HALF, 0.5, np.sqrt(0.5)), (toys.TWO_THIRDS, 2 / 3, 0.5)],
)
def test_other_exponents_are_seen_too(closure, exponent, coefficient):
    found = symbol_map(closure, toys.REST, {}, {})
    assert found.exponent.shape == ()
    assert_allclose((found.exponent, found.coefficient), (exponent, coefficient), rtol=1e-12)
