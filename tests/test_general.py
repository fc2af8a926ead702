"""Closures without closed forms: the paper's own, by their pencils alone, and toys that are solved by hand."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

import stability as st
from stability import codegen, emit
from stability.closures import CLOSURES
from stability.errors import SceneError
from stability.general import by_growth, finite_eigenvalues
from stability.spectrum import pencil_eigenvalues
from tests import toys
from tests.conftest import HOPPER

POINT = {"r": 1.0, "theta": 3.0}
WAVENUMBER, ANGLE = np.geomspace(1, 1e5, 6), np.linspace(0, 350, 7)
QUESTIONS = {"rigid_plastic": HOPPER, "perturbed": HOPPER | {"epsilon": 2e-5}}


@pytest.fixture(params=QUESTIONS)
def both(request, monkeypatch):
    """Return a closure's name, the same closure by its pencil alone, and parameters."""
    name = request.param
    closure = replace(CLOSURES[name], name=f"{name}_by_pencil")
    codegen.load(CLOSURES, name)  # with its closed forms, before they are taken away
    monkeypatch.setattr(emit, "closed_forms", lambda closure: {})
    codegen.load(CLOSURES, closure)
    return name, closure, QUESTIONS[name]


def test_the_pencil_and_the_closed_form_agree(both):
    name, closure, parameters = both
    one, other = (
        st.eigenvalues(c, "radial_hopper", parameters, POINT, WAVENUMBER, ANGLE[:, None]) for c in (name, closure)
    )
    assert one.shape == other.shape
    # the pencil's error is that of a backward stable method: relative to the largest eigenvalue
    assert np.all(abs(one - other) <= 1e-13 * abs(one).max(axis=-1, keepdims=True))


def test_digits_agree_with_the_closed_form(both):
    name, closure, parameters = both
    one, other = (
        st.eigenvalues(c, "radial_hopper", parameters, POINT, 100.0, 30.0, digits=30) for c in (name, closure)
    )
    assert all(abs(a - b) <= abs(b) * 1e-29 for a, b in zip(one, other, strict=True))


def test_maps_and_reductions_work_at_many_points(both):
    name, closure, parameters = both
    points = {"r": np.array([0.8, 1.0]), "theta": np.array([0.0, 3.0])}
    one, other = (st.growth_map(c, "radial_hopper", parameters, points, WAVENUMBER, ANGLE) for c in (name, closure))
    assert_allclose(other.growth_rate, one.growth_rate, rtol=0, atol=1e-13 * float(abs(one.growth_rate).max()))
    largest = st.largest_growth(closure, "radial_hopper", parameters, points, WAVENUMBER, ANGLE)
    assert_allclose(largest.largest_growth_rate, other.growth_rate.max(("wave_angle", "wavenumber")), rtol=1e-13)


def test_what_needs_a_closed_form_says_what_works_instead(both):
    _, closure, parameters = both
    question = (closure, "radial_hopper", parameters, POINT)
    for ask in (
        lambda: st.neutral_curve(*question, ANGLE),
        lambda: st.eigenvalues(*question, WAVENUMBER, 0.0, rtol=1e-6),
    ):
        with pytest.raises(SceneError, match="no closed form of their eigenvalues: eigenvalues, growth_map"):
            ask()
    with pytest.raises(SceneError, match='use matrix = "full"'):
        st.eigenvalues(*question, 1.0, 0.0, matrix="leading")


def test_three_modes_come_by_decreasing_real_part():
    # lambda^3 = -q^2 cos^2
    q, angle = np.array([1.0, 8.0]), 60.0
    found = st.eigenvalues(toys.TWO_THIRDS, toys.REST, {}, {}, q, angle)
    expected = ((q / 2) ** (2 / 3))[:, None] * np.exp(1j * np.pi * np.array([1 / 3, -1 / 3, 1]))
    assert_allclose(found, expected, rtol=1e-13)
    precise = st.eigenvalues(toys.TWO_THIRDS, toys.REST, {}, {}, 8.0, angle, digits=25)
    assert abs(precise[2].real + 16 ** (1 / 3)) < 1e-15


def test_an_eliminated_unknown_makes_a_fourth_order_operator():
    q = np.array([0.5, 2.0])
    found = st.eigenvalues(toys.HYPERVISCOUS, toys.REST, {}, {}, q, 20.0)
    assert_allclose(found[:, 0], q**2 - q**4 / 10, rtol=1e-13)


def test_a_flow_without_a_field_that_the_closure_needs_is_refused():
    with pytest.raises(SceneError, match="elliptic needs the fields a, b, which uniform_strain does not provide"):
        st.eigenvalues(toys.ELLIPTIC, "uniform_strain", {}, {}, 1.0, 0.0)


def test_a_constraint_hidden_behind_another_goes_the_way_of_qz():
    # fields x, y, z, w: x' = y, y' = z, 0 = x - w, 0 = w: x vanishes, then y and z must; no mode is left but one
    E = np.diag([1.0, 1.0, 0.0])
    L = np.array([[0.0, 1.0, 0.0], [2.0, 0.0, 1.0], [1.0, 0.0, 0.0]], complex)  # z is the multiplier of x = 0
    assert finite_eigenvalues(L[None], (1, 1, 0), 0, 0).shape == (1, 0)
    assert pencil_eigenvalues(E, L, 0).size == 0


def test_equal_real_parts_are_ordered_by_imaginary_part():
    found = by_growth(np.array([[1 - 2j, 1 + 2j, 3 + 0j]]))
    assert found.tolist() == [[3 + 0j, 1 + 2j, 1 - 2j]]
