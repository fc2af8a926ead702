"""A scene becomes a result that tells by itself what it is."""

import json
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_array_equal

import stability as st
from stability.errors import SceneError
from stability.plan import marched, plan
from stability.results import open_results, save
from stability.runner import KINDS, run
from stability.scene import load_scene
from stability.scene.messages import REQUESTS
from stability.summary import summary
from stability.timestepper.march import march
from tests.test_scene import DIAGRAM, GOOD, MARCH

# Directions across the wedge between the velocity characteristic at 45 degrees and the stress characteristic at 28.
CURVE = (
    GOOD.replace("growth_map", "neutral_curve")
    .replace('{ from = 1.0, to = 1e4, count = 5, spacing = "log" }', "{ from = 10.0, to = 1e4 }")
    .replace("[0.0, 45.0, 90.0]", "[36.0, 40.0, 44.0]")
)


@pytest.fixture
def scene(tmp_path):
    def written(text: str) -> Path:
        path = tmp_path / "scene.toml"
        path.write_text(text)
        return path

    return written


def test_every_kind_of_request_has_its_analysis():
    assert KINDS.keys() == REQUESTS.keys()


def test_a_growth_map_is_the_eigenvalues_that_a_script_gets(scene, perturbed_hopper):
    ds = run(scene(GOOD))
    expected = st.eigenvalues(
        "perturbed",
        "radial_hopper",
        perturbed_hopper,
        {"r": 1, "theta": 0},
        ds.wavenumber.values,
        ds.wave_angle.values[:, None],
    )
    assert ds.growth_rate.dims == ("wave_angle", "wavenumber")
    np.testing.assert_allclose(
        ds.growth_rate, expected[..., 0].real, rtol=1e-10
    )  # 1e-11: what `fast` may lose near neutrality


def test_a_result_holds_its_scene_and_its_assumptions(scene):
    path = scene(GOOD)
    ds = run(load_scene(path))
    assert ds.attrs["title"] == "A scene of the tests"
    assert ds.attrs["scene_text"] == GOOD
    assert json.loads(ds.attrs["assumed"])["wedge_angle"] == "theta_w is not given"
    assert json.loads(ds.attrs["parameters"])["wedge_angle"] == 15.0


def test_auto_is_the_full_matrix_and_another_is_taken_as_asked(scene):
    auto = run(scene(GOOD))
    truncated = run(scene(GOOD + 'matrix = "truncated"\n'))
    assert (auto.attrs["matrix"], truncated.attrs["matrix"]) == ("full", "truncated")
    assert not np.array_equal(auto.growth_rate, truncated.growth_rate)


def test_auto_takes_a_cheaper_matrix_where_the_tolerance_allows_it(scene):
    text = GOOD.replace("from = 1.0", "from = 300.0").replace("[0.0, 45.0, 90.0]", "[35.0, 37.0, 40.0]")
    ds = run(scene(text + "[tolerance]\ngrowth = 0.2\naccuracy = 'standard'\n"))
    assert ds.attrs["matrix"] == "truncated" and "frequency" not in ds
    assert 0 < float(ds.attrs["true_error"]) <= float(ds.attrs["predicted_error"]) <= 0.2
    assert "D' in float64" in ds.attrs["plan_reason"]


def test_a_named_rung_that_misses_is_taken_with_a_warning(scene):
    ds = run(scene(GOOD + "matrix = 'leading'\n[tolerance]\ngrowth = 1e-3\n"))
    assert ds.attrs["matrix"] == "leading"
    (warning,) = json.loads(ds.attrs["plan_warnings"])
    assert warning.startswith("the tolerance growth = 0.001 may be missed") and 'with matrix = "leading"' in warning


def test_proven_signs_can_be_asked_for(scene):
    ds = run(scene(GOOD + "[tolerance]\nsign = 'certified'\n"))
    assert ds.attrs["sign"].startswith("certified: 15 samples")
    assert "signs" in summary(ds)


def test_regions_alone_are_those_of_the_searched_diagram(scene):
    searched, alone = run(scene(DIAGRAM)), run(scene(DIAGRAM + "growth = false\n"))
    assert_array_equal(alone.region, searched.region)
    assert "scaled_growth_rate" not in alone and "check" not in summary(alone)


def test_equal_scenes_give_equal_files(scene, tmp_path):
    path = scene(GOOD + "[tolerance]\ngrowth = 0.1\n")
    one, other = (save(run(path), tmp_path / name).read_bytes() for name in ("one.nc", "other.nc"))
    assert one == other, "no times, no order of a dict: a result is a function of its scene"


