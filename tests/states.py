"""Random base states: any smooth jet is one, so closures are tested far from every registered flow."""

import numpy as np
from mpmath import mpf

from stability.arithmetic import NUMPY, multiprecision
from stability.model import Base, Model

PAPER = ("perturbed", "rigid_plastic")  # the paper's closures, whose fields a random jet has
COMPONENTS = ("u", "v", "p")
SUFFIXES = ("", "_x", "_y", "_xx", "_xy", "_yy")


def nested(jet: dict) -> tuple:
    """Return a flat jet ``{u: , u_x: , ...}`` as the nested state of a closure with fields ((u, v), p)."""

    def of(c: str) -> tuple:
        g = (jet[f"{c}_x"], jet[f"{c}_y"])
        return jet[c], g, ((jet[f"{c}_xx"], jet[f"{c}_xy"]), (jet[f"{c}_xy"], jet[f"{c}_yy"]))

    return tuple(zip(of("u"), of("v"), strict=True)), of("p")


def random_jet(closure: str, rng: np.random.Generator) -> dict[str, float]:
    """Return a random jet with p > 0; for the constrained closure, one with div u = 0 to second order."""
    jet = {c + s: float(rng.normal() * 10 ** rng.uniform(-1, 1)) for c in COMPONENTS for s in SUFFIXES}
    jet["p"] = abs(jet["p"])
    if closure == "rigid_plastic":
        jet |= {"v_y": -jet["u_x"], "v_xy": -jet["u_xx"], "v_yy": -jet["u_xy"]}
    return jet


def base_of(closure: str, jet: dict, friction_angle: float, epsilon: float, arithmetic=NUMPY) -> Base:
    """Return the base state of a jet; the flow's name only fills the model's second place."""
    number = arithmetic.number
    parameters = {"friction_angle": number(friction_angle), "epsilon": number(epsilon)}
    state = nested({n: number(v) for n, v in jet.items()})
    return Base(Model(closure, "uniform_strain", arithmetic), parameters, state, (number(0), number(0)), {})


def random_base(closure: str, rng: np.random.Generator) -> tuple[Base, dict, dict]:
    """Return (base in 60 digits, jet as mpmath numbers, values of the constant symbols)."""
    jet = random_jet(closure, rng)
    friction, epsilon = float(rng.uniform(0.05, 1.5)), float(10 ** rng.uniform(-6, 0))
    exact = multiprecision(60)
    base = base_of(closure, jet, friction, epsilon, exact)
    sine = exact.sin(exact.number(friction))
    constants = {"k": exact.sqrt(exact.number(2)) * sine, "epsilon": exact.number(epsilon), "g_x": 0, "g_y": 0}
    constants = {n: mpf(v) for n, v in constants.items()}
    return base, {n: mpf(exact.number(v)) for n, v in jet.items()}, constants
