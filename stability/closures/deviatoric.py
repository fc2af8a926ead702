"""The flow rule that the paper offers in (P1.2): the deviator of the strain rate over the norm of the whole of it.

It regularises nothing: for every 0 < |delta| < 1 the leading matrix has the eigenvalue ``-Lambda delta (delta +
C)/2``, positive in a wedge, up to ``(Lambda/2)|delta|(sqrt(2 - delta^2) - |delta|)``. The paper's (P5) to (P9) belong
to the full rule of `perturbed`; `derivations.flow_rules` proves both.
"""

from sympy import eye

from stability.closures.base import Closure, norm
from stability.closures.drucker_prager import LETTERS, UNIT_NORM
from stability.closures.plane_flow import V, grad_p, momentum_and_mass, velocity
from stability.parameters import EPSILON, FRICTION_ANGLE
from stability.symbols import A, epsilon, k, p

stress = p * eye(2) - k * p * (V - V.trace() / 2 * eye(2)) / norm(V)  # (P1.2) with (I5), its sign corrected

DEVIATORIC = Closure(
    name="deviatoric",
    title="Singularly perturbed flow with the deviatoric flow rule",
    source="paper, (P1.1) and (P1.2)",
    **momentum_and_mass(stress, velocity - epsilon * grad_p),
    parameters=(FRICTION_ANGLE, EPSILON),
    letters=LETTERS,
    relations=((A[0, 1], UNIT_NORM),),
)
