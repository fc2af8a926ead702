"""Eigenvalues with a guarantee: enclosures in balls, error bounds in float64, and the one where the other does not do.

A computed eigenvalue lambda solves ``x^2 - g x + f = 0`` for its distance x to an exact one, with ``f = lambda^2 - Tr lambda + Det`` and
``g = 2 lambda - Tr`` of the exact coefficients. The nearer root obeys |x| <= 2 |f|/|g|, so bounds of f and g, by running error
analysis, bound the error of whatever method found lambda.
"""

from typing import Any

import numpy as np

from stability import spectrum
from stability.arithmetic import Arithmetic
from stability.balls import FIRST_BITS, LAST_BITS, enclosing
from stability.bounded import INFLATION, Bounded
from stability.certified import Certifier, Tally, exact_float
from stability.model import Form


def guaranteed(
    closure: Any, flow: Any, parameters: dict, point: dict, wavenumber: Any, wave_angle: Any, matrix: str, rtol: float
) -> tuple[np.ndarray, Tally]:
    """Return eigenvalues (waves..., modes) whose real parts err by less than ``rtol`` relative, and how each was reached.

    float64 with its own error bound first; where that is too large, balls of doubling precision. A real part that is
    still not separated from zero at `LAST_BITS` is returned as the centre of its enclosure and tallied as undecided.
    Waves are the given float64 numbers; parameters and point are decimals.
    """
    q, angle = np.broadcast_arrays(np.asarray(wavenumber, float), np.asarray(wave_angle, float))
    certifier, tally = Certifier(closure, flow, parameters, point, matrix), Tally()
    q, angle, shape = q.ravel(), angle.ravel(), q.shape
    found, error = bounded_eigenvalues(certifier.float_base.form(angle, matrix), q)
    with np.errstate(invalid="ignore"):
        good = np.all(error <= rtol * np.abs(found.real), axis=-1)
    tally.add("float64", np.count_nonzero(good))
    for i in np.flatnonzero(~good):
        bits, decided = FIRST_BITS, False
        while not decided and bits <= LAST_BITS:
            row = enclosed_eigenvalues(certifier.form(angle[i], bits), float(q[i]))
            decided = all(radius <= rtol * abs(value.real) for value, radius in row)
            name = enclosing(bits).name
            bits *= 2
        tally.add(name if decided else "undecided", 1)
        if not decided:
            tally.undecided.append((float(angle[i]), float(q[i])))
        found[i] = [value for value, _ in row]
    return found.reshape(*shape, -1), tally


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
            found = list(spectrum.leading_first(*spectrum.pair(plain, wavenumber)))
            trace, determinant = (spectrum.values(form.coefficients[part], q) for part in ("trace", "determinant"))
            errors = [distance(trace, determinant, value) for value in found]
    speed = form.speed if isinstance(form.speed, Bounded) else Bounded(form.speed)
    shifted = [value - 1j * (speed.value * wavenumber) for value in found]
    errors = [np.where(np.isfinite(v) & np.isfinite(e), e, np.inf) for v, e in zip(found, errors, strict=True)]
    return np.stack(shifted, axis=-1), np.stack(errors, axis=-1)


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
    """Return (centre, radius of the real part) of every eigenvalue in ball arithmetic, leading one first."""
    a = form.arithmetic
    q = exact_float(wavenumber, a)
    parts = [spectrum.single_parts(form.coefficients, q)] if "trace" not in form.coefficients else ball_pair(form, q)
    rows = []
    for real, imaginary in parts:
        value = complex(a.centre(real), a.centre(imaginary - form.speed * q))
        rows.append((value, a.size(real - a.number(value.real)) * INFLATION))
    return sorted(rows, key=lambda row: -row[0].real)


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
    """Return an upper bound of how far a ball reaches from its centre."""
    return a.size(ball - a.number(a.centre(ball)))


def complex_root(x: Any, y: Any, a: Arithmetic) -> tuple[Any, Any]:
    """Return a square root of x + i y in real ball arithmetic; which of the two does not matter."""
    modulus = a.sqrt(x * x + y * y)
    if not modulus > 0:  # the balls contain zero: so do both parts, within the root of the modulus
        reach = a.sqrt(a.number(a.size(modulus)))
        return reach * a.unit, reach * a.unit
    if a.centre(x) >= 0:
        real = a.sqrt((modulus + x) / 2)
        return real, y / (2 * real)
    imaginary = a.sqrt((modulus - x) / 2)
    return y / (2 * imaginary), imaginary
