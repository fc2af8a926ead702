"""A scene says what is modelled; a wrong one says everything that is wrong with it."""

import re
import tomllib
from dataclasses import FrozenInstanceError
from importlib import import_module
from math import isclose
from pathlib import Path

import numpy as np
import pytest
from pydantic import ValidationError

from stability import manual
from stability.errors import SceneError
from stability.scene import load_scene

SCENES = sorted((Path(__file__).parent.parent / "figures" / "scenes").glob("*.toml"))

GOOD = """
title = "A scene of the tests"
closure = "perturbed"
flow = "radial_hopper"
[parameters]
friction_angle = 34
wall_friction_angle = 9.0
epsilon = { value = 2e-5, why = "the first of two values" }
[assumed]
wedge_angle = { value = 15.0, why = "theta_w is not given" }
outlet_radius = { value = 0.5, why = "r_0 is not given" }
inlet_radius = { value = 1.5, why = "r_1 is not given" }
gravity = { value = 9.81, why = "the standard value" }
[request]
kind = "growth_map"
point = { r = 1.0, theta = 0.0 }
wavenumber = { from = 1.0, to = 1e4, count = 5, spacing = "log" }
wave_angle = [0.0, 45.0, 90.0]
"""
DIAGRAM = """
title = "A diagram of the tests"
closure = "perturbed"
flow = "uniform_strain"
[parameters]
friction_angle = 34.0
[request]
kind = "phase_diagram"
delta = { values = [-0.5, 0.0, 0.5] }
scaled_wavenumber = { from = 0.01, to = 100.0, count = 3, spacing = "log" }
"""
MARCH = (
    GOOD.split("[request]")[0].replace('{ value = 2e-5, why = "the first of two values" }', "1e-4")
    + """
[request]
kind = "march"
mesh = { kind = "polar", elements = 400, half = true }
snapshots = { from = 0.0, to = 0.02, count = 5 }
floor = 0.05
step = { first = 1e-5, largest = 5e-4, smallest = 1e-9 }
perturbation = { size = 1e-3, seed = 1 }
checkpoint_every = 4
[tolerance]
newton = 1e-9
"""
)


@pytest.fixture
def load(tmp_path):
    def loaded(text: str):
        path = tmp_path / "scene.toml"
        path.write_text(text)
        return load_scene(path)

    return loaded


@pytest.fixture
def problems(load):
    """Return the problems of a text, without the file's name, which must begin each of them."""

    def found(text: str) -> list[str]:
        with pytest.raises(SceneError) as caught:
            load(text)
        assert str(caught.value) == "\n".join(caught.value.problems)
        assert all(p.startswith("scene.toml: ") and "\n" not in p for p in caught.value.problems)
        return [p.removeprefix("scene.toml: ") for p in caught.value.problems]

    return found


def test_a_scene_holds_what_the_file_says(load):
    scene = load(GOOD)
    assert (scene.title, scene.closure, scene.flow) == ("A scene of the tests", "perturbed", "radial_hopper")
    assert scene.parameters["friction_angle"] == 34.0 and scene.parameters["epsilon"] == 2e-5
    assert scene.parameters["wedge_angle"] == 15.0, "printed and assumed numbers are one dict"
    assert scene.assumed == {
        "wedge_angle": "theta_w is not given",
        "outlet_radius": "r_0 is not given",
        "inlet_radius": "r_1 is not given",
        "gravity": "the standard value",
    }
    assert scene.request.point == {"r": 1.0, "theta": 0.0}
    assert scene.request.matrix == "auto"
    assert scene.text == GOOD and scene.path.name == "scene.toml"


def test_a_scene_cannot_change(load):
    scene = load(GOOD)
    with pytest.raises(FrozenInstanceError):
        scene.title = "another"
    with pytest.raises(ValidationError):
        scene.request.matrix = "full"


def test_an_axis_is_a_range_or_a_list(load):
    request = load(GOOD).request
    np.testing.assert_allclose(request.wavenumber.samples, [1, 10, 100, 1e3, 1e4], rtol=1e-14)  # rounding of pow
    np.testing.assert_array_equal(request.wave_angle.samples, [0, 45, 90])
    np.testing.assert_array_equal(load(DIAGRAM).request.delta.samples, [-0.5, 0, 0.5])


