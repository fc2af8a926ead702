"""The base states: published and computed numbers, exactness on the axis, boundary conditions, refusals."""

import pytest
from mpmath import mpf
from numpy.testing import assert_allclose
from sympy import Float, Matrix, cos, rad, sin, tan

from stability.arithmetic import multiprecision
from stability.errors import SceneError
from stability.flows import FLOWS
from stability.flows.radial_hopper import RADIAL_HOPPER
from stability.model import Model
from stability.symbols import symbol

DIGITS = multiprecision(50)


def test_constants_of_the_hopper_reproduce_the_reference(hopper, reference):
    found = Model("rigid_plastic", "radial_hopper", DIGITS).base(hopper, {"r": 1, "theta": 0}).flow_letters
    expected = reference["meta"]["derived"]
    for name in ("Psi_w", "w", "F"):
        assert abs(found[name] / mpf(expected[name]) - 1) < mpf(10) ** -35  # at least 35 digits are significant


def test_the_base_state_reproduces_the_reference(hopper, reference):
    for row in reference["points"]:
        base = Model("perturbed", "radial_hopper", DIGITS).base(
            hopper | {"epsilon": "2e-5"}, {"r": row["r"], "theta": row["theta_deg"]}
        )
        letters = base.letters()
        (velocity, _, _), (p, p_gradient, p_hessian) = base.state
        pairs = {
            "p": p,
            "dp_dr": p_gradient[0],
            "lap_p": p_hessian[0][0] + p_hessian[1][1],
            "u_r": velocity[0],
            "normV": letters["N"],
            "mu": letters["mu"],
            "A_rr": letters["A_xx"],
            "A_rtheta": letters["A_xy"],
        }
        for name, value in pairs.items():
            assert abs(value - mpf(row[name])) <= mpf(10) ** -34 * (1 + abs(mpf(row[name]))), name


@pytest.mark.parametrize("r", ["0.51", "0.75", "1", "1.49"])
def test_the_radial_flow_solves_the_equations_exactly_on_the_axis(hopper, r):
    residual = Model("rigid_plastic", "radial_hopper", DIGITS).base(hopper, {"r": r, "theta": 0}).imbalance()
    assert max(map(abs, residual)) < mpf(10) ** -45  # 50 digits, terms of order 10


def test_the_residual_off_the_axis_is_the_stated_one(hopper):
    residual = Model("rigid_plastic", "radial_hopper").base(hopper, {"r": 1.0, "theta": 5.0}).imbalance()
    assert_allclose(residual[1], -2.19, atol=0.005)  # computed at 40 digits; printed to three in the documentation
    assert abs(residual[2]) < 1e-15  # div u = 0 exactly


def test_mass_residual_of_the_perturbed_system_is_epsilon_laplacian_p_or_zero(perturbed_hopper):
    point = {"r": "0.75", "theta": 3}
    plain, compatible = (
        Model("perturbed", flow, DIGITS).base(perturbed_hopper, point)
        for flow in ("radial_hopper", "radial_hopper_compatible")
    )
    laplacian = plain.state[1][2][0][0] + plain.state[1][2][1][1]
    assert abs(plain.imbalance()[2] + mpf("2e-5") * laplacian) < mpf(10) ** -40
    assert abs(compatible.imbalance()[2]) < mpf(10) ** -45


def test_the_pressure_vanishes_on_both_arcs(hopper):
    for r in ("0.5", "1.5"):
        # Just inside: the arcs themselves lie outside the open hopper. p is linear there with a slope of order 100.
        shift = "1e-30" if r == "0.5" else "-1e-30"
        at = DIGITS.number(r) + DIGITS.number(shift)
        base = Model("rigid_plastic", "radial_hopper", DIGITS).base(hopper, {"r": at, "theta": 0})
        assert abs(base.state[1][0]) < mpf(10) ** -27


def test_stress_at_the_wall_satisfies_coulomb_friction_to_leading_order():
    # With tan 2Psi = 2 s_rt/(s_rr - s_tt): |s_rt| = tan(varphi_w) s_tt at Psi = Psi_w, by (R8)
    varphi, varphi_w = symbol("varphi"), symbol("varphi_w")
    values = {varphi: rad(34), varphi_w: rad(9)}
    twice = 2 * RADIAL_HOPPER.letters[symbol("Psi_w")]
    shear, normal = sin(varphi) * sin(twice), 1 + sin(varphi) * cos(twice)
    assert abs((shear - tan(varphi_w) * normal).subs(values).evalf(40)) < Float("1e-38")


@pytest.mark.parametrize("delta", [-1.4, -0.3, 0.0, 0.5, 1.0, 1.4142])
def test_uniform_strain_has_the_delta_and_the_norm_it_was_given(delta):
    base = Model("perturbed", "uniform_strain").base(
        {"friction_angle": 34, "epsilon": 1e-3, "delta": delta, "strain_rate": 3.0, "pressure": 2.0}, {}
    )
    letters = base.letters()
    assert_allclose(letters["A_xx"] + letters["A_yy"], delta, atol=4e-16)
    assert_allclose(letters["N"], 3.0, rtol=4e-16)
    assert letters["A_xx"] > letters["A_yy"]  # extension along x


REFUSALS = {
    "wall_friction_angle must not exceed": {"wall_friction_angle": 35},
    "outlet_radius must be less": {"outlet_radius": 1.6, "inlet_radius": 1.5},
    "r must lie between": {"r": 0.4},
    "must not exceed wedge_angle": {"theta": 16},
    "wedge_angle = 90": {"wedge_angle": 90},
    "r = -1": {"r": -1},
    "theta is missing": {"theta": None},
    "gravity is missing": {"gravity": None},
}


@pytest.mark.parametrize("sentence", REFUSALS)
def test_bad_input_is_refused_with_one_clear_sentence(hopper, sentence):
    values = hopper | {"r": 1.0, "theta": 0.0} | REFUSALS[sentence]
    values = {w: v for w, v in values.items() if v is not None}
    point = {w: values.pop(w) for w in ("r", "theta") if w in values}
    with pytest.raises(SceneError, match=sentence):
        Model("rigid_plastic", "radial_hopper").base(values, point)


def test_w_equal_to_one_is_refused():
    # Decimal parameters hardly ever meet w = 1 exactly, so the relation itself is tested.
    relation, sentence = RADIAL_HOPPER.conditions[2]
    assert not relation.subs(symbol("w"), 1) and relation.subs(symbol("w"), 2)
    assert "w = 1" in sentence


@pytest.mark.parametrize("name", FLOWS)
def test_every_flow_gives_every_field_and_its_body_force(name):
    flow = FLOWS[name]
    assert [str(f) for f in flow.fields][:3] == ["u", "v", "p"] and Matrix(flow.body_force).shape == (2, 1)
