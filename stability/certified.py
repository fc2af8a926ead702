"""Certified signs: float64 where its running error bound decides, ball arithmetic of growing precision elsewhere.

Stage 1  the base state in balls of 128 bits, once per point, rounded to `Bounded` floats
Stage 2  coefficients of the stability polynomial per direction, with error bounds, in float64 (`bounded`)
Stage 3  every sample: the polynomial and the sum of its terms' bounds, two small matrix products; the sign counts where
         the value exceeds the bound
Stage 4  the rest: coefficients and polynomial in balls, the precision doubled until the sign is decided or `LAST_BITS` is reached;
         what is then still undecided is a tie for all that can be told, and is reported with its enclosure

Parameters and point are the decimals of the scene, waves are the float64 numbers of the grid. The verdict is the sign of the
leading growth rate: +1 grows, -1 decays, 0 undecided.
"""

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from stability import spectrum
from stability.arithmetic import Arithmetic
from stability.balls import FIRST_BITS, LAST_BITS, available, enclosing
from stability.bounded import BOUNDED, INFLATION, UNIT, Bounded
from stability.model import Base, Form, Model

# Per term of the polynomial in float64: a power of q by repeated products (at most 10 roundings), its product with the
# coefficient and the sum over at most 6 terms: fewer than 24 roundings.
TERM_ROUNDINGS = 24
BLOCK = 2**16  # samples at once: the tables of a block stay in cache


@dataclass
class Tally:
    """How the signs of a map were decided: samples by arithmetic, and the enclosures of those that were not."""

    by: dict[str, int] = field(default_factory=dict)
    undecided: list[tuple] = field(default_factory=list)

    def add(self, arithmetic: str, count: int) -> None:
        """Count samples decided by an arithmetic."""
        if count:
            self.by[arithmetic] = self.by.get(arithmetic, 0) + int(count)


def rounded(tensor: Any, arithmetic: Arithmetic) -> Any:
    """Return nested balls as `Bounded` floats that enclose them."""
    if isinstance(tensor, tuple):
        return tuple(rounded(t, arithmetic) for t in tensor)
    if isinstance(tensor, int | float):
        return tensor
    centre = arithmetic.centre(tensor)
    return Bounded(centre, arithmetic.size(tensor - arithmetic.number(centre)) * INFLATION)