def test_a_full_turn_keeps_both_ends(load):
    turn = load(
        GOOD.replace("[0.0, 45.0, 90.0]", "{ from = 0.0, to = 360.0, count = 1441 }")
    ).request.wave_angle.samples
    assert (turn[0], turn[-1], turn.size) == (0.0, 360.0, 1441)
    assert 36.0 in turn and isclose(turn[1], 0.25)


@pytest.mark.parametrize("path", SCENES, ids=lambda p: p.stem)
def test_every_scene_of_the_figures_loads_and_gives_its_reasons(path):
    scene = load_scene(path)
    assert all(len(why) > 10 for why in scene.assumed.values())
    assert "figure" in scene.title


def test_there_are_scenes_for_the_figures():
    assert {"L1", "P1", "P2.1", "P2.1-curve"} <= {path.stem for path in SCENES}


def test_the_scene_on_the_help_page_loads(load):
    page = manual.RUN.split("A scene:\n")[1].split("\n\n")[0]
    assert load(page).request.wave_angle.count == 1441


def test_seven_faults_of_one_scene_are_reported_at_once(problems):
    text = (
        GOOD.replace("friction_angle = 34", "friction_angle = 134", 1)  # 1: out of range
        .replace("wall_friction_angle = 9.0", "wall_frction_angle = 9.0")  # 2: misspelt
        .replace('{ value = 15.0, why = "theta_w is not given" }', "15.0")  # 3: no reason
        .replace('gravity = { value = 9.81, why = "the standard value" }', "")  # 4: missing
        .replace("count = 5", "count = 5.5")  # 5: no whole number
        .replace("[0.0, 45.0, 90.0]", '"all"')  # 6: no axis
        .replace("r = 1.0", "r = -1.0")  # 7: out of range
    )
    found = problems(text)
    assert len(found) == 7
    for start in (
        "[parameters] friction_angle = 134 deg lies outside (0, 90) deg: it is the internal angle of friction",
        "[parameters] wall_frction_angle is unknown; did you mean wall_friction_angle? (known: ",
        "[assumed] wedge_angle.why is missing: it is the reason",
        "[parameters] gravity is missing: it is the acceleration due to gravity (paper, I1), in (0, inf) m/s2",
        "[request] wavenumber.count = 5.5 should be a valid integer: it is the number of samples",
        '[request] wave_angle = "all" is neither a range nor a list: it is the directions in degrees, as in {',
        "[request] point.r = -1.0 m lies outside (0, inf) m: it is the distance from the apex",
    ):
        assert any(p.startswith(start) for p in found), start