def test_a_neutral_curve_lies_in_its_range(scene):
    ds = run(scene(CURVE))
    q = ds.neutral_wavenumber.values
    assert np.isfinite(q).any() and np.nanmin(q) > 10 and np.nanmax(q) < 1e4


def test_resolve_inserts_directions(scene):
    coarse = run(scene(CURVE))
    fine = run(scene(CURVE + "resolve = 0.2\n"))
    assert fine.sizes["wave_angle"] > coarse.sizes["wave_angle"]


def test_a_phase_diagram_says_where_waves_grow(scene):
    ds = run(scene(DIAGRAM))
    assert_array_equal(ds.region.sel(delta=0.5), [2, 2, 2])  # 0 < delta < k: unstable at every wavelength
    assert_array_equal(ds.region.sel(delta=-0.5), [0, 0, 0])  # below -k/(2(1 + sqrt 2)): stable
    assert ds.attrs["disagreements"] == "0"


def test_an_executor_changes_nothing_and_anything_else_is_refused(scene):
    path = scene(GOOD)
    with ThreadPoolExecutor(1) as executor:
        assert run(path, executor=executor).identical(run(path))
    with pytest.raises(TypeError, match="executor must be None or a concurrent.futures.Executor, got 4"):
        run(path, executor=4)


def test_progress_changes_nothing(scene, capsys):
    path = scene(DIAGRAM)
    assert run(path, progress=True).identical(run(path))
    assert capsys.readouterr().out == ""


def test_progress_reaches_the_end(scene):
    seen = []
    loaded = load_scene(scene(DIAGRAM))
    KINDS["phase_diagram"](loaded, plan(loaded), lambda done, total: seen.append((done, total)))
    assert seen == [(1, 3), (2, 3), (3, 3)]


def test_a_march_is_the_one_that_a_script_gets_and_holds_its_forecast(scene):
    text = MARCH.replace("elements = 400", "elements = 60").replace("to = 0.02, count = 5", "to = 1e-4, count = 2")
    path = scene(text)
    ds = run(path)
    expected = march(marched(load_scene(path)))
    assert all(ds[name].equals(expected[name]) for name in ds.variables)
    assert (ds.attrs["scene_text"], ds.attrs["title"]) == (text, "A scene of the tests")
    assert json.loads(ds.attrs["plan"])["elements"] == 60 and "predicted_error" not in ds.attrs
    assert json.loads(ds.attrs["plan_warnings"])[0].startswith("1.1 cells in a wavelength are too few")


def test_equal_marches_give_equal_files(scene, tmp_path):
    path = scene(
        MARCH.replace("elements = 400", "elements = 60").replace("to = 0.02, count = 5", "to = 1e-4, count = 2")
    )
    one, other = (save(run(path), tmp_path / name).read_bytes() for name in ("one.nc", "other.nc"))
    assert one == other


def test_only_a_march_keeps_a_checkpoint(scene, tmp_path):
    with pytest.raises(SceneError, match="a growth_map keeps none, a march alone does"):
        run(scene(GOOD), checkpoint=tmp_path / "checkpoint")


def test_a_bad_scene_is_refused_before_it_runs(scene):
    with pytest.raises(SceneError, match="friction_angle = 134 deg"):
        run(scene(GOOD.replace("= 34", "= 134")))


@pytest.mark.parametrize(
    ("text", "phrases"),
    [
        (GOOD, ["perturbed on radial_hopper, matrix full", "r = 1 m, theta = 0 deg", "3 wave_angle x 5 wavenumber",
                "largest growth", "at wavenumber 1 1/m",
                "momentum misses by", "wedge_angle = 15: theta_w is not given"]),
        (CURVE, ["shortest wave", "neutral at"]),
        (DIAGRAM, ["-0.1638 < delta < 0.9546", "0 <= delta <= 0.7908", "0 of 9 samples disagree"]),
    ],
    ids=["growth_map", "neutral_curve", "phase_diagram"],
)  # fmt: skip
def test_a_summary_is_the_same_from_a_file(text, phrases, scene, tmp_path):
    ds = run(scene(text))
    told = summary(ds)
    assert told == summary(open_results(save(ds, tmp_path / "saved.nc")))
    for phrase in phrases:
        assert phrase in told


def test_a_summary_says_when_growth_is_cut_off_by_the_grid(scene):
    text = GOOD.replace('"perturbed"', '"rigid_plastic"').replace(
        'epsilon = { value = 2e-5, why = "the first of two values" }', ""
    )
    assert "shortest wave sampled: growth may rise further" in summary(run(scene(text.replace("45.0", "37.0"))))
    assert "shortest wave sampled" not in summary(run(scene(GOOD)))
