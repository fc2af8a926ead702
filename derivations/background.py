"""Numbers of a base state: the jets of a flow at a point, and what the package's matrices are there."""

from collections.abc import Mapping
from dataclasses import replace
from functools import cache

from sympy import Expr, Matrix, N, Rational, Symbol, cos, pi, sin

from stability.closures.base import Closure
from stability.closures.drucker_prager import RIGID_PLASTIC
from stability.flows.base import Flow
from stability.flows.radial_hopper import R, g, pressure, r_0, r_1, theta_w, varphi_w
from stability.linearise import imbalance, letter_gradients
from stability.symbols import body_force, epsilon, gradient, hessian, p, r, theta, varphi
from stability.tangent import tangent

PRECISION = 60
DEGREE = pi / 180
# Printed: the two angles and epsilon (figure P2.1). Not printed, assumed: the wedge, its arcs, g.
HOPPER = {
    varphi: 34 * DEGREE,
    varphi_w: 9 * DEGREE,
    epsilon: Rational(2, 100000),
    theta_w: 15 * DEGREE,
    r_0: Rational(1, 2),
    r_1: Rational(3, 2),
    g: Rational(981, 100),
}
GEOMETRY = "example hopper"  # as the evidence calls it
GEOMETRY_MEANS = (
    "φ_f = 34°, φ_w = 9° (printed); θ_w = 15°, r₀ = 0.5 m, r₁ = 1.5 m, g = 9.81 m/s² (assumed: the paper gives none)"
)
Values = dict[Symbol, Expr]


def at(radius: Expr, degrees: Expr = 0) -> Values:
    """Return the coordinates of a point of the hopper."""
    return {r: Rational(radius), theta: Rational(degrees) * DEGREE}


def letters_of(flow: Flow, parameters: Mapping[Symbol, Expr]) -> Values:
    """Return the flow's constants as numbers."""
    values: Values = {s: N(e, PRECISION) for s, e in parameters.items()}
    for letter, definition in flow.letters.items():
        values[letter] = N(definition.xreplace(values), PRECISION)
    return values


@cache
def derivatives(flow: Flow) -> dict[Symbol, Expr]:
    """Return value, gradient and second gradient of every field at the point, and gravity, as expressions."""
    # p0 as (R7) has it; `radial` proves that the regrouped form which the flow computes with is the same.
    as_printed = replace(flow, fields={p: pressure(R)}).jet()
    return flow.jet() | as_printed | dict(zip(body_force, flow.body_force, strict=True))


def state(flow: Flow, point: Values, closure: Closure = RIGID_PLASTIC, reverse: bool = False) -> Values:
    """Return everything a matrix or a balance needs at a point; ``reverse`` turns the velocity round."""
    values = letters_of(flow, HOPPER | point)
    values |= {s: N(e.xreplace(values), PRECISION) for s, e in derivatives(flow).items()}
    if reverse:
        turned = {s for c in closure.q[:2] for s in (c, *gradient(c), *sum(hessian(c), ()))}
        values |= {s: -values[s] for s in turned}
    for letter, definition in (closure.letters | letter_gradients(closure)).items():
        values[letter] = N(definition.xreplace(values), PRECISION)
    return values


def residual(values: Values, closure: Closure = RIGID_PLASTIC) -> list[Expr]:
    """Return what the state lacks in each balance law."""
    return [N(e.xreplace(values), PRECISION) for e in imbalance(closure)]


def eigenvalues(closure: Closure, values: Values, wavenumber: Expr, angle: Expr, matrix: str = "full") -> list[Expr]:
    """Return the eigenvalues by decreasing real part; for a rigid-plastic closure only Tr D."""
    xi = tuple(N(wavenumber * e, PRECISION) for e in (cos(angle), sin(angle)))
    D = Matrix(tangent(closure, xi, matrix)).xreplace(values).applyfunc(lambda e: N(e, PRECISION))
    if closure is RIGID_PLASTIC:
        return [N(D.trace().expand(), PRECISION)]
    half, root = D.trace() / 2, N((D.trace() ** 2 / 4 - D.det()).expand() ** Rational(1, 2), PRECISION)
    found = [N((half + sign * root).expand(), PRECISION) for sign in (1, -1)]
    return sorted(found, key=lambda e: -e.as_real_imag()[0])
