"""The plan picks the cheapest rung of the ladder that holds the tolerance, and says what it will miss."""

import json
import subprocess
import sys
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from stability import plan as planning
from stability.model import Model
from stability.plan import plan
from stability.probe import SAFETY, growth, perturbation, probe, rounding
from stability.runner import ROUNDING, run
from stability.scene import load_scene
from stability.scene.messages import REQUESTS
from tests.conftest import HOPPER
from tests.test_scene import DIAGRAM, GOOD, MARCH

LADDER = Path(__file__).parent.parent / "figures" / "scenes" / "ladder"
# Scene -> the rung that it is for (matrix, precision, sampling), and how its error is known.
RUNGS = {
    "leading": ("leading", "standard", "grid", "measured"),
    "truncated": ("truncated", "standard", "grid", "bound"),
    "truncated-hopper": ("truncated", "standard", "grid", "measured"),
    "full": ("full", "standard", "grid", "exact"),
    "draft": ("full", "draft", "grid", "bound"),
    "certified": ("full", "certified", "grid", "exact"),
    "adaptive": ("full", "standard", "adaptive", "measured"),
    "curve": ("full", "standard", "exact neutral curve", "exact"),
    "boundary": ("truncated", "standard", "closed-form boundary", "exact"),
}
UNIFORM = {"friction_angle": 34.0, "epsilon": 2e-5, "delta": 0.1, "strain_rate": 2.0, "pressure": 2.0}


@cache
def result(name: str):
    return run(LADDER / f"{name}.toml")


@pytest.fixture
def planned(tmp_path):
    def of(text: str):
        path = tmp_path / "scene.toml"
        path.write_text(text)
        return plan(load_scene(path))

    return of


def test_every_scene_of_the_ladder_has_its_rung():
    assert {path.stem for path in LADDER.glob("*.toml")} == RUNGS.keys()


@pytest.mark.parametrize("name", RUNGS)
def test_every_rung_is_picked_by_a_scene(name):
    found = plan(load_scene(LADDER / f"{name}.toml"))
    assert (found.matrix, found.precision, found.sampling, found.error_kind) == RUNGS[name]
    assert not found.warnings and found.predicted_seconds > 0 and found.samples > 0


def test_the_scenes_reach_every_rung():
    rungs = list(zip(*RUNGS.values(), strict=True))
    assert set(rungs[0]) == {"leading", "truncated", "full"}
    assert set(rungs[1]) == {"draft", "standard", "certified"}
    assert set(rungs[2]) == {"closed-form boundary", "exact neutral curve", "adaptive", "grid"}


@pytest.mark.parametrize("name", RUNGS)
def test_the_true_error_is_within_the_predicted_one_and_the_tolerance(name):
    ds, scene = result(name), load_scene(LADDER / f"{name}.toml")
    text, told = ds.attrs["true_error"], json.loads(ds.attrs["plan"])
    assert ds.attrs["plan_reason"].splitlines() == list(told["reasons"])
    if text.startswith("not probed"):
        assert told["error_kind"] == "exact"
    else:
        assert float(text) <= max(told["predicted_error"], ROUNDING)
        assert told["predicted_error"] <= scene.tolerance.growth


@pytest.mark.parametrize(("name", "matrix"), [("truncated-hopper", "truncated"), ("leading", "leading")])
def test_the_probe_finds_the_largest_growth_and_error_of_the_whole_map(name, matrix):
    scene = load_scene(LADDER / f"{name}.toml")
    ask = scene.request
    base = Model(scene.closure, scene.flow).base(scene.parameters, ask.point)
    full, cheap = (base.form(ask.wave_angle.samples, m).filled(ask.wave_angle.samples.size).column()
                   for m in ("full", matrix))  # fmt: skip
    exact, found = (growth(form, ask.wavenumber.samples) for form in (full, cheap))
    waves = probe(base, ask.wave_angle.samples, ask.wavenumber.samples)
    np.testing.assert_allclose(waves.scale, exact.max(), rtol=1e-2)  # the tip of a tongue between two rows of the probe
    true = np.max(np.abs(found - exact) / np.maximum(exact.max(), np.abs(exact)))
    measured = waves.error(np.abs(found[waves.rows, waves.columns] - waves.truth))
    assert measured <= true * (1 + 1e-2) and true <= SAFETY * measured


