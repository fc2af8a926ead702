"""What is measured across the bands of a march: jumps and their thickness, what is normal to them, delta in troughs."""

import numpy as np
from xarray import Dataset

from figures.fronts import envelope, inside, waves


def jumps(profile: np.ndarray, r: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return size, thickness (m) and period (m) of the rises and falls of a profile (r,) between its turning points.

    The thickness is the size over the steepest slope; the period is the way from turning point to turning point with
    half of that on either side. A sine has a thickness of 1/pi = 0.32 periods, a jump that a mesh cannot resolve has
    one or two cells.
    """
    step = np.diff(profile)
    turn = np.concatenate([[0], np.flatnonzero(step[1:] * step[:-1] < 0) + 1, [len(profile) - 1]])
    size, apart = abs(np.diff(profile[turn])), np.diff(r[turn])
    steepest = np.array([abs(step[a:b]).max() for a, b in zip(turn[:-1], turn[1:], strict=True)])
    beside = np.pad(apart, 1, "reflect" if len(apart) > 1 else "edge")
    return size, size / np.maximum(steepest, 1e-300) * (r[1] - r[0]), apart + (beside[:-2] + beside[2:]) / 2


def thickness(ds: Dataset, share: float = 0.5) -> tuple[float, float, float, int]:
    """Return how thick (m, along r) the jumps of the tangential velocity are in one snapshot.

    Only rises and falls of at least ``share`` of the largest size and of the steepest slope count: the bands that have
    formed, not the slow return between them.

    Returns
    -------
    median thickness, its standard error over the jumps, median of thickness over period, number of jumps
    """
    r = ds.r.values
    found = [jumps(ray, r[inside(r)]) for ray in ds.velocity_theta.values[inside(r)].T[1:-1]]  # 0 on axis and wall
    size, thick, period = (np.concatenate(each) for each in zip(*found, strict=True))
    slope = size / thick
    strong = (size >= share * size.max()) & (slope >= share * slope.max())
    rays = max(1, len(found) // 8)  # neighbouring rays see the same band
    error = 1.2533 * thick[strong].std() / np.sqrt(max(1, strong.sum() / rays))  # of a median
    middle = np.median(thick[strong])
    return float(middle), float(error), float(np.median((thick / period)[strong])), int(strong.sum())


def gradients(ds: Dataset) -> np.ndarray:
    """Return the gradient (2, 2, r, theta) of the waves of the velocity in a snapshot, in the frame (e_r, e_theta)."""
    r, theta = ds.r.values, np.radians(ds.theta.values)
    u, v = (waves(ds[name].values, r) for name in ("velocity_r", "velocity_theta"))
    by_r = [np.gradient(f, r, axis=0) for f in (u, v)]
    by_theta = [np.gradient(f, theta, axis=1) / r[:, None] for f in (u, v)]
    return np.array([[by_r[0], by_theta[0] - v / r[:, None]], [by_r[1], by_theta[1] + u / r[:, None]]])


def across(ds: Dataset, share: float = 0.05) -> tuple[float, float]:
    """Return what of the jump of the velocity across bands is normal to them, and the direction of their normals.

    In a band the gradient of the velocity is a jump times the normal: of the gradient's singular vectors, the first
    on the right is the normal, the first on the left the jump. Taken are the ``share`` of the nodes with most shear.

    Returns
    -------
    median of |jump . normal| / |jump|, median of the angle of the normals from e_r (deg, 0 to 90)
    """
    r = ds.r.values
    g = np.moveaxis(gradients(ds), (0, 1), (-2, -1))[inside(r)]
    size = np.linalg.norm(g, axis=(-2, -1))
    g = g[size > np.quantile(size, 1 - share)]
    left, _, right = np.linalg.svd(g)
    normal, jump = right[:, 0], left[:, :, 0]
    angle = np.degrees(np.arctan2(abs(normal[:, 1]), abs(normal[:, 0])))
    return float(np.median(abs((normal * jump).sum(axis=1)))), float(np.median(angle))


def troughs(ds: Dataset) -> tuple[float, float, float, float]:
    """Return what is found in the troughs and on the crests of the waves of the average stress in one snapshot.

    Troughs and crests are the nodes where the wave is beyond its local root mean square (`envelope` over sqrt 2).

    Returns
    -------
    share of the troughs with delta > 0, mean delta in troughs and on crests, ratio of the mean ||V|| of the two
    """
    r, theta = ds.r.values, ds.theta.values
    wave = waves(ds.pressure.values, r)
    scaled = (wave / envelope(wave, r, theta))[inside(r)]
    delta, norm = ds.dilation.values[inside(r)], ds.strain_rate_norm.values[inside(r)]
    low, high = scaled < -(0.5**0.5), scaled > 0.5**0.5
    ratio = norm[low].mean() / norm[high].mean()
    return float((delta[low] > 0).mean()), float(delta[low].mean()), float(delta[high].mean()), float(ratio)
