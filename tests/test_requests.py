"""Scenes of kinds well_posedness, smallest_cure, field_map and crosscheck: what they hold, refuse, say and write."""

import json
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner
from numpy.testing import assert_allclose

import stability as st
from stability import manual
from stability.cli import main
from stability.errors import SceneError
from stability.field.writing import write_vtk
from stability.plan import PLANS, plan
from stability.results import open_results, save
from stability.runner import KINDS
from stability.scene.requests import REQUESTS
from stability.summary import summary
from tests.test_scene import GOOD, MARCH

UNIFORM = """
title = "A point of the tests"
closure = "{closure}"
flow = "uniform_strain"
[parameters]
friction_angle = 34.0
delta = 0.0
strain_rate = 1.0
pressure = 1.0
{more}
[request]
kind = "well_posedness"
"""
COULOMB = UNIFORM.format(closure="rigid_plastic", more="")
HYPER = UNIFORM.format(closure="hyperstress", more="hyperviscosity = 1e-4")
FIELD = """
title = "A field of the tests"
closure = "rigid_plastic"
flow = "field"
[parameters]
friction_angle = 34.0
[request]
kind = "field_map"
file = "flow.vts"
duration = 0.5
"""
CURE = UNIFORM.format(closure="viscous", more="").replace(
    '"well_posedness"', '"smallest_cure"\nparameter = "viscosity"'
)
CROSS = (
    GOOD.split("[request]")[0]
    + """
[request]
kind = "crosscheck"
point = { r = 1.0, theta = 0.0 }
"""
)


@pytest.fixture
def scene(tmp_path):
    def written(text: str) -> Path:
        path = tmp_path / "scene.toml"
        path.write_text(text)
        return path

    return written


@pytest.fixture
def problems(scene):
    def found(text: str) -> list[str]:
        with pytest.raises(SceneError) as caught:
            st.load_scene(scene(text))
        return [p.removeprefix("scene.toml: ") for p in caught.value.problems]

    return found


def test_the_requests_on_the_help_page_load(scene):
    hopper = CROSS.replace('epsilon = { value = 2e-5, why = "the first of two values" }\n', "")
    for name, head in (("field_map", FIELD), ("crosscheck", CROSS), ("smallest_cure", hopper)):
        page = next(p for p in manual.RUN.split("\b\n") if p.startswith(f"The request of a {name}"))
        table = page.split("\n", 1)[1].split("\n\n")[0].replace("flow.vtu", "scene.toml")
        assert st.load_scene(scene(head.split("[request]")[0] + table)).request.kind == name


def test_a_verdict_of_a_scene_is_the_one_that_a_script_gets(scene):
    ds = st.run(scene(COULOMB))
    given = {"friction_angle": 34.0, "delta": 0.0, "strain_rate": 1.0, "pressure": 1.0}
    found = st.well_posedness("rigid_plastic", "uniform_strain", given, {})
    assert ds.attrs["sentence"] == str(found) and ds.attrs["verdict"] == "ill-posed" and ds.attrs["law"] == found.law
    assert (ds.exponent, ds.coefficient, ds.short_wave_angle) == (2, found.coefficient, found.worst_angle)
    assert_allclose(np.stack([ds.wedge_from, ds.wedge_to], axis=1), found.wedge, rtol=0, atol=0)
    assert ds.attrs["certified"] == "true" and json.loads(ds.attrs["cause"]) == list(found.cause)
    assert json.loads(ds.attrs["notes"]) == list(found.notes)


def test_a_verdict_without_wedges_is_saved_like_any_other(scene, tmp_path):
    ds = st.run(scene(UNIFORM.format(closure="viscous", more="kinematic_viscosity = 0.1")))
    assert ds.attrs["verdict"] == "stable" and "wedge_from" not in ds and ds.coefficient < 0
    again = open_results(save(ds, tmp_path / "x.nc"))
    assert again.identical(ds) and summary(again) == summary(ds)


