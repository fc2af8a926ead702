"""Approximate radial flow in a wedge hopper: the paper's appendix, corrected.

Written in Cartesian coordinates (x along e_r, y along e_theta) about the point (r, theta): a neighbour (x, y)
lies at the radius ``R`` and at the angle ``Theta``. The printed appendix has a wrong sign of the speed (R9), a
misprinted prefactor (R7) and a definition of Psi that contradicts w; `derivations` holds the evidence.
"""

from math import inf

from sympy import And, Ne, asin, atan, cos, sin, sqrt

from stability.flows.base import Flow
from stability.parameters import EPSILON, FRICTION_ANGLE, Parameter
from stability.symbols import epsilon, p, r, symbol, theta, u, v, varphi, x, y

varphi_w, theta_w, g = symbol("varphi_w"), symbol("theta_w"), symbol("g")
r_0, r_1 = symbol("r_0"), symbol("r_1")
Psi_w, w, F = symbol("Psi_w"), symbol("w"), symbol("F")

R = sqrt((r + x) ** 2 + y**2)
Theta = theta + atan(y / (r + x))

LETTERS = {
    Psi_w: (varphi_w + asin(sin(varphi_w) / sin(varphi))) / 2,  # (R8): (I6) at yield, tan 2Psi = 2s_rt/(s_rr - s_tt)
    w: 2 * sin(varphi) / (1 - sin(varphi)) * (1 + Psi_w / theta_w),  # after (R8)
    F: sqrt((w + 2) / (w - 1) * (1 - (r_0 / r_1) ** (w - 1)) / (1 - (r_0 / r_1) ** (w + 2))),  # p0(r_1) = 0
}


def pressure(rho):
    """Return p0 at the radius rho (R7), with the prefactor g r_0 that is printed as 5_0."""
    z = rho / r_0
    bracket = (F**2 / (w + 2) - 1 / (w - 1)) * z**w + z / (w - 1) - F**2 / (w + 2) / z**2
    return g * r_0 / (1 - sin(varphi)) * bracket


def pressure_regrouped(rho):
    """Return the same p0, F^2 written out and z^w gathered into (rho/r_1)^w: what is computed.

    As printed, the coefficient of z^w is a difference of two nearly equal numbers and z^w overflows, which costs all
    digits of p0 from a friction angle of some 75 degrees on. That the two are equal is proved in `derivations.radial`.
    """
    z, ratio = rho / r_0, r_0 / r_1
    rest = 1 - ratio ** (w + 2)
    bracket = z - (1 - ratio ** (w - 1)) / rest / z**2 - (rho / r_1) ** w * (1 / ratio - ratio**2) / rest
    return g * r_0 / (1 - sin(varphi)) * bracket / (w - 1)


def speed(rho, angle):
    """Return the speed towards the apex (R9)."""
    return sqrt(g * r_0) * F * (1 - 2 * theta_w * Psi_w * (angle / theta_w) ** 2) * r_0 / rho


# e_r at the neighbour is ((r + x), y)/R in the local frame; the flow is inward.
VELOCITY = (-speed(R, Theta) * (r + x) / R, -speed(R, Theta) * y / R)

GEOMETRY = (
    FRICTION_ANGLE,
    Parameter("wall_friction_angle", "varphi_w", "deg", 0, 90, "angle of wall friction", "paper, I6"),
    Parameter("wedge_angle", "theta_w", "deg", 0, 90, "half angle of the wedge", "paper, appendix"),
    Parameter("outlet_radius", "r_0", "m", 0, inf, "radius of the outflow arc", "paper, R7"),
    Parameter("inlet_radius", "r_1", "m", 0, inf, "radius of the inflow arc", "paper, R7"),
    Parameter("gravity", "g", "m/s2", 0, inf, "acceleration due to gravity", "paper, I1"),
)

RADIAL_HOPPER = Flow(
    name="radial_hopper",
    title="Approximate radial hopper flow",
    source="paper, appendix (R2) to (R10), corrected",
    fields={u: VELOCITY[0], v: VELOCITY[1], p: pressure_regrouped(R)},
    body_force=(-g * cos(theta), g * sin(theta)),
    point=(
        Parameter("r", "r", "m", 0, inf, "distance from the apex", "paper, appendix"),
        Parameter("theta", "theta", "deg", -90, 90, "angle from the hopper's axis", "paper, appendix"),
    ),
    parameters=GEOMETRY,
    letters=LETTERS,
    conditions=(
        (
            varphi_w <= varphi,
            "wall_friction_angle must not exceed friction_angle: the wall would be rougher than the material",
        ),
        (r_0 < r_1, "outlet_radius must be less than inlet_radius"),
        (
            Ne(w, 1),
            "w = 1 makes the radial solution (R7) singular: change wedge_angle or an angle of friction slightly",
        ),
        (F**2 > 0, "F^2 is not positive: there is no radial solution with stress-free arcs for these parameters"),
        (And(r_0 < r, r < r_1), "the point lies outside the hopper: r must lie between outlet_radius and inlet_radius"),
        (
            And(-theta_w <= theta, theta <= theta_w),
            "the point lies outside the hopper: |theta| must not exceed wedge_angle",
        ),
    ),
    axis="the local e_r, towards e_theta",
)

RADIAL_HOPPER_COMPATIBLE = Flow(
    name="radial_hopper_compatible",
    title="Radial hopper flow that satisfies the perturbed mass balance",
    source="paper, appendix, with u + epsilon grad p0 so that (P1.1) holds",
    fields={
        u: VELOCITY[0] + epsilon * pressure_regrouped(R).diff(x),
        v: VELOCITY[1] + epsilon * pressure_regrouped(R).diff(y),
        p: pressure_regrouped(R),
    },
    body_force=RADIAL_HOPPER.body_force,
    point=RADIAL_HOPPER.point,
    parameters=(*GEOMETRY, EPSILON),
    letters=LETTERS,
    conditions=RADIAL_HOPPER.conditions,
    axis=RADIAL_HOPPER.axis,
)
