"""Enclosures of everything about one wave: D itself, its trace, determinant, eigenvalues, and the verdict's quantity N.

Complex numbers are pairs of real balls, so that Arb and mpmath intervals serve alike.
"""

from dataclasses import dataclass
from typing import Any

from stability import spectrum
from stability.arithmetic import Arithmetic
from stability.balls import FIRST_BITS, exact_float
from stability.certified import Certifier
from stability.enclosures import ball_pair
from stability.model import Base

Pair = tuple[Any, Any]  # real and imaginary part


@dataclass(frozen=True)
class Enclosure:
    """Balls that contain the exact values for one wave; complex ones are pairs (real, imaginary).

    Attributes
    ----------
    D : 2 x 2, in the flow's local frame, drift included
    trace, determinant : of D for an observer who moves with the flow; None under an exact constraint
    eigenvalues : drift included
    N : the stability polynomial, positive where stable (`spectrum.stability_polynomial`)
    arithmetic : what computed them
    """

    D: tuple[tuple[Pair, Pair], tuple[Pair, Pair]]
    trace: Pair | None
    determinant: Pair | None
    eigenvalues: tuple[Pair, ...]
    N: Any
    arithmetic: str


def enclosure(
    closure: Any,
    flow: Any,
    parameters: dict,
    point: dict,
    wavenumber: float,
    wave_angle: float,
    matrix: str = "full",
    bits: int = FIRST_BITS,
) -> Enclosure:
    """Return enclosures of D (L3.1, P3), of its invariants and of N, for one wave.

    Parameters
    ----------
    closure, flow, parameters, point, matrix : as in `stability.eigenvalues`; parameters and point are decimals
    wavenumber, wave_angle : 1/m and degrees, exact float64 numbers; D itself is that of the full matrix
    bits : working precision; `enclosing` says which arithmetic

    Raises
    ------
    SceneError : a parameter or a point outside its range
    """
    certifier = Certifier(closure, flow, parameters, point, matrix)
    form, base = certifier.form(float(wave_angle), bits), certifier.base(bits)
    a = form.arithmetic
    q = exact_float(float(wavenumber), a)
    two = "trace" in form.coefficients
    parts = ball_pair(form, q) if two else [spectrum.single_parts(form.coefficients, q)]
    cosine, sine = a.direction(exact_float(float(wave_angle), a), a)
    return Enclosure(
        D=tangent_matrix(base, (q * cosine, q * sine), a),
        trace=spectrum.values(form.coefficients["trace"], q) if two else None,
        determinant=spectrum.values(form.coefficients["determinant"], q) if two else None,
        eigenvalues=tuple((real, imaginary - form.speed * q) for real, imaginary in parts),
        N=spectrum.evaluate(spectrum.stability_polynomial(form.coefficients), q),
        arithmetic=a.name,
    )


def times(x: Pair, y: Pair) -> Pair:
    """Return a product."""
    return x[0] * y[0] - x[1] * y[1], x[0] * y[1] + x[1] * y[0]


def over(x: Pair, y: Pair) -> Pair:
    """Return a quotient."""
    size = y[0] * y[0] + y[1] * y[1]
    return (x[0] * y[0] + x[1] * y[1]) / size, (x[1] * y[0] - x[0] * y[1]) / size


def minus(x: Pair, y: Pair) -> Pair:
    """Return a difference."""
    return x[0] - y[0], x[1] - y[1]


def tangent_matrix(base: Base, xi: tuple, a: Arithmetic) -> tuple:
    """Return D from the pencil in balls: the Schur complement (P3), or the projection (L3.1)."""
    second, first, zeroth = base.pencil()
    axes = (0, 1)

    def L(i: int, j: int) -> Pair:
        real = zeroth[i][j] - sum(xi[b] * xi[c] * second[b][c][i][j] for b in axes for c in axes)
        return real + a.number(0), sum(xi[b] * first[b][i][j] for b in axes) + a.number(0)

    C = [[L(i, j) for j in axes] for i in axes]
    B, row, corner = [L(i, 2) for i in axes], [L(2, j) for j in axes], L(2, 2)
    if base.model.modes == 2:
        return tuple(tuple(minus(C[i][j], over(times(B[i], row[j]), corner)) for j in axes) for i in axes)
    size = times(row[0], B[0]), times(row[1], B[1])
    along = size[0][0] + size[1][0], size[0][1] + size[1][1]
    lost = [[times(row[0], C[0][j]), times(row[1], C[1][j])] for j in axes]
    total = [(one[0] + other[0], one[1] + other[1]) for one, other in lost]
    return tuple(tuple(minus(C[i][j], over(times(B[i], total[j]), along)) for j in axes) for i in axes)
