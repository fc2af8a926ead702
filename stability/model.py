"""A closure on a flow, compiled: from a point and a direction of waves to the coefficients of their eigenvalues.

The base state is turned into each wave's own frame (chi, tau), where one set of generated expressions serves every
direction. That needs a frame-indifferent closure, which a test holds for each registered one.
"""

import re
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from stability import codegen
from stability.arithmetic import NUMPY, Arithmetic
from stability.closures import CLOSURES
from stability.errors import PrecisionError, SceneError
from stability.flows import FLOWS
from stability.forms import Form
from stability.parameters import Parameter, merged, problems, radians, to_si

# A flow that satisfies a constraint analytically misses it by a few roundings, some 1e-16 of the velocity gradient.
CONSTRAINT_RTOL = 1e-12
MATRICES = ("full", "truncated", "leading")  # D (P3), D' (P7), M (P4)


def check_waves(wavenumber: np.ndarray, wave_angle: np.ndarray) -> None:
    """Raise `SceneError` unless the waves can be evaluated."""
    bad = wavenumber[~(np.isfinite(wavenumber) & (wavenumber > 0))]
    if bad.size:
        raise SceneError(
            f"wavenumber = {bad.flat[0]:g} 1/m lies outside (0, inf) 1/m: it is the modulus of the wavevector, "
            "and a disturbance without wavelength has no direction"
        )
    if not np.all(np.isfinite(wave_angle)):
        raise SceneError("wave_angle holds values that are not finite: give degrees")


def check_range(found: tuple, wavenumber: np.ndarray, wave_angle: np.ndarray) -> None:
    """Raise `PrecisionError` if an eigenvalue left the range of float64 on the way."""
    lost = ~np.all([np.isfinite(e) for e in found], axis=0)
    if np.any(lost):
        q, angle = (np.broadcast_to(v, lost.shape)[lost].flat[0] for v in (wavenumber, wave_angle))
        raise PrecisionError(
            f"{np.count_nonzero(lost)} eigenvalues leave the range of float64, the first at wavenumber {q:g} 1/m, "
            f"wave_angle {angle:g} deg: change the units or the range, or use rtol= or digits= of stability.eigenvalues"
        )


def unknown_matrix(matrix: Any) -> str:
    """Return the sentence that names the matrices there are."""
    return f"matrix = {matrix!r} is unknown: use one of {', '.join(MATRICES)}"


def no_truncation(name: str) -> str:
    """Return the sentence that refuses D' and M of a closure without closed forms, or M's pencil."""
    return (
        f'closure {name} has no such pencil: use matrix = "full"; D\' is that of closures with two velocities and one '
        "constraint, and M is no reduction of a pencil"
    )


def given(sentence: str, values: Mapping) -> str:
    """Return the values that a sentence speaks of, or all of them if it names none."""
    named = {w: v for w, v in values.items() if re.search(rf"\b{w}\b", sentence)}
    return ", ".join(f"{w} = {v}" for w, v in (named or values).items())


def rotated(tensor: Any, c: Any, s: Any) -> Any:
    """Return the components of a nested tensor in axes turned by the angle with cosine ``c`` and sine ``s``."""
    if not isinstance(tensor, tuple):
        return tensor
    x, y = (rotated(part, c, s) for part in tensor)
    return combine(x, y, c, s), combine(x, y, -s, c)


def combine(x: Any, y: Any, c: Any, s: Any) -> Any:
    """Return ``c x + s y`` for nested tensors of one shape."""
    if isinstance(x, tuple):
        return tuple(combine(a, b, c, s) for a, b in zip(x, y, strict=True))
    return c * x + s * y


