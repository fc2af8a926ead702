"""What is measured on a march, on waves whose place, length, direction and speed are known."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from xarray import Dataset

from figures import bands, fronts

R, THETA, TIME = np.linspace(0.5, 1.5, 126), np.linspace(0, 15, 33), np.linspace(0, 0.1, 41)
SMOOTH = 16 * (R - 0.5) * (1.5 - R)  # m2/s2: zero on the arcs, 4 in the middle, as the stress in the hopper


def cartesian(r=R, theta=THETA):
    """Return x along the axis and y across it."""
    return r[:, None] * np.cos(np.radians(theta)), r[:, None] * np.sin(np.radians(theta))


def march(**fields) -> Dataset:
    """Return a Dataset like that of a march, its fields broadcast to (time, r, theta)."""
    shape = (len(TIME), len(R), len(THETA))
    found = {name: (("time", "r", "theta"), np.broadcast_to(f, shape).astype(float)) for name, f in fields.items()}
    return Dataset(found, {"time": TIME, "r": R, "theta": THETA})


def packet(centre: float, width: float = 0.1) -> np.ndarray:
    """Return a wave of 10 cm along r in an envelope (r, theta) about (centre, 0)."""
    x, y = cartesian()
    return np.cos(2 * np.pi * x / 0.1) * np.exp(-((x - centre) ** 2 + y**2) / (2 * width**2))


def test_smoothing_leaves_waves_and_takes_the_smooth_stress_away():
    wave = np.sin(2 * np.pi * (R - 0.5) / 0.1)  # zero on the arcs, as the stress
    found = fronts.waves((SMOOTH + wave)[:, None], R)[:, 0]
    middle = fronts.inside(R)
    assert_allclose(found[middle], wave[middle], atol=0.01 * 4)  # 1 % of the smooth part
    assert abs(fronts.waves(SMOOTH[:, None], R)[middle]).max() < 0.003 * 4


@pytest.mark.parametrize(("length", "left"), [(0.05, 1.0), (0.1, 1.0), (0.2, 0.82)])
def test_waves_up_to_20_cm_are_kept(length, left):
    """Exact: (1 - exp(-(k sigma)^2/2))^2 of the wave."""
    wave = np.sin(2 * np.pi * (R - 0.5) / length)
    found = fronts.waves(wave[:, None], R)[:, 0]
    kept = (1 - np.exp(-((2 * np.pi / length * fronts.SMOOTH) ** 2) / 2)) ** 2
    assert_allclose(found[fronts.inside(R)], kept * wave[fronts.inside(R)], atol=0.01)
    assert_allclose(kept, left, atol=0.01)


def test_the_whole_hopper_is_odd_in_the_tangential_velocity_and_even_in_the_rest():
    ds = fronts.whole(march(velocity_theta=THETA, pressure=1 + THETA).isel(time=0))
    assert ds.sizes["theta"] == 2 * len(THETA) - 1 and np.all(np.diff(ds.theta) > 0)
    assert_allclose(ds.velocity_theta.values[0], ds.theta.values, rtol=0, atol=0)
    assert_allclose(ds.pressure.values[0], 1 + abs(ds.theta.values), rtol=0, atol=0)


def test_waves_are_placed_where_they_are_and_show_when_they_reach_their_share():
    ds = march(pressure=SMOOTH[:, None] + packet(1.1) * (2 * TIME)[:, None, None])
    first = fronts.visible(ds)
    # An envelope as narrow as the patch of the mean halves the power: 0.02 of 4 is reached at 0.04 to 0.08 s.
    assert 0.04 <= TIME[first] <= 0.08
    r, theta = fronts.place(ds.isel(time=first), "pressure")
    assert theta == 0 and abs(r - 1.1) < 0.02
    with pytest.raises(ValueError, match=r"no wave of the pressure reaches 0\.5"):
        fronts.visible(ds, share=0.5)


@pytest.mark.parametrize("angle", [30.0, 45.0])
@pytest.mark.parametrize("length", [0.03, 0.05, 0.1])
def test_length_and_direction_of_a_plane_wave_are_found(length, angle):
    ds = fronts.whole(march(velocity_theta=0.0).isel(time=0))
    x, y = cartesian(theta=ds.theta.values)
    k = 2 * np.pi / length * np.array([np.cos(np.radians(angle)), np.sin(np.radians(angle))])
    field = np.sin(k[0] * x + k[1] * y) + 3 * x**2 - 2 * y  # on a smooth flow
    found, spread, direction = fronts.spectrum(field, R, ds.theta.values, 1.0)
    assert_allclose(found, length, rtol=0.01)  # of a window of 50 cm
    assert_allclose(direction, angle, atol=1)
    assert spread < length / 0.5


def test_the_speed_of_a_travelling_wave_is_found_and_that_of_its_decay_is_none():
    near = R[(R > 0.8) & (R < 1.0)]
    wave = np.cos(2 * np.pi / 0.1 * (near - (-1.4) * TIME[:, None]))
    speed, explained = fronts.drift(wave, TIME, near)
    assert_allclose([speed, explained], [-1.4, 1], rtol=0.01)  # splines, 12 points a wave
    still = np.cos(2 * np.pi / 0.1 * near) * np.exp(-TIME[:, None] / 0.05)
    speed, explained = fronts.drift(still, TIME, near)
    assert abs(speed) < 0.05 and explained < 0.01


def test_travel_finds_the_speed_of_waves_and_of_the_material():
    wave = np.cos(2 * np.pi / 0.1 * (R[:, None] + 1.5 * TIME[:, None, None]))
    found = fronts.travel(march(pressure=SMOOTH[:, None] + 0.2 * wave, velocity_r=-1 / R[:, None]), after=0.02)
    assert_allclose(found[:, 0], -1.5, rtol=0.02)
    assert np.all(found[:, 1] < 0.01) and np.all(found[:, 2] > 0.99)
    assert_allclose(found[:, 3], -1 / np.array([0.7, 0.85, 1.0, 1.15]), rtol=0.01)


def test_a_sine_is_a_third_of_its_period_thick_and_a_jump_one_cell():
    size, thick, period = bands.jumps(np.sin(2 * np.pi * R / 0.2), R)
    assert_allclose(period[2:-2], 0.2, rtol=0.05)  # but for the ends; turning points are 12 or 13 cells apart
    assert_allclose(thick[1:-1], 0.2 / np.pi, rtol=0.02)
    assert_allclose(size[1:-1], 2, rtol=0.01)
    _, thick, _ = bands.jumps(np.where(R < 1, 0.0, 1.0) - 0.1 * (R - 1), R)
    assert_allclose(thick[1], R[1] - R[0], rtol=0.01)


def test_a_saw_tooth_is_thin_for_its_period():
    tooth = np.interp((R - 0.5) % 0.2, [0, 0.18, 0.2], [0, 1, 0])
    _, thick, share, number = bands.thickness(march(velocity_theta=tooth[:, None]).isel(time=-1))
    assert share < 0.2 and number >= 3 * 31 and thick < 5  # 2 of 20 cm


@pytest.mark.parametrize("width", [0.02, 0.03])
def test_thickness_is_that_of_the_jumps(width):
    """The largest slope of tanh(x/width) is 1/width, between -1 and 1: it is 2 widths thick."""
    place = (R[:, None] + THETA / 100) % 0.3 - 0.15
    profile = np.tanh(place / width) - place / 0.15  # jumps in a saw tooth that falls slowly
    found, error, _, number = bands.thickness(march(velocity_theta=profile).isel(time=-1))
    top = profile.max() - profile.min()
    assert_allclose(found, top / (1 / width - 1 / 0.15), rtol=0.08)  # cells of 8 mm flatten the steepest slope
    assert error < 0.1 * found and number >= 32


def shear(angle: float, normal: float) -> Dataset:
    """Return bands with normals at +-angle (deg) from the axis whose velocity jumps along them, and by ``normal``."""
    x, y = cartesian()
    c, s = np.cos(np.radians(angle)), np.sin(np.radians(angle))
    step = 0.1 * np.sin(2 * np.pi * (c * x + s * y) / 0.08)
    u, v = step * (-s + normal * c), step * (c + normal * s)
    turn = np.radians(THETA)
    return march(velocity_r=u * np.cos(turn) + v * np.sin(turn), velocity_theta=v * np.cos(turn) - u * np.sin(turn))


@pytest.mark.parametrize("normal", [0.0, 0.2])
def test_the_normal_part_of_jumps_and_the_direction_of_bands_are_found(normal):
    part, angle = bands.across(shear(45, normal).isel(time=-1))
    assert_allclose(part, normal / np.hypot(1, normal), atol=0.02)  # central differences, 14 points a wave
    assert_allclose(angle, 45 - 7, atol=9)  # from e_r, which turns by up to 15 degrees over the hopper


def test_delta_in_troughs_and_crests_is_told_apart():
    wave = np.cos(2 * np.pi * R / 0.1)[:, None] + 0 * THETA
    ds = march(pressure=SMOOTH[:, None] + wave, dilation=-0.1 * wave, strain_rate_norm=4 - 3 * np.sign(wave))
    ds = ds.isel(time=-1)
    share, low, high, ratio = bands.troughs(ds)
    assert share == 1 and low > 0.07 and high < -0.07
    assert_allclose(ratio, 7, rtol=1e-12)
    assert bands.troughs(ds.assign(dilation=-ds.dilation))[0] == 0


def test_waves_arrive_later_further_down():
    size = np.clip(TIME[:, None] - (1.3 - R) / 8, 0, None)[:, :, None]
    wave = np.cos(2 * np.pi * R / 0.1)[:, None]
    found = fronts.arrivals(march(pressure=SMOOTH[:, None] + 20 * size * wave))
    assert found[0] < found[1] < found[2]
    assert fronts.arrivals(march(pressure=SMOOTH[:, None])) == [np.inf] * 3


def test_the_growth_rate_of_waves_is_found():
    wave = 1e-3 * np.exp(40 * TIME)[:, None, None] * np.cos(2 * np.pi * R / 0.1)[:, None]
    assert_allclose(fronts.growth(march(velocity_theta=wave), 0.02, 0.08), 40, rtol=1e-9)  # exact but for rounding


def test_likeness_is_1_with_itself_and_minus_1_half_a_wave_away():
    wave = np.cos(2 * np.pi / 0.1 * (R[:, None] + 1.0 * TIME[:, None, None]))
    found = fronts.likeness(march(pressure=SMOOTH[:, None] + wave))
    assert_allclose(found[[-1, 20, 0]], [1, -1, 1], atol=0.02)  # 0, 5 and 10 cm from the last


def test_a_power_law_is_found_with_the_error_that_its_scatter_says():
    x = np.array([2e-5, 4e-5, 1e-4, 2e-4])
    exponent, error, prefactor = fronts.power_law(x, 3 * x**0.5)
    assert_allclose([exponent, prefactor], [0.5, 3], rtol=1e-10)
    assert error < 1e-10
    scatter = np.array([0.1, -0.1, 0.1, -0.1])
    exponent, error, _ = fronts.power_law(x, 3 * x**0.5 * np.exp(scatter))
    along = np.log(x) - np.log(x).mean()
    slope = scatter @ along / (along @ along)
    left = scatter - scatter.mean() - slope * along
    assert_allclose([exponent, error], [0.5 + slope, np.sqrt(left @ left / 2 / (along @ along))], rtol=1e-9)


def test_first_waves_are_measured_with_the_viscosity_beneath_them():
    x, y = cartesian()
    k = 2 * np.pi / 0.06 / np.sqrt(2)
    ds = march(velocity_theta=np.sin(k * x) * np.sin(k * y), pressure=1.0, viscosity=R[:, None])
    found = fronts.first_lengths(ds)
    assert_allclose(found[:, 0], 0.06, rtol=0.02)
    assert_allclose(found[:, 2], 45, atol=1.5)
    assert_allclose(found[:, 3], fronts.WINDOWS, rtol=0.01)
