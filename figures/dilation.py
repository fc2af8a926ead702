"""Short waves over the rate of dilation, of critical-state plasticity and of the perturbed system.

With sin(psi) = tr V/(V_1 - V_2), psi the dilation angle, delta = sqrt(2) sin(psi)/sqrt(1 + sin^2 psi) in both. Both
leading matrices vanish in the directions 45 - psi/2 degrees from the axis of extension.
"""

from dataclasses import dataclass

import numpy as np
from scipy.optimize import brentq

import stability as st
from tests.closures.benchmarks import BENCHMARKS

COARSE, NEAR = np.linspace(0, 90, 46), np.linspace(-4, 4, 49)  # degrees: of all directions, and about one
LIMIT = 1e6  # 1/m: bounded growth has come to its limit to six digits
BENCHMARK = {(b.closure, b.exponent): {w: float(v) for w, v in b.parameters.items()} for b in BENCHMARKS}


def sine(delta: np.ndarray) -> np.ndarray:
    """Return sin(psi), the closure's f."""
    return delta / np.sqrt(2 - delta**2)


def delta(sine_of_dilation: np.ndarray) -> np.ndarray:
    """Return the rate of dilation tr V/||V||."""
    return sine_of_dilation * np.sqrt(2 / (1 + sine_of_dilation**2))


def null(delta: np.ndarray) -> np.ndarray:
    """Return the direction (degrees from the axis of extension) in which the leading matrix vanishes."""
    return np.degrees(np.arccos(sine(delta))) / 2


@dataclass(frozen=True)
class System:
    """One of the two systems: its name and scale, and what is asked of it."""

    closure: str
    flow: str
    exponent: int
    matrix: str

    @property
    def constants(self) -> dict:
        """The benchmark's parameters."""
        return BENCHMARK[self.closure, self.exponent]

    def state(self, delta: float) -> dict:
        """Return the parameters at a rate of dilation; pressure follows from it at the critical state's volume."""
        if self.closure != "critical_state":
            return self.constants | {"delta": delta}
        C, s = self.constants["critical_pressure"], self.constants["critical_friction"]
        return self.constants | {"delta": delta, "pressure": C * (1 - sine(delta) / (2 * s))}  # f = 2 s (1 - p/C)

    def verdict(self, delta: float) -> st.Verdict:
        """Return the verdict at a rate of dilation."""
        return st.well_posedness(self.closure, self.flow, self.state(delta), {}, self.matrix)

    def fastest(self, delta: float, wavenumber: float) -> tuple[float, float]:
        """Return growth (1/s) and direction (degrees) of the fastest wave of a wavenumber, by search."""
        angles = np.concatenate([COARSE, null(delta) + NEAR])
        for _ in range(2):
            angles = np.unique(np.clip(angles, 0, 90))
            growth = st.eigenvalues(
                self.closure, self.flow, self.state(delta), {}, wavenumber, angles, matrix=self.matrix
            )[..., 0].real
            where = angles[growth.argmax()]
            angles = where + NEAR / 8
        return growth.max(), where


CRITICAL = System("critical_state", "uniform_fraction", 1, "full")
PERTURBED = System("perturbed", "uniform_strain", 0, "truncated")


def critical_limit(delta: np.ndarray) -> np.ndarray:
    """Return Re lambda/|xi| of the shortest waves where the medium dilates, 0 where it compacts.

    The published sqrt(phi Y_phi f/rho); Y of the closure is over the density of the grains, which leaves Y_phi f.
    """
    c, f = CRITICAL.constants, sine(delta)
    p = c["critical_pressure"] * (1 - f / (2 * c["critical_friction"]))
    slope = c["critical_friction"] * c["hardening"] * p**2 / c["critical_pressure"]  # Y_phi at phi = phi_c
    return np.sqrt(np.maximum(slope * f, 0))


def perturbed_limit(delta: np.ndarray) -> np.ndarray:
    """Return epsilon Re lambda of the shortest waves in the direction in which the leading matrix vanishes."""
    return delta * (k() - delta) / (2 - delta**2)


def k() -> float:
    """Return sqrt(2) sin(friction angle)."""
    return np.sqrt(2) * np.sin(np.radians(PERTURBED.constants["friction_angle"]))


def scaled(wavenumber_scale: float) -> float:
    """Return the wavenumber (1/m) at which Lambda epsilon = mu |xi|^2 epsilon/2 has a value."""
    c = PERTURBED.constants
    viscosity = k() * c["pressure"] / c["strain_rate"]
    return np.sqrt(2 * wavenumber_scale / (viscosity * c["epsilon"]))


def slowest_compaction() -> float:
    """Return the rate of dilation, negative, up to which every short wave of the critical state decays."""
    return brentq(lambda d: CRITICAL.fastest(d, LIMIT)[0], -0.12, -0.05, xtol=1e-9)