@dataclass(frozen=True)
class Model:
    """The generated functions of a closure and of a flow, in one arithmetic ."""

    closure: Any
    flow: Any
    arithmetic: Arithmetic = NUMPY

    @cached_property
    def _closure(self) -> dict:
        return codegen.load(CLOSURES, self.closure)

    @cached_property
    def _flow(self) -> dict:
        return codegen.load(FLOWS, self.flow)

    @cached_property
    def _functions(self) -> tuple[dict, dict]:
        return self._closure["build"](self.arithmetic), self._flow["build"](self.arithmetic)

    @property
    def closure_name(self) -> str:
        """The closure's word."""
        return self._closure["NAME"]

    @property
    def flow_name(self) -> str:
        """The flow's word."""
        return self._flow["NAME"]

    @property
    def modes(self) -> int:
        """How many eigenvalues a wave has: those of its pencil that are finite."""
        return self._closure["MODES"]

    @property
    def closed(self) -> bool:
        """Whether eigenvalues have a closed form (two velocities and one constraint); else the pencil is solved."""
        return self._closure["FORM"] != "General"

    @property
    def evolves(self) -> tuple[int, ...]:
        """The diagonal of E: 1 for an evolution equation, 0 for a constraint."""
        return self._closure["EVOLVES"]

    @property
    def fields(self) -> tuple:
        """The names of the closure's fields; a vector is a pair."""
        return self._closure["FIELDS"]

    @property
    def parameters(self) -> dict[str, Parameter]:
        """Return the records of every parameter of closure and flow, by word."""
        return merged(self._closure["PARAMETERS"], self._flow["PARAMETERS"])

    @property
    def point(self) -> dict[str, Parameter]:
        """Return the records of the coordinates that choose a point of the flow."""
        return merged(self._flow["POINT"])

    @property
    def axis(self) -> str:
        """What wave angle 0 means."""
        return self._flow["AXIS"]

    def missing_fields(self) -> list[str]:
        """Return one sentence if the flow does not provide every field of the closure."""
        needed = [c for f in self.fields for c in (f if isinstance(f, tuple) else (f,))]
        missing = [c for c in needed if c not in self._flow["FIELDS"]]
        if not missing:
            return []
        return [
            f"{self.closure_name} needs the field{'s' * (len(missing) > 1)} {', '.join(missing)}, which "
            f"{self.flow_name} does not provide: it has {', '.join(self._flow['FIELDS'])}; choose another flow"
        ]

    def problems(self, parameters: Mapping, point: Mapping) -> list[str]:
        """Return everything that is wrong with parameters and point, one sentence each."""
        if missing := self.missing_fields():
            return missing
        found = problems(self.parameters, parameters, "[parameters]")
        for name in point:
            if name not in self.point:
                found.append(
                    f"point {name} is unknown: {self.flow_name} has {', '.join(self.point) or 'no coordinates'}"
                )
        for name, record in self.point.items():
            if name not in point:
                found.append(f"point {name} is missing: it is {record.described}, in {record.range}")
            else:
                found += filter(
                    None, {record.problem(v, "point") for v in np.ravel(np.asarray(point[name], dtype=object))}
                )
        if not found:
            constants, place = self._si(parameters, point)
            for stage in ("conditions", "letter_conditions"):
                with np.errstate(all="ignore"):  # what does not exist is not fulfilled, and is said in words
                    holds = self._functions[1][stage](place, constants)
                found += [f"{text} ({given(text, {**parameters, **point})})" for text, ok in holds if not np.all(ok)]
                if found:
                    break
        return found

    def _si(self, parameters: Mapping, point: Mapping) -> tuple[dict, dict]:
        number, pi = self.arithmetic.number, self.arithmetic.pi
        place = {w: number(point[w]) for w in self.point}
        place |= {w: radians(place[w], pi) for w, r in self.point.items() if r.unit == "deg"}
        return to_si(self.parameters, parameters, number, pi), place

    def base(self, parameters: Mapping, point: Mapping) -> "Base":
        """Return the base state at a point, or raise `SceneError` with every problem.

        Parameters
        ----------
        parameters : words of closure and flow, SI units, angles in degrees
        point : coordinates of the flow's point (angles in degrees); arrays of one shape make an array of points
        """
        if found := self.problems(parameters, point):
            raise SceneError(*found)
        constants, place = self._si(parameters, point)
        closure, flow = self._functions
        jets = flow["state"](place, constants)
        state = tuple(
            tuple(zip(*(jets[c] for c in f), strict=True)) if isinstance(f, tuple) else jets[f] for f in self.fields
        )
        base = Base(self, constants, state, flow["body_force"](place, constants), flow["letters"](place, constants))
        if self._closure["FORM"] == "Single":
            self._check_constraint(base)
        return base

    def _check_constraint(self, base: "Base") -> None:
        """Refuse a flow that breaks an exact constraint: identities used in compiling would not hold."""
        (_, gradient, _), miss = base.state[0], base.imbalance()[-1]
        size = sum(abs(g) for row in gradient for g in row)
        worst = np.max(np.asarray(self.arithmetic.centre(abs(miss) / size)))
        if worst > CONSTRAINT_RTOL:
            raise SceneError(
                f"{self.closure_name} imposes its constraint exactly, but {self.flow_name} misses it by {worst:.3g} "
                "of the velocity gradient: choose a flow with div u = 0 (delta = 0), or another closure"
            )