WAVES = '{ from = 1.0, to = 1e4, count = 5, spacing = "log" }'
ANGLES = "[0.0, 45.0, 90.0]"
# The beginning of the only sentence: what to replace in the good scene, and by what.
ONE_FAULT = {
    "title is missing": ('title = "A scene of the tests"', ""),
    "title = 3 should be a valid string": ('title = "A scene of the tests"', "title = 3"),
    "closure 'pertubed' is unknown; did you mean 'perturbed'?": ('"perturbed"', '"pertubed"'),
    "flow 'hopper' is unknown": ('"radial_hopper"', '"hopper"'),
    "hue is unknown (known: title, closure, flow,": ("[parameters]", 'hue = "red"\n[parameters]'),
    '[parameters] friction_angle = "34" should be a valid number': ("= 34", '= "34"'),
    "[parameters] friction_angle = true should be a valid number": ("= 34", "= true"),
    "[parameters] friction_angle = NaN should be a finite number": ("= 34", "= nan"),
    "[parameters] friction_angle.vaule is unknown; did you mean value?": ("= 34", "= { vaule = 34 }"),
    "[assumed] epsilon stands under [parameters] too": ("[assumed]", '[assumed]\nepsilon = { value = 1, why = "?" }'),
    '[assumed] gravity.why = "" is empty': ('"the standard value"', '""'),
    '[request] kind = "growthmap" is unknown; did you mean growth_map?': ('"growth_map"', '"growthmap"'),
    "[request] kind is missing: it is what is asked, one of growth_map,": ('kind = "growth_map"', ""),
    "[request] point.theta is missing": ("r = 1.0, theta = 0.0", "r = 1.0"),
    "[request] point.phi is unknown (known: r, theta)": ("theta = 0.0 }", "theta = 0.0, phi = 0.0 }"),
    "[request] point = 1.0 is not a table": ("{ r = 1.0, theta = 0.0 }", "1.0"),
    "the point lies outside the hopper: r must lie between": ("r = 1.0", "r = 2.0"),
    "the point lies outside the hopper: |theta| must not exceed wedge_angle": ("theta = 0.0", "theta = 20.0"),
    "[request] wavenumber is missing: it is the wavenumbers in 1/m": ("wavenumber = {", "#"),
    "[request] wavenumber.to is missing": ("to = 1e4, ", ""),
    "[request] wavenumber.step is unknown (known: from, to, count, spacing)": ("count = 5", "count = 5, step = 1"),
    "[request] wavenumber.from = -1.0 1/m lies outside (0, inf) 1/m": (WAVES, "{ from = -1.0, to = 1e4, count = 5 }"),
    "[request] wavenumber.to = 0.5 must exceed from = 1": ("to = 1e4", "to = 0.5"),
    "[request] wavenumber.count = 1 should be greater than or equal to 2": ("count = 5", "count = 1"),
    "[request] wavenumber.count = 100001 should be less than or equal to 100000": ("count = 5", "count = 100001"),
    '[request] wavenumber.spacing = "cubic" should be \'linear\' or \'log\'': ('"log"', '"cubic"'),
    '[request] wave_angle.spacing = "log" needs from > 0, got 0': (ANGLES, WAVES.replace("1.0", "0")),
    "[request] wave_angle = [] is empty": (ANGLES, "[]"),
    "[request] wave_angle = [0.0, 45.0, 45.0] must increase": ("90.0]", "45.0]"),
    '[request] wave_angle[1] = "x" should be a valid number': ("45.0,", '"x",'),
    '[request] matrix = "ful" should be': ("[request]", '[request]\nmatrix = "ful"'),
    "[tolerance] growth = 2.0 should be less than 1": ("[request]", "[tolerance]\ngrowth = 2.0\n[request]"),
    '[tolerance] sign = "proven" should be': ("[request]", '[tolerance]\nsign = "proven"\n[request]'),
    '[tolerance] accuracy = "rough" should be': ("[request]", '[tolerance]\naccuracy = "rough"\n[request]'),
    "[tolerance] digits = 8 should be greater than or equal to 16": ("[request]", "[tolerance]\ndigits = 8\n[request]"),
    '[request] sampling = "random" should be': ("[request]", '[request]\nsampling = "random"'),
    '[request] sampling = "grid" excludes [tolerance] digits': (
        "[request]", '[tolerance]\ndigits = 30\n[request]\nsampling = "grid"'),
    "[request] frequency = 1 should be a valid boolean": ("[request]", "[request]\nfrequency = 1"),
    '[request] frequency = true needs matrix = "full"': (
        "[request]", '[request]\nfrequency = true\nmatrix = "leading"'),
    "[tolerance] sgin is unknown; did you mean sign?": ("[request]", '[tolerance]\nsgin = "float"\n[request]'),
}  # fmt: skip


@pytest.mark.parametrize("sentence", ONE_FAULT)
def test_one_fault_is_one_sentence_about_its_place(sentence, problems):
    good, bad = ONE_FAULT[sentence]
    assert GOOD.count(good) >= 1
    (found,) = problems(GOOD.replace(good, bad, 1))
    assert found.startswith(sentence)


def test_a_draft_that_must_be_proven_is_refused(problems):
    (found,) = problems(GOOD + '[tolerance]\naccuracy = "draft"\nsign = "certified"\n')
    assert found.startswith("[tolerance] = {") and "asks for a draft (float32) and for more at once" in found


def test_what_only_a_map_can_hold_is_refused_elsewhere(load, problems):
    assert load(DIAGRAM + "[tolerance]\ngrowth = 1e-3\n").tolerance.growth == 1e-3
    found = problems(DIAGRAM + '[tolerance]\nsign = "certified"\ndigits = 30\n')
    assert found == [
        '[tolerance] sign = "certified" belongs to a growth_map', "[tolerance] digits = 30 belongs to a growth_map"
    ]  # fmt: skip


def test_every_broken_condition_of_the_flow_is_reported(problems):
    found = problems(GOOD.replace("value = 0.5", "value = 1.6").replace("theta = 0.0", "theta = 20.0"))
    assert any(p.startswith("outlet_radius must be less than inlet_radius") for p in found)
    assert any(p.startswith("the point lies outside the hopper: |theta|") for p in found)


