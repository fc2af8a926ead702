"""Neutral curves: against a fine contour, against 50 digits, and the numbers that the paper's figures rest on."""

import numpy as np
import pytest
from contourpy import contour_generator
from mpmath import mpf
from numpy.testing import assert_allclose
from scipy.spatial import cKDTree

import stability as st
from stability import spectrum
from stability.arithmetic import multiprecision
from stability.errors import SceneError
from stability.model import Model

POINT = {"r": 1.0, "theta": 0.0}
CASES = [("perturbed", "full"), ("rigid_plastic", "full"), ("perturbed", "truncated")]


def curve(closure, hopper, angle, matrix="full", **more):
    parameters = hopper | ({"epsilon": 2e-5} if closure == "perturbed" else {})
    return st.neutral_curve(closure, "radial_hopper", parameters, POINT, angle, matrix, **more)


@pytest.mark.parametrize(("closure", "matrix"), CASES[:2])
def test_the_curve_agrees_with_a_contour_of_2000_x_2000_samples(hopper, closure, matrix):
    q, angle = np.geomspace(0.2, 4e4, 2000), np.linspace(0.0, 90.0, 2000)
    parameters = hopper | ({"epsilon": 2e-5} if closure == "perturbed" else {})
    growth = st.growth_map(closure, "radial_hopper", parameters, POINT, q, angle).growth_rate.values
    cell = np.log(q[1] / q[0]), angle[1]
    # arcsinh tames the growth's range; it keeps zero where it is
    contour = np.concatenate(contour_generator(np.log(q), angle, np.arcsinh(growth)).lines(0.0)) / cell
    ds = curve(closure, hopper, np.linspace(0, 90, 3601), wavenumber_range=(q[0], q[-1]), resolve=0.5 * cell[0])
    level = np.log(ds.neutral_wavenumber.values) / cell[0]
    exact = np.column_stack([level.ravel(), np.repeat(ds.wave_angle.values, level.shape[1]) / cell[1]])
    gap, _ = cKDTree(exact[np.isfinite(exact[:, 0])]).query(contour)
    # in cells, with exact points at most 0.6 of a cell apart: linear interpolation errs by a cell at the sharp tips
    # at most
    assert np.median(gap) < 0.3 and gap.max() < 2
    # and the other way: every crossing of every 40th row has a sign change of the map beside it
    rows = np.arange(0, 2000, 40)
    ds = curve(closure, hopper, angle[rows], wavenumber_range=(q[0], q[-1]))
    for row, crossings in zip(rows, ds.neutral_wavenumber.values, strict=True):
        change = np.flatnonzero(np.diff(growth[row] > 0))
        expected = crossings[np.isfinite(crossings)]
        assert len(change) == len(expected)
        assert all(q[i] <= c <= q[i + 1] for i, c in zip(change, expected, strict=True))


@pytest.mark.parametrize(("closure", "matrix"), CASES)
def test_roots_agree_with_50_digits_to_the_conditioning_of_the_polynomial(hopper, closure, matrix):
    exact = multiprecision(60)
    angle = np.array([3.0, 29.0, 33.3, 40.0, 44.5, 46.0, 61.0, 91.0])
    ds = curve(closure, hopper, angle, matrix)
    parameters = hopper | ({"epsilon": 2e-5} if closure == "perturbed" else {})
    base = Model(closure, "radial_hopper", exact).base(parameters, POINT)
    checked = 0
    for a, row in zip(angle, ds.neutral_wavenumber.values, strict=True):
        form = base.form(exact.number(a), matrix).coefficients
        for root in row[np.isfinite(row)]:
            low, high = (exact.number(root) * (1 + sign * mpf("1e-9")) for sign in (-1, 1))
            below, above = (spectrum.margin(form, q, exact) for q in (low, high))
            assert below * above < 0  # the sign changes within 1e-9 of it: no root is spurious, none misplaced
            slope = abs(above - below) / mpf("2e-9")
            # the float64 coefficients carry some 50 roundings against the sum of moduli that the margin is relative to
            assert abs(spectrum.margin(form, exact.number(root), exact)) < 50 * 2.0**-52 * (1 + slope)
            checked += 1
    assert checked >= 4


def test_the_perturbed_curve_closes_at_the_known_wavenumber(hopper):
    ds = curve("perturbed", hopper, np.linspace(0, 90, 181), resolve=0.02)
    # computed with 160 digits elsewhere: 7.09e3 /m for the trace-free A of the appendix flow
    assert_allclose(ds.neutral_wavenumber.max(), 7.095e3, rtol=1e-3)
    assert not ds.unstable_shortest.any()


def test_the_compatible_flow_closes_earlier(perturbed_hopper):
    angle = np.linspace(30, 60, 61)
    ds = st.neutral_curve("perturbed", "radial_hopper_compatible", perturbed_hopper, POINT, angle, resolve=0.02)
    assert_allclose(ds.neutral_wavenumber.max(), 4.2e3, rtol=1e-2)  # computed elsewhere, two digits


def test_rigid_plastic_wedges_have_the_exact_edges(hopper):
    # On the axis the major stress axis is e_theta: 45 < phi < 45 + varphi/2 becomes 28 < wave angle < 45 degrees.
    angle = np.linspace(0, 90, 9001)
    unstable = curve("rigid_plastic", hopper, angle, "leading").unstable_shortest.values.astype(bool)
    assert_allclose([angle[unstable].min(), angle[unstable].max()], [28, 45], atol=0.0101)
    assert_allclose(unstable.mean(), 17 / 90, atol=2 / 9000)


def test_resolving_inserts_directions_until_neighbours_are_close(hopper):
    rough, fine = (curve("perturbed", hopper, np.linspace(40, 50, 21), resolve=r) for r in (None, 0.05))
    assert fine.sizes["wave_angle"] > rough.sizes["wave_angle"] == 21
    count = fine.neutral_wavenumber.notnull().sum("crossing").values
    level = np.log(fine.neutral_wavenumber.values)
    same = count[1:] == count[:-1]
    assert np.nanmax(np.abs(np.diff(level, axis=0))[same]) <= 0.05


def test_the_truncation_has_the_closed_form(hopper):
    # Det D' = 0: q^2 = (k a - a^2 - d^2)/(mu epsilon d^2) in the wave's frame
    angle = np.linspace(20.0, 44.0, 49)
    ds = curve("perturbed", hopper, angle, "truncated")
    A = np.sqrt(0.5)  # A = diag(1, -1)/sqrt 2 on the axis
    a, d = A * np.cos(2 * np.deg2rad(angle)), -A * np.cos(2 * np.deg2rad(angle))
    square = (np.sqrt(2) * np.sin(np.deg2rad(34)) * a - a**2 - d**2) / (float(ds.viscosity) * 2e-5 * d**2)
    expected = np.where(square > 0, np.sqrt(np.maximum(square, 0)), np.nan)
    found = ds.neutral_wavenumber.values[:, 0]
    clear = np.abs(square) > 1e-3 * np.nanmax(np.abs(square))  # at 28 degrees the numerator vanishes: all digits cancel
    assert_allclose(found[clear], expected[clear], rtol=1e-10)


def test_a_range_that_makes_no_sense_is_refused(hopper):
    with pytest.raises(SceneError, match="wavenumber = 0"):
        curve("rigid_plastic", hopper, [1.0], wavenumber_range=(0.0, 1.0))
