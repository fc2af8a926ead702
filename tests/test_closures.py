"""Every registered closure: its identities hold, its stress dissipates, its mistakes are refused."""

import pytest
from sympy import Matrix, Symbol, simplify

from stability.closures import CLOSURES
from stability.closures.base import Closure, norm
from stability.closures.drucker_prager import PERTURBED, stress
from stability.closures.plane_flow import V, grad_u, momentum_and_mass, velocity
from stability.errors import SceneError
from stability.linearise import state_letters
from stability.parameters import Parameter
from stability.symbols import k, p, symbol


@pytest.mark.parametrize("name", CLOSURES)
def test_relations_between_letters_follow_from_their_definitions(name):
    closure = CLOSURES[name]
    incompressible = closure.flux[2, :] == velocity.T and closure.supply[2] == 0
    constraint = {symbol("v_y"): -symbol("u_x")} if incompressible else {}  # div u = 0 (I7.1)
    for _, vanishing in closure.relations:
        for letter in reversed(state_letters(closure)):
            vanishing = vanishing.subs(letter, closure.letters[letter])
        assert simplify(vanishing.subs(constraint)) == 0


def test_both_systems_share_one_stress():
    rigid, perturbed = CLOSURES["rigid_plastic"], CLOSURES["perturbed"]
    assert rigid.flux[:2, :] == perturbed.flux[:2, :] == stress
    assert rigid.flux[2, :] == velocity.T


def test_plastic_work_is_dissipated():
    # -(sigma - p) : grad u = +k p ||V||: the sign that (I4) prints would feed energy into the flow
    work = -sum((stress - p * Matrix.eye(2)).multiply_elementwise(grad_u))
    assert simplify(work - k * p * norm(V)) == 0


def test_the_stress_is_at_yield():
    # (sigma - p)^2 = k^2 p^2 (I2)
    deviation = stress - p * Matrix.eye(2)
    assert simplify(norm(deviation) ** 2 - k**2 * p**2) == 0


def changed(**attributes) -> Closure:
    given = {n: getattr(PERTURBED, n) for n in PERTURBED.__dataclass_fields__}
    return Closure(**(given | attributes))


def test_a_closure_with_the_wrong_number_of_equations_is_refused():
    with pytest.raises(ValueError, match="3 components of q need 3 entries"):
        changed(supply=PERTURBED.supply[:2, :])


def test_an_undeclared_symbol_is_refused_by_name():
    with pytest.raises(ValueError, match="undeclared symbols.*viscosity_0"):
        changed(flux=PERTURBED.flux * Symbol("viscosity_0", real=True))


def test_a_letter_that_python_reserves_is_refused():
    record = Parameter("slope", "lambda", "1", 0, 1, "slope", "nowhere")
    with pytest.raises(ValueError, match="lambda.*choose other letters"):
        changed(parameters=(*PERTURBED.parameters, record))


def test_an_unknown_name_is_refused_with_the_nearest_one():
    with pytest.raises(SceneError, match="did you mean 'perturbed'"):
        CLOSURES["pertubed"]


def test_the_registry_reads_as_a_dict():
    assert list(CLOSURES)[:2] == ["rigid_plastic", "perturbed"] and "water" not in CLOSURES
    assert repr(CLOSURES) == f"closures: {', '.join(CLOSURES)}"
    assert momentum_and_mass(stress, velocity)["evolves"] == (1, 1, 0)
