"""Fields whose jets are known: a uniform strain, a cubic one, and the paper's hopper flow on a polar grid."""

from functools import cache

import numpy as np

from stability.field.grids import Field, field_from
from stability.model import Model
from tests.conftest import HOPPER

STRAIN = (0.8, 0.3, 0.1, -0.6)  # u_x, u_y, v_x, v_y
PUSH = (1.0, -0.5)  # grad p


def strain(x, y, gradient=STRAIN):
    """Return u, v and p of a uniform velocity gradient under a uniform pressure gradient."""
    a, b, c, d = gradient
    return {"u": a * x + b * y, "v": c * x + d * y, "p": 2 + PUSH[0] * x + PUSH[1] * y}


def skewed(rows: int, columns: int) -> tuple[np.ndarray, np.ndarray]:
    """Return a smooth curvilinear grid on about [0, 1]^2."""
    j, i = np.meshgrid(np.linspace(0, 1, rows), np.linspace(0, 1, columns), indexing="ij")
    return i + 0.1 * i * np.sin(4 * j), j + 0.05 * i


def waves(x, y):
    """Return u, v and p that no stencil is exact for."""
    return {"u": np.sin(2 * x + y), "v": np.cos(x - 2 * y), "p": 3 + np.sin(x * y + x)}


def waves_jet(x, y):
    """Return the exact jets of `waves`: f, f_x, f_y, f_xx, f_xy, f_yy."""
    s, c = np.sin(2 * x + y), np.cos(2 * x + y)
    S, C = np.sin(x - 2 * y), np.cos(x - 2 * y)
    a, b = np.sin(x * y + x), np.cos(x * y + x)
    return {
        "u": (s, 2 * c, c, -4 * s, -2 * s, -s),
        "v": (C, -S, 2 * S, -C, 2 * C, -4 * C),
        "p": (3 + a, (y + 1) * b, x * b, -((y + 1) ** 2) * a, b - x * (y + 1) * a, -x * x * a),
    }


def flat(jet) -> list[np.ndarray]:
    """Return a nested jet as a list."""
    f, (f_x, f_y), ((f_xx, f_xy), (_, f_yy)) = jet
    return [f, f_x, f_y, f_xx, f_xy, f_yy]


@cache
def hopper(n: int, closure: str = "perturbed") -> tuple[Field, np.ndarray, np.ndarray]:
    """Return the paper's hopper flow at n x n points of a polar grid, with r and theta of each point."""
    r, theta = np.meshgrid(np.linspace(0.7, 1.2, n), np.linspace(-8, 8, n), indexing="ij")
    base = Model(closure, "radial_hopper").base(
        HOPPER | ({"epsilon": 2e-5} if closure == "perturbed" else {}), {"r": r.ravel(), "theta": theta.ravel()}
    )
    (along, across), p = base.state[0][0], base.state[1][0]
    angle = np.deg2rad(theta)
    c, s = np.cos(angle), np.sin(angle)
    along, across, p = (np.broadcast_to(a, r.size).reshape(r.shape) for a in (along, across, p))
    return field_from(r * c, r * s, u=along * c - across * s, v=along * s + across * c, p=p), r, theta
