"""A stored growth map, re-checked in full and in part, and what it says about it afterwards."""

import json

import numpy as np
import pytest

import stability as st
from stability import balls, certified, results
from stability.errors import SceneError

Q, ANGLE = np.geomspace(1, 1e8, 24), np.arange(0, 360, 7.5)
POINT = {"r": 1.0, "theta": 2.0}


@pytest.fixture
def stored(perturbed_hopper, tmp_path):
    ds = st.growth_map("perturbed", "radial_hopper", perturbed_hopper, POINT, Q, ANGLE)
    return results.open_results(results.save(ds, tmp_path / "map.nc"))


def test_a_stored_map_is_certified_in_full_and_keeps_its_attributes_when_saved(stored, tmp_path):
    found = st.certify(stored)
    again = results.open_results(results.save(found, tmp_path / "certified.nc"))
    for ds in (found, again):
        assert np.array_equal(ds.sign, np.sign(stored.growth_rate)) and ds.sign.dtype == np.int8
        assert sum(json.loads(ds.attrs["sign_decided"]).values()) == Q.size * ANGLE.size
        assert int(ds.attrs["sign_disagreements"]) == 0 and json.loads(ds.attrs["sign_undecided"]) == []
        assert ds.attrs["sign"].startswith(f"certified: {Q.size * ANGLE.size} samples decided by float64")
        assert ds.sign.attrs["long_name"] == results.VARIABLES["sign"][1]
    assert again.attrs == found.attrs
    assert set(stored.attrs) <= set(found.attrs)


def test_a_part_of_a_map_is_certified_and_the_rest_keeps_its_sign(stored):
    broken = stored.copy(deep=True)
    broken.growth_rate.values[:] = -broken.growth_rate.values  # every sign is wrong
    found = st.certify(broken, samples=100, seed=3)
    right = found.sign.values == np.sign(stored.growth_rate.values)
    assert right.sum() == 100 == int(found.attrs["sign_disagreements"])
    assert sum(json.loads(found.attrs["sign_decided"]).values()) == 100
    assert np.array_equal(st.certify(broken, samples=100, seed=3).sign, found.sign)  # the draw is seeded
    assert not np.array_equal(st.certify(broken, samples=100, seed=4).sign, found.sign)


def test_a_map_over_positions_is_certified_at_each(perturbed_hopper):
    point = {"r": np.array([0.7, 1.3]), "theta": np.array([0.0, -5.0])}
    ds = st.certify(st.growth_map("perturbed", "radial_hopper", perturbed_hopper, point, Q, ANGLE[:9]))
    assert ds.sign.dims == ds.growth_rate.dims and np.array_equal(ds.sign, np.sign(ds.growth_rate))


def test_ties_are_listed_with_their_place_and_their_enclosure():
    flow = {"friction_angle": 34.0, "epsilon": 2e-5, "delta": 0.0, "strain_rate": 1.0, "pressure": 1.0}
    ds = st.growth_map("perturbed", "uniform_strain", flow, {}, [1.0], [10.0, 45.0], matrix="leading")
    found = st.certify(ds)
    (tie,) = json.loads(found.attrs["sign_undecided"])
    assert (tie["wave_angle"], tie["wavenumber"]) == (45.0, 1.0)
    assert abs(tie["growth_rate"]) <= tie["radius"] < 1e-300
    assert found.sign.values.tolist() == [[-1], [0]]
    assert "undecided 50 %" in found.attrs["sign"]


def test_the_summary_names_the_intervals_that_stand_in_for_python_flint(stored, monkeypatch):
    for module in (balls, certified):
        monkeypatch.setattr(module, "available", lambda: False)
    flow = {"friction_angle": 34.0, "epsilon": 2e-5, "delta": 0.0, "strain_rate": 1.0, "pressure": 1.0}
    ds = st.growth_map("perturbed", "uniform_strain", flow, {}, [1.0], [45.0], matrix="leading")
    assert "mpmath intervals (python-flint is not installed: slower)" in st.certify(ds).attrs["sign"]


@pytest.mark.parametrize("samples", [0, -1, Q.size * ANGLE.size + 1])
def test_a_number_of_samples_outside_the_map_is_refused(stored, samples):
    with pytest.raises(SceneError, match=rf"samples = {samples} lies outside"):
        st.certify(stored, samples=samples)


def test_what_is_no_growth_map_is_refused(stored):
    with pytest.raises(SceneError, match="certify needs a growth map"):
        st.certify(stored.drop_vars("growth_rate"))
