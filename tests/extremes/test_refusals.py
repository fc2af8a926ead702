"""What cannot be answered is refused with one clear error, and by every path alike."""

from math import asin, inf, nan, pi, sin, sqrt

import numpy as np
import pytest

import stability as st
from stability.certified import Certifier
from stability.errors import PrecisionError, SceneError
from tests.extremes.case import HOPPER

UNIFORM = {"friction_angle": 34.0, "epsilon": 2e-5, "delta": 0.3, "strain_rate": 1.0, "pressure": 1.0}
PATHS = {"float64": {}, "guaranteed": {"rtol": 1e-11}, "digits": {"digits": 20}}
every_path = pytest.mark.parametrize("path", PATHS.values(), ids=PATHS.keys())


def uniform(path, wavenumber=1.0, wave_angle=30.0, **change):
    return st.eigenvalues("perturbed", "uniform_strain", UNIFORM | change, {}, wavenumber, wave_angle, **path)


def hopper(path, point=None, wavenumber=1.0, **change):
    parameters = HOPPER | {"epsilon": 2e-5} | change
    at = {"r": 1.0, "theta": 0.0} | (point or {})
    return st.eigenvalues("perturbed", "radial_hopper", parameters, at, wavenumber, 30.0, **path)


@every_path
@pytest.mark.parametrize("wavenumber", [0.0, -0.0, -1.0, inf, -inf, nan])
def test_a_wavenumber_without_a_wave_is_refused(path, wavenumber):
    with pytest.raises(SceneError, match=r"wavenumber = .* lies outside \(0, inf\)") as refused:
        uniform(path, wavenumber)
    assert len(refused.value.problems) == 1


@every_path
@pytest.mark.parametrize("wave_angle", [inf, nan])
def test_an_angle_that_is_no_direction_is_refused(path, wave_angle):
    with pytest.raises(SceneError, match="wave_angle holds values that are not finite"):
        uniform(path, wave_angle=wave_angle)


@every_path
@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        ({"strain_rate": 0.0}, "strain_rate = 0.0 1/s lies outside"),
        ({"pressure": 0.0}, "pressure = 0.0 m2/s2 lies outside"),
        ({"pressure": -1.0}, "pressure = -1.0 m2/s2 lies outside"),
        ({"delta": sqrt(2)}, "delta = 1.4142135623730951 lies outside"),
        ({"delta": -sqrt(2)}, "delta = -1.4142135623730951 lies outside"),
        ({"delta": 1.5}, "delta = 1.5 lies outside"),
        ({"epsilon": 0.0}, "epsilon = 0.0 s lies outside"),
        ({"friction_angle": 90.0}, "friction_angle = 90.0 deg lies outside"),
        ({"friction_angle": nan}, "friction_angle = nan deg lies outside"),
    ],
)
def test_a_parameter_at_the_edge_of_its_range_is_refused(path, change, sentence):
    with pytest.raises(SceneError, match=sentence) as refused:
        uniform(path, **change)
    assert len(refused.value.problems) == 1


@every_path
@pytest.mark.parametrize("point", [{"r": 0.5}, {"r": 1.5}, {"r": 0.4}, {"r": 2.0}, {"theta": 15.01}, {"r": nan}])
def test_a_point_on_the_arcs_or_outside_the_hopper_is_refused(path, point):
    with pytest.raises(SceneError, match="lies outside") as refused:
        hopper(path, point)
    assert len(refused.value.problems) == 1


def test_the_singular_radial_solution_is_refused_where_float64_cannot_tell_it_and_answered_by_balls():
    sine = sin(5 * pi / 180)
    psi = (2 * pi / 180 + asin(sin(2 * pi / 180) / sine)) / 2
    wedge = psi / ((1 - sine) / (2 * sine) - 1) * 180 / pi  # w = 1 to the last bit of float64
    change = {"friction_angle": 5.0, "wall_friction_angle": 2.0, "wedge_angle": wedge}
    with np.errstate(all="ignore"), pytest.raises(SceneError, match="w = 1 makes the radial solution"):
        hopper(PATHS["float64"], **change)
    sure, exact = (hopper(PATHS[name], **change) for name in ("guaranteed", "digits"))  # w - 1 is some 1e-17 there
    assert abs(sure[0].real / float(exact[0].real) - 1) <= 1e-11


@pytest.mark.parametrize("wavenumber", [1e200, 1e300])
def test_eigenvalues_beyond_float64_are_refused_and_not_returned_as_infinity(wavenumber):
    with pytest.raises(PrecisionError, match="outside the range of float64"):
        hopper(PATHS["guaranteed"], wavenumber=wavenumber)
    found = hopper(PATHS["digits"], wavenumber=wavenumber)  # mpmath has no such range
    assert found[0].real < 0 and abs(found[0].real) > 1e300


@pytest.mark.parametrize(
    ("wavenumber", "change"), [(1e-200, {}), (1e150, {}), (1.0, {"strain_rate": 1e-170}), (1.0, {"strain_rate": 1e170})]
)
def test_what_leaves_the_range_on_the_way_is_answered_with_a_guarantee(wavenumber, change):
    found = uniform(PATHS["guaranteed"], wavenumber, **change)
    exact = uniform(PATHS["digits"], wavenumber, **change)
    assert np.all(np.isfinite(found))
    assert all(abs(f.real - float(e.real)) <= 1e-11 * abs(float(e.real)) for f, e in zip(found, exact, strict=True))


def test_a_certificate_is_for_one_point():
    many = {"r": np.array([0.7, 1.0]), "theta": np.array([0.0, 1.0])}
    with pytest.raises(SceneError, match="a certificate holds at one point"):
        Certifier("perturbed", "radial_hopper", HOPPER | {"epsilon": 2e-5}, many)


def test_an_equality_that_no_precision_tells_from_zero_is_a_precision_error():
    flow = UNIFORM | {"delta": 0.0}
    with pytest.raises(PrecisionError, match="cannot be told from zero"):
        st.eigenvalues("perturbed", "uniform_strain", flow, {}, 1.0, 45.0, matrix="leading", rtol=1e-6)  # Det M = 0
