"""What is measured on a march: waves, their place, length, direction and speed, and the jumps across them.

Pure functions of arrays and Datasets. A wave is what is left of a field after smoothing along r (`waves`); nothing
here depends on epsilon, so that no length of the theory enters what is compared with it.
"""

import numpy as np
from scipy.interpolate import CubicSpline, RegularGridInterpolator
from scipy.ndimage import gaussian_filter, gaussian_filter1d
from xarray import Dataset, concat

# Waves along r are 5 to 20 cm long, the smooth flow varies over the hopper's 1 m. Two passes of this width (m) leave
# 0.9 of a wave of 20 cm, 1.0 of 10 cm, and less than 0.3 % of the initial pressure.
SMOOTH = 0.07
MARGIN = 0.15  # m from the arcs: bands that the upper corners shed at the start, and what smoothing makes of the arcs
# Waves of the stress show where their amplitude reaches this part of its largest value: contours 5 % apart then sway to
# and fro by nearly half their distance.
SHOWING = 0.02
RADII = (0.7, 0.85, 1.0, 1.15)  # m from the apex: where the speed of waves is measured, over 20 cm each
WINDOWS = (0.8, 0.9, 1.0, 1.1)  # m from the apex, on the axis: above, the band that the corners shed is in the window
FIELDS = ("velocity_r", "velocity_theta", "pressure", "strain_rate_norm", "dilation", "viscosity")


def whole(ds: Dataset) -> Dataset:
    """Return the fields of a march over half the wedge on both sides of the axis."""
    above = ds[[name for name in FIELDS if name in ds]]
    below = above.isel(theta=slice(None, 0, -1)).assign_coords(theta=lambda half: -half.theta)
    return concat([below.assign(velocity_theta=-below.velocity_theta), above], "theta")


def waves(field: np.ndarray, r: np.ndarray, axis: int = -2, width: float = SMOOTH) -> np.ndarray:
    """Return a field (..., r, theta) less its smooth part: Gaussian smoothing along r, of the field and of the rest.

    Beyond the arcs the field is continued by its odd reflection, which keeps value and slope there.
    """
    field = np.moveaxis(np.asarray(field, dtype=float), axis, -1)
    sigma = width / (r[1] - r[0])
    reach = min(int(4 * sigma) + 1, len(r) - 1)
    for _ in range(2):
        continued = np.pad(field, [*[(0, 0)] * (field.ndim - 1), (reach, reach)], "reflect", reflect_type="odd")
        field = field - gaussian_filter1d(continued, sigma)[..., reach:-reach]
    return np.moveaxis(field, -1, axis)


def inside(r: np.ndarray) -> np.ndarray:
    """Return which radii are not next to an arc."""
    return (r >= r[0] + MARGIN) & (r <= r[-1] - MARGIN)


def envelope(wave: np.ndarray, r: np.ndarray, theta: np.ndarray, width: float = SMOOTH) -> np.ndarray:
    """Return the local amplitude of a wave (..., r, theta): sqrt 2 of its root mean square over a Gaussian patch."""
    return np.sqrt(2 * smoothed(wave**2, r, theta, width))


def amplitudes(ds: Dataset, name: str = "pressure") -> np.ndarray:
    """Return the root mean square (time,) of the waves of a field over the hopper, but for its ends."""
    r = ds.r.values
    return np.sqrt((waves(ds[name].values, r)[:, inside(r)] ** 2).mean(axis=(1, 2)))


def shown(ds: Dataset) -> np.ndarray:
    """Return the local amplitude (time, r, theta) of the waves of the stress, over its largest initial value."""
    r, theta = ds.r.values, ds.theta.values
    return envelope(waves(ds.pressure.values, r), r, theta) / ds.pressure.values[0].max()


def visible(ds: Dataset, share: float = SHOWING) -> int:
    """Return the first snapshot in which waves of the average stress show somewhere away from the arcs."""
    found = np.flatnonzero(shown(ds)[:, inside(ds.r.values)].max(axis=(1, 2)) >= share)
    if not len(found):
        raise ValueError(f"no wave of the pressure reaches {share:g} of its largest value in this run")
    return int(found[0])


def place(ds: Dataset, name: str) -> tuple[float, float]:
    """Return r (m) and theta (deg) where the waves of a field are largest in one snapshot."""
    r, theta = ds.r.values, ds.theta.values
    return largest(envelope(waves(ds[name].values, r), r, theta), r, theta)