class Certifier:
    """The signs of the growth rate about one base state."""

    def __init__(self, closure: Any, flow: Any, parameters: dict, point: dict, matrix: str = "full"):
        self.question = (closure, flow, parameters, point)
        self.matrix = matrix
        self._bases: dict[int, Base] = {}
        balls = self.base(FIRST_BITS)
        arithmetic = balls.model.arithmetic
        constants = {word: rounded(value, arithmetic) for word, value in balls.parameters.items()}
        model = Model(closure, flow, BOUNDED)
        self.float_base = Base(model, constants, rounded(balls.state, arithmetic), (), {})

    def base(self, bits: int) -> Base:
        """Return the base state in balls; python-flint's working precision is set on the way."""
        arithmetic = enclosing(bits)
        if bits not in self._bases:
            closure, flow, parameters, point = self.question
            self._bases[bits] = Model(closure, flow, arithmetic).base(parameters, point)
        return self._bases[bits]

    def form(self, wave_angle: float, bits: int) -> Form:
        """Return the reduced form of one direction in balls."""
        base = self.base(bits)
        return base.form(exact_float(float(wave_angle), base.model.arithmetic), self.matrix)

    def signs(
        self, wavenumber: np.ndarray, wave_angle: np.ndarray, tally: Tally, chosen: np.ndarray | bool = True
    ) -> np.ndarray:
        """Return the sign of the growth rate (wave_angle, wavenumber), int8; only the chosen samples go beyond float64."""
        chosen = np.broadcast_to(chosen, (wave_angle.size, wavenumber.size))
        sign = np.empty(chosen.shape, np.int8)
        for start in range(0, wave_angle.size, rows := max(1, BLOCK // wavenumber.size)):
            part = slice(start, start + rows)
            sign[part] = self.float_signs(wavenumber, wave_angle[part])
        tally.add("float64", np.count_nonzero(sign[chosen]))
        for i in np.flatnonzero(((sign == 0) & chosen).any(axis=1)):
            open_ = np.flatnonzero((sign[i] == 0) & chosen[i])
            bits = FIRST_BITS
            while open_.size and bits <= LAST_BITS:
                form = self.form(wave_angle[i], bits)
                found = np.array([ball_sign(form, float(q)) for q in wavenumber[open_]], dtype=np.int8)
                sign[i, open_] = found
                tally.add(form.arithmetic.name, np.count_nonzero(found))
                open_ = open_[found == 0]
                bits *= 2
            if open_.size:
                tally.add("undecided", open_.size)
                tally.undecided += [(float(wave_angle[i]), float(q)) for q in wavenumber[open_]]
        return sign

    def float_signs(self, wavenumber: np.ndarray, wave_angle: np.ndarray) -> np.ndarray:
        """Return the signs that float64 can vouch for, 0 elsewhere."""
        coefficients = self.float_base.form(wave_angle, self.matrix).coefficients
        with np.errstate(over="ignore", invalid="ignore"):
            value = enclosed(spectrum.stability_polynomial(coefficients), wavenumber, wave_angle.size)
            sign = -value
            if "trace" in coefficients:  # both modes may grow only where Re Tr > 0
                trace = enclosed(spectrum.real_imaginary(coefficients["trace"])[0], wavenumber, wave_angle.size)
                sign = np.where(value < 0, 1, np.where(trace < 0, sign, np.where(trace > 0, 1, 0)))
        return sign.astype(np.int8)


def exact_float(value: float, arithmetic: Arithmetic) -> Any:
    """Return exactly that float64 number, not the decimal that it prints as."""
    p, q = value.as_integer_ratio()
    return arithmetic.number(p) / arithmetic.number(q)


def enclosed(polynomial: spectrum.Polynomial, wavenumber: np.ndarray, size: int) -> np.ndarray:
    """Return the certain signs (size, wavenumber) of a polynomial with `Bounded` coefficients, 0 where uncertain.

    Divided by a power of q first, so that the orders start at 0 and the powers stay within range.
    """
    lowest = min(polynomial)
    orders = [n - lowest for n in polynomial]
    table = [c if isinstance(c, Bounded) else Bounded(float(c)) for c in polynomial.values()]
    values = np.stack([np.broadcast_to(c.value, size) for c in table], axis=1).astype(float)
    errors = np.stack([np.broadcast_to(c.bound, size) for c in table], axis=1)
    errors = errors + TERM_ROUNDINGS * UNIT * np.abs(values)
    powers = np.stack([wavenumber**n for n in orders])
    total, bound = values @ powers, (errors * INFLATION) @ powers
    return np.where(np.abs(total) > bound, np.sign(total), 0.0)


def ball_sign(form: Form, wavenumber: float) -> int:
    """Return the sign of the growth rate in ball arithmetic, 0 if the balls contain both."""
    a = form.arithmetic
    q = exact_float(wavenumber, a)
    coefficients = form.coefficients
    if "trace" in coefficients:
        t, _ = spectrum.values(coefficients["trace"], q)
        if t > 0:
            return 1
        value = spectrum.evaluate(spectrum.stability_polynomial(coefficients), q)
        return 1 if value < 0 else -1 if value > 0 and t < 0 else 0
    value = spectrum.evaluate(spectrum.stability_polynomial(coefficients), q)
    return 1 if value < 0 else -1 if value > 0 else 0


def arithmetic_note() -> str:
    """Return what decides the signs that float64 cannot."""
    return "Arb balls" if available() else "mpmath intervals (python-flint is not installed: slower)"
