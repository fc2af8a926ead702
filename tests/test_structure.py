"""What holds for a closure at almost every state."""

import pytest

from stability.closures import CLOSURES
from stability.structure import frame_indifferent, galilean, modes
from tests import toys


@pytest.mark.parametrize(
    ("name", "expected"), [("rigid_plastic", (1, 0)), ("perturbed", (2, 1)), ("hyperstress", (1, 2))]
)
def test_modes_and_rank_of_the_constraints(name, expected):
    assert modes(CLOSURES[name]) == expected


def test_modes_of_closures_without_a_velocity():
    assert modes(toys.TWO_THIRDS) == (3, 0)
    assert modes(toys.HYPERVISCOUS) == (1, 1)
    assert modes(toys.FREE) == (1, 1)  # at almost every state


def test_a_closure_that_leaves_a_field_open_is_refused():
    open_field = toys.toy("open", {toys.a: (1, 0, 0, toys.a), toys.b: (0, 0, 0, 0)})
    with pytest.raises(ValueError, match="do not determine its fields"):
        modes(open_field)


@pytest.mark.parametrize("name", ["rigid_plastic", "perturbed", "mu_i"])
def test_isotropic_closures_are_frame_indifferent_and_galilean(name):
    assert frame_indifferent(CLOSURES[name]) and galilean(CLOSURES[name])


def test_a_closure_that_prefers_an_axis_is_found_out():
    assert not frame_indifferent(toys.ELLIPTIC)