def test_a_wrong_table_hides_no_wrong_number(problems):
    found = problems(GOOD.replace('title = "A scene of the tests"', "").replace("= 34", "= 95"))
    assert [p.split()[0] for p in found] == ["title", "[parameters]"]


def test_without_a_valid_closure_the_words_of_the_flow_are_still_checked(problems):
    found = problems(
        GOOD.replace('"perturbed"', '"mud"').replace("wall_friction_angle = 9.0", "wall_friction_angle = 99")
    )
    assert [p.split(" ")[:2] for p in found] == [["closure", "'mud'"], ["[parameters]", "wall_friction_angle"]]


def test_of_a_list_the_first_wrong_value_is_named(problems):
    text = GOOD.replace('{ from = 1.0, to = 1e4, count = 5, spacing = "log" }', "[-3.0, -2.0, 1.0]")
    (found,) = problems(text)
    assert found.startswith("[request] wavenumber[0] = -3.0 1/m lies outside (0, inf) 1/m")


def test_more_samples_than_memory_holds_are_refused(problems):
    text = GOOD.replace("count = 5", "count = 100000").replace(
        "[0.0, 45.0, 90.0]", "{ from = 0, to = 9, count = 100000 }"
    )
    (found,) = problems(text)
    assert found.startswith("[request] asks for 1e+10 samples")


def test_a_uniform_flow_needs_no_point_and_takes_none(load, problems):
    uniform = DIAGRAM.split("[request]")[0] + (
        "epsilon = 1e-3\ndelta = 0.1\nstrain_rate = 1\npressure = 1\n"
        '[request]\nkind = "growth_map"\nwavenumber = [1.0]\nwave_angle = [0.0]\n'
    )
    assert load(uniform).request.point == {}
    (found,) = problems(uniform + "point = { r = 1.0 }\n")
    assert found.startswith("[request] point.r is unknown: this flow is uniform")


def test_a_flow_that_breaks_the_constraint_of_its_closure_is_refused(problems):
    text = DIAGRAM.split("[request]")[0].replace('"perturbed"', '"rigid_plastic"') + (
        "delta = 0.5\nstrain_rate = 1\npressure = 1\n"
        '[request]\nkind = "growth_map"\nwavenumber = [1.0]\nwave_angle = [0.0]\n'
    )
    (found,) = problems(text)
    assert found.startswith("rigid_plastic imposes its constraint exactly, but uniform_strain misses it")


def test_a_neutral_curve_may_limit_its_wavenumbers(load, problems):
    curve = GOOD.replace("growth_map", "neutral_curve").replace(', count = 5, spacing = "log"', "")
    assert load(curve).request.wavenumber.stop == 1e4
    assert load("\n".join(li for li in curve.split("\n") if not li.startswith("wavenumber"))).request.wavenumber is None
    (found,) = problems(curve.replace("to = 1e4", "to = 1e4, count = 3"))
    assert found == "[request] wavenumber.count is unknown (known: from, to)"


def test_a_phase_diagram_belongs_to_the_perturbed_closure_in_uniform_strain(load, problems):
    assert load(DIAGRAM).parameters == {"friction_angle": 34.0}
    found = problems(DIAGRAM.replace('"perturbed"', '"rigid_plastic"').replace('"uniform_strain"', '"radial_hopper"'))
    assert [p.split(" has ")[0] for p in found] == ['closure = "rigid_plastic"', 'flow = "radial_hopper"']
    (found,) = problems(DIAGRAM.replace("34.0", "34.0\nepsilon = 1e-5"))
    assert found == "[parameters] epsilon is unknown (known: friction_angle)"
    (found,) = problems(DIAGRAM.replace("[-0.5,", "[-1.5,"))
    assert found.startswith("[request] delta[0] = -1.5 lies outside (-1.41421, 1.41421)")


def test_a_file_that_is_not_toml_is_reported_with_its_line(problems):
    (found,) = problems("title = 'x'\nclosure = [1,\nflow = 2\n")
    assert found.startswith("this is not TOML: ") and "line 3" in found


