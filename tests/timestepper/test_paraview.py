"""Files for ParaView: parsed again, they hold the points and the fields."""

import base64
import xml.etree.ElementTree as Xml
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

import stability as st
from stability.timestepper.march import March, march
from stability.timestepper.paraview import write_paraview
from tests.conftest import HOPPER


@pytest.fixture(scope="module")
def ds():
    asked = March("perturbed", "radial_hopper", HOPPER | {"epsilon": 1e-4}, {"elements": 60, "half": False}, (0, 1e-4))
    return march(asked)


def read(path: Path) -> tuple[tuple[int, ...], dict[str, np.ndarray]]:
    """Return the numbers of points along the three indices of a structured grid, and its arrays."""
    root = Xml.parse(path).getroot()
    assert root.attrib == {"type": "StructuredGrid", "version": "1.0", "byte_order": "LittleEndian",
                           "header_type": "UInt64"}  # fmt: skip
    piece = root.find("StructuredGrid/Piece")
    assert piece.get("Extent") == root.find("StructuredGrid").get("WholeExtent")
    ends = np.array(piece.get("Extent").split(), dtype=int).reshape(3, 2)
    found = {}
    for array in piece.iter("DataArray"):
        assert (array.get("type"), array.get("format")) == ("Float64", "binary")
        content = base64.b64decode(array.text, validate=True)
        assert int.from_bytes(content[:8], "little") == len(content) - 8
        found[array.get("Name")] = np.frombuffer(content[8:], "<f8").reshape(-1, int(array.get("NumberOfComponents")))
    return tuple(ends[:, 1] - ends[:, 0] + 1), found


def test_a_snapshot_has_its_points_and_fields_in_the_order_of_its_extent(ds, tmp_path):
    write_paraview(ds, tmp_path)
    shape, arrays = read(tmp_path / "march_0001.vts")
    assert shape == (ds.sizes["r"], ds.sizes["theta"], 1), "the first index varies fastest"
    assert {len(values) for values in arrays.values()} == {np.prod(shape)}
    radius, angle = np.meshgrid(ds.r, np.deg2rad(ds.theta))
    x, y, z = arrays["points"].T.reshape(3, *radius.shape)
    assert_allclose(np.hypot(x, y), radius, rtol=1e-15)  # roundings
    assert_allclose(np.arctan2(y, x), angle, atol=1e-15)
    assert not z.any() and not arrays["velocity"][:, 2].any()
    now = ds.isel(time=1).transpose("theta", "r", ...)
    for name in ("velocity_r", "velocity_theta", "pressure", "strain_rate_norm", "dilation", "viscosity"):
        assert_array_equal(arrays[name].reshape(radius.shape), now[name])
    u, v = arrays["velocity"].T[:2].reshape(2, *radius.shape)
    assert_allclose(u * np.cos(angle) + v * np.sin(angle), now.velocity_r, rtol=1e-14, atol=1e-15)
    assert_allclose(v * np.cos(angle) - u * np.sin(angle), now.velocity_theta, rtol=0, atol=1e-14)


def test_cells_are_not_inverted(ds, tmp_path):
    write_paraview(ds, tmp_path)
    shape, arrays = read(tmp_path / "march_0000.vts")
    points = arrays["points"].reshape(shape[1], shape[0], 3)[..., :2]
    along, up = points[:-1, 1:] - points[:-1, :-1], points[1:, :-1] - points[:-1, :-1]
    turn = along[..., 0] * up[..., 1] - along[..., 1] * up[..., 0]
    assert (turn > 0).all(), "i runs with r and j with theta: right-handed everywhere"


def test_the_collection_lists_every_snapshot_with_its_time(ds, tmp_path):
    collection = write_paraview(ds, tmp_path / "new" / "folder", "N1")
    assert collection.name == "N1.pvd"
    rows = Xml.parse(collection).getroot().findall("Collection/DataSet")
    assert [float(row.get("timestep")) for row in rows] == ds.time.values.tolist()
    assert all((collection.parent / row.get("file")).exists() for row in rows)


def test_fields_that_a_closure_does_not_have_are_left_out(ds, tmp_path):
    write_paraview(ds.drop_vars("viscosity"), tmp_path)
    assert "viscosity" not in read(tmp_path / "march_0000.vts")[1]


def test_equal_results_make_equal_files(ds, tmp_path):
    for folder in ("a", "b"):
        write_paraview(ds, tmp_path / folder)
    for path in (tmp_path / "a").iterdir():
        assert path.read_bytes() == (tmp_path / "b" / path.name).read_bytes()


def test_a_result_without_snapshots_is_refused():
    with pytest.raises(ValueError, match="only the result of a march"):
        write_paraview(st.phase_diagram(34.0, [0.0], [1.0]), "nowhere")
