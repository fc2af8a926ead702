"""Float64 numbers that carry a bound of their own error: the running error analysis of any generated expression.

A `Bounded` stands for every real number within ``error`` of ``value``. With the unit roundoff u = 2^-53 each operation
adds its own rounding to what it inherits:

    a + b      ea + eb                              + u |value|
    a b        |a| eb + |b| ea + ea eb              + u |value| + tiny
    a / b      ea/room + |value| (eb/room)          + u |value| + tiny      room = |b| - eb; unbounded unless positive
    sqrt a     ea/sqrt(a), or sqrt(ea) at a = 0     + u |value|
    f(a)       ea times the largest |f'| near a     + 8 u |value|           library functions err by 4 units at most

``tiny`` covers underflow and is left out only where a factor is exactly zero. Products of errors are kept, so the
bounds hold to all orders but for the rounding of the errors themselves, which some hundred operations raise by at most
1e-12 relative; `INFLATION` covers that. Bounds are met with equality only if all roundings conspire: the measured
median is 65 times the true error of a coefficient (tests/test_bounded.py).
"""

from dataclasses import replace
from fractions import Fraction
from typing import Any

import numpy as np

from stability.arithmetic import NUMPY, Arithmetic, cosine_sine

UNIT = 2.0**-53
LIBRARY = 8 * UNIT  # twice the 4 units in the last place that NumPy's vectorised functions may err
TINY = 2.0**-1073
INFLATION = 1 + 1e-9
EXTENDED = np.finfo(np.longdouble).nmant >= 63  # on x86; elsewhere directions are known to 8 u only
PI = np.longdouble("3.14159265358979323846264338327950288")
LONG = replace(NUMPY, pi=PI, rational=lambda p, q: np.longdouble(p) / q)


class Bounded:
    """A number or an array with an error bound of the same shape."""

    __slots__ = ("value", "error")
    __array_ufunc__ = None  # NumPy leaves mixed operations to the methods below

    def __init__(self, value: Any, error: Any = 0.0):
        self.value, self.error = value, error

    def __add__(self, other: Any) -> "Bounded":
        other = lifted(other)
        value = self.value + other.value
        return Bounded(value, self.error + other.error + UNIT * np.abs(value))

    def __neg__(self) -> "Bounded":
        return Bounded(-self.value, self.error)

    def __sub__(self, other: Any) -> "Bounded":
        return self + -lifted(other)

    def __rsub__(self, other: Any) -> "Bounded":
        return lifted(other) + -self

    def __mul__(self, other: Any) -> "Bounded":
        other = lifted(other)
        value = self.value * other.value
        inherited = np.abs(self.value) * other.error + (np.abs(other.value) + other.error) * self.error
        return Bounded(value, inherited + UNIT * np.abs(value) + TINY * (self.somewhere & other.somewhere))

    def __truediv__(self, other: Any) -> "Bounded":
        other = lifted(other)
        room = np.abs(other.value) - other.bound  # the bound: where room is small, so is what rounding may eat of it
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
            value = self.value / other.value
            error = self.error / room + np.abs(value) * (other.error / room) + UNIT * np.abs(value) + TINY
        return Bounded(value, np.where(room > 0, error, np.inf))

    def __rtruediv__(self, other: Any) -> "Bounded":
        return lifted(other) / self

    def __pow__(self, exponent: Any) -> "Bounded":
        """Return a power with a real exponent, of a positive base: d(x^w) = x^w (w dx/x + ln x dw)."""
        exponent = lifted(exponent)
        value = self.value**exponent.value
        low = self.value - self.bound
        with np.errstate(divide="ignore", invalid="ignore"):
            steps = np.abs(exponent.value) + exponent.error, np.abs(np.log(self.value))
            relative = steps[0] * self.error / low + steps[1] * exponent.error
        relative = relative * (1 + relative) + LIBRARY  # exp(t) - 1 <= t (1 + t) for t <= 1
        return Bounded(value, np.where((low > 0) & (relative < 1), relative * np.abs(value) + TINY, np.inf))

    __radd__, __rmul__ = __add__, __mul__

    def __getitem__(self, index: Any) -> "Bounded":
        return Bounded(self.value[index], np.broadcast_to(self.error, np.shape(self.value))[index])

    @property
    def somewhere(self) -> Any:
        """Whether the number may differ from zero."""
        return (self.value != 0) | (self.error != 0)

    @property
    def bound(self) -> Any:
        """The error bound, with the rounding of the bound itself covered."""
        return self.error * INFLATION


