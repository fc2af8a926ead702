"""Arcs of directions on the whole circle."""

import pytest

from stability.wedges import both_ways, merged


def test_opposite_directions_come_in_order():
    assert both_ways([150.0, 0.0]) == [0.0, 150.0, 180.0, 330.0]


@pytest.mark.parametrize(
    ("arcs", "within", "found"),
    [
        ([(28.0, 45.0)], set(), ((28.0, 45.0), (208.0, 225.0))),
        ([(20.0, 30.0), (30.0, 50.0)], {30.0}, ((20.0, 50.0), (200.0, 230.0))),
        ([(20.0, 30.0), (30.0, 50.0)], set(), ((20.0, 30.0), (30.0, 50.0), (200.0, 210.0), (210.0, 230.0))),
        ([(152.0, 208.0)], set(), ((152.0, 208.0), (332.0, 28.0))),  # from 332 over 0 to 28
        ([(20.0, 60.0), (150.0, 200.0)], {20.0}, ((150.0, 240.0), (330.0, 60.0))),
        ([(90.0, 270.0)], set(), ((90.0, 270.0), (270.0, 90.0))),
        ([(0.0, 180.0)], set(), ((0.0, 360.0),)),
        ([(30.0, 210.0)], {30.0}, ((0.0, 360.0),)),
        ([(45.0, 45.0)], set(), ((45.0, 45.0), (225.0, 225.0))),
    ],
)
def test_ranges_join_where_the_direction_between_them_grows_too(arcs, within, found):
    assert merged(arcs, within) == found
