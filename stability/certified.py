"""Certified signs: float64 where its running error bound decides, ball arithmetic of growing precision elsewhere.

Stage 1  the base state in balls of 128 bits, once per point, rounded to `Bounded` floats
Stage 2  coefficients of the stability polynomial per direction, with error bounds, in float64 (`bounded`)
Stage 3  every sample: the polynomial and the sum of its terms' bounds, two small matrix products; the sign counts where
         the value exceeds the bound
Stage 4  the rest: coefficients and polynomial in balls, the precision doubled until the sign is decided or `LAST_BITS`
         is reached; what is then still undecided is a tie for all that can be told, and is reported with its enclosure

Parameters and point are the decimals of the scene, waves are the float64 numbers of the grid. The verdict is the sign
of the leading growth rate: +1 grows, -1 decays, 0 undecided.
"""

from dataclasses import dataclass, field
from math import fmod
from typing import Any

import numpy as np

from stability import spectrum
from stability.arithmetic import Arithmetic
from stability.balls import FIRST_BITS, LAST_BITS, available, enclosing, exact_float, float_enclosure
from stability.bounded import BOUNDED, INFLATION, TINY, UNIT, Bounded
from stability.enclosures import enclosed_eigenvalues
from stability.errors import SceneError
from stability.model import Base, Form, Model

# Per term of the polynomial in float64: a power of q by repeated products (at most 10 roundings), its product with the
# coefficient and the sum over at most 6 terms: fewer than 24 roundings.
TERM_ROUNDINGS = 24
BLOCK = 2**16  # samples at once: the arrays of a block stay in cache
DIRECTIONS = 2**10  # whose coefficients are formed at once: some 900 temporaries each


@dataclass
class Tally:
    """How the signs of a map were decided: samples by arithmetic, and the enclosures of those that were not."""

    by: dict[str, int] = field(default_factory=dict)
    undecided: list[tuple[float, float]] = field(default_factory=list)  # (wave_angle, wavenumber)
    enclosures: list[tuple[float, float]] = field(default_factory=list)  # of their growth rates: (centre, radius)

    def add(self, arithmetic: str, count: int | np.integer) -> None:
        """Count samples decided by an arithmetic."""
        if count:
            self.by[arithmetic] = self.by.get(arithmetic, 0) + int(count)

    def tie(self, wave_angle: float, wavenumber: float, leading: tuple[complex, float]) -> None:
        """Note a wave whose sign no precision tried could tell, with (value, radius) of its leading eigenvalue."""
        self.undecided.append((float(wave_angle), float(wavenumber)))
        self.enclosures.append((leading[0].real, leading[1]))


def rounded(tensor: Any, arithmetic: Arithmetic) -> Any:
    """Return nested balls as `Bounded` floats that enclose them."""
    if isinstance(tensor, tuple):
        return tuple(rounded(t, arithmetic) for t in tensor)
    if isinstance(tensor, int | float):
        return tensor
    return Bounded(*float_enclosure(tensor, arithmetic))


