"""Seeded generators, one family per extreme: `cases(family, count)` are the same numbers everywhere."""

from collections.abc import Callable, Iterator
from math import pi, sin

import numpy as np

from tests.extremes import places
from tests.extremes.case import Case
from tests.extremes.flows import (
    ROOT_2,
    Rng,
    angles,
    any_flow,
    hopper,
    jet,
    power,
    sign,
    uniform,
    wavenumbers,
    with_waves,
)

SEED = 20240


def near_direction(wanted: str) -> Callable[[Rng, str], Case]:
    """Return the generator of cases beside a special direction."""

    def near(rng: Rng, family: str) -> Case:
        while True:
            case = any_flow(rng, family)
            if found := places.directions(case.base(places.EXACT), wanted):
                exact = found[rng.integers(len(found))]
                return with_waves(case, places.beside(exact, rng, 5), wavenumbers(rng))

    return near


def near_wavenumber(make: Callable[[Rng, str], Case], find: Callable) -> Callable[[Rng, str], Case]:
    """Return the generator of cases beside a special wavenumber."""

    def near(rng: Rng, family: str) -> Case:
        while True:
            case = make(rng, family)
            angle = float(rng.uniform(0, 360))
            form = case.base(places.EXACT).form(places.EXACT.number(angle))
            if "discriminant" in form.coefficients or find is places.neutral_wavenumbers:
                if found := find(form):
                    exact = found[rng.integers(len(found))]
                    return with_waves(case, np.array([angle]), places.around(exact, rng, 30))

    return near


def still(rng: Rng, family: str) -> Case:
    return uniform(
        rng, family, float(rng.choice([0, 0.3])), strain_rate=power(rng, -30, -3), pressure=power(rng, -2, 2)
    )


def epsilon(rng: Rng, family: str) -> Case:
    more = {"epsilon": power(rng, -12, 0)}
    return hopper(rng, family, more) if rng.integers(2) else uniform(rng, family, float(rng.uniform(-1, 1)), **more)


def delta_k(rng: Rng, family: str) -> Case:
    angle = float(rng.uniform(1, 89))
    k = ROOT_2 * sin(angle * pi / 180)
    return uniform(rng, family, min(k + sign(rng) * power(rng, -14, -2), 1.41), friction_angle=angle)


def friction(rng: Rng, family: str) -> Case:
    angle = power(rng, -6, 1) if rng.integers(2) else 90 - power(rng, -3, 1)
    if rng.integers(2):
        return uniform(rng, family, float(rng.choice([0, 0.3])), friction_angle=angle)
    return hopper(rng, family, {"friction_angle": angle, "wall_friction_angle": angle * float(rng.uniform(0.1, 1))})


def arcs(rng: Rng, family: str) -> Case:
    gap = power(rng, -15, -1)
    r = 0.5 + gap if rng.integers(2) else 1.5 - gap
    return hopper(
        rng, family, point={"r": float(np.clip(r, 0.5 + 2e-16, 1.5 - 3e-16)), "theta": float(rng.uniform(-14, 14))}
    )


def geometry(rng: Rng, family: str) -> Case:
    outlet, wedge = power(rng, -6, 3), min(power(rng, 0, 2), 89.0)
    inlet = outlet * (1 + power(rng, -8, 3))  # p0 loses digits as (inlet/outlet)^w: see friction
    r = outlet + (inlet - outlet) * float(rng.uniform(0.05, 0.95))
    more = {"outlet_radius": outlet, "inlet_radius": inlet, "wedge_angle": wedge, "wall_friction_angle": 33.0}
    return hopper(rng, family, more, {"r": r, "theta": float(rng.uniform(-0.99, 0.99)) * wedge})


def w_to_one(rng: Rng, family: str) -> Case:
    """Return a hopper whose exponent w (after R8) is 1 to within 1e-1 to 1e-15; needs sin(friction) < 1/3."""
    inner = float(rng.uniform(3, 10))
    wall = inner * float(rng.uniform(0.1, 0.9))
    sine = sin(inner * pi / 180)
    psi = (wall * pi / 180 + np.arcsin(sin(wall * pi / 180) / sine)) / 2
    wedge = psi / ((1 - sine) / (2 * sine) - 1) * 180 / pi * (1 + sign(rng) * power(rng, -15, -1))
    return hopper(rng, family, {"friction_angle": inner, "wall_friction_angle": wall, "wedge_angle": float(wedge)})


def out_of_range(rng: Rng, family: str) -> Case:
    """Return waves, flows and viscosities whose powers leave float64 on the way to eigenvalues within it."""
    strain, mu = power(rng, -100, 100), power(rng, -60, 60)
    more = {"strain_rate": strain, "epsilon": power(rng, -50, 50)}
    return uniform(rng, family, float(rng.choice([0, 0.3])), mu, (angles(rng), wavenumbers(rng, -90, 90)), **more)


FAMILIES: dict[str, Callable[[Rng, str], Case]] = {
    "wavenumber": any_flow,
    "epsilon": epsilon,
    "viscosity": lambda rng, family: uniform(rng, family, float(rng.choice([0, 0.3, -0.3])), power(rng, -8, 8)),
    "delta_sqrt_2": lambda rng, family: uniform(
        rng, family, sign(rng) * min(ROOT_2 - power(rng, -14, -1), 1.414213562373095)
    ),
    "delta_zero": lambda rng, family: uniform(rng, family, sign(rng) * power(rng, -14, -1)),
    "delta_k": delta_k,
    "friction": friction,
    "det_m_zero": near_direction("null"),
    "velocity_characteristic": near_direction("velocity"),
    "stress_characteristic": near_direction("stress"),
    "arcs": arcs,
    "still": still,
    "geometry": geometry,
    "w_one": w_to_one,
    "nearly_double": near_wavenumber(uniform, places.double_wavenumbers),
    "neutral": near_wavenumber(any_flow, places.neutral_wavenumbers),
    "any_jet": jet,
    "out_of_range": out_of_range,
}


def cases(family: str, count: int) -> Iterator[Case]:
    """Yield seeded cases of a family until they hold ``count`` waves or more; the first are the same for any count."""
    rng = np.random.default_rng([SEED, list(FAMILIES).index(family)])
    done = 0
    while done < count:
        case = FAMILIES[family](rng, family)
        done += case.wave_angle.size * case.wavenumber.size
        yield case
