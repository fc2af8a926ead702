"""Properties that hold for any closure: rotation, conjugation, scaling, limits."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as some
from numpy.testing import assert_allclose

from stability.arithmetic import NUMPY
from stability.errors import SceneError
from stability.model import Base, Model, rotated
from tests.states import PAPER, base_of, random_jet

seeds = some.integers(0, 2**32 - 1)
angles = some.floats(-360, 360)
wavenumbers = some.floats(-2, 5).map(lambda e: 10.0**e)
names = some.sampled_from(PAPER)
quick = settings(max_examples=60, deadline=None, derandomize=True)


def leading(base: Base, angle: float, q: float) -> np.ndarray:
    found = np.array(base.form(angle).eigenvalues(q))
    return found[np.argsort(-found.real)]


def assert_same(found, expected, scale=1e-11):
    # the same eigenvalues by other roundings, against the largest of them
    assert_allclose(np.sort_complex(found), np.sort_complex(expected), rtol=0, atol=scale * np.abs(expected).max())


@quick
@given(seed=seeds, angle=angles, turn=angles, q=wavenumbers, name=names)
def test_turning_flow_and_wave_together_changes_nothing(seed, angle, turn, q, name):
    base = base_of(name, random_jet(name, np.random.default_rng(seed)), 0.6, 1e-3)
    c, s = np.cos(np.deg2rad(turn)), np.sin(np.deg2rad(turn))
    turned = Base(base.model, base.parameters, tuple(tuple(rotated(t, c, s) for t in f) for f in base.state), (), {})
    assert_same(np.array(turned.form(angle - turn).eigenvalues(q)), np.array(base.form(angle).eigenvalues(q)))


@quick
@given(seed=seeds, angle=angles, q=wavenumbers, name=names)
def test_the_opposite_wave_has_conjugate_eigenvalues(seed, angle, q, name):
    base = base_of(name, random_jet(name, np.random.default_rng(seed)), 0.6, 1e-3)
    assert_same(np.conj(base.form(angle + 180).eigenvalues(q)), np.array(base.form(angle).eigenvalues(q)))


@quick
@given(seed=seeds, angle=angles, q=wavenumbers, speed=some.floats(-100, 100), name=names)
def test_a_moving_observer_sees_only_a_doppler_shift(seed, angle, q, speed, name):
    jet = random_jet(name, np.random.default_rng(seed)) | {"u": 0.0, "v": 0.0}
    rest = np.array(base_of(name, jet, 0.6, 1e-3).form(angle).eigenvalues(q))
    moving = np.array(base_of(name, jet | {"u": speed}, 0.6, 1e-3).form(angle).eigenvalues(q))
    assert_same(moving + 1j * q * speed * np.cos(np.deg2rad(angle)), rest)


@quick
@given(delta=some.floats(-1.41, 1.41), angle=angles, exponent=some.floats(-3, 3), friction=some.floats(1, 89))
def test_m_and_the_truncation_have_the_closed_forms(delta, angle, exponent, friction):
    # (P5), (P6), (P8T) and half of (P8D), with phi from the major principal stress axis, which is y here
    parameters = {"friction_angle": friction, "epsilon": 0.5, "delta": delta, "strain_rate": 2.0, "pressure": 3.0}
    base = Model("perturbed", "uniform_strain").base(parameters, {})
    mu, k = base.letters()["mu"], np.sqrt(2) * np.sin(np.deg2rad(friction))
    q = 10.0**exponent
    Lambda, C = mu * q**2 / 2, np.sqrt(2 - delta**2) * np.cos(2 * np.deg2rad(90 - angle))
    trace_m, det_m = -Lambda * (2 + delta * C), Lambda**2 / 2 * (C + delta) ** 2
    trace = trace_m - (1 + k / 2 * (C - delta)) / 0.5
    det = det_m + Lambda / (2 * 0.5) * (C**2 + k * C + delta * (delta - k))
    for matrix, expected_trace, expected_det in (("leading", trace_m, det_m), ("truncated", trace, det)):
        one, other = base.form(angle, matrix).eigenvalues(q)
        size = abs(expected_trace) + 1 / 0.5
        assert_allclose(one + other, expected_trace, rtol=0, atol=1e-13 * size)
        assert_allclose(one * other, expected_det, rtol=0, atol=1e-13 * size**2)


def test_short_waves_of_rigid_plastic_flow_grow_as_l5(hopper):
    base = Model("rigid_plastic", "radial_hopper").base(hopper, {"r": 1.0, "theta": 0.0})
    letters = base.letters()
    angle = np.linspace(0, 360, 721)
    c = np.cos(2 * np.deg2rad(angle - 90))  # the major principal stress axis is e_theta on the axis
    sine = np.sin(np.deg2rad(34))
    limit = -letters["mu"] / 2 * c * (c + sine) / (1 + sine * c)  # (L5)
    for q, tolerance in ((1e3, 1e-2), (1e5, 1e-6)):  # the next order is O(1/q^2) relative in the real part
        growth = base.form(angle).eigenvalues(q)[0].real / q**2
        assert_allclose(growth, limit, rtol=0, atol=tolerance * letters["mu"])


def test_unstable_share_of_directions_is_friction_angle_over_180_degrees(hopper):
    base = Model("rigid_plastic", "radial_hopper").base(hopper, {"r": 1.0, "theta": 0.0})
    angle = np.linspace(0, 360, 14401)[:-1]
    share = np.mean(base.form(angle).eigenvalues(1e8)[0].real > 0)
    assert_allclose(share, 34 / 180, atol=8 / 14400)  # exact; eight edges, each within one grid direction


def test_epsilon_to_zero_tends_to_rigid_plastic_linearly(hopper):
    point = {"r": 1.0, "theta": 2.0}
    limit = Model("rigid_plastic", "radial_hopper").base(hopper, point).form(37.0).eigenvalues(30.0)[0]
    gaps = []
    for epsilon in (1e-8, 1e-9):
        base = Model("perturbed", "radial_hopper").base(hopper | {"epsilon": epsilon}, point)
        gaps.append(abs(base.form(37.0).eigenvalues(30.0)[1] - limit))
    assert_allclose(gaps[0] / gaps[1], 10, rtol=1e-3)  # the next order is epsilon smaller


def test_points_and_directions_come_in_arrays(perturbed_hopper):
    model = Model("perturbed", "radial_hopper")
    many = model.base(perturbed_hopper, {"r": np.array([0.7, 1.0, 1.3]), "theta": np.array([0.0, 5.0, -5.0])})
    found = many.form(np.array([10.0, 45.0, 100.0])).eigenvalues(50.0)
    for i, (r, theta, angle) in enumerate([(0.7, 0.0, 10.0), (1.0, 5.0, 45.0), (1.3, -5.0, 100.0)]):
        alone = model.base(perturbed_hopper, {"r": r, "theta": theta}).form(angle).eigenvalues(50.0)
        # some array functions of NumPy round differently from their scalar forms, in the last place
        assert_allclose([f[i] for f in found], alone, rtol=1e-13)


@pytest.mark.parametrize("rank", [0, 1, 2, 3])
def test_rotation_preserves_the_norm_of_a_tensor(rank):
    entries = np.random.default_rng(rank).normal(size=(2,) * rank)

    def nested(t):
        return tuple(map(nested, t)) if np.ndim(t) else float(t)

    turned = np.array(rotated(nested(entries), 0.6, 0.8))
    assert_allclose(np.linalg.norm(turned), np.linalg.norm(entries), rtol=1e-14)
    assert NUMPY.number("2") == 2.0


@pytest.mark.parametrize(
    ("flow", "more"),
    [("uniform_strain", {"delta": 0.3, "strain_rate": 1, "pressure": 1}), ("radial_hopper_compatible", None)],
)
def test_a_flow_that_breaks_an_exact_constraint_is_refused(perturbed_hopper, flow, more):
    parameters = {"friction_angle": 34} | more if more else perturbed_hopper
    point = {} if more else {"r": 1, "theta": 0}
    with pytest.raises(SceneError, match="rigid_plastic imposes its constraint exactly"):
        Model("rigid_plastic", flow).base(parameters, point)
