"""Special directions of symbols that are known, and what stands between them."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from stability.balls import enclosing
from stability.directions import Directions, crossing, discriminant
from stability.model import Model
from stability.puiseux import Numbers
from tests import toys

BITS = 256
ZERO2 = ((0, 0), (0, 0))


def directions(closure, flow, parameters):
    base = Model(closure, flow, enclosing(BITS)).base(parameters, {}).resting()[0]
    return Directions(base.model.evolves, base.pencil(), Numbers(base.model.arithmetic, BITS))


def of_pencil(second, evolves=(1, 1)):
    """Return the directions of a pencil with second-order terms only, L2[a][b] nested."""
    arithmetic = enclosing(BITS)
    n = arithmetic.number
    pencil = tuple(tuple(tuple(tuple(n(e) if e else 0 for e in r) for r in m) for m in row) for row in second)
    return Directions(evolves, (pencil, (ZERO2, ZERO2), ZERO2), Numbers(arithmetic, BITS))


def strained(delta, **more):
    return {"friction_angle": 34, "delta": delta, "strain_rate": 1.0, "pressure": 1.0} | more


def test_the_special_directions_of_coulomb_flow_are_its_characteristics():
    d = directions("rigid_plastic", "uniform_strain", strained(0.0))
    assert_allclose([s.angle for s in d.special], [28, 45, 135, 152], rtol=1e-15)
    assert all(s.root.multiplicity == 1 for s in d.special)
    assert_allclose(d.arcs(), [(28, 45), (45, 135), (135, 152), (152, 208)], rtol=1e-15)


def test_the_null_directions_of_m_are_double_roots():
    # Det M = 0 where s cos 2phi = -delta (P6), phi from y
    d = directions("perturbed", "uniform_strain", strained(0.3, epsilon=0.01))
    phi = np.rad2deg(np.arccos(-0.3 / np.sqrt(2 - 0.3**2))) / 2
    assert_allclose([s.angle for s in d.special], [90 - phi, 90 + phi], rtol=1e-13)
    assert [s.root.multiplicity for s in d.special] == [2, 2]


def test_a_hull_of_one_sign_has_no_special_direction():
    d = directions(toys.DIFFUSION, toys.REST, {"growth": 1.0})
    assert d.special == [] and d.arcs() == [(0.0, 180.0)]


def test_pairs_that_cross_the_axis_are_found_by_the_resultant():
    # gamma^2 - (x^2 - 4 y^2)... : lambda E = L with trace (x^2 - 4 y^2) q^2 and determinant 1 (x^2 + y^2)^2 q^4
    x2, y2 = ((-1, -2), (2, 0)), ((4, -2), (2, 0))  # L2_xx, L2_yy: trace -1 and 4, off-diagonal -2, 2
    d = of_pencil(((x2, ZERO2), (ZERO2, y2)))
    expected = np.rad2deg(np.arctan([0.5, -0.5])) % 180
    assert_allclose([s.angle for s in d.special], sorted(expected), rtol=1e-14)
    inside, outside = (d.laws(a)[0].sign for a in (0.0, 90.0))
    assert (inside, outside) == (1, -1)


def test_a_double_root_in_every_direction_is_noticed():
    same = ((1, 0), (0, 1))
    d = of_pencil(((same, ZERO2), (ZERO2, same)))
    assert not d.degenerate  # real and off the axis: nothing can cross it
    assert directions(toys.ELLIPTIC, toys.REST, {}).special[0].angle == pytest.approx(90, abs=1e-12)


def test_discriminant_and_crossing_of_small_polynomials():
    one = {(0, 0): 1}
    assert discriminant({0: {(0, 0): 3}, 1: {(0, 0): 2}, 2: one}) == {(0, 0): 8}  # -(b^2 - 4 a c) a
    assert crossing({0: one, 1: {(0, 0): 5}, 2: one}, odd=False) == {(0, 0): 5}
    assert crossing({0: one, 2: one}, odd=False) == {}
