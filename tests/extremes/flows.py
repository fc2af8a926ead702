"""Random cases of each flow: what the families of `samples` are made of."""

from math import pi, sin, sqrt

import numpy as np

from tests.extremes.case import HOPPER, Case
from tests.states import random_jet

ROOT_2 = sqrt(2)
Rng = np.random.Generator


def power(rng: Rng, low: float, high: float) -> float:
    """Return a number with a uniform logarithm."""
    return float(10.0 ** rng.uniform(low, high))


def angles(rng: Rng) -> np.ndarray:
    return rng.uniform(0, 360, 5)


def wavenumbers(rng: Rng, low: float = -6, high: float = 12, count: int = 6) -> np.ndarray:
    return 10.0 ** rng.uniform(low, high, count)


def sign(rng: Rng) -> int:
    return int(rng.choice([-1, 1]))


def hopper(rng: Rng, family: str, more: dict | None = None, point: dict | None = None, waves: tuple = ()) -> Case:
    """Return a case on one of the hopper's flows; the rigid-plastic closure takes no epsilon."""
    kind = rng.integers(3)
    parameters = HOPPER | {"epsilon": power(rng, -8, -2)} | (more or {})
    if kind == 0:
        del parameters["epsilon"]
    closure = "rigid_plastic" if kind == 0 else "perturbed"
    flow = "radial_hopper_compatible" if kind == 2 else "radial_hopper"
    if point is None:
        point = {
            "r": float(rng.uniform(0.55, 1.45)),
            "theta": float(rng.uniform(-0.9, 0.9) * parameters["wedge_angle"]),
        }
    return Case(family, closure, flow, parameters, point, *(waves or (angles(rng), wavenumbers(rng))))


def uniform(
    rng: Rng, family: str, delta: float | None = None, mu: float | None = None, waves: tuple = (), **more: float
) -> Case:
    """Return a case of the uniform flow with viscosity mu; without dilation also of the rigid-plastic closure."""
    parameters = {"friction_angle": float(rng.uniform(1, 89)), "strain_rate": power(rng, -3, 3)} | more
    parameters["delta"] = float(rng.uniform(-1.4, 1.4)) if delta is None else delta
    k = ROOT_2 * sin(parameters["friction_angle"] * pi / 180)
    mu = power(rng, -4, 4) if mu is None else mu
    parameters.setdefault("pressure", mu * parameters["strain_rate"] / k)
    closure = "rigid_plastic" if parameters["delta"] == 0 and rng.integers(2) else "perturbed"
    if closure == "perturbed":
        parameters.setdefault("epsilon", power(rng, -8, 0))
    else:
        parameters.pop("epsilon", None)
    return Case(family, closure, "uniform_strain", parameters, {}, *(waves or (angles(rng), wavenumbers(rng))))


def jet(rng: Rng, family: str) -> Case:
    """Return a case about a random jet."""
    closure = ("rigid_plastic", "perturbed")[rng.integers(2)]
    parameters = random_jet(closure, rng) | {"friction_angle": float(rng.uniform(1, 89))}
    if closure == "perturbed":
        parameters["epsilon"] = power(rng, -12, 0)
    return Case(family, closure, "jet", parameters, {}, angles(rng), wavenumbers(rng))


def any_flow(rng: Rng, family: str) -> Case:
    """Return a case of any flow and closure."""
    kind = rng.integers(3)
    return (
        (hopper, jet, uniform)[kind](rng, family)
        if kind < 2
        else uniform(rng, family, delta=float(rng.choice([0, 0.3])))
    )


def with_waves(case: Case, wave_angle, wavenumber) -> Case:
    return Case(
        *(getattr(case, f) for f in ("family", "closure", "flow", "parameters", "point")), wave_angle, wavenumber
    )