def test_the_residual_of_every_balance_law_bears_its_name(scene):
    ds = st.run(scene(HYPER))
    names = {str(n) for n in ds.data_vars if "residual" in str(n)}
    laws = {"momentum_residual_x", "momentum_residual_y", "residual_p", "residual_lap_u", "residual_lap_v"}
    assert names == laws and all(ds[n].attrs["units"] for n in laws)
    assert "the law of lap_u by 0" in summary(ds)
    three = st.run(scene(COULOMB))
    assert "mass_residual" in three and "residual_p" not in three


def test_a_verdict_is_printed_and_explained(scene, monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    scene(COULOMB)
    told = CliRunner().invoke(main, ["explain", "scene.toml"])
    assert told.exit_code == 0 and "precision      balls of 256 bits" in told.output
    done = CliRunner().invoke(main, ["run", "scene.toml"])
    assert done.exit_code == 0, done.output
    law = "0.0369593821168 m^2/s |xi|^2"
    assert f"verdict        ill-posed: short waves grow without bound, as {law}, at" in done.stdout
    assert "Signs are\n" in done.stdout or "Signs are certified." in done.stdout


def test_a_map_of_a_closure_without_closed_forms_runs(scene):
    waves = "wavenumber = [10.0, 100.0]\nwave_angle = [30.0, 60.0]\n"
    ds = st.run(scene(HYPER.replace("well_posedness", "growth_map") + waves))
    assert ds.growth_rate.shape == (2, 2) and np.isfinite(ds.growth_rate).all() and "residual_p" in ds


@pytest.mark.parametrize(
    ("request_", "begins"),
    [
        ('kind = "neutral_curve"\nwave_angle = [30.0]', '[request] kind = "neutral_curve" needs eigenvalues in closed'),
        ('kind = "growth_map"\nwave_angle = [30.0]\nwavenumber = [1.0]\nsampling = "adaptive"',
         '[request] sampling = "adaptive" needs eigenvalues in closed form, and closure hyperstress has 1 modes'),
        ('kind = "growth_map"\nwave_angle = [30.0]\nwavenumber = [1.0]\n[tolerance]\ngrowth = 0.1',
         "[tolerance] growth = 0.1 needs eigenvalues in closed form"),
        ('kind = "well_posedness"\nmatrix = "truncated"', '[request] matrix = "truncated": closure hyperstress has no'),
    ],
    ids=["curve", "adaptive", "tolerance", "truncated"],
)  # fmt: skip
def test_what_needs_closed_forms_is_refused_without_them(request_, begins, problems):
    (found,) = problems(HYPER.split("[request]")[0] + "[request]\n" + request_)
    assert found.startswith(begins)


@pytest.mark.parametrize(
    ("old", "new", "begins"),
    [
        ('"well_posedness"', '"well_posedness"\nmatrix = "leading"', '[request] matrix = "leading" should be'),
        ('"well_posedness"', '"well_posedness"\npoint = { r = 1.0 }', "[request] point.r is unknown: this flow is"),
        ("delta = 0.0", "delta = 0.1", "rigid_plastic imposes its constraint exactly"),
        ('"uniform_strain"', '"field"', 'flow = "field" belongs to [request] kind = "field_map"'),
        ("[request]", "[tolerance]\ngrowth = 0.1\n[request]", "[tolerance] growth = 0.1 belongs to a growth_map"),
        ("[request]", "[tolerance]\ndigits = 20\n[request]", "[tolerance] digits = 20 belongs to a growth_map"),
    ],
)
def test_one_fault_of_a_verdict_is_one_sentence(old, new, begins, problems):
    (found,) = problems(COULOMB.replace(old, new))
    assert found.startswith(begins)


def test_a_least_cure_of_a_scene_is_the_one_that_a_script_gets(scene, tmp_path):
    path = scene(CURE + "bracket = { from = 1e-3, to = 10.0 }\n")
    ds = st.run(path)
    given = {"friction_angle": 34.0, "delta": 0.0, "strain_rate": 1.0, "pressure": 1.0}
    ask = {"parameter": "kinematic_viscosity", "bracket": (1e-3, 10.0)}
    found = st.smallest_cure("viscous", "uniform_strain", given, {}, **ask)
    assert [float(ds[f"cure_{n}"]) for n in ("below", "from", "to")] == [found.below, found.above, found.last]
    assert_allclose(ds.cure_from, 0.0369593821168465, rtol=3e-6)  # (mu/2) tan^2(varphi/2), exact; twice rtol and balls
    assert ds.cure_from.units == "m2/s" and np.isnan(ds.cure_beyond) and ds.attrs["parameter"] == "kinematic_viscosity"
    assert json.loads(ds.attrs["parameters"])["kinematic_viscosity"] == found.above
    assert f"{ds.attrs['sentence']} {' '.join(json.loads(ds.attrs['notes']))}" == str(found)
    assert open_results(save(ds, tmp_path / "cure.nc")).identical(ds)


def test_a_least_cure_is_printed_and_explained(scene, monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    scene(CURE + "growth = 5.0\nbracket = { from = 1e-3, to = 1.0 }\nlongest = 1e3\n")
    told = CliRunner().invoke(main, ["explain", "scene.toml"])
    assert told.exit_code == 0 and "wanted         no wave grows faster than 5 1/s" in told.output
    done = CliRunner().invoke(main, ["run", "scene.toml"])
    assert done.exit_code == 0, done.output
    assert "cure           kinematic_viscosity = 0.0369593" in done.stdout
    assert "notes          What still grows does so no faster than ||V||" in done.stdout


@pytest.mark.parametrize(
    ("old", "new", "begins"),
    [
        ('"viscosity"', '"epsilon"', "[request] parameter epsilon is unknown here; known are delta, friction_angle"),
        ("[request]", "kinematic_viscosity = 1.0\n[request]", "[parameters] kinematic_viscosity is what [request]"),
        ("pressure = 1.0\n", "", "[parameters] pressure is missing"),
        (
            "[request]",
            "[request]\ngrowth = -1.0",
            "[request] growth = -1.0 should be greater than or equal to 0: it is",
        ),
        (
            "[request]",
            "[request]\nlongest = 0.0",
            "[request] longest = 0.0 should be greater than 0: it is the longest",
        ),
        ("[request]", "[request]\nbracket = { from = 1.0 }", "[request] bracket.to is missing"),
        (
            "[request]",
            "[request]\nbracket = { from = -1.0, to = 1.0 }",
            "[request] bracket.from = -1.0 m2/s lies outside",
        ),
        ("[request]", "[request]\nbracket = { from = 2.0, to = 1.0 }", "[request] bracket.to = 1.0 must exceed"),
        ("[request]", "[request]\nrtol = 0.0", "[request] rtol = 0.0 should be greater than or equal to 0.00"),
        ("delta = 0.0", "delta = 0.1", "viscous imposes its constraint exactly"),
        ("[request]", "[tolerance]\ngrowth = 0.1\n[request]", "[tolerance] growth = 0.1 belongs to a growth_map"),
    ],
)
def test_one_fault_of_a_least_cure_is_one_sentence(old, new, begins, problems):
    (found,) = problems(CURE.replace(old, new))
    assert found.startswith(begins)


@pytest.fixture
def field(tmp_path):
    """Write flow.vts: pure strain at 1/s and unit pressure, in whose every point Coulomb flow is ill-posed."""
    x, y = np.linspace(0, 1, 9), np.linspace(0, 1, 7)
    X, Y = np.meshgrid(x, y)
    flow = st.field_from(x, y, u=X / np.sqrt(2), v=-Y / np.sqrt(2), p=np.ones_like(X))
    empty = st.field_map("rigid_plastic", flow, {"friction_angle": 34.0}, check=False)
    return write_vtk(empty.drop_vars([n for n in empty.data_vars if n != "verdict"]), flow, tmp_path / "flow.vts")


def test_a_field_map_is_run_from_a_scene_and_written_for_paraview(field, scene, monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    ds = st.run(scene(FIELD))
    assert np.all(ds.verdict == 4) and np.all(ds.exponent == 2)
    assert_allclose(ds.coefficient, 0.0369593821168, rtol=1e-6)  # computed by `well_posedness` at such a point
    assert ds.attrs["answer"].startswith("63 points were judged with rigid_plastic. 100 % of them are ill-posed")
    done = CliRunner().invoke(main, ["run", "scene.toml"])
    assert done.exit_code == 0, done.output
    assert "model          rigid_plastic on the flow of flow.vts" in done.stdout
    assert "answer         63 points were judged" in done.stdout
    assert open_results(tmp_path / "scene.nc").attrs["answer"] == ds.attrs["answer"]
    written = CliRunner().invoke(main, ["export", "scene.nc", "--vtk", "maps"])
    assert written.output == "wrote maps/scene.vts; open it in ParaView\n"
    told = CliRunner().invoke(main, ["explain", "scene.toml"])
    assert "field          flow.vts, 63 points" in told.output
    (tmp_path / "elsewhere").mkdir()
    moved = (tmp_path / "scene.nc").rename(tmp_path / "elsewhere" / "scene.nc")
    lost = CliRunner().invoke(main, ["export", str(moved), "--vtk", "maps"])
    assert lost.exit_code == 2 and "the field of this map is in flow.vts" in lost.stderr and "--scene" in lost.stderr
    again = CliRunner().invoke(main, ["export", str(moved), "--vtk", "maps", "--scene", "scene.toml"])
    assert again.exit_code == 0, again.output


@pytest.mark.parametrize(
    ("old", "new", "begins"),
    [
        ('"field"', '"uniform_strain"', 'flow = "uniform_strain" is not that of a field_map: flow = "field"'),
        ('"flow.vts"', '"none.vts"', '[request] file = "none.vts": there is no such file: /'),
        ('file = "flow.vts"', "", "[request] file is missing: it is the file of the flow field"),
        ("0.5", "-0.5", "[request] duration = -0.5 s lies outside (0, inf) s"),
        ("duration", "fields = { w = 'w' }\nduration", "[request] fields.w is unknown (known: u, v, p)"),
        ("duration", "fields = { u = 1 }\nduration", "[request] fields.u = 1 should be a valid string"),
        ("= 34.0", "= 134.0", "[parameters] friction_angle = 134.0 deg lies outside"),
        ("[request]", "delta = 0.1\n[request]", "[parameters] delta is unknown (known: friction_angle)"),
    ],
)
def test_one_fault_of_a_field_map_is_one_sentence(old, new, begins, field, problems):
    (found,) = problems(FIELD.replace(old, new))
    assert found.startswith(begins)


def test_a_cross_check_holds_what_the_file_says_and_leaves_the_rest_to_itself(scene):
    short = st.load_scene(scene(CROSS)).request
    assert short.parts == ("cell", "neutral", "symbol", "hopper", "saturation") and short.saturation is None
    assert st.load_scene(Path(__file__).parent.parent / "figures" / "scenes" / "X1.toml").request.model_dump() == (
        short.model_dump() | {"saturation": ({"epsilon": 1e-4, "cells": (32, 64, 128, 256)},
                                             {"epsilon": 4e-3, "cells": (32, 64, 128, 256, 512)})}
    )  # fmt: skip


def test_a_part_of_a_cross_check_is_run_from_a_scene(scene, tmp_path):
    path = scene(CROSS + 'parts = ["symbol"]\n')
    assert plan(st.load_scene(path)).words["parts"] == "symbol"
    ds = st.run(path)
    assert float(ds.symbol_matrix_error.isel(symbol_mesh=-1).max()) < 0.01  # what is asked of the finest mesh
    assert ds.attrs["request"] == "crosscheck"
    again = open_results(save(ds, tmp_path / "x.nc"))
    assert "symbol         that of the finest mesh is within" in summary(again) == summary(ds)


@pytest.mark.parametrize(
    ("more", "begins"),
    [
        ('parts = ["cells"]', "[request] parts[0] = \"cells\" should be 'cell', 'neutral', 'symbol', 'hopper' or"),
        ("parts = []", "[request] parts = [] is empty: it is what is checked"),
        ("elements = 10", "[request] elements = 10 should be greater than or equal to 100: it is the number of"),
        ('mesh = { kind = "polar" }', "[request] mesh = {\"kind\": \"polar\"} should be"),
        ("step = 1.0", "[request] step = 1.0 must not exceed duration = 0.045 s"),
        ("delta = 2.0", "[request] delta = 2.0 lies outside (-1.41421, 1.41421)"),
        ("noise = 3.0", "[request] noise = 3.0 lies outside (0, 1)"),
        ("saturation = [{ epsilon = 1e-4 }]", "[request] saturation[0].cells is missing: it is the numbers of cells"),
        ("saturation = [{ epsilon = -1.0, cells = [32] }]", "[request] saturation.epsilon = -1.0 s lies outside"),
        ("saturation = [{ epsilon = 1.0, cells = [1] }]", "[request] saturation[0].cells[0] = 1 should be greater"),
        ("saturation = [{ epsilom = 1.0, cells = [9] }]", "[request] saturation[0].epsilom is unknown; did you"),
        ("[tolerance]\nnewton = 1e-9", "[tolerance] newton = 1e-09 belongs to a march"),
    ],
)  # fmt: skip
def test_one_fault_of_a_cross_check_is_one_sentence(more, begins, problems):
    (found,) = problems(CROSS + more)
    assert found.startswith(begins)


def test_only_a_closure_with_epsilon_in_a_hopper_is_cross_checked(problems):
    rigid = CROSS.replace('"perturbed"', '"rigid_plastic"').replace(
        'epsilon = { value = 2e-5, why = "the first of two values" }', ""
    )
    (found,) = problems(rigid)
    assert found.startswith('closure = "rigid_plastic" cannot be cross-checked: the periodic cell gives it epsilon')
    hyper = rigid.replace('"rigid_plastic"', '"hyperstress"').replace("[assumed]", "hyperviscosity = 1\n[assumed]")
    assert any("cannot be cross-checked: its fields are (u, v, p, lap_u, lap_v)" in p for p in problems(hyper))


def test_a_march_of_an_own_closure_goes_on_from_its_checkpoint(scene, tmp_path, monkeypatch):
    from stability.timestepper import checkpoint
    from tests.timestepper.test_march import Killed, stopping

    small = MARCH.replace("elements = 400", "elements = 60").replace("to = 0.02, count = 5", "to = 2e-3, count = 3")
    own = tmp_path / "own.py"
    own.write_text("from stability.closures.drucker_prager import PERTURBED as OWN\n")
    path, kept = scene(small.replace('"perturbed"', '"own.py:OWN"')), tmp_path / "own.checkpoint"

    class Reporting:
        __enter__ = staticmethod(lambda: stopping(6))
        __exit__ = staticmethod(lambda *_: None)

    with monkeypatch.context() as patched:
        patched.setattr("stability.progress.reporting", lambda *_: Reporting())
        with pytest.raises(Killed):
            st.run(path, progress=True, checkpoint=kept)
    assert checkpoint.load(kept).state["step"] == 4
    assert st.resume(kept).identical(st.run(path)), "looked for beside the checkpoint"
    own.write_text(
        "from dataclasses import replace\nfrom stability.closures.drucker_prager import PERTURBED\n"
        "OWN = replace(PERTURBED, supply=2 * PERTURBED.supply)\n"
    )
    with pytest.raises(st.errors.CheckpointError, match="another state of the toolkit's source files"):
        st.resume(kept)


def test_every_kind_has_its_plan_and_its_lines_on_the_help_page():
    assert PLANS.keys() == KINDS.keys() == REQUESTS.keys()
    page = manual.RUN.split("Kinds of request:")[1]
    assert all(f"\n  {kind} " in page for kind in REQUESTS)
