"""The flows and the grids of waves that are timed."""

from dataclasses import dataclass

import numpy as np

HOPPER = {
    "friction_angle": 34, "wall_friction_angle": 9, "wedge_angle": 15,
    "outlet_radius": 0.5, "inlet_radius": 1.5, "gravity": 9.81,
}  # fmt: skip
PERTURBED = HOPPER | {"epsilon": 2e-5}
POINT = {"r": 1.0, "theta": 0.0}
# Degrees from e_r on the axis: the major principal stress is along e_theta, 45 degrees from it the velocity
# characteristics lie, where Det M vanishes.
CHARACTERISTIC = 45.0


@dataclass(frozen=True)
class Case:
    """A closure on the hopper, at a point or at many, and the waves of a map."""

    wavenumber: np.ndarray
    wave_angle: np.ndarray
    parameters: dict
    point: dict
    closure: str = "perturbed"
    flow: str = "radial_hopper"

    @property
    def question(self) -> tuple:
        """Everything but the waves, in the order of the package's functions."""
        return self.closure, self.flow, self.parameters, self.point

    @property
    def shape(self) -> tuple[int, ...]:
        """The shape of the map: (positions,) directions, wavenumbers."""
        places = np.broadcast_shapes(*(np.shape(v) for v in self.point.values()))
        return *places, self.wave_angle.size, self.wavenumber.size

    @property
    def size(self) -> int:
        """How many samples the map has."""
        return int(np.prod(self.shape))


def polar(samples: int, epsilon: float = 2e-5) -> Case:
    """Return a square map over all directions, from long waves to 100/sqrt(epsilon)."""
    n = round(samples**0.5)
    wavenumber = np.geomspace(0.1, 100 / epsilon**0.5, n)
    return Case(wavenumber, np.linspace(0, 360, n, endpoint=False), HOPPER | {"epsilon": epsilon}, POINT)


def zoom(samples: int, half_width: float) -> Case:
    """Return a map of the directions within ``half_width`` degrees of a characteristic, up to 1e10 /m."""
    n = round(samples**0.5)
    angle = CHARACTERISTIC + half_width * np.linspace(-1, 1, n)
    return Case(np.geomspace(1, 1e10, n), angle, PERTURBED, POINT)


def positions(count: int, directions: int = 32, waves: int = 32) -> Case:
    """Return small maps at many places of the hopper."""
    rng = np.random.default_rng(1)
    places = {"r": rng.uniform(0.6, 1.4, count), "theta": rng.uniform(-14, 14, count)}
    angle = np.linspace(0, 360, directions, endpoint=False)
    return Case(np.geomspace(0.1, 100 / 2e-5**0.5, waves), angle, PERTURBED, places)