@dataclass(frozen=True)
class Base:
    """A base state at one point (or an array of points): the jet of every field, in the flow's local frame."""

    model: Model
    parameters: dict
    state: tuple
    body_force: tuple
    flow_letters: dict

    def at(self, index: Any) -> "Base":
        """Return the base states at some of an array of points, in that order."""

        def taken(tensor: Any) -> Any:
            if isinstance(tensor, tuple):
                return tuple(map(taken, tensor))
            return tensor[index] if np.ndim(tensor) else tensor

        return replace(self, state=taken(self.state))

    def letters(self) -> dict:
        """Return the closure's letters (k, N = ||V||, A, mu, ...) at the point."""
        return self.model._functions[0]["letters"](self.state, self.parameters)

    def imbalance(self) -> tuple:
        """Return div F - S of each balance law: how far the base state is from a steady solution."""
        return self.model._functions[0]["imbalance"](self.state, self.parameters, self.body_force)

    def pencil(self, matrix: str = "full") -> tuple:
        """Return L2[a][b], L1[a] and L0 of `linearise.pencil`, in the flow's local frame; those of D' if truncated."""
        names = {"full": "pencil", "truncated": "pencil_truncated"}
        if matrix not in names or names[matrix] not in self.model._functions[0]:
            raise SceneError(no_truncation(self.model.closure_name) if matrix in MATRICES else unknown_matrix(matrix))
        return self.model._functions[0][names[matrix]](self.state, self.parameters)

    def form(self, wave_angle: Any, matrix: str = "full") -> Form:
        """Return the reduced form of D, D' or M for waves in the given direction, or the pencil where there is none.

        Parameters
        ----------
        wave_angle : degrees from the flow's axis; an array broadcasts against the points
        matrix : "full" (D), "truncated" (D', P7) or "leading" (M, P4)
        """
        if matrix not in MATRICES:
            raise SceneError(unknown_matrix(matrix))
        c, s = self.model.arithmetic.direction(wave_angle, self.model.arithmetic)
        if not self.model.closed:
            return self._general(c, s, matrix)
        turned = tuple(tuple(rotated(tensor, c, s) for tensor in jet) for jet in self.state)
        coefficients = self.model._functions[0][matrix](turned, self.parameters)
        along = turned[0][0][0] if matrix == "full" else 0
        return Form(coefficients, along, self.model.arithmetic)

    def resting(self) -> tuple["Base", tuple]:
        """Return the base state as an observer sees it who moves along, and the velocity that was taken off.

        It stays where it does more than shift the frequency; left in elsewhere, its roundings were the growth rate's.
        """
        first = self.state[0]
        if not (self.model._closure["GALILEAN"] and isinstance(self.model.fields[0], tuple)):
            return self, (0, 0)
        velocity, *slopes = first
        return replace(self, state=((tuple(0.0 for _ in velocity), *slopes), *self.state[1:])), velocity

    def _general(self, c: Any, s: Any, matrix: str) -> Any:
        if matrix != "full":
            raise SceneError(no_truncation(self.model.closure_name))
        from stability.general import General, along_direction  # not needed by closures with closed forms

        resting, velocity = self.resting()
        m = self.model
        series = along_direction(resting.pencil(), c, s)
        speed = c * velocity[0] + s * velocity[1]
        return General(m.closure_name, m.evolves, m.modes, m._closure["RANK"], series, speed, m.arithmetic)
