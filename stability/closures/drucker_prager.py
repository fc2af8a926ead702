"""The paper's two systems: one stress, two mass balances.

Source: S. Hendy, "Instabilities in Granular Flows"; labels are the paper's.
"""

from sympy import eye, sin, sqrt

from stability.closures.base import Closure, norm
from stability.closures.plane_flow import V, grad_p, momentum_and_mass, velocity
from stability.parameters import EPSILON, FRICTION_ANGLE
from stability.symbols import A, epsilon, k, mu, norm_V, p, varphi

stress = p * eye(2) - k * p * V / norm(V)  # (I7), (P1): sigma/rho; (I4) prints the opposite sign of mu

LETTERS = {
    k: sqrt(2) * sin(varphi),  # (I2)
    norm_V: norm(V),
    A[0, 0]: V[0, 0] / norm_V,  # after (I7.1)
    A[0, 1]: V[0, 1] / norm_V,
    A[1, 1]: V[1, 1] / norm_V,
    mu: k * p / norm_V,  # (I5), over density
}
UNIT_NORM = A[0, 0] ** 2 + 2 * A[0, 1] ** 2 + A[1, 1] ** 2 - 1  # A:A = 1

RIGID_PLASTIC = Closure(
    name="rigid_plastic",
    title="Incompressible rigid-plastic flow",
    source="paper, (I7) and (I7.1)",
    **momentum_and_mass(stress, velocity),  # (I7.1): div u = 0
    parameters=(FRICTION_ANGLE,),
    letters=LETTERS,
    relations=((A[0, 1], UNIT_NORM), (A[1, 1], A[0, 0] + A[1, 1])),  # (I7.1) makes A trace-free
)

PERTURBED = Closure(
    name="perturbed",
    title="Singularly perturbed rigid-plastic flow",
    source="paper, (P1) and (P1.1)",
    **momentum_and_mass(stress, velocity - epsilon * grad_p),  # (P1.1): div u = epsilon Lap p
    parameters=(FRICTION_ANGLE, EPSILON),
    letters=LETTERS,
    relations=((A[0, 1], UNIT_NORM),),
)
