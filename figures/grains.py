"""A random packing of discs, for schematics."""

import numpy as np
from scipy.spatial import cKDTree


def packing(width: float, height: float, seed: int = 1, steps: int = 300) -> tuple[np.ndarray, np.ndarray]:
    """Return centres and radii of grains that fill a block: random ones, pushed apart until hardly any overlap."""
    rng = np.random.default_rng(seed)
    count = round(1.06 * width * height)
    centre, radius = rng.uniform((0, 0), (width, height), (count, 2)), rng.uniform(0.44, 0.54, count)
    for _ in range(steps):
        centre = np.column_stack([centre[:, 0] % width, np.clip(centre[:, 1], radius, height - radius)])
        i, j = cKDTree(centre, boxsize=(width, 0)).query_pairs(2 * radius.max(), output_type="ndarray").T
        apart = centre[i] - centre[j]
        apart[:, 0] -= width * np.round(apart[:, 0] / width)  # the block is continued periodically along the band
        distance = np.hypot(*apart.T)
        push = (0.45 * np.maximum(0, (radius[i] + radius[j]) / distance - 1))[:, None] * apart
        np.add.at(centre, i, push)
        np.add.at(centre, j, -push)
    return centre - (width / 2, height / 2), radius
