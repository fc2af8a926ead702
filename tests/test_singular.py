"""Waves beside a singular direction, in toys that are solved by hand."""

import pytest
from numpy.testing import assert_allclose

import stability as st
from stability import balls
from tests import toys
from tests.toys import GROWTH, REST, a, b, b_x, g, toy

# da/dt = b, growth a = -b_xx/2: lambda = 2 growth/(q cos)^2, beside y on either side 2 growth/(q theta)^2
STEEP = toy("steep", {a: (1, 0, 0, b), b: (0, -b_x / 2, 0, g * a)}, (GROWTH,))


@pytest.mark.parametrize("exact", [True, False], ids=["Arb", "intervals"])
def test_a_double_root_is_as_steep_on_both_sides(exact, monkeypatch):
    if not exact:
        monkeypatch.setattr(balls, "available", lambda: False)
    found = st.well_posedness(STEEP, REST, {"growth": 1.5}, {})
    assert found.kind == "singular symbol" and found.vanishing == (1, 2)
    assert (found.beside.exponent, found.beside.power) == (-2, 2)
    assert_allclose((found.beside.angle, found.beside.coefficient), (90, 3), rtol=1e-14)


def test_decay_beside_a_singular_direction_is_told():
    found = st.well_posedness(STEEP, REST, {"growth": -1.5}, {})
    assert found.beside.coefficient < 0 and "beside these directions all waves decay" in str(found)


def test_a_singular_direction_may_have_steady_neighbours():
    found = st.well_posedness(toys.FREE_ALONG_Y, REST, {}, {})
    assert found.beside.coefficient == 0 and "neither grow nor decay" in str(found)
