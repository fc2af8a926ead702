"""The time-stepper's own results as fields: its files read back, and its gradients against those made here."""

import json

import numpy as np
import pytest
from numpy.testing import assert_allclose

from stability import results
from stability.field.mapping import field_map
from stability.field.reading import read_field
from stability.field.writing import write_vtk
from stability.timestepper.march import March, march
from stability.timestepper.paraview import write_paraview
from tests.conftest import HOPPER

PARAMETERS = {"friction_angle": 34, "epsilon": 1e-4}


@pytest.fixture(scope="module")
def run():
    mesh = {"kind": "polar", "elements": 400, "half": True}
    return march(March("perturbed", "radial_hopper", HOPPER | PARAMETERS, mesh, (0.0, 2e-3), noise=1e-4))


def test_a_march_is_judged_from_its_netcdf_file_and_written_for_paraview(run, tmp_path):
    field = read_field(results.save(run, tmp_path / "march.nc"))
    ds = field_map("perturbed", field, PARAMETERS, duration=2e-3)
    assert ds.verdict.dims == ("r", "theta") and "t = 0.002 s" in ds.attrs["source"]
    # Both arcs of the hopper are free of stress: p = 0 there.
    assert json.loads(ds.attrs["masked"])["without pressure"] == 2 * run.sizes["theta"]
    assert (ds.verdict.values[[0, -1]] == 0).all() and (ds.verdict.values[1:-1] > 0).all()
    again = read_field(write_vtk(ds, field, tmp_path / "map.vts"), {"p": "pressure", "verdict": "verdict"})
    assert_allclose(again.values["verdict"], ds.verdict)


def test_gradients_are_those_of_the_march_within_both_errors(run):
    ds = field_map("rigid_plastic", read_field(run, time=0.0), {"friction_angle": 34}, check=False)
    own = run.strain_rate_norm.sel(time=0.0).values
    inside = (slice(1, -1), slice(1, -1))
    # The march takes means over control volumes, which err by O(h^2) as well: as much again, and noise of
    # 1e-4 sqrt(g r_0) over cells of some 0.03 m.
    allowed = 4 * ds.gradient_error.values[inside] + 4 * 1e-4 * np.sqrt(9.81 * 0.5) / 0.03
    assert (abs(ds.strain_rate_norm.values / own - 1)[inside] < allowed).all()
    assert np.quantile(abs(ds.strain_rate_norm.values / own - 1)[inside], 0.9) < 0.03


def test_the_marchs_own_paraview_files_are_read(run, tmp_path):
    folder = write_paraview(run, tmp_path).parent
    found = read_field(sorted(folder.glob("*.vts"))[-1])
    expected = read_field(run)
    for name in "uvp":  # the file has the angles first
        assert_allclose(found.values[name], expected.values[name].T, rtol=1e-14, atol=1e-14)
