"""Datasets: units on everything, provenance, and files that read back identically."""

import json

import numpy as np
import pytest

import stability as st
from stability import results
from stability.errors import SceneError

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


def test_another_file_is_refused_by_its_first_bytes_and_a_missing_one_is_missing(tmp_path):
    for name, text in (("table.csv", b"x,y\n1,2\n"), ("empty.nc", b"")):
        (tmp_path / name).write_bytes(text)
        with pytest.raises(SceneError, match=f"{name} is no netCDF file"):
            st.open_results(tmp_path / name)
    with pytest.raises(FileNotFoundError):
        st.open_results(tmp_path / "none.nc")


@pytest.mark.parametrize(
    ("first", "needs"),
    [(b"\x89HDF\r\n\x1a\n", r"netCDF-4 \(HDF5\), which needs the extra data: pip install 'granular-stability\[data\]'"),
     (b"CDF\x05", "64-bit data, which needs the package netCDF4")],
)  # fmt: skip
def test_a_format_that_needs_a_package_names_it(first, needs, tmp_path, monkeypatch):
    monkeypatch.setattr(results, "find_spec", lambda name: None)
    (tmp_path / "four.nc").write_bytes(first + bytes(100))
    with pytest.raises(SceneError, match=f"four.nc is .*{needs}"):
        st.open_results(tmp_path / "four.nc")


@pytest.mark.parametrize("part", [0.01, 0.3, 0.99])
def test_a_file_that_is_cut_short_is_refused_in_one_sentence(part, tmp_path, perturbed_hopper):
    ds = st.growth_map("perturbed", "radial_hopper", perturbed_hopper, POINT, np.arange(1.0, 40), [0.0, 40.0])
    whole = results.save(ds, tmp_path / "whole.nc").read_bytes()
    (tmp_path / "half.nc").write_bytes(whole[: int(part * len(whole))])
    with pytest.raises(SceneError, match="half.nc is netCDF-3 by its first bytes, and cannot be read") as caught:
        st.open_results(tmp_path / "half.nc")
    assert "\n" not in str(caught.value)


def test_a_result_kept_as_netcdf_4_is_opened_with_the_extra_data(ds, tmp_path):
    pytest.importorskip("h5netcdf", reason="the extra data is not installed")
    ds.to_netcdf(tmp_path / "four.nc", engine="h5netcdf")
    assert st.open_results(tmp_path / "four.nc").equals(ds)


def test_a_failed_write_leaves_the_old_file(ds, tmp_path, monkeypatch):
    path = results.save(ds, tmp_path / "result.nc")
    before = path.read_bytes()
    monkeypatch.setattr("stability.codegen.os.replace", lambda *_: (_ for _ in ()).throw(OSError("disk full")))
    with pytest.raises(OSError, match="disk full"):
        results.save(ds, path)
    assert path.read_bytes() == before and [p.name for p in tmp_path.iterdir()] == ["result.nc"]