def test_a_file_that_cannot_be_read_is_named(tmp_path):
    with pytest.raises(SceneError, match=r"^nowhere\.toml: No such file or directory: .*nowhere\.toml$"):
        load_scene(tmp_path / "nowhere.toml")
    with pytest.raises(SceneError, match=r"Is a directory"):
        load_scene(tmp_path)
    (tmp_path / "binary.toml").write_bytes(b"\x89HDF\xff")
    with pytest.raises(SceneError, match=r"^binary\.toml: this is not UTF-8 text \(byte 0\)"):
        load_scene(tmp_path / "binary.toml")


@pytest.mark.parametrize("value", ["3", '"x"', "[]", "[1]", "{}", "true", "1979-05-27", "{ a = 1 }", "-inf", "[{}]"])
@pytest.mark.parametrize("key", ["title", "closure", "flow", "parameters", "assumed", "request", "tolerance", "point"])
def test_no_value_anywhere_ends_in_a_traceback(key, value, load):
    if key == "point":
        text = GOOD.replace("{ r = 1.0, theta = 0.0 }", value)
    else:  # leave out the key, or the table, and write it first
        pieces = [piece for piece in re.split(r"\n(?=\[)", GOOD.strip()) if not piece.startswith(f"[{key}]")]
        text = "\n".join([f"{key} = {value}", re.sub(rf"(?m)^{key} .*", "", pieces[0]), *pieces[1:]])
    assert tomllib.loads(text)
    try:
        load(text)
    except SceneError as error:
        assert error.problems


def test_a_march_holds_what_the_file_says_and_its_defaults(load):
    request = load(MARCH).request
    assert request.mesh.model_dump() == {"kind": "polar", "elements": 400, "half": True}
    assert request.snapshots.samples.tolist() == [0.0, 0.005, 0.01, 0.015, 0.02]
    assert (request.scheme, request.solver) == ("backward_euler", "direct")
    assert load(MARCH).tolerance.newton == 1e-9
    short = MARCH.split("step = ")[0].replace('kind = "polar", ', "").replace(", half = true", "")
    assert load(short).request.step == request.step and load(short).request.mesh == request.mesh
    assert load(short).request.perturbation is None and load(short).request.checkpoint_every == 20
    assert load(short.replace("{ from = 0.0, to = 0.02, count = 5 }", "[0.01]")).request.snapshots.samples == [0.01]


def test_the_march_on_the_help_page_loads(load):
    page = manual.RUN.split("may be left out:\n")[1].split("\n\n")[0]
    scene = load(MARCH.split("[request]")[0] + page)
    assert scene.request.mesh.elements == 4000 and scene.request.snapshots.count == 11


# The beginning of the only sentence: what to replace in the march, and by what.
ONE_FAULT_OF_A_MARCH = {
    "[request] mesh is missing: it is the mesh of the hopper": ("mesh = {", "#"),
    '[request] mesh.kind = "hex" should be \'polar\', \'graded\' or \'diamond\': it is how the cells lie': (
        '"polar"', '"hex"'),
    "[request] mesh.elements = 2 should be greater than or equal to 4: it is the number of elements": ("400", "2"),
    "[request] mesh.elements = 1000001 should be less than or equal to 1000000": ("400", "1000001"),
    "[request] mesh.half = 1 should be a valid boolean": ("half = true", "half = 1"),
    "[request] mesh.elemnts is unknown; did you mean elements? (known: kind, elements, half)": ("elements", "elemnts"),
    "[request] snapshots is missing: it is the times in s": ("snapshots = {", "#"),
    "[request] snapshots = {": ("from = 0.0", "from = -0.1"),
    "[request] snapshots = [0.0] must end after t = 0 s": ("{ from = 0.0, to = 0.02, count = 5 }", "[0.0]"),
    "[request] snapshots.to = -1.0 must exceed from = 0": ("0.02", "-1.0"),
    "[request] floor is missing: it is the least ||V|| in 1/s": ("floor = ", "#"),
    "[request] floor = 0.0 1/s lies outside (0, inf) 1/s: it is the least ||V|| in the rheology": ("0.05", "0.0"),
    "[request] step.first = -1.0 s lies outside (0, inf) s: it is the first time step": (
        "1e-5, largest", "-1.0, largest"),
    "[request] step.first = \"1\" should be a valid number: it is the first time step in s": (
        "1e-5, largest", '"1", largest'),
    "[request] step = {\"first\": 0.01, ": ("first = 1e-5", "first = 1e-2"),
    "[request] scheme = \"rk4\" should be 'backward_euler' or 'bdf2': it is how time is discretised": (
        "floor", 'scheme = "rk4"\nfloor'),
    "[request] solver = \"lu\" should be 'direct' or 'iterative'": ("floor", 'solver = "lu"\nfloor'),
    "[request] perturbation.size = 1.5 lies outside (0, 1): it is the largest random velocity": ("= 1e-3", "= 1.5"),
    "[request] perturbation.seed = -1 should be greater than or equal to 0": ("seed = 1", "seed = -1"),
    "[request] perturbation.size is missing: it is the largest random velocity over": ("size = 1e-3, ", ""),
    "[request] checkpoint_every = 0 should be greater than or equal to 1": ("every = 4", "every = 0"),
    "[request] point is unknown (known: kind, mesh, snapshots, ": ("floor", "point = { r = 1.0 }\nfloor"),
    "[request] asks for 6e+08 numbers, over the limit of 5e+07: lower elements or count": (
        "elements = 400, half = true }\nsnapshots = { from = 0.0, to = 0.02, count = 5 }",
        "elements = 1000000, half = true }\nsnapshots = { from = 0.0, to = 0.02, count = 100 }"),
    "[tolerance] newton = 1.0 should be less than 1": ("newton = 1e-9", "newton = 1.0"),
    "[tolerance] growth = 0.001 is no tolerance of a march: newton is": ("newton = 1e-9", "growth = 1e-3"),
    "[tolerance] digits = 30 belongs to a growth_map": ("newton = 1e-9", "digits = 30"),
    "outlet_radius must be less than inlet_radius (outlet_radius = 1.6, inlet_radius = 1.5)": ("= 0.5", "= 1.6"),
    "wall_friction_angle must not exceed friction_angle": ("= 9.0", "= 40.0"),
}  # fmt: skip