@pytest.mark.parametrize("matrix", ["truncated", "leading"])
@pytest.mark.parametrize(
    ("flow", "parameters", "point"),
    [("radial_hopper", HOPPER | {"epsilon": 2e-5}, {"r": 1.0, "theta": 3.0}), ("uniform_strain", UNIFORM, {})],
    ids=["hopper", "uniform"],
)
def test_the_perturbation_bound_holds(flow, parameters, point, matrix):
    base = Model("perturbed", flow).base(parameters, point)
    random = np.random.default_rng(1)
    angle, q = random.uniform(0, 360, 4000), 10 ** random.uniform(-1, 5, 4000)
    full, cheap = (base.form(angle, m).filled(angle.size) for m in ("full", matrix))
    true, bound = np.abs(growth(cheap, q) - growth(full, q)), perturbation(full, cheap, q)
    assert np.all(true <= bound * (1 + 1e-9) + 1e-9 * np.abs(growth(full, q)))  # 1e-9: rounding of both


def test_in_a_uniform_flow_the_bound_of_the_truncation_does_not_grow_with_the_wavenumber():
    base = Model("perturbed", "uniform_strain").base(UNIFORM, {})
    q = np.geomspace(1e2, 1e8, 7)
    full, cheap = (base.form(np.full(7, 20.0), m).filled(7) for m in ("full", "truncated"))
    bound = perturbation(full, cheap, q)
    assert bound.max() < 10 * UNIFORM["strain_rate"]  # D - D' = -grad u (and a shift of the frequency)


@pytest.mark.parametrize("closure", ["perturbed", "rigid_plastic"])
def test_the_rounding_bound_covers_float32(closure, tmp_path):
    from stability.analyses.growth_map import growth_map

    parameters = HOPPER | ({"epsilon": 2e-5} if closure == "perturbed" else {})
    angle, q = np.linspace(0, 360, 241), np.geomspace(1, 3e4, 121)
    question = closure, "radial_hopper", parameters, {"r": 1.0, "theta": 0.0}, q, angle
    draft, exact = (growth_map(*question, accuracy=a).growth_rate.values for a in ("draft", "standard"))
    form = Model(closure, "radial_hopper").base(parameters, question[3]).form(angle).filled(angle.size).column()
    assert np.all(np.abs(draft - exact) <= rounding(form, q))


def test_without_a_tolerance_nothing_is_approximated_or_probed(planned):
    found = planned(GOOD)
    assert (found.matrix, found.precision, found.sampling, found.error_kind) == ("full", "standard", "grid", "exact")
    assert found.probe is None and found.true_error(np.zeros((3, 5))) is None
    assert planned(GOOD + 'sampling = "adaptive"\n').matrix == "full"
    assert planned(GOOD + 'matrix = "truncated"\n').precision == "standard"


def test_a_tighter_tolerance_never_takes_a_cheaper_rung(planned):
    costs = [planned(GOOD + f"[tolerance]\ngrowth = {t}\n") for t in (0.9, 0.1, 1e-3, 1e-8)]
    order = [(list(planning.LETTER).index(p.matrix), p.precision) for p in costs]
    assert [rung[0] for rung in order] == sorted(rung[0] for rung in order)
    assert costs[-1].matrix == "full" and costs[-1].precision == "standard"


@pytest.mark.parametrize("demand", ['[tolerance]\ngrowth = 0.5\nsign = "certified"\n',
                                    "frequency = true\n[tolerance]\ngrowth = 0.5\n"])  # fmt: skip
