"""The command ``stability``: its pages, its output, its exit statuses."""

import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest
from click.testing import CliRunner

from stability import codegen, runner
from stability.cli import main
from stability.closures import CLOSURES
from stability.errors import ConvergenceError, PrecisionError
from stability.results import open_results
from tests.test_scene import DIAGRAM, GOOD, MARCH

ROOT = Path(__file__).parent.parent


@pytest.fixture
def call(tmp_path, monkeypatch):
    """Call the command in an empty folder that holds scene.toml."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "scene.toml").write_text(GOOD)

    def called(*arguments: str):
        return CliRunner().invoke(main, arguments)

    return called


def process(*arguments: str, **options) -> subprocess.CompletedProcess:
    """Run the command in a process of its own, as a user does."""
    environment = os.environ | {"PYTHONPATH": str(ROOT), **options.pop("env", {})}
    command = [sys.executable, "-m", "stability", *arguments]
    return subprocess.run(command, capture_output=True, text=True, env=environment, **options)


def test_the_first_page_says_what_it_does_how_to_start_and_what_the_statuses_mean(call):
    page = call("--help").output
    for phrase in ("Linear stability", "stability run figures/scenes/P2.1.toml", "Exit status:", "0    done", "130"):
        assert phrase in page
    for command in ("run", "resume", "export", "explain", "list", "derive"):
        assert f"\n  {command} " in page


def test_help_loads_no_heavy_library():
    script = (
        "import sys\nfrom stability.cli import main\n"
        "try: main(['--help'])\nexcept SystemExit: pass\n"
        "print('loaded:', *sorted({m.split('.')[0] for m in sys.modules}))"
    )
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, cwd=ROOT, check=True)
    loaded = set(done.stdout.split("loaded:")[1].split())
    assert "click" in loaded
    assert not loaded & {"sympy", "matplotlib", "pydantic", "xarray", "numpy", "rich", "scipy", "mpmath"}


def test_a_run_writes_its_result_and_says_what_it_found(call, tmp_path):
    done = call("run", "scene.toml")
    assert done.exit_code == 0, done.output
    assert done.stdout.startswith("A scene of the tests\n")
    assert "\n  cost " in done.stdout and "s predicted\n" in done.stdout
    assert "largest growth" in done.stdout and "wedge_angle = 15: theta_w is not given" in done.stdout
    assert done.stdout.endswith(
        'wrote scene.nc; to open it: import stability; ds = stability.open_results("scene.nc")\n'
    )
    assert open_results(tmp_path / "scene.nc").attrs["scene_text"] == GOOD


def test_a_plan_is_explained_without_a_run(call, tmp_path):
    done = call("explain", "scene.toml")
    assert done.exit_code == 0, done.output
    for phrase in (
        "matrix         full",
        "precision      standard",
        "sampling       grid, 15 samples",
        "cost ",
        "reasons ",
    ):
        assert f"\n  {phrase}" in done.stdout
    assert [p.name for p in tmp_path.iterdir()] == ["scene.toml"]


def test_a_rung_that_misses_the_tolerance_is_warned_of_on_standard_error(call, tmp_path):
    (tmp_path / "scene.toml").write_text(GOOD + 'matrix = "leading"\n[tolerance]\ngrowth = 1e-3\n')
    for command in (["explain", "scene.toml"], ["run", "scene.toml", "--quiet"]):
        done = call(*command)
        assert done.exit_code == 0
        assert done.stderr.startswith("warning: the tolerance growth = 0.001 may be missed")


def test_a_quiet_run_prints_nothing(call, tmp_path):
    done = call("run", "scene.toml", "--quiet", "-o", "other.nc")
    assert (done.exit_code, done.output) == (0, "")
    assert (tmp_path / "other.nc").exists()


def test_every_problem_of_a_scene_is_a_line_on_standard_error_and_nothing_is_written(call, tmp_path):
    (tmp_path / "scene.toml").write_text(GOOD.replace("= 34", "= 134").replace("count = 5", "count = 1"))
    done = call("run", "scene.toml")
    assert done.exit_code == 2 and done.stdout == ""
    assert [line.split(" = ")[0] for line in done.stderr.splitlines()] == [
        "error: scene.toml: [request] wavenumber.count",
        "error: scene.toml: [parameters] friction_angle",
    ]
    assert not (tmp_path / "scene.nc").exists()


@pytest.mark.parametrize(
    ("output", "says"),
    [("nowhere/x.nc", "there is no folder nowhere"), (".", "is a folder"), ("scene.toml", "is the scene itself")],
)
def test_a_place_that_cannot_be_written_is_refused_before_the_run(output, says, call, monkeypatch, tmp_path):
    monkeypatch.setattr(runner, "KINDS", {})  # an analysis that started would fail
    done = call("run", "scene.toml", "-o", output)
    assert done.exit_code == 2 and says in done.stderr
    assert (tmp_path / "scene.toml").read_text() == GOOD


@pytest.mark.parametrize(
    ("raised", "status", "says"),
    [
        (ConvergenceError("no decrease after 9 halvings"), 3, "error: no decrease after 9 halvings\n"),
        (PrecisionError("30 digits do not decide"), 3, "error: 30 digits do not decide\n"),
        (KeyboardInterrupt(), 130, "error: interrupted: nothing was written\n"),
    ],
    ids=["convergence", "precision", "interrupted"],
)
def test_a_failure_has_its_status_and_no_traceback(raised, status, says, call, monkeypatch, tmp_path):
    def fails(scene, planned, report):
        raise raised

    monkeypatch.setitem(runner.KINDS, "growth_map", fails)
    done = call("run", "scene.toml")
    assert (done.exit_code, done.stderr) == (status, says)
    assert not (tmp_path / "scene.nc").exists()


def test_a_disk_that_fails_is_named(call, monkeypatch):
    def full(ds, path):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("stability.results.save", full)
    done = call("run", "scene.toml")
    assert done.exit_code == 2
    assert done.stderr == "error: --output scene.nc cannot be written: No space left on device\n"


def test_statuses_reach_the_shell(tmp_path):
    (tmp_path / "scene.toml").write_text(GOOD)
    assert process("run", "scene.toml", cwd=tmp_path).returncode == 0
    missing = process("run", "absent.toml", cwd=tmp_path)
    assert missing.returncode == 2 and missing.stderr.startswith("error: absent.toml: No such file")
    assert process("rum", cwd=tmp_path).returncode == 2


@pytest.fixture
def strangers(tmp_path):
    """Fill a folder with files that are named as packages, each of which leaves a trace when it is run."""
    for name in ("click", "numpy", "pandas", "pydantic", "rich", "scipy", "sympy", "tomllib", "xarray", "json"):
        (tmp_path / f"{name}.py").write_text(f"open('ran_{name}', 'w').close()\nraise ImportError\n")
    (tmp_path / "scene.toml").write_text(GOOD)
    return tmp_path


def test_no_module_of_the_present_folder_stands_in_for_a_package(strangers):
    done = process("run", "scene.toml", cwd=strangers)
    assert done.returncode == 0, done.stderr
    assert (strangers / "scene.nc").exists() and not list(strangers.glob("ran_*"))


def test_the_present_folder_is_still_where_a_closure_of_ones_own_is_looked_for(strangers):
    own = "from stability.closures.drucker_prager import PERTURBED as OWN\n"
    (strangers / "own.py").write_text(own)
    done = process("derive", "own.py:OWN", "--matrix", "leading", cwd=strangers)
    assert done.returncode == 0 and "[2, 2] =" in done.stdout, done.stderr
    assert not list(strangers.glob("ran_*"))


def test_the_command_runs_from_a_checkout_and_where_python_was_told_to_be_safe(tmp_path):
    plain = [sys.executable, "-m", "stability", "--version"]
    bare = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
    done = subprocess.run(plain, capture_output=True, text=True, cwd=ROOT, env=bare)
    assert done.returncode == 0 and done.stdout.startswith("stability "), done.stderr
    safe = process("--version", cwd=tmp_path, env={"PYTHONSAFEPATH": "1"})
    assert safe.returncode == 0, safe.stderr


@pytest.mark.skipif(sys.platform == "win32", reason="no SIGINT to send")
def test_an_interrupt_ends_a_long_run_with_its_status_and_without_a_file(tmp_path):
    long = DIAGRAM.replace("{ values = [-0.5, 0.0, 0.5] }", "{ from = -0.5, to = 1.2, count = 20000 }")
    (tmp_path / "long.toml").write_text(long.replace("count = 3", "count = 301"))
    command = [sys.executable, "-m", "stability", "run", "long.toml"]
    environment = os.environ | {"PYTHONPATH": str(ROOT)}

    def heeding() -> None:
        signal.signal(
            signal.SIGINT, signal.SIG_DFL
        )  # a shell's background job, such as a CI run, is started deaf to it

    options = {"cwd": tmp_path, "env": environment, "stderr": subprocess.PIPE, "text": True, "preexec_fn": heeding}
    with subprocess.Popen(command, **options) as running:
        heartbeat = running.stderr.readline()  # the run has begun, and says so where there is no terminal
        running.send_signal(signal.SIGINT)
        rest = running.stderr.read()
    assert heartbeat.startswith("long: ") and "left" in heartbeat
    assert running.returncode == 130
    assert rest.splitlines()[-1] == "error: interrupted: nothing was written"
    assert [p.name for p in tmp_path.iterdir()] == ["long.toml"]


SMALL = MARCH.replace("elements = 400", "elements = 60").replace("to = 0.02, count = 5", "to = 1e-3, count = 3")


@pytest.fixture
def marching(call, tmp_path):
    """Call the command in a folder that holds small.toml, a march of a fraction of a second."""
    (tmp_path / "scene.toml").unlink()
    (tmp_path / "small.toml").write_text(SMALL)
    return call


def test_a_march_is_explained_run_and_exported(marching, tmp_path):
    told = marching("explain", "small.toml")
    assert told.exit_code == 0, told.output
    for phrase in ("mesh           polar, 60 elements", "unknowns       2", "time           to 0.001 s, 3 snapshots",
                   "cost ", "reasons        waves: the first are expected where mu is largest"):  # fmt: skip
        assert f"\n  {phrase}" in told.stdout
    assert "warning: 1.1 cells in a wavelength are too few, 10 resolve it" in told.stderr
    done = marching("run", "small.toml")
    assert done.exit_code == 0, done.output
    for phrase in ("perturbed on radial_hopper\n", "marched        to t = 0.001 s, 3 snapshots", "wedge_angle = 15: "):
        assert phrase in done.stdout
    assert sorted(p.name for p in tmp_path.iterdir()) == ["small.nc", "small.toml"], "the checkpoint is removed"
    written = marching("export", "small.nc", "--vtk", "vtk")
    assert written.stdout == "wrote vtk/small.pvd and 3 snapshots beside it; open it in ParaView\n"
    assert len(list((tmp_path / "vtk").glob("small_000?.vts"))) == 3


def test_what_cannot_be_exported_is_named(marching, tmp_path):
    (tmp_path / "map.toml").write_text(GOOD)
    marching("run", "map.toml", "-q")
    for result, says in (
        ("map.nc", "map.nc is not the result of a march or a field_map"),
        ("none.nc", "none.nc cannot be read as a result: "),
        ("small.toml", "small.toml is no netCDF file"),
    ):
        done = marching("export", result, "--vtk", "vtk")
        assert done.exit_code == 2 and done.stderr.startswith(f"error: {says}"), done.output


def test_a_march_that_fails_has_its_status_and_can_be_continued_by_a_changed_scene(marching, tmp_path):
    (tmp_path / "hard.toml").write_text(SMALL.replace("newton = 1e-9", "newton = 1e-30"))  # beyond rounding
    done = marching("run", "hard.toml")
    assert done.exit_code == 3, done.output
    assert done.stderr.splitlines()[-1].startswith("error: Newton's method fails at time 0 s, step 1")
    assert "stability resume hard.nc.checkpoint --scene CHANGED.toml" in done.stderr
    again = marching("resume", "hard.nc.checkpoint", "--scene", "small.toml", "-o", "easy.nc")
    assert again.exit_code == 0, again.output
    assert "going on from hard.nc.checkpoint: step 0, t = 0 s" in again.stderr
    assert "continued      from step 0, t = 0 s of another scene" in again.stdout
    assert not (tmp_path / "hard.nc.checkpoint").exists()


def test_a_checkpoint_that_cannot_be_used_has_the_status_of_bad_input_and_is_kept(marching, tmp_path):
    kept = tmp_path / "small.nc.checkpoint"
    kept.write_bytes(b"something else")
    for command in (("run", "small.toml"), ("resume", "small.nc.checkpoint")):
        done = marching(*command)
        assert done.exit_code == 2
        assert done.stderr == (
            "error: small.nc.checkpoint is not a checkpoint of this toolkit's present format: name another file\n"
        )
    assert kept.read_bytes() == b"something else"
    assert marching("resume", "none.checkpoint").exit_code == 2
    assert "is a folder" in marching("resume", "none.checkpoint", "-o", ".").stderr


def test_a_result_that_cannot_be_written_costs_no_march(marching, monkeypatch, tmp_path):
    def full(ds, path):
        raise OSError(28, "No space left on device")

    with monkeypatch.context() as patched:
        patched.setattr("stability.results.save", full)
        done = marching("run", "small.toml")
    assert done.exit_code == 2
    assert done.stderr.splitlines()[-1] == (
        "error: --output small.nc cannot be written: No space left on device; the run is kept in "
        "small.nc.checkpoint: make room, then stability resume small.nc.checkpoint"
    )
    assert marching("resume", "small.nc.checkpoint").exit_code == 0
    assert sorted(p.name for p in tmp_path.iterdir()) == ["small.nc", "small.toml"]


def test_a_map_loads_no_solver(tmp_path):
    (tmp_path / "scene.toml").write_text(GOOD)
    script = (
        "import sys\nfrom stability.cli import main\n"
        "try: main(['explain', 'scene.toml'])\n"
        "except SystemExit: print(*(m for m in sys.modules if 'timestepper' in m))"
    )
    environment = os.environ | {"PYTHONPATH": str(ROOT)}
    command = [sys.executable, "-c", script]
    done = subprocess.run(command, capture_output=True, text=True, cwd=tmp_path, env=environment, check=True)
    assert done.stdout.splitlines()[-1] == ""


@pytest.mark.parametrize("variable", ["NO_COLOR", None])
def test_errors_are_red_on_a_terminal_unless_no_colour_is_asked_for(variable, tmp_path, monkeypatch):
    monkeypatch.delenv("NO_COLOR", raising=False)
    if variable:
        monkeypatch.setenv(variable, "1")
    done = CliRunner().invoke(main, ["run", str(tmp_path / "absent.toml")], color=True)
    assert ("\x1b[31m" in done.stderr) is (variable is None)


def test_a_list_has_every_entry_and_every_parameter(call):
    page = call("list").output
    for phrase in (
        'closure = "perturbed"',
        'flow = "uniform_strain"',
        "epsilon",
        "(0, 90)",
        "m/s2",
        "paper, I2",
        "e_theta",
    ):
        assert phrase in page
    assert "\n  provides the fields u, v, p, lap_u, lap_v, spin, n1, n2\n" in page
    assert "\n  needs the fields u, v, p, lap_u, lap_v\n" in page
    assert "flow =" not in call("list", "closures").output
    assert "closure =" not in call("list", "flows").output
    assert call("list", "walls").exit_code == 2


def test_a_list_derives_nothing(call, tmp_path, monkeypatch):
    monkeypatch.setenv("STABILITY_CACHE", str(tmp_path / "cold"))
    codegen.namespace.cache_clear()
    monkeypatch.setattr("stability.emit.source", lambda entry: pytest.fail("derived"))
    page = call("list", "closures").output
    assert all(f'closure = "{name}"' in page for name in CLOSURES)
    codegen.namespace.cache_clear()


def test_a_list_needs_no_sympy_and_no_unicode(tmp_path):
    process("list")  # warms the cache of records
    script = (
        "import sys\nfrom stability.cli import main\n"
        "try: main(['list'])\nexcept SystemExit: print('sympy' in sys.modules)"
    )
    environment = os.environ | {"LC_ALL": "C", "PYTHONUTF8": "0", "PYTHONCOERCECLOCALE": "0"}
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, cwd=ROOT, env=environment, check=True)
    assert done.stdout.decode("ascii").endswith("False\n")


def test_a_tangent_matrix_is_printed_in_three_ways(call):
    from sympy import Matrix, sympify

    import stability as st

    text = call("derive", "perturbed", "--matrix", "leading").output
    assert "[2, 2] =" in text and "\nmu = k*p/N\n" in text and text.isascii()
    python = call("derive", "perturbed", "--matrix", "leading", "--format", "python").output
    M = st.tangent_matrix("perturbed", matrix="leading")
    names = {str(s): s for s in M.free_symbols}
    assert sympify(python, locals=names | {"Matrix": Matrix}) == Matrix(M)
    assert call("derive", "perturbed", "--matrix", "leading", "--format", "latex").output.startswith(
        r"\left[\begin{matrix}"
    )


def test_a_tangent_matrix_can_be_written_out_on_a_flow(call):
    text = call("derive", "perturbed", "--flow", "uniform_strain", "--matrix", "leading").output
    assert "delta" in text and "A_xx" not in text


def test_unknown_names_are_refused_with_the_nearest_known_one(call):
    for arguments, says in (
        (["derive", "perturbd"], "error: closure 'perturbd' is unknown; did you mean 'perturbed'?"),
        (["derive", "perturbed", "--flow", "uniform"], "error: flow 'uniform' is unknown"),
        (["lst"], "No such command 'lst'"),
    ):
        done = call(*arguments)
        assert done.exit_code == 2 and says in done.stderr


def test_the_version_is_that_of_the_package(call):
    from stability import __version__

    assert call("--version").output == f"stability {__version__}\n"