def smoothed(field: np.ndarray, r: np.ndarray, theta: np.ndarray, width: float = SMOOTH) -> np.ndarray:
    """Return the Gaussian mean of a field (..., r, theta) over patches of a width (m)."""
    middle = (r[0] + r[-1]) / 2
    sigma = width / (r[1] - r[0]), width / (middle * np.radians(theta[1] - theta[0]))
    return gaussian_filter(field, (*[0] * (field.ndim - 2), *sigma), mode="reflect")


def viscous(ds: Dataset, r: float, theta: float) -> tuple[float, float, float]:
    """Return mu of the initial state at a place over its largest value, and r (m) and theta (deg) of the latter.

    The noise in the initial velocities is in mu too: a mean over patches takes it out.
    """
    radii, angles = ds.r.values, ds.theta.values
    mu = smoothed(ds.viscosity.values[0], radii, angles)
    at = largest(mu, radii, angles)
    return float(mu[abs(radii - r).argmin(), abs(angles - theta).argmin()] / mu.max()), *at


def largest(field: np.ndarray, r: np.ndarray, theta: np.ndarray) -> tuple[float, float]:
    """Return r (m) and theta (deg) of the largest value (r, theta), the ends of the hopper left out."""
    i, j = np.unravel_index(field[inside(r)].argmax(), field[inside(r)].shape)
    return float(r[inside(r)][i]), float(theta[j])


def spectrum(field: np.ndarray, r: np.ndarray, theta: np.ndarray, centre: float) -> tuple[float, float, float]:
    """Return wavelength (m), its relative spread, and direction (deg from e_r, 0 to 90) of the waves around the axis.

    The field (r, theta), given on both sides of the axis, is seen through a round window about the point (centre, 0)
    that touches the walls; a cubic polynomial is taken away; wavenumber and direction are the means over all waves
    with more than half the power of the strongest.
    """
    reach = 0.98 * min(centre * np.sin(np.radians(theta[-1])), r[-1] - centre, centre - r[0])
    points = 97
    x = np.linspace(-reach, reach, points)
    X, Y = np.meshgrid(x, x, indexing="ij")
    window = np.where(np.hypot(X, Y) < reach, np.cos(np.pi / 2 * np.minimum(np.hypot(X, Y) / reach, 1)) ** 2, 0)
    place = np.stack([np.hypot(X + centre, Y), np.degrees(np.arctan2(Y, X + centre))], axis=-1)
    # The corners of the square lie beyond the walls, where the window is zero.
    seen = RegularGridInterpolator((r, theta), field, method="cubic", bounds_error=False, fill_value=0.0)(place)
    smooth = np.stack([X**i * Y**j for i in range(4) for j in range(4 - i)], axis=-1) / reach
    fit = np.linalg.lstsq((smooth * window[..., None]).reshape(window.size, -1), (seen * window).ravel(), rcond=None)[0]
    size = 512
    power = abs(np.fft.fft2((seen - smooth @ fit) * window, (size, size))) ** 2
    k = 2 * np.pi * np.fft.fftfreq(size, x[1] - x[0])
    along, across = np.meshgrid(k, k, indexing="ij")
    strong = power > power.max() / 2
    weight, q = power[strong], np.hypot(along, across)[strong]
    mean = np.average(q, weights=weight)
    spread = np.sqrt(np.average((q - mean) ** 2, weights=weight)) / mean
    angle = np.degrees(np.arctan2(abs(across), abs(along)))[strong]
    return float(2 * np.pi / mean), float(spread), float(np.average(angle, weights=weight))


def drift(wave: np.ndarray, time: np.ndarray, r: np.ndarray) -> tuple[float, float]:
    """Return the speed (m/s, positive away from the apex) at which a wave (time, r) travels, and how well it does.

    The speed c is that of the least squares of wave_t + c wave_r; the second number is the part of wave_t that it
    explains, 1 for a wave that travels unchanged.
    """
    in_time = CubicSpline(time, wave, axis=0)(time, 1)
    along = CubicSpline(r, wave, axis=1)(r, 1)
    speed = -(in_time * along).sum() / (along**2).sum()
    return float(speed), float(1 - ((in_time + speed * along) ** 2).sum() / (in_time**2).sum())


