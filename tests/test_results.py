"""Datasets: units on everything, provenance, and files that read back identically."""

import json

import numpy as np
import pytest

import stability as st
from stability import results

POINT = {"r": 1.0, "theta": 0.0}


@pytest.fixture(params=["growth_map", "positions", "neutral_curve", "phase_diagram"])
def ds(request, perturbed_hopper):
    if request.param == "phase_diagram":
        return st.phase_diagram(34.0, [-0.1, 0.0, 0.5], [0.1, 1.0])
    model = ("perturbed", "radial_hopper", perturbed_hopper)
    if request.param == "neutral_curve":
        return st.neutral_curve(*model, POINT, [20.0, 40.0, 50.0])
    point = POINT if request.param == "growth_map" else {"r": [0.8, 1.1], "theta": [0.0, 3.0]}
    return st.growth_map(*model, point, [1.0, 30.0], [0.0, 40.0])


def test_every_variable_has_a_unit_and_a_meaning(ds):
    for name in ds.variables:
        assert ds[name].attrs["units"] and ds[name].attrs["long_name"]


def test_files_read_back_identically(ds, tmp_path):
    described = results.described(
        ds, title="a title", scene_text="closure = 'perturbed'\n", assumed={"gravity": "standard"}
    )
    path = results.save(described, tmp_path / "result.nc")
    again = st.open_results(path)
    assert again.identical(described)
    assert {v: again[v].dtype for v in again.variables} == {v: described[v].dtype for v in described.variables}
    assert results.assumptions(again) == {"gravity": "standard"}


def test_equal_questions_make_equal_bytes(ds, tmp_path):
    one, other = (results.save(ds, tmp_path / name).read_bytes() for name in ("a.nc", "b.nc"))
    assert one == other


def test_versions_parameters_and_the_kind_of_sign_are_recorded(ds):
    assert json.loads(ds.attrs["versions"])["granular-stability"] == st.__version__
    assert json.loads(ds.attrs["parameters"])["friction_angle"] == 34
    assert ds.attrs["matrix"] in ("full", "truncated")


def test_results_of_a_flow_record_its_residuals(perturbed_hopper):
    ds = st.growth_map("perturbed", "radial_hopper", perturbed_hopper, POINT, [1.0], [0.0])
    for name in ("momentum_residual_x", "momentum_residual_y", "mass_residual"):
        assert np.isfinite(ds[name])
    assert json.loads(ds.attrs["flow_constants"])["w"] == pytest.approx(4.672154966411657, rel=1e-14)


def test_a_failed_write_leaves_the_old_file(ds, tmp_path, monkeypatch):
    path = results.save(ds, tmp_path / "result.nc")
    before = path.read_bytes()
    monkeypatch.setattr("stability.codegen.os.replace", lambda *_: (_ for _ in ()).throw(OSError("disk full")))
    with pytest.raises(OSError, match="disk full"):
        results.save(ds, path)
    assert path.read_bytes() == before and [p.name for p in tmp_path.iterdir()] == ["result.nc"]
