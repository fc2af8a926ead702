"""A user's own closure in their own file: the one way in which a name runs code, and every way in which it fails."""

import logging
import re
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner

import stability as st
from stability import codegen, plotting, userfile
from stability.cli import main
from stability.errors import SceneError
from stability.results import open_results

TEN_LINES = """
from sympy import eye, sin, sqrt
from stability import Closure, Parameter
from stability.closures.base import norm
from stability.closures.plane_flow import V, momentum_and_mass, velocity
from stability.parameters import FRICTION_ANGLE
from stability.symbols import p, symbol, varphi

VISCOSITY = Parameter("viscosity", "nu", "m2/s", 0, 1e9, "kinematic viscosity", "this example")
stress = p * eye(2) - sqrt(2) * sin(varphi) * p * V / norm(V) - 2 * symbol("nu") * V
SLOW = Closure(name="slow", title="Coulomb with viscosity", source="this example",
               **momentum_and_mass(stress, velocity), parameters=(FRICTION_ANGLE, VISCOSITY))
"""
SCENE = """
title = "A closure of my own"
closure = "my_file.py:SLOW"
flow = "uniform_strain"
[parameters]
friction_angle = 34.0
viscosity = 0.02
delta = 0.0
strain_rate = 1.0
pressure = 1.0
[request]
kind = "well_posedness"
"""
STRAIN = {"friction_angle": 34.0, "delta": 0.0, "strain_rate": 1.0, "pressure": 1.0}
RIGID = "from stability.closures.drucker_prager import RIGID_PLASTIC as OWN\n"


