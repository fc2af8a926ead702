"""A march's result: fields with units on the polar grid, formed from the state as the rheology sees it."""

import json
from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from sympy import eye, sin, sqrt

from stability import results
from stability.closures.base import Closure, norm
from stability.closures.plane_flow import V, grad_p, momentum_and_mass, velocity
from stability.model import Model
from stability.parameters import EPSILON, FRICTION_ANGLE
from stability.symbols import epsilon, p, varphi
from stability.timestepper import output
from stability.timestepper.hopper import hopper_problem
from stability.timestepper.integrate import Step
from stability.timestepper.march import March, march
from stability.timestepper.mesh import periodic_cell
from tests.conftest import HOPPER

PARAMETERS = HOPPER | {"epsilon": 1e-4}
LOG = {column: [0, 2] for column in output.LOG}


def problem(kind: str = "polar", elements: int = 60, half: bool = True, floor: float = 0.05):
    mesh = {"kind": kind, "elements": elements, "half": half}
    return hopper_problem("perturbed", "radial_hopper", PARAMETERS, mesh, floor)


@pytest.fixture(scope="module")
def ds():
    return march(March("perturbed", "radial_hopper", PARAMETERS, {"elements": 60}, (0.0, 1e-4)))


def test_every_column_of_the_step_log_is_in_a_result_but_the_seconds():
    assert output.LOG.keys() == Step.__dataclass_fields__.keys() - {"seconds"}
    assert set(output.LOG.values()) <= results.VARIABLES.keys()


def test_every_variable_has_a_unit_and_the_right_dimensions(ds):
    for name in ds.variables:
        assert ds[name].attrs["units"] and ds[name].attrs["long_name"], name
    for name in ("velocity_r", "velocity_theta", "pressure", "strain_rate_norm", "dilation", "viscosity"):
        assert ds[name].dims == ("time", "r", "theta")
    assert all(ds[name].dims == ("step",) for name in output.LOG.values())
    assert (ds.r[0], ds.r[-1], ds.theta[0]) == (0.5, 1.5, 0) and ds.theta[-1] == pytest.approx(15, rel=1e-15)


def test_a_file_reads_back_identically(ds, tmp_path):
    again = results.open_results(results.save(ds, tmp_path / "march.nc"))
    assert again.identical(ds)
    assert {v: again[v].dtype for v in again.variables} == {v: ds[v].dtype for v in ds.variables}


def test_attributes_say_what_was_marched_and_what_was_counted(ds):
    assert (ds.attrs["request"], ds.attrs["closure"], ds.attrs["scheme"]) == ("march", "perturbed", "backward_euler")
    assert json.loads(ds.attrs["steps"]) == {"first": 1e-5, "largest": 5e-4, "smallest": 1e-9}
    assert json.loads(ds.attrs["parameters"]) == PARAMETERS
    assert int(ds.attrs["elements"]) == 60 and int(ds.attrs["checkpoint_every"]) == 20
    for name, count in json.loads(ds.attrs["counted"]).items():
        assert count == {"largest": ds[name].max(), "last": ds[name][-1]}
    assert not any("second" in name for name in [*ds.variables, *ds.attrs]), "no times of a clock"


@pytest.mark.parametrize("kind", ["polar", "graded", "diamond"])
@pytest.mark.parametrize("half", [True, False])
def test_the_initial_state_is_that_of_the_theory_at_second_order(kind, half):
    """Nodal gradients are means over control volumes: errors inside fall fourfold as cells are halved."""
    worst = []
    for elements in (300, 1200, 4800):
        one = problem(kind, elements, half)
        found = output.dataset(one, [0.0], [one.initial], LOG)
        points = {"r": 1.0 + 0 * found.theta.values, "theta": found.theta.values}
        letters = Model("perturbed", "radial_hopper").base(PARAMETERS, points).letters()
        inside = found.isel(time=0).interp(r=1.0)
        keep = abs(found.theta.values) < 12
        assert_allclose(inside.velocity_theta, 0, atol=1e-12)  # roundings of speeds of 1 to 3 m/s
        for name, letter in (("strain_rate_norm", "N"), ("viscosity", "mu")):
            worst.append(np.max(abs(inside[name].values / letters[letter] - 1)[keep]))
    for errors in (worst[::2], worst[1::2]):
        assert errors[2] < errors[0] / 8, errors  # 16 expected; the grid does not always have r = 1
        assert errors[2] < 2e-3


def test_the_floor_bounds_the_norm_in_delta_and_mu_alone():
    one, other = problem(floor=0.05), problem(floor=5.0)
    free, bounded = (output.fields(each, each.initial) for each in (one, other))
    assert_array_equal(free["strain_rate_norm"], bounded["strain_rate_norm"])
    norm = free["strain_rate_norm"]
    assert (norm < 5).any() and (norm > 5).any()
    expected = np.where(norm > 5, norm, (norm**2 + 25) / 10)
    assert_allclose(bounded["viscosity"] * expected, free["viscosity"] * norm, rtol=1e-13)  # k p, roundings
    assert_allclose(bounded["dilation"] * expected, free["dilation"] * norm, rtol=1e-13, atol=1e-15)


def test_matter_at_rest_has_finite_delta_and_mu():
    one = problem()
    still = one.initial * (0, 0, 1)
    found = output.fields(one, still)
    assert all(np.isfinite(values).all() for values in found.values())
    assert not found["strain_rate_norm"].any()


def test_a_closure_without_the_letter_mu_has_no_viscosity():
    stress = p * eye(2) - sqrt(2) * sin(varphi) * p * V / norm(V)
    laws = momentum_and_mass(stress, velocity - epsilon * grad_p)
    bare = Closure("bare", "Without letters", "this test", **laws, parameters=(FRICTION_ANGLE, EPSILON))
    one = hopper_problem(bare, "radial_hopper", PARAMETERS, {"elements": 60})
    expected = output.fields(problem(), one.initial)
    del expected["viscosity"]
    found = output.fields(one, one.initial)
    assert found.keys() == expected.keys()
    for name, values in expected.items():
        assert_array_equal(found[name], values)


def test_a_mesh_without_a_polar_grid_is_refused():
    with pytest.raises(ValueError, match="has no polar grid"):
        output.polar_grid(periodic_cell(1.0, 5))
    bent = problem().mesh
    nodes = bent.nodes.copy()
    nodes[7] += 1e-6
    with pytest.raises(ValueError, match="do not lie on arcs and rays"):
        output.polar_grid(replace(bent, nodes=nodes))


def test_findings_are_made_from_the_dataset_alone(ds, tmp_path):
    rows = output.findings(ds)
    assert rows == output.findings(results.open_results(results.save(ds, tmp_path / "march.nc")))
    said = "\n".join(text for _, text in rows)
    for phrase in ("polar, 60 elements over half the wedge", "to t = 0.0001 s, 2 snapshots", "(backward_euler)",
                   "factorisations, 0 rejected tries", "below the floor: 0 at the end, 0 at most, of 60"):  # fmt: skip
        assert phrase in said
