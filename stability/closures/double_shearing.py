"""Spencer's double-shearing model: plastic slip along both families of stress characteristics.

Source: Spencer, J. Mech. Phys. Solids 12, 1964. The stress is at yield, ``p + s p (2 n n - 1)`` with n the direction
of the major principal (most compressive) stress and s = sin(varphi); the strain rate is not coaxial with it. Simple
shears along the two characteristics, at +-(45 - varphi/2) degrees from n in axes that turn with n, give with psi the
angle of n

    2 s Dpsi/Dt = s (v_x - u_y) + (u_y + v_x) cos 2psi - (u_x - v_y) sin 2psi,        div u = 0

The direction is carried as a unit vector n, Dn/Dt = (Dpsi/Dt) n_perp, because the angle is no scalar of the frame; its
length is conserved, which adds a third, neutral mode. Every term is of first order, so the growth is that of

    lambda^2 = p q^2 (cos 2theta - s)^2/(1 - s cos 2theta)

with theta from the minor principal stress axis: positive in every direction but the two stress characteristics.
"""

from sympy import ImmutableMatrix, Matrix, eye, sin

from stability.closures.base import Closure
from stability.closures.plane_flow import V, grad_u, momentum_and_mass, velocity
from stability.parameters import FRICTION_ANGLE
from stability.symbols import gradient, p, symbol, varphi

n1, n2 = symbol("n1"), symbol("n2")  # the director; n_x would read as a derivative
n = Matrix([n1, n2])
across = Matrix([-n2, n1])
length2 = n1**2 + n2**2  # one, written out so that the law does not depend on the length
s = sin(varphi)

stress = p * eye(2) + s * p * (2 * n * n.T / length2 - eye(2))
spin = (grad_u[1, 0] - grad_u[0, 1]) / 2
turn = (
    spin + (n.T * V * across)[0] / length2 / s
)  # Dpsi/Dt; n.V.n_perp = [(u_y + v_x) cos 2psi - (u_x - v_y) sin 2psi]/2
grad_n = Matrix([gradient(n1), gradient(n2)])

_plane = momentum_and_mass(stress, velocity)

DOUBLE_SHEARING = Closure(
    name="double_shearing",
    title="Spencer's double-shearing model",
    source="Spencer, J. Mech. Phys. Solids 12, 1964",
    fields=(*_plane["fields"], (n1, n2)),
    evolves=(*_plane["evolves"], 1, 1),
    flux=ImmutableMatrix(_plane["flux"].col_join(Matrix.zeros(2, 2))),
    supply=ImmutableMatrix([*_plane["supply"], *(turn * across - grad_n * velocity)]),
    parameters=(FRICTION_ANGLE,),
)
