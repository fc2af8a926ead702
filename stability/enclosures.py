"""Eigenvalues with their errors: bounds in float64, enclosures in balls.

A computed eigenvalue lambda solves ``x^2 - g x + f = 0`` for its distance x to an exact one, with
``f = lambda^2 - Tr lambda + Det`` and ``g = 2 lambda - Tr`` of the exact coefficients. The nearer root obeys
|x| <= 2 |f|/|g|, so bounds of f and g, by running error analysis, bound the error of whatever method found lambda. Two
values farther apart than their bounds are near two roots.
"""

from typing import Any

import numpy as np

from stability import spectrum
from stability.arithmetic import Arithmetic
from stability.balls import exact_float, float_enclosure, upper
from stability.bounded import INFLATION, Bounded
from stability.model import Form


def bounded_eigenvalues(form: Form, wavenumber: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return float64 eigenvalues (waves, modes) and bounds of the error of their real parts; inf where there is none.

    ``form`` has `Bounded` coefficients, one direction per wave.
    """
    q = Bounded(wavenumber)
    with np.errstate(all="ignore"):
        if "trace" not in form.coefficients:
            real, imaginary = (spread(part, wavenumber) for part in spectrum.single_parts(form.coefficients, q))
            found, errors = [real.value + 1j * imaginary.value], [real.bound]
        else:
            plain = {part: {n: centre(c) for n, c in series.items()} for part, series in form.coefficients.items()}
            found = list(spectrum.pair(plain, wavenumber))
            trace, determinant = (spectrum.values(form.coefficients[part], q) for part in ("trace", "determinant"))
            errors = [distance(trace, determinant, value) for value in found]
            apart = np.abs(found[0] - found[1]) > (errors[0] + errors[1]) * INFLATION  # else both may be near one root
            errors = [np.where(apart, e, np.inf) for e in errors]
    speed = form.speed if isinstance(form.speed, Bounded) else Bounded(form.speed)
    shifted = np.stack([value - 1j * (speed.value * wavenumber) for value in found], axis=-1)
    bound = np.stack(errors, axis=-1)
    return ordered(shifted, np.where(np.isfinite(shifted) & np.isfinite(bound), bound, np.inf))


def within(value: Any, error: Any, rtol: float) -> Any:
    """Return whether the exact real part is certain to lie within rtol, relative to itself, of the value's."""
    return error * (1 + rtol) <= rtol * np.abs(value.real)


def ordered(found: np.ndarray, error: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return eigenvalues (waves, modes) and bounds of their errors by decreasing real part.

    Real parts that the bounds do not separate tie, and the imaginary part decides, as for conjugate pairs; the gap then
    counts as an error.
    """
    if found.shape[-1] == 1:
        return found, error
    one, other = found[..., 0], found[..., 1]
    with np.errstate(invalid="ignore"):  # inf - inf: not apart
        gap, reach = one.real - other.real, error.sum(axis=-1)
    tie = ~(np.abs(gap) > reach)
    swap = np.where(tie, one.imag < other.imag, gap < 0)[..., None]
    error = np.where(tie, np.abs(gap), 0.0)[..., None] + error
    return np.where(swap, found[..., ::-1], found), np.where(swap, error[..., ::-1], error)


def distance(trace: tuple, determinant: tuple, value: np.ndarray) -> np.ndarray:
    """Return a bound of the distance from ``value`` to the nearest root of the characteristic polynomial."""
    parts = spectrum.characteristic(trace, determinant, Bounded(value.real), Bounded(value.imag))
    f_r, f_i, g_r, g_i = (spread(part, value.real) for part in parts)
    residual = np.hypot(np.abs(f_r.value) + f_r.bound, np.abs(f_i.value) + f_i.bound)
    slope = np.hypot(np.maximum(0, np.abs(g_r.value) - g_r.bound), np.maximum(0, np.abs(g_i.value) - g_i.bound))
    return 2 * residual / slope * INFLATION


def centre(number: Any) -> Any:
    """Return the float64 value of a `Bounded` or of a plain number."""
    return number.value if isinstance(number, Bounded) else number


def spread(number: Any, like: np.ndarray) -> Bounded:
    """Return a number as a `Bounded` array of the shape of ``like``."""
    number = number if isinstance(number, Bounded) else Bounded(number)
    return Bounded(number.value + 0 * like, number.error + 0 * like)


def enclosed_eigenvalues(form: Form, wavenumber: float) -> list[tuple[complex, float]]:
    """Return (centre, radius of the real part) of every eigenvalue in ball arithmetic, as `ordered` has them."""
    a = form.arithmetic
    q = exact_float(float(wavenumber), a)
    parts = [spectrum.single_parts(form.coefficients, q)] if "trace" not in form.coefficients else ball_pair(form, q)
    rows = []
    for real, imaginary in parts:
        growth, radius = float_enclosure(real, a)
        rows.append((complex(growth, a.centre(imaginary - form.speed * q)), radius))
    values, radii = ordered(np.array([[v for v, _ in rows]]), np.array([[e for _, e in rows]]))
    return [(complex(v), float(e)) for v, e in zip(values[0], radii[0], strict=True)]


def ball_pair(form: Form, q: Any) -> list[tuple[Any, Any]]:
    """Return real and imaginary part of both eigenvalues: half the trace plus a root, and Det over it."""
    a = form.arithmetic
    (tr, ti), (dr, di), (gap, twist) = (spectrum.values(form.coefficients[p], q) for p in form.coefficients)
    rr, ri = complex_root(gap, twist, a)
    if a.centre(tr * rr + ti * ri) < 0:
        rr, ri = -rr, -ri
    large = (tr / 2 + rr, ti / 2 + ri)
    small = (tr / 2 - rr, ti / 2 - ri)
    size = large[0] * large[0] + large[1] * large[1]
    if size > 0:
        quotient = ((dr * large[0] + di * large[1]) / size, (di * large[0] - dr * large[1]) / size)
        small = tuple(min(pair, key=lambda e: radius(e, a)) for pair in zip(small, quotient, strict=True))
    return [large, small]


def radius(ball: Any, a: Arithmetic) -> float:
    """Return an upper bound of how far a ball reaches from the nearest float to its centre."""
    return float_enclosure(ball, a)[1]


def complex_root(x: Any, y: Any, a: Arithmetic) -> tuple[Any, Any]:
    """Return a square root of x + i y in real ball arithmetic; which of the two does not matter."""
    modulus = a.sqrt(x * x + y * y)
    if not modulus > 0:  # the balls contain zero: so do both parts, within the root of the largest modulus
        reach = a.sqrt(upper(x) + upper(y))
        return reach * a.unit, reach * a.unit
    if a.centre(x) >= 0:
        real = a.sqrt((modulus + x) / 2)
        return real, y / (2 * real)
    imaginary = a.sqrt((modulus - x) / 2)
    return y / (2 * imaginary), imaginary