def arrivals(ds: Dataset, at: tuple[float, ...] = (1.2, 1.0, 0.8), share: float = SHOWING) -> list[float]:
    """Return the times (s) at which waves of the average stress first show on the arcs at radii (m); inf if never.

    A wave shows on an arc where the mean of its amplitude over the arc reaches ``share``.
    """
    size, found = shown(ds).mean(axis=2), []
    for radius in at:
        showing = np.flatnonzero(size[:, abs(ds.r.values - radius).argmin()] >= share)
        found.append(float(ds.time[showing[0]]) if len(showing) else np.inf)
    return found


def growth(ds: Dataset, start: float, stop: float, name: str = "velocity_theta") -> float:
    """Return the rate (1/s) at which the root mean square of a field's waves grows between two times (s)."""
    size = amplitudes(ds, name)
    chosen = (ds.time.values >= start) & (ds.time.values <= stop) & (size > 0)
    return float(np.polyfit(ds.time.values[chosen], np.log(size[chosen]), 1)[0])


def likeness(ds: Dataset, name: str = "pressure") -> np.ndarray:
    """Return the correlation (time,) of the waves of each snapshot with those of the last."""
    r = ds.r.values
    wave = waves(ds[name].values, r)[:, inside(r)].reshape(ds.sizes["time"], -1)
    return wave @ wave[-1] / np.maximum(np.linalg.norm(wave, axis=1) * np.linalg.norm(wave[-1]), 1e-300)


def power_law(x: np.ndarray, y: np.ndarray) -> tuple[float, float, float]:
    """Return exponent, its standard error, and prefactor of y = prefactor x^exponent.

    Least squares of the logarithms; the error is from what the points do about the line.
    """
    slope, covariance = np.polyfit(np.log(x), np.log(y), 1, cov=True)
    return float(slope[0]), float(np.sqrt(covariance[0, 0])), float(np.exp(slope[1]))


def travel(ds: Dataset, after: float, at: tuple[float, ...] = RADII) -> np.ndarray:
    """Return how fast the waves of the average stress travel along r from a time on.

    Returns
    -------
    array (radii, 4) : speed of the waves (m/s), its standard error over rays that see different bands, the part of
        their change that travelling explains, and the mean velocity u_r of the material there (m/s)
    """
    late = ds.sel(time=slice(after, None))
    r, time = late.r.values, late.time.values
    wave, rays = waves(late.pressure.values, r), np.linspace(0.1, 0.9, 5) * (len(late.theta) - 1)
    found = []
    for centre in at:
        near = abs(r - centre) <= 0.1
        each = np.array([drift(wave[:, near, round(j)], time, r[near]) for j in rays])
        speed, explained = each.mean(axis=0)
        error = each[:, 0].std(ddof=1) / np.sqrt(len(each))
        found.append((speed, error, explained, float(late.velocity_r.values[:, near].mean())))
    return np.array(found)


def lengths(ds: Dataset, at: tuple[float, ...] = WINDOWS) -> np.ndarray:
    """Return `spectrum` (windows, 3) of the tangential velocity in one snapshot, around points of the axis."""
    fields = whole(ds)
    where = fields.r.values, fields.theta.values
    return np.array([spectrum(fields.velocity_theta.values, *where, centre) for centre in at])


def first_lengths(ds: Dataset, at: tuple[float, ...] = WINDOWS) -> np.ndarray:
    """Return what the waves of u_theta in the last snapshot are, around points of the axis.

    Returns
    -------
    array (windows, 4) : wavelength (m), its relative spread, direction (deg from e_r, which is a principal direction of
        the stress on the axis), and the viscosity mu (m2/s) of the initial state there
    """
    smooth = ds.viscosity.isel(time=0, theta=0)
    found = lengths(ds.isel(time=-1), at)
    # The noise in the initial velocities is in mu too: a mean over 10 cm takes it out.
    mu = [float(smooth.where(abs(smooth.r - centre) <= 0.05).mean()) for centre in at]
    return np.column_stack([found, mu])


def mean_length(waves: np.ndarray) -> tuple[float, float]:
    """Return the geometric mean of wavelengths (windows, ...), and its relative standard error over the windows."""
    each = np.log(np.asarray(waves)[:, 0])
    return float(np.exp(each.mean())), float(each.std(ddof=1) / np.sqrt(len(each)))