@pytest.fixture
def folder(tmp_path, monkeypatch) -> Path:
    """Return the present folder, with my_file.py and a scene that names it."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "my_file.py").write_text(TEN_LINES)
    (tmp_path / "scene.toml").write_text(SCENE)
    return tmp_path


def refused(word: str, folder: Path | None = None) -> str:
    """Return the one sentence with which a name is refused."""
    with pytest.raises(SceneError) as caught:
        userfile.entry("closure", word, folder)
    (problem,) = caught.value.problems
    assert "\n" not in problem and problem.startswith(f'closure = "{word}"')
    return problem.removeprefix(f'closure = "{word}"').removeprefix(": ")


def test_the_page_about_closures_does_what_it_shows(tmp_path, monkeypatch):
    page = (Path(__file__).parent.parent / "docs" / "adding-a-closure.md").read_text(encoding="utf-8")
    blocks = dict(re.findall(r"```(python|toml|text)\n(.*?)```", page, re.DOTALL))
    (tmp_path / "my_file.py").write_text(blocks["python"])
    (tmp_path / "scene.toml").write_text(blocks["toml"])
    monkeypatch.chdir(tmp_path)
    done = CliRunner().invoke(main, ["run", "scene.toml"])
    assert done.exit_code == 0, done.output
    executes, shown = blocks["text"].split("\n", 1)
    assert done.stdout.startswith(shown)
    assert done.stderr == f"{executes.replace('...', str(tmp_path))}\n"


def test_a_closure_in_a_file_is_the_registered_one_of_the_same_laws(folder):
    wave = ("uniform_strain", STRAIN | {"viscosity": 0.02}, {}, 100.0, np.linspace(0, 90, 7))
    own = st.eigenvalues("my_file.py:SLOW", *wave)
    given = ("uniform_strain", STRAIN | {"kinematic_viscosity": 0.02}, *wave[2:])
    np.testing.assert_allclose(own, st.eigenvalues("viscous", *given), rtol=1e-12, atol=1e-12 * abs(own).max())


def test_a_scene_names_a_closure_of_its_folder_from_wherever_it_is_run(folder, monkeypatch):
    monkeypatch.chdir("/")
    ds = st.run(folder / "scene.toml")
    assert ds.attrs["closure"] == "slow" and ds.attrs["verdict"] == "ill-posed"
    # exact: a viscosity is subtracted from the largest growth of Coulomb flow, (mu/2) tan^2(varphi/2)
    tangent, sine = np.tan(np.radians(17)), np.sin(np.radians(34))
    assert abs(ds.coefficient.item() / (sine * tangent**2 / np.sqrt(2) - 0.02) - 1) < 1e-12
    assert str(folder) not in str(ds.attrs), "a result holds no paths"


def test_the_command_says_that_it_executes_the_file(folder):
    (folder / "my_file.py").write_text(TEN_LINES + "\n# said once for each text of a file\n")
    done = CliRunner().invoke(main, ["run", "scene.toml"])
    assert done.exit_code == 0, done.output
    assert done.stderr == f"stability: executes {folder / 'my_file.py'}\n"
    assert "verdict        ill-posed: short waves grow without bound, as 0.0169593821" in done.stdout
    assert open_results(folder / "scene.nc").attrs["sentence"].startswith("ill-posed")


def test_a_matrix_is_derived_from_a_file(folder):
    done = CliRunner().invoke(main, ["derive", "my_file.py:SLOW", "--matrix", "leading", "--format", "python"])
    assert done.exit_code == 0 and done.stdout.startswith("Matrix([["), done.output


def test_a_flow_in_a_file_is_a_flow_too(folder):
    (folder / "my_flow.py").write_text("from stability.flows.uniform_strain import UNIFORM_STRAIN as FLOW\n")
    given = (STRAIN, {}, 100.0, 37.0)
    own, registered = (st.eigenvalues("rigid_plastic", f, *given) for f in ("my_flow.py:FLOW", "uniform_strain"))
    assert own == registered
    with pytest.raises(SceneError, match=r'^flow = "my_file.py:SLOW": SLOW is of type Closure, not a Flow '):
        st.eigenvalues("rigid_plastic", "my_file.py:SLOW", *given)


def test_a_changed_file_is_run_again_and_an_unchanged_one_is_not(folder, caplog):
    caplog.set_level(logging.INFO, "stability")
    path = folder / "own.py"
    path.write_text(RIGID)
    one = userfile.entry("closure", "own.py:OWN")
    assert userfile.entry("closure", "own.py:OWN") is one and len(caplog.messages) == 1
    path.write_text(RIGID.replace("RIGID_PLASTIC", "PERTURBED"))
    assert userfile.entry("closure", "own.py:OWN").name == "perturbed"
    assert caplog.messages == [f"executes {path}"] * 2


def test_a_closure_of_a_file_is_derived_once_for_all_processes(folder, monkeypatch):
    wave = ("uniform_strain", STRAIN | {"viscosity": 0.02}, {}, 100.0, 37.0)
    first = st.eigenvalues("my_file.py:SLOW", *wave)
    for memory in (codegen.namespace, codegen.signature, userfile.run):
        memory.cache_clear()  # as another process begins
    monkeypatch.setattr(codegen, "generate", lambda *_: pytest.fail("derived again in spite of the cache"))
    assert st.eigenvalues("my_file.py:SLOW", *wave) == first


def test_dataclasses_in_a_file_find_their_module(folder):
    text = "from __future__ import annotations\nfrom dataclasses import dataclass\n@dataclass\nclass A:\n    x: int\n"
    (folder / "own.py").write_text(text + RIGID)
    assert userfile.entry("closure", "own.py:OWN").name == "rigid_plastic"


def scene_problems(folder: Path, name: str) -> str:
    (folder / "scene.toml").write_text(SCENE.replace("my_file.py:SLOW", name))
    with pytest.raises(SceneError) as caught:
        st.load_scene(folder / "scene.toml")
    return caught.value.problems[0]


def test_a_scene_runs_no_relative_file_outside_its_folder(folder):
    inside = folder / "scenes"
    inside.mkdir()
    (folder / "other.py").write_text("raise SystemExit('must not run')")
    for name in ("../other.py:OWN", "../scenes/../other.py:OWN"):
        assert "lies outside the scene's folder" in scene_problems(inside, name)
    (inside / "link.py").symlink_to(folder / "other.py")
    assert "lies outside the scene's folder" in scene_problems(inside, "link.py:OWN")
    assert "other.py line 1: SystemExit: must not run" in scene_problems(inside, f"{folder / 'other.py'}:OWN")


def test_a_script_may_name_a_file_anywhere(folder, monkeypatch):
    (folder / "below").mkdir()
    monkeypatch.chdir(folder / "below")
    assert userfile.entry("closure", "../my_file.py:SLOW").name == "slow"


OTHERS = ("my_file", "my_file.py", "my_file:SLOW", "os:system", "my_file.pyc:SLOW", "my_file.SLOW")


@pytest.mark.parametrize("name", OTHERS)
def test_no_other_form_of_name_runs_anything(name, folder, monkeypatch):
    monkeypatch.setattr(userfile, "run", lambda *_: pytest.fail("ran a file"))
    assert "is unknown" in scene_problems(folder, name)


def test_a_name_without_what_it_defines_says_how_to_name_it(folder):
    assert 'name what the file defines too, as in "my_file.py:NAME"' in scene_problems(folder, "my_file.py")


LAWS = "**momentum_and_mass(stress, velocity)"
# What is appended to or replaced in the ten lines: the only sentence.
FAULTS = {
    "twice": ("parameters=(FRICTION", "evolves=(1, 1), parameters=(FRICTION", "got multiple values for"),
    "counts": (LAWS, f"{LAWS} | {{'evolves': (1, 1)}}",
               r"my_file.py line 1[12]: closure slow: 3 components of q need 3 entries of E and S and an 3 x 2 flux"),
    "a two in E": (LAWS, f"{LAWS} | {{'evolves': (1, 2, 0)}}",
                   r"evolves = \(1, 2, 0\) may hold 1 \(evolution\) and 0 \(constraint\) only$"),
    "undeclared": ("(FRICTION_ANGLE, VISCOSITY)", "(FRICTION_ANGLE,)",
                   r"my_file.py line 1[12]: closure slow uses undeclared symbols \['nu'\]: declare each as a "),
    "no range": ("0, 1e9, ", "", r"line 9: missing 2 required positional arguments: 'meaning' and 'source': a "
                 r"Parameter is \(word, symbol, unit, low, high, meaning, source\)"),
    "range of words": ("0, 1e9", "'small', 'large'", r"line 9: parameter viscosity has no range: low and high must be"),
    "empty range": ("0, 1e9", "1, 1", r"line 9: parameter viscosity has no range: .* got 1 and 1$"),
    "same symbol": ("ANGLE, VISCOSITY)", "ANGLE, VISCOSITY, Parameter('other', 'nu', '1', 0, 1, '', ''))",
                    r"closure slow: the parameter viscosity and the parameter other share the symbol 'nu': choose "),
    "pressure's symbol": ('"nu", "m2/s"', '"p", "m2/s"',
                          r"the field p and the parameter viscosity share the symbol 'p': choose another"),
    "plain symbol": ('symbol("nu")', '__import__("sympy").Symbol("nu")', r"make it by stability.symbols.symbol\("),
    "hyperbolic": ("sin(varphi)", "__import__('sympy').tanh(varphi)", r"holds tanh\(varphi\).*: write it by exp, as "),
    "no record": ("(FRICTION_ANGLE, VISCOSITY)", "('friction_angle',)",
                  r"parameters holds friction_angle \(of type str\): give Parameter\(word, "),
    "name": ('name="slow"', "name=3", r"my_file.py line 1[12]: closure: name must be text that is not empty, got 3 "),
    "syntax": ("VISCOSITY = ", "VISCOSITY = = ", r"my_file.py line 9: this is not Python: invalid syntax$"),
    "error": ("sqrt(2)", "square_root(2)", r"my_file.py line 10: NameError: name 'square_root' is not defined$"),
    "no such name": ("SLOW =", "FAST =", r"my_file.py has no SLOW \(my_file.py defines FAST\)$"),
    "no closure": ("SLOW = Closure(", "SLOW = dict(",
                   r"SLOW is of type dict, not a Closure \(my_file.py defines no Closure\)$"),
}  # fmt: skip


@pytest.mark.parametrize("fault", FAULTS)
def test_a_closure_that_is_not_self_consistent_is_refused_in_one_sentence(fault, folder):
    old, new, said = FAULTS[fault]
    assert old in TEN_LINES
    (folder / "my_file.py").write_text(TEN_LINES.replace(old, new, 1))
    assert re.search(said, refused("my_file.py:SLOW"))


@pytest.mark.parametrize("fault", FAULTS)
def test_the_command_tells_a_fault_without_a_traceback(fault, folder):
    old, new, said = FAULTS[fault]
    (folder / "my_file.py").write_text(TEN_LINES.replace(old, new, 1))
    done = CliRunner().invoke(main, ["run", "scene.toml"])
    assert done.exit_code == 2 and isinstance(done.exception, SystemExit)
    assert re.search(said.removesuffix("$"), done.stderr) and "Traceback" not in done.output


@pytest.mark.parametrize(
    ("word", "said"),
    [
        ("none.py:SLOW", "No such file or directory: "),
        ("my_file.py:", "the name after the colon is missing (my_file.py defines SLOW)"),
        ("binary.py:SLOW", "binary.py is not UTF-8 text (byte 0)"),
        (".py:SLOW", "No such file or directory: "),
    ],
)
def test_a_file_that_cannot_be_read_is_named(word, said, folder):
    (folder / "binary.py").write_bytes(b"\xff\xfe")
    assert refused(word).startswith(said)


def test_faults_of_file_and_scene_are_reported_together(folder):
    (folder / "my_file.py").write_text("SLOW = 1")
    (folder / "scene.toml").write_text(SCENE.replace('kind = "well_posedness"', 'kind = "well"'))
    with pytest.raises(SceneError) as caught:
        st.load_scene(folder / "scene.toml")
    assert [p.split(" = ")[0] for p in caught.value.problems] == ["scene.toml: [request] kind", "scene.toml: closure"]


def test_a_map_of_an_own_closure_has_its_signs_proven(folder):
    waves = 'kind = "growth_map"\nwavenumber = [10.0, 100.0]\nwave_angle = [37.0, 60.0]\n'
    text = SCENE.replace('kind = "well_posedness"', waves + '[tolerance]\nsign = "certified"')
    (folder / "scene.toml").write_text(text)
    ds = st.run("scene.toml")
    assert ds.attrs["sign"].startswith("certified: 4 samples") and ds.sign.values.tolist() == [[1, 1], [-1, -1]]


def test_a_result_from_elsewhere_runs_nothing(folder, monkeypatch):
    ds = st.growth_map("rigid_plastic", "uniform_strain", STRAIN, {}, [10.0], [37.0])
    monkeypatch.setattr(userfile, "run", lambda *_: pytest.fail("ran a file"))
    for name in ("my_file.py:SLOW", "slow"):
        foreign = ds.assign_attrs(closure=name)
        for use in (st.certify, lambda ds: plotting.caption("What is seen.", ds)):
            with pytest.raises(SceneError, match=f"closure '{name}' is unknown"):
                use(foreign)
