"""Balance laws of momentum and mass for a plane flow (u, v, p): what most rheologies need besides their stress."""

from sympy import ImmutableMatrix, Matrix

from stability.closures.base import strain_rate
from stability.symbols import body_force, gradient, p, u, v

velocity = Matrix([u, v])
grad_u = Matrix([gradient(u), gradient(v)])
grad_p = Matrix(gradient(p))
V = strain_rate(grad_u)


def momentum_and_mass(stress: Matrix, mass_flux: Matrix) -> dict:
    """Return fields, E, F and S of ``Du/Dt = g - div stress`` (I7), stress over density, and ``div mass_flux = 0``."""
    return {
        "fields": ((u, v), p),
        "evolves": (1, 1, 0),
        "flux": ImmutableMatrix(stress.col_join(mass_flux.T)),
        "supply": ImmutableMatrix([*(Matrix(body_force.tolist()) - grad_u * velocity), 0]),
    }
