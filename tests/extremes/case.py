"""What a sample is: a base state and a grid of waves, and a flow that can be given any jet."""

from dataclasses import dataclass, replace
from math import inf

import numpy as np
from sympy import Integer

from stability.arithmetic import Arithmetic
from stability.flows.base import Flow
from stability.model import Base, Model
from stability.parameters import Parameter
from stability.symbols import p, symbol, u, v, x, y
from tests.states import COMPONENTS, SUFFIXES

HOPPER = {
    "friction_angle": 34.0,
    "wall_friction_angle": 9.0,
    "wedge_angle": 15.0,
    "outlet_radius": 0.5,
    "inlet_radius": 1.5,
    "gravity": 9.81,
}


def taylor(name: str):
    """Return the second-order Taylor polynomial whose coefficients are parameters."""
    c = {s: symbol(f"c_{name}{s}") for s in SUFFIXES}
    linear = c[""] + c["_x"] * x + c["_y"] * y
    return linear + (c["_xx"] * x**2 + c["_yy"] * y**2) / 2 + c["_xy"] * x * y


JET = Flow(
    name="jet",
    title="Any smooth base state, by its value and derivatives at a point",
    source="tests",
    fields={field: taylor(name) for field, name in zip((u, v, p), COMPONENTS, strict=True)},
    body_force=(Integer(0), Integer(0)),
    point=(),
    parameters=tuple(
        Parameter(c + s, f"c_{c}{s}", "SI", -inf, inf, "component of the jet", "tests")
        for c in COMPONENTS
        for s in SUFFIXES
    ),
)
FLOWS = {"jet": JET}  # beside the registered ones, by name


@dataclass(frozen=True, eq=False)  # compared and hashed by identity: it holds dicts and arrays
class Case:
    """Waves of every given angle and every given wavenumber about one base state: parameters and point are decimals."""

    family: str
    closure: str
    flow: str
    parameters: dict[str, float]
    point: dict[str, float]
    wave_angle: np.ndarray
    wavenumber: np.ndarray

    @property
    def question(self) -> tuple:
        """What `stability.eigenvalues` asks first."""
        return self.closure, FLOWS.get(self.flow, self.flow), self.parameters, self.point

    @property
    def shape(self) -> tuple[int, int]:
        """Directions, wavenumbers."""
        return self.wave_angle.size, self.wavenumber.size

    def base(self, arithmetic: Arithmetic) -> Base:
        """Return the base state in an arithmetic."""
        closure, flow, parameters, point = self.question
        return Model(closure, flow, arithmetic).base(parameters, point)

    def wave(self, i: int, j: int) -> "Case":
        """Return the case with one of its waves."""
        return replace(self, wave_angle=self.wave_angle[i : i + 1], wavenumber=self.wavenumber[j : j + 1])

    def about(self, i: int, j: int) -> str:
        """Return one wave in words, to be pasted into a regression file."""
        place = f"{self.closure} {self.flow} {self.parameters} {self.point}"
        return (
            f"{self.family}: {place} wave_angle {float(self.wave_angle[i])!r} wavenumber {float(self.wavenumber[j])!r}"
        )
