"""The paper's two systems: one stress, two mass balances.

Source: S. Hendy, "Instabilities in Granular Flows"; labels are the paper's.
"""

from sympy import ImmutableMatrix, Matrix, eye, sin, sqrt

from stability.closures.base import Closure, norm, strain_rate
from stability.parameters import EPSILON, FRICTION_ANGLE
from stability.symbols import A, body_force, epsilon, gradient, k, mu, norm_V, p, u, v, varphi

velocity = Matrix([u, v])
grad_u = Matrix([gradient(u), gradient(v)])
V = strain_rate(grad_u)

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


def balance_laws(mass_flux: Matrix) -> dict:
    """Return fields, E, F and S of momentum (I7) over the given flux of mass."""
    return {
        "fields": ((u, v), p),
        "evolves": (1, 1, 0),
        "flux": ImmutableMatrix(stress.col_join(mass_flux.T)),
        "supply": ImmutableMatrix([*(Matrix(body_force.tolist()) - grad_u * velocity), 0]),
        "letters": LETTERS,
    }


RIGID_PLASTIC = Closure(
    name="rigid_plastic",
    title="Incompressible rigid-plastic flow",
    source="paper, (I7) and (I7.1)",
    **balance_laws(velocity),  # (I7.1): div u = 0
    parameters=(FRICTION_ANGLE,),
    relations=((A[0, 1], UNIT_NORM), (A[1, 1], A[0, 0] + A[1, 1])),  # (I7.1) makes A trace-free
)

PERTURBED = Closure(
    name="perturbed",
    title="Singularly perturbed rigid-plastic flow",
    source="paper, (P1) and (P1.1)",
    **balance_laws(velocity - epsilon * Matrix(gradient(p))),  # (P1.1): div u = epsilon Lap p
    parameters=(FRICTION_ANGLE, EPSILON),
    relations=((A[0, 1], UNIT_NORM),),
)
