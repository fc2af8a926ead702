"""Fields from files. ``data/`` was written once by VTK 9.7.2's own writers, see its README."""

from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from numpy.testing import assert_allclose

from stability import results
from stability.errors import SceneError
from stability.field import vtkxml
from stability.field.mapping import field_map
from stability.field.reading import read_field
from stability.field.writing import write_vtk
from tests.field.fields import hopper, strain

DATA = Path(__file__).parent / "data"
NAMES = {"p": "stress"}
DENSITY = 1500.0


@pytest.mark.parametrize(
    ("name", "shape"),
    [
        ("strain_ascii.vts", (7, 9)),
        ("strain_zlib_base64.vts", (7, 9)),
        ("strain_raw_lzma.vts", (7, 9)),
        ("strain_raw_zlib.vtu", (63,)),
        ("strain_inline_plain.vtu", (63,)),
        ("strain_cells_zlib_base64.vtu", (96,)),
    ],
)
def test_what_vtks_own_writers_write_is_read_exactly(name, shape):
    field = read_field(DATA / name, NAMES, density=DENSITY)
    assert field.x.shape == shape
    for letter, exact in strain(field.x, field.y).items():
        # A few roundings: the numbers were computed in another order, and the pressure was multiplied by the density.
        assert_allclose(field.values[letter], exact, rtol=0, atol=4e-15)


def test_a_legacy_file_is_read_by_vtk_itself():
    pytest.importorskip("vtkmodules", reason="the extra vtk is not installed")
    field = read_field(DATA / "strain.vtk", NAMES, density=DENSITY)
    assert_allclose(field.values["u"], strain(field.x, field.y)["u"], atol=1e-9)  # text with some ten digits


def test_without_vtk_a_legacy_file_is_refused_with_what_helps(monkeypatch):
    monkeypatch.setattr("stability.field.reading.find_spec", lambda name: None)
    with pytest.raises(SceneError, match="install the extra vtk"):
        read_field(DATA / "strain.vtk", NAMES)


@pytest.mark.parametrize("cut", [100, 1500, 3000])
def test_a_truncated_file_is_refused(tmp_path, cut):
    path = tmp_path / "half.vts"
    path.write_bytes((DATA / "strain_zlib_base64.vts").read_bytes()[:cut])
    with pytest.raises(SceneError, match="not a whole VTK XML file|no whole|kind"):
        read_field(path, NAMES)


def test_a_name_that_is_not_there_is_answered_with_those_that_are():
    with pytest.raises(SceneError, match=r"no p and no pressure for p: it holds velocity:0..2, stress"):
        read_field(DATA / "strain_ascii.vts")


@pytest.mark.parametrize("name", ["strain_ascii.vts", "strain_raw_zlib.vtu", "strain_cells_zlib_base64.vtu"])
def test_a_map_is_written_where_the_field_stood_and_read_back(tmp_path, name):
    field = read_field(DATA / name, NAMES, density=DENSITY)
    ds = field_map("perturbed", field, {"friction_angle": 34, "epsilon": 1e-3})
    path = write_vtk(ds, field, tmp_path / f"map{Path(name).suffix}")
    again = read_field(path, {"u": "u", "v": "v", "p": "pressure", "growth": "growth_rate"})
    assert again.x.shape == field.x.shape
    assert_allclose(again.values["growth"], ds.growth_rate.values, rtol=0, atol=0)
    assert_allclose(again.x, field.x, rtol=0, atol=1e-15)
    kept = results.open_results(results.save(ds, tmp_path / "map.nc"))
    xr.testing.assert_equal(kept, ds)


def test_a_map_of_points_without_cells_is_written_as_vertices(tmp_path):
    field = read_field(DATA / "strain_raw_zlib.vtu", NAMES, density=DENSITY)
    from stability.field.grids import field_from

    bare = field_from(field.x, field.y, **field.values)
    ds = field_map("rigid_plastic", bare, {"friction_angle": 34})
    piece = vtkxml.read(write_vtk(ds, bare, tmp_path / "map.vtu"))
    assert set(piece.topology["types"]) == {1} and np.isinf(piece.at_points["growth_rate"]).all()
    with pytest.raises(SceneError, match="written as .vtu"):
        write_vtk(ds, bare, tmp_path / "map.vts")


def test_a_polar_dataset_becomes_cartesian():
    field, r, theta = hopper(9)
    angle = np.deg2rad(theta)
    u, v = field.values["u"], field.values["v"]
    dims = ("time", "r", "theta")
    ds = xr.Dataset(
        {
            "velocity_r": (dims, (u * np.cos(angle) + v * np.sin(angle))[None]),
            "velocity_theta": (dims, (v * np.cos(angle) - u * np.sin(angle))[None]),
            "pressure": (dims, field.values["p"][None]),
        },
        {"time": [0.5], "r": r[:, 0], "theta": theta[0]},
    )
    found = read_field(ds)
    assert found.dims == ("r", "theta") and "t = 0.5 s" in found.source
    for name in "uvp":
        assert_allclose(found.values[name], field.values[name], rtol=1e-14, atol=1e-14)


def test_a_rectilinear_dataset_is_read_by_its_coordinates(tmp_path):
    x, y = np.linspace(0, 1, 8), np.linspace(0, 2, 6)
    values = strain(*np.meshgrid(x, y))
    ds = xr.Dataset({n: (("y", "x"), a) for n, a in values.items()}, {"x": x, "y": y})
    results.save(ds, tmp_path / "field.nc")
    for source in (ds, tmp_path / "field.nc", ds.transpose("x", "y")):
        assert_allclose(read_field(source).values["v"], values["v"], rtol=1e-15)


def test_a_netcdf_4_file_is_read_with_the_extra_data_and_refused_with_its_name_without(tmp_path, monkeypatch):
    (tmp_path / "four.nc").write_bytes(b"\x89HDF\r\n\x1a\n" + bytes(100))
    with monkeypatch.context() as bare:
        bare.setattr(results, "find_spec", lambda name: None)
        with pytest.raises(SceneError, match=r"four.nc is netCDF-4 \(HDF5\), which needs the extra data: pip install"):
            read_field(tmp_path / "four.nc")
    pytest.importorskip("h5netcdf", reason="the extra data is not installed")
    x, y = np.linspace(0, 1, 8), np.linspace(0, 2, 6)
    values = strain(*np.meshgrid(x, y))
    ds = xr.Dataset({n: (("y", "x"), a) for n, a in values.items()}, {"x": x, "y": y})
    ds.to_netcdf(tmp_path / "four.nc", engine="h5netcdf")
    assert_allclose(read_field(tmp_path / "four.nc").values["v"], values["v"], rtol=0, atol=0)


@pytest.mark.parametrize("name", ["flow.csv", "flow.nc", "flow"])
def test_any_other_file_is_refused_in_one_sentence(name, tmp_path):
    (tmp_path / name).write_text("x,y,u,v,p\n0,0,1,0,1\n")
    with pytest.raises(
        SceneError, match=f"{name} is neither a netCDF nor a VTK file: .* stability.field_from"
    ) as caught:
        read_field(tmp_path / name)
    assert "\n" not in str(caught.value)
