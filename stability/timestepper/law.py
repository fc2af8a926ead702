"""A closure at the points of a mesh: flux and supply with their exact derivatives, and the floor under ||V||."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from stability import codegen
from stability.arithmetic import NUMPY
from stability.closures import CLOSURES
from stability.errors import SceneError

FIELDS = (("u", "v"), "p")
PRESSURE = 2


def contracted(entries: tuple, index: tuple, area: np.ndarray) -> dict[tuple, Any]:
    """Return ``{rest of the index: sum over the axis a of area[a] times the entry}``; index = (row, a, ...)."""
    found: dict[tuple, Any] = {}
    for value, (i, a, *rest) in zip(entries, index, strict=True):
        found[(i, *rest)] = found.get((i, *rest), 0) + area[a] * value
    return found


@dataclass(frozen=True, eq=False)
class Law:
    """The balance laws of a closure with the fields (u, v, p), in numbers.

    Attributes
    ----------
    closure : registered name, or a `Closure`
    parameters : words to numbers in SI units, angles in radians
    body_force : gravity in the Cartesian axes of the mesh (m/s2)
    floor : least ||V|| that the rheology sees (1/s); 0 for none
    least_pressure : least p that a closure sees whose stress exists for p > 0 only, such as mu(I); 0 for none (m2/s2)
    """

    closure: Any
    parameters: Mapping[str, float]
    body_force: tuple[float, float] = (0.0, 0.0)
    floor: float = 0.0
    least_pressure: float = 0.0

    def __post_init__(self) -> None:
        if self._generated["FIELDS"] != FIELDS:
            raise SceneError(
                f'closure = "{self._generated["NAME"]}" has the fields {self._generated["FIELDS"]}: '
                "the time-stepper solves for velocity and pressure (u, v, p) alone"
            )

    @cached_property
    def _generated(self) -> dict:
        return codegen.load(CLOSURES, self.closure, codegen.POINTWISE)

    @cached_property
    def _functions(self) -> dict:
        return self._generated["build"](NUMPY)

    @cached_property
    def values(self) -> tuple[float, ...]:
        """The parameters in the order of the generated functions."""
        return tuple(self.parameters[record.word] for record in self._generated["PARAMETERS"])

    @property
    def evolves(self) -> tuple[int, ...]:
        """The diagonal of E."""
        return self._generated["EVOLVES"]

    @property
    def bounds_pressure(self) -> bool:
        """Whether p is bounded below: never where the stress exists for p <= 0 too, as in the paper's closures."""
        return self.least_pressure > 0 and self._generated["NEEDS_PRESSURE"]

    @property
    def pressure_diffuses(self) -> bool:
        """Whether the mass flux sees the pressure gradient, as in (P1.1); colocated pressure needs that."""
        return any((i, j) == (2, 2) for n in ("FLUX_G0", "FLUX_G1") for i, _, j in self._generated[n])

    def strain_rate_norm(self, g: np.ndarray) -> np.ndarray:
        """Return ||V||, not bounded below, from gradients (2, fields, ...)."""
        return self._functions["strain_rate_norm"](g)

    def _call(self, name: str, q: np.ndarray, g: np.ndarray) -> tuple:
        if self.bounds_pressure:
            q = np.stack(
                [*q[:PRESSURE], np.where(q[PRESSURE].real > self.least_pressure, q[PRESSURE], self.least_pressure)]
            )
        m = None
        if name.split("_")[0].upper() in self._generated["BOUNDED"]:
            norm = self.strain_rate_norm(g)
            m = np.where(norm.real > self.floor, norm, self.floor)  # `pointwise` says why this is all there is to it
        return self._functions[name](q, g, m, self.values, self.body_force)

    def flux(self, q: np.ndarray, g: np.ndarray, area: np.ndarray) -> dict[tuple, Any]:
        """Return ``{(row,): flux through area vectors}``."""
        return contracted(self._call("flux", q, g)[0], self._generated["FLUX"], area)

    def flux_moduli(self, q: np.ndarray, g: np.ndarray, area: np.ndarray) -> tuple:
        """Return the derivatives of that flux by q and by each of the two gradients, as ``{(row, column): array}``."""
        _, *entries = self._call("flux_moduli", q, g)
        tables = (self._generated[name] for name in ("FLUX_Q", "FLUX_G0", "FLUX_G1"))
        by_q, *by_g = (contracted(e, index, area) for e, index in zip(entries, tables, strict=True))
        return self._seen(by_q, q), *by_g

    def _seen(self, by_q: dict, q: np.ndarray) -> dict:
        """Return derivatives by q, zero by the pressure where the closure does not see it."""
        if not self.bounds_pressure:
            return by_q
        seen = q[PRESSURE].real > self.least_pressure
        return {(i, j): e * seen if j == PRESSURE else e for (i, j), e in by_q.items()}

    def supply(self, q: np.ndarray, g: np.ndarray) -> dict[tuple, Any]:
        """Return ``{(row,): supply}``."""
        return dict(zip(self._generated["SUPPLY"], self._call("supply", q, g)[0], strict=True))

    def supply_moduli(self, q: np.ndarray, g: np.ndarray) -> tuple:
        """Return the derivatives of the supply by q and by each of the two gradients, as ``{(row, column): array}``."""
        _, *entries = self._call("supply_moduli", q, g)
        tables = (self._generated[name] for name in ("SUPPLY_Q", "SUPPLY_G0", "SUPPLY_G1"))
        by_q, *by_g = (dict(zip(index, e, strict=True)) for e, index in zip(entries, tables, strict=True))
        return self._seen(by_q, q), *by_g
