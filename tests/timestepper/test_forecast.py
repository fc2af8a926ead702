"""What a march will be is told from its mesh and its base state, before anything runs."""

import json
from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

import stability as st
from stability.timestepper import forecast as forecasting
from stability.timestepper.forecast import CELLS, COST, FASTEST, cell_size, forecast, largest_viscosity
from stability.timestepper.integrate import SCHEMES
from stability.timestepper.linear import SOLVERS
from stability.timestepper.march import March
from stability.timestepper.mesh import hopper_mesh
from tests.conftest import HOPPER

ASKED = March("perturbed", "radial_hopper", HOPPER | {"epsilon": 1e-4}, {"elements": 4000}, (0.0, 0.1))


def test_the_numbers_are_those_of_the_mesh_that_is_marched():
    for kind, half in (("polar", True), ("graded", False), ("diamond", True)):
        asked = replace(ASKED, mesh={"kind": kind, "elements": 500, "half": half})
        found, problem = forecast(asked), asked.problem()
        assert found.elements == len(problem.mesh.elements) and found.unknowns == problem.initial.size
        assert found.mesh.startswith(f"{kind}, {found.elements} elements over ")
        assert ("half the wedge" in found.mesh) is half


@pytest.mark.parametrize("epsilon", [1e-4, 2e-5])
def test_the_predicted_wavenumber_grows_fastest_of_all(epsilon):
    """At (1 m, 0), over all directions; the maximum is flat: 3 % in the wavenumber cost 0.1 % of the growth."""
    hopper = HOPPER | {"epsilon": epsilon}
    mu = float(st.growth_map("perturbed", "radial_hopper", hopper, {"r": 1, "theta": 0}, [1.0], [0.0]).viscosity)
    expected = FASTEST / np.sqrt(mu * epsilon)
    wavenumber, angle = np.geomspace(expected / 3, expected * 3, 241), np.linspace(0, 180, 361)
    growth = st.growth_map("perturbed", "radial_hopper", hopper, {"r": 1, "theta": 0}, wavenumber, angle).growth_rate
    assert_allclose(float(growth.max("wave_angle").idxmax("wavenumber")), expected, rtol=0.03)


def test_the_largest_viscosity_is_that_of_the_axis():
    r, mu = largest_viscosity(ASKED)
    elsewhere = st.growth_map(
        "perturbed", "radial_hopper", ASKED.parameters, {"r": [r - 0.1, r, r + 0.1], "theta": [0.0] * 3}, [1.0], [0.0]
    ).viscosity
    assert_allclose(elsewhere[1], mu, rtol=1e-12)
    assert np.argmax(elsewhere.values) == 1


@pytest.mark.parametrize("kind", ["polar", "graded", "diamond"])
def test_the_cell_size_is_that_of_the_elements_nearby(kind):
    mesh = hopper_mesh(0.5, 1.5, np.deg2rad(15), 4000, kind)
    area = np.deg2rad(15) * (1.5**2 - 0.5**2) / 2
    mean = np.sqrt(area / len(mesh.elements))
    assert 0.5 * mean < cell_size(mesh, 1.2) < 2 * mean
    if kind == "graded":
        assert_allclose(cell_size(mesh, 1.2) / cell_size(mesh, 0.6), 2, rtol=0.05)  # squares that grow with r; one cell


def test_few_cells_in_a_wavelength_are_warned_of_with_the_number_that_would_do():
    coarse = forecast(replace(ASKED, mesh={"elements": 500}))
    (warning,) = coarse.warnings
    assert coarse.cells_per_wavelength < CELLS and "too few" in warning
    enough = float(warning.split("; ")[1].split()[0])
    fine = forecast(replace(ASKED, mesh={"elements": round(1.1 * enough)}))
    assert not fine.warnings and fine.cells_per_wavelength >= CELLS
    assert fine.wavelength == coarse.wavelength


def test_without_epsilon_no_wavelength_is_predicted_and_the_mesh_is_warned_of():
    found = forecast(replace(ASKED, closure="rigid_plastic", parameters=HOPPER))
    assert found.wavelength is None and found.cells_per_wavelength is None
    (warning,) = found.warnings
    assert "rigid_plastic has no time scale epsilon" in warning


def test_a_flow_may_have_epsilon_where_the_closure_has_none():
    asked = replace(ASKED, flow="radial_hopper_compatible")
    assert forecast(asked).wavelength == pytest.approx(forecast(ASKED).wavelength, rel=0.02)  # u + epsilon grad p0


def test_cost_grows_with_elements_steps_and_time():
    one = forecast(ASKED)
    assert one.steps == pytest.approx(0.1 / 5e-4, rel=0.1)
    per_step = (one.predicted_seconds - COST["start"]) / one.steps
    assert per_step == pytest.approx(COST["seconds"] * COST["banded"] * (one.elements / 4000) ** COST["power"])
    longer = forecast(replace(ASKED, snapshots=(0.0, 0.2)))
    assert longer.predicted_seconds == pytest.approx(2 * one.predicted_seconds, rel=0.1)
    assert forecast(replace(ASKED, snapshots=(1e-9,))).steps == 1


def test_every_scheme_and_solver_has_its_cost():
    assert {*SCHEMES, *SOLVERS} <= forecasting.COST.keys()


def test_a_forecast_is_rows_and_json():
    found = forecast(ASKED)
    assert json.loads(found.text)["predicted_seconds"] == found.predicted_seconds
    assert [name for name, _ in found.rows()] == ["mesh", "unknowns", "time", "cost"]
    assert "backward Euler, steps of 1e-05 to 0.0005 s" in found.time
    assert any(reason.startswith("waves: ") for reason in found.reasons)