class Certifier:
    """The signs of the growth rate about one base state."""

    def __init__(self, closure: Any, flow: Any, parameters: dict, point: dict, matrix: str = "full"):
        if any(np.ndim(value) for value in point.values()):
            raise SceneError(f"a certificate holds at one point: give numbers instead of arrays for {', '.join(point)}")
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
            with np.errstate(all="ignore"):  # the model checks its input in floats first, which may overflow on the way
                self._bases[bits] = Model(closure, flow, arithmetic).base(parameters, point)
        return self._bases[bits]

    def form(self, wave_angle: float, bits: int) -> Form:
        """Return the reduced form of one direction in balls."""
        base = self.base(bits)
        return base.form(exact_float(fmod(wave_angle, 360), base.model.arithmetic), self.matrix)  # fmod is exact

    def signs(
        self, wavenumber: np.ndarray, wave_angle: np.ndarray, tally: Tally, chosen: np.ndarray | bool = True
    ) -> np.ndarray:
        """Return the sign of the growth rate (wave_angle, wavenumber), int8; only chosen samples go beyond float64."""
        chosen = np.broadcast_to(chosen, (wave_angle.size, wavenumber.size))
        sign = np.empty(chosen.shape, np.int8)
        for part in cuts(wave_angle.size, DIRECTIONS):
            self.float_signs(wavenumber, wave_angle[part], sign[part])
        tally.add("float64", np.count_nonzero(sign[chosen]))
        for i in np.flatnonzero(((sign == 0) & chosen).any(axis=1)):
            open_ = np.flatnonzero((sign[i] == 0) & chosen[i])
            bits = FIRST_BITS
            while open_.size and bits <= LAST_BITS:
                form = self.form(wave_angle[i], bits)
                found = ball_signs(form, wavenumber[open_])
                sign[i, open_] = found
                tally.add(form.arithmetic.name, np.count_nonzero(found))
                open_ = open_[found == 0]
                bits *= 2
            if open_.size:
                tally.add("undecided", open_.size)
                for q in wavenumber[open_]:
                    tally.tie(wave_angle[i], q, enclosed_eigenvalues(form, q)[0])
        return sign

    def float_signs(self, wavenumber: np.ndarray, wave_angle: np.ndarray, sign: np.ndarray) -> None:
        """Write the signs that float64 can vouch for, 0 elsewhere."""
        with np.errstate(over="ignore", under="ignore", invalid="ignore", divide="ignore"):
            coefficients = self.float_base.form(wave_angle, self.matrix).coefficients
            stable = Certain.of(spectrum.stability_polynomial(coefficients), wave_angle.size)
            trace = None
            if "trace" in coefficients:
                trace = Certain.of(spectrum.real_imaginary(coefficients["trace"])[0], wave_angle.size)
            powers = stable.powers(wavenumber)
            for rows in cuts(wave_angle.size, max(1, BLOCK // wavenumber.size)):
                np.negative(stable.signs(rows, powers), out=sign[rows])
                if trace is not None and not trace.negative:  # both modes may grow, but only where Re Tr > 0
                    t = trace.signs(rows, trace.powers(wavenumber))
                    sign[rows] = np.where(sign[rows] > 0, 1, np.where(t < 0, sign[rows], np.where(t > 0, 1, 0)))


def cuts(size: int, length: int) -> list[slice]:
    """Return consecutive ranges of at most that length."""
    return [slice(i, min(i + length, size)) for i in range(0, size, length)]


@dataclass(frozen=True)
class Certain:
    """Polynomials with `Bounded` coefficients, one a direction: values, errors (directions, terms), what is lost.

    They are divided by a power of q first, so that the orders start at 0 and the powers stay within range. What
    underflows, a power or its product with a coefficient, is covered by ``lost``, ``tiny`` times each coefficient.
    """

    orders: tuple[int, ...]
    values: np.ndarray
    errors: np.ndarray
    lost: np.ndarray

    @classmethod
    def of(cls, polynomial: spectrum.Polynomial, size: int) -> "Certain":
        """Return the polynomials of ``size`` directions."""
        table = [c if isinstance(c, Bounded) else Bounded(float(c)) for c in polynomial.values()]
        values = np.stack([np.broadcast_to(c.value, size) for c in table], axis=1).astype(float)
        errors = np.stack([np.broadcast_to(c.bound, size) for c in table], axis=1)
        errors = (errors + TERM_ROUNDINGS * UNIT * np.abs(values)) * INFLATION
        lost = TINY * (1 + np.abs(values) + errors).sum(axis=1, keepdims=True) * len(table)
        return cls(tuple(n - min(polynomial) for n in polynomial), values, errors, lost)

    @property
    def negative(self) -> bool:
        """Whether every coefficient is certainly negative, and the values with them."""
        return bool(np.all(self.values + self.errors < 0))

    def powers(self, wavenumber: np.ndarray) -> np.ndarray:
        """Return the powers of the wavenumber, one row a term."""
        return np.stack([wavenumber**n for n in self.orders])

    def signs(self, rows: slice, powers: np.ndarray) -> np.ndarray:
        """Return the certain signs (rows, wavenumber), int8, 0 where uncertain."""
        total, bound = self.values[rows] @ powers, self.errors[rows] @ powers
        bound += self.lost[rows]
        if not np.isfinite(np.abs(self.values[rows]) @ powers.max(axis=1)).all():
            total[~np.isfinite(total)] = np.nan  # a sum that overflowed has no sign
        positive = np.greater(total, bound).view(np.int8)
        return np.subtract(positive, np.less(total, np.negative(bound, out=bound)).view(np.int8), out=positive)


def ball_signs(form: Form, wavenumber: np.ndarray) -> np.ndarray:
    """Return the signs of the growth rate in ball arithmetic, int8, 0 where the balls contain both."""
    polynomial = spectrum.stability_polynomial(form.coefficients)
    trace = spectrum.real_imaginary(form.coefficients["trace"])[0] if "trace" in form.coefficients else None

    def sign(q: Any) -> int:
        value = spectrum.evaluate(polynomial, q)
        if trace is None:
            return 1 if value < 0 else -1 if value > 0 else 0
        t = spectrum.evaluate(trace, q)
        return 1 if t > 0 or value < 0 else -1 if value > 0 and t < 0 else 0

    return np.array([sign(exact_float(float(q), form.arithmetic)) for q in wavenumber], dtype=np.int8)


def arithmetic_note() -> str:
    """Return what decides the signs that float64 cannot."""
    return "Arb balls" if available() else "mpmath intervals (python-flint is not installed: slower)"