def test_what_only_d_has_keeps_the_full_matrix(planned, demand):
    found = planned(GOOD + demand)
    assert found.matrix == "full" and any("asked for" in reason for reason in found.reasons)


@pytest.mark.parametrize(
    ("named", "rung"),
    [('matrix = "leading"\n[tolerance]\n', "leading"), ('[tolerance]\naccuracy = "draft"\n', "draft"),
     ('sampling = "adaptive"\n[tolerance]\n', "adaptive")],
)  # fmt: skip
def test_a_named_rung_is_taken(planned, named, rung):
    found = planned(GOOD + named + "growth = 1e-9\n")
    assert rung in (found.matrix, found.precision, found.sampling)
    missed = rung != "adaptive"  # an adaptive map refines until it holds
    assert bool(found.warnings) is missed
    if missed:
        assert f'= "{rung}"' in found.warnings[0] and "may be missed" in found.warnings[0]


def test_an_adaptive_map_says_that_the_full_grid_is_cheaper(planned):
    (reason,) = [r for r in planned(GOOD + 'sampling = "adaptive"\n').reasons if r.startswith("sampling")]
    assert "though the full grid would take" in reason


def test_a_diagram_with_growth_rates_is_searched(planned):
    found, alone = planned(DIAGRAM), planned(DIAGRAM + "growth = false\n")
    assert (found.sampling, alone.sampling) == ("grid", "closed-form boundary")
    assert found.predicted_seconds >= alone.predicted_seconds


def test_a_plan_is_a_function_of_its_scene(planned):
    text = GOOD + "[tolerance]\ngrowth = 0.1\n"
    assert planned(text) == planned(text)
    assert json.loads(planned(text).text)["matrix"] == planned(text).matrix


def test_planning_loads_no_heavy_library():
    plan(load_scene(LADDER / "truncated.toml"))  # warms the cache of generated modules
    script = (
        "import sys\nfrom stability.scene import load_scene\nfrom stability.plan import plan\n"
        f"plan(load_scene({str(LADDER / 'truncated.toml')!r}))\n"
        "print(*sorted({m.split('.')[0] for m in sys.modules}))"
    )
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    assert not {"sympy", "matplotlib", "scipy", "xarray"} & set(done.stdout.split())


def test_every_kind_of_request_has_its_plan():
    assert planning.PLANS.keys() == REQUESTS.keys()


def test_a_march_is_planned_with_everything_that_its_scene_says(planned, tmp_path):
    words = {"kind": "diamond", "elements": 500, "half": False}
    text = MARCH.replace(
        'kind = "polar", elements = 400, half = true', 'kind = "diamond", elements = 500, half = false'
    )
    text = text.replace("floor = 0.05", 'floor = 0.1\nscheme = "bdf2"\nsolver = "iterative"').replace(
        "newton = 1e-9", "newton = 1e-7"
    )
    path = tmp_path / "other.toml"
    path.write_text(text)
    asked = planning.marched(load_scene(path))
    assert (asked.closure, asked.flow, asked.mesh) == ("perturbed", "radial_hopper", words)
    assert asked.parameters == HOPPER | {"epsilon": 1e-4} and asked.snapshots == [0.0, 0.005, 0.01, 0.015, 0.02]
    assert (asked.first, asked.largest, asked.smallest) == (1e-5, 5e-4, 1e-9)
    assert (asked.scheme, asked.floor, asked.solver, asked.newton) == ("bdf2", 0.1, "iterative", 1e-7)
    assert (asked.noise, asked.seed, asked.every) == (1e-3, 1, 4)
    path.write_text(MARCH.replace("perturbation", "#").replace("newton", "#"))
    plain = planning.marched(load_scene(path))
    assert (plain.noise, plain.newton) == (0.0, 1e-9)
    assert planned(text).mesh.startswith("diamond, ") and planned(text).elements == pytest.approx(500, rel=0.05)