def lifted(value: Any) -> Bounded:
    """Return a number as a `Bounded`; integers and floats are exact."""
    return value if isinstance(value, Bounded) else Bounded(value, 0.0)


def smooth(function: Any, steepest: Any) -> Any:
    """Return a `Bounded` version of a library function; ``steepest(a, e)`` bounds its slope within e of a."""

    def bounded(a: Any) -> Bounded:
        a = lifted(a)
        with np.errstate(divide="ignore", invalid="ignore"):
            value = function(a.value)
            slope = steepest(a.value, a.error)
        inherited = np.where(a.error > 0, slope * a.error, 0.0)
        return Bounded(value, inherited + LIBRARY * np.abs(value))

    return bounded


def root(a: Any) -> Bounded:
    """Return the square root: |sqrt a - sqrt a'| <= |a - a'|/sqrt a."""
    a = lifted(a)
    value = np.sqrt(a.value)
    with np.errstate(divide="ignore", invalid="ignore"):
        inherited = np.where(value > 0, a.error / value, np.sqrt(a.error))
    return Bounded(value, inherited + UNIT * value)


def number(value: Any) -> Bounded:
    """Return a decimal or a float read as the decimal that it prints as, with its exact conversion error."""
    if isinstance(value, Bounded):
        return value
    nearest = float(value)
    exact = Fraction(repr(nearest) if isinstance(value, float) else str(value))
    return Bounded(nearest, float(abs(Fraction(nearest) - exact)) * INFLATION)


def direction(degrees: Any, _: Any = None) -> tuple[Bounded, Bounded]:
    """Return cosine and sine of exact float64 angles in degrees; exact at the axes, and only there.

    From extended precision, where there is one, only the rounding to float64 is left. In float64 the reduced angle in
    radians errs by 3 u relative, so the cosine by 3 u |angle sine| beside the library's error.
    """
    degrees = np.fmod(degrees, 360.0)  # exact; cosine_sine takes quarter turns off without rounding only near zero
    if EXTENDED:
        c, s = (np.asarray(f, dtype=float) for f in cosine_sine(np.asarray(degrees, np.longdouble), LONG))
    else:
        c, s = cosine_sine(degrees, NUMPY)
    rest = np.abs(degrees - 90 * np.floor(degrees / 90 + 0.5))
    reduced = np.deg2rad(rest)

    def error(f: Any, slope: Any) -> Any:
        found = 1.5 * UNIT * np.abs(f) if EXTENDED else LIBRARY * np.abs(f) + 4 * UNIT * reduced * np.abs(slope)
        found = found + TINY
        return np.where(rest == 0, 0.0, found)

    return Bounded(c, error(c, s)), Bounded(s, error(s, c))


def rational(p: int, q: int) -> Bounded:
    """Return p/q."""
    return Bounded(float(p)) / q


def steepest_tangent(tangent: Any, e: Any) -> Any:
    """Return a bound of the slope within e of T = |tan|: tan <= T + 2 e (1 + T^2) there if e (1 + T) < 1/4."""
    return np.where(e * (1 + tangent) < 0.25, 1 + (tangent + 2 * e * (1 + tangent**2)) ** 2, np.inf)


BOUNDED = Arithmetic(
    name="float64 with running error bounds", number=number, complex=complex, rational=rational,
    where=np.where, floor=np.floor, pi=Bounded(np.pi, 1.3e-16), sqrt=root,
    sin=smooth(np.sin, lambda a, e: np.minimum(1, np.abs(np.cos(a)) + e)),
    cos=smooth(np.cos, lambda a, e: np.minimum(1, np.abs(np.sin(a)) + e)),
    tan=smooth(np.tan, lambda a, e: steepest_tangent(np.abs(np.tan(a)), e)),
    asin=smooth(np.arcsin, lambda a, e: 1 / np.sqrt((1 - (m := np.minimum(1, np.abs(a) + 2 * e))) * (1 + m))),
    atan=smooth(np.arctan, lambda a, e: 1.0),
    exp=smooth(np.exp, lambda a, e: np.exp(a + e)),
    log=smooth(np.log, lambda a, e: 1 / np.maximum(0, a - e * INFLATION)),
    direction=direction,
)  # fmt: skip
