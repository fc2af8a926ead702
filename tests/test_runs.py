"""What the paper says of its runs: each statement is judged by numbers, and falls where they say otherwise."""

import copy
import json
from pathlib import Path

import numpy as np
import pytest

import stability as st
from derivations import measured, runs
from derivations.verdict import Kind
from figures.common import SCENES

KEPT = measured.load()
# A statement -> the path of numbers in a long run, and values that contradict it.
CONTRADICTED = {
    "first_place": {"viscosity": {"pressure": [0.5, 1.2, 0.0]}},
    "jump_in_troughs": {"troughs": [1.0, 0.1, -0.1, 1.1]},
    "sharp": {"thickness": [0.05, 0.001, 0.3, 50]},
    "normal": {"across": [0.5, 45.0]},
    "downwards": {"arrivals": [0.03, 0.02, 0.01]},
    "cut_off": {"late_growth": 1e3},
    "down_travel": {"travel": [[0.1, 0.1, 0.9, -1.5]] * 4},
    "unsteady": {"likeness": 0.95},
    "dilating": {"troughs": [0.4, 0.1, -0.1, 5.0]},
}


def changed(**numbers) -> dict:
    found = copy.deepcopy(KEPT)
    for run in (found["N1"], found["N3"], *found["meshes"]):
        run |= numbers
    return found


@pytest.mark.parametrize("name", CONTRADICTED)
def test_a_statement_about_the_long_runs_fails_where_both_contradict_it(name):
    verdict = getattr(runs, name)(changed(**CONTRADICTED[name]))
    assert verdict.kind is Kind.FAILS and verdict.right and verdict.counterexample


def first(exponent: float, factor: float = 1.0, angle: float = 42.0) -> dict:
    """Return measurements whose first waves follow a power law: mu |xi|^2 epsilon = 1 / factor^2 for 1/2."""
    found = copy.deepcopy(KEPT)
    for one in found["first"].values():
        mu = np.array(one["waves"])[:, 3]
        length = 2 * np.pi * factor * np.sqrt(mu * 4e-5) * (one["epsilon"] / 4e-5) ** exponent
        one["waves"] = np.column_stack([length, 0 * mu + 0.1, 0 * mu + angle, mu]).tolist()
    return found


@pytest.mark.parametrize(("exponent", "kind"), [(0.5, Kind.HOLDS), (0.2, Kind.FAILS), (0.0, Kind.FAILS)])
def test_the_exponent_of_the_wavelength_is_judged_by_its_error(exponent, kind):
    found = runs.root(first(exponent))
    assert found.kind is kind and f"{exponent:.2f}" in found.evidence


def test_a_wavelength_without_epsilon_is_not_set_by_it():
    assert runs.controlled(first(0.0)).kind is Kind.FAILS


@pytest.mark.parametrize(("last", "kind"), [(0.079, Kind.HOLDS), (0.05, Kind.HOLDS_IF)])
def test_a_wavelength_that_still_follows_the_mesh_holds_on_finer_ones_only(last, kind):
    found = first(0.5)
    windows = [0.95, 1.0, 1.05, 1.0]
    found["lengths"] = [
        {"elements": KEPT["N3"]["elements"] * 4**i, "waves": [[size * w, 0.1, 45.0] for w in windows]}
        for i, size in enumerate((0.1, 0.081, last), start=-1)
    ]
    assert runs.controlled(found).kind is kind


@pytest.mark.parametrize(("factor", "kind"), [(1.0, Kind.HOLDS), (1.7, Kind.HOLDS), (2.5, Kind.FAILS)])
def test_the_scale_of_the_wavelength_may_be_off_by_a_factor_of_three_in_its_square(factor, kind):
    assert runs.scaled(first(0.5, factor)).kind is kind


@pytest.mark.parametrize(("angle", "kind"), [(45.0, Kind.HOLDS), (38.0, Kind.HOLDS), (20.0, Kind.FAILS)])
def test_the_direction_may_be_off_by_10_degrees(angle, kind):
    assert runs.oblique(first(0.5, angle=angle)).kind is kind


@pytest.mark.parametrize(
    ("second", "third", "kind"),
    [(0.025, 0.012, Kind.HOLDS), (0.025, 0.024, Kind.HOLDS_IF), (0.05, 0.05, Kind.FAILS)],
)
def test_jumps_that_are_as_thick_on_a_finer_mesh_are_resolved(second, third, kind):
    found = copy.deepcopy(KEPT)
    found["meshes"] = [
        {"cell": cell, "elements": elements, "end": 0.16, "thickness": [thick, 0.001, 0.2, 50]}
        for cell, elements, thick in ((0.016, 1000, 0.05), (0.008, 4000, second), (0.004, 16000, third))
    ]
    assert runs.grid_dependent(found).kind is kind


def test_measurements_are_plain_numbers_with_four_digits():
    text = json.dumps(measured.rounded({"a": np.array([np.pi, 2]), "b": (np.int64(3), 1 / 3), "c": np.float64(1e-9)}))
    assert text == '{"a": [3.142, 2.0], "b": [3, 0.3333], "c": 1e-09}'


def test_the_measurements_are_of_the_scenes_in_the_repository():
    for name, found in {"N1": KEPT["N1"], "N3": KEPT["N3"], "N3-coarse": KEPT["meshes"][0]}.items():
        check(name, found)
    for epsilon, name in measured.FIRST.items():
        check(name, KEPT["first"][epsilon])


def check(name: str, found: dict) -> None:
    scene = st.load_scene(SCENES / f"{name}.toml")
    assert found["epsilon"] == scene.parameters["epsilon"] and found["end"] == scene.request.snapshots.samples[-1]
    assert abs(found["elements"] / scene.request.mesh.elements - 1) < 0.05


@pytest.mark.slow
def test_a_run_on_a_quarter_of_the_elements_gives_the_same_verdicts(tmp_path: Path):
    """Twenty seconds of time on one core; the mesh is four times as coarse as in figure N3, so only signs are sure."""
    story = measured.rounded(measured.story(st.run(SCENES / "N3-coarse.toml")))
    coarse = KEPT | {"N1": story, "N3": story}
    for judged in (runs.normal, runs.downwards, runs.cut_off, runs.down_travel, runs.unsteady, runs.dilating):
        assert judged(coarse).kind is judged(KEPT).kind
    # The thickness is that of the repository: the same run, on another machine to the digits that rounding leaves.
    assert abs(story["thickness"][0] / KEPT["meshes"][0]["thickness"][0] - 1) < 0.2