@pytest.mark.parametrize("sentence", ONE_FAULT_OF_A_MARCH)
def test_one_fault_of_a_march_is_one_sentence_about_its_place(sentence, problems):
    good, bad = ONE_FAULT_OF_A_MARCH[sentence]
    assert MARCH.count(good) >= 1
    (found,) = problems(MARCH.replace(good, bad, 1))
    assert found.startswith(sentence)


def test_only_a_hopper_is_marched(problems):
    found = problems(DIAGRAM.split("[request]")[0] + "[request]" + MARCH.split("[request]")[1])
    assert 'flow = "uniform_strain" cannot be marched: it fills no hopper; choose radial_hopper or ' in "\n".join(found)
    (other,) = problems(MARCH.replace('"perturbed"', '"rigid_plastic"').replace("epsilon = 1e-4", ""
                        ).replace('"radial_hopper"', '"radial_hopper_compatible"'))  # fmt: skip
    assert other.startswith("[parameters] epsilon is missing")


def test_only_closures_of_velocity_and_pressure_are_marched(problems, monkeypatch):
    monkeypatch.setattr(import_module("stability.scene.runs"), "FIELDS", (("u", "v"), "p", "T"))
    (found,) = problems(MARCH)
    assert found.startswith('closure = "perturbed" cannot be marched: its fields are (u, v, p), ')


def test_a_closure_with_further_fields_is_refused_in_one_sentence(problems):
    text = MARCH.replace('"perturbed"', '"hyperstress"').replace("epsilon = 1e-4", "hyperviscosity = 1e-6")
    (found,) = problems(text)
    assert found == 'closure = "hyperstress" cannot be marched: its fields are (u, v, p, lap_u, lap_v), not (u, v, p)'


def test_newton_is_no_tolerance_of_a_map(problems):
    (found,) = problems(GOOD + "[tolerance]\nnewton = 1e-9\n")
    assert found == "[tolerance] newton = 1e-09 belongs to a march"


def test_faults_of_a_march_are_reported_at_once(problems):
    text = MARCH.replace('"polar"', '"hex"').replace("0.05", "-1.0").replace("seed = 1", "sede = 1")
    found = problems(text.replace("= 0.5", "= 1.6").replace("newton = 1e-9", "growth = 1e-3"))
    assert [p.split(" = ")[0].split(" is ")[0] for p in found] == [
        "[request] mesh.kind", "[request] perturbation.sede", "[request] floor",
        "outlet_radius must be less than inlet_radius (outlet_radius", "[tolerance] growth"
    ]  # fmt: skip
