"""The data behind each figure, and the files that `python -m figures` writes; images are never compared."""

import json
import re
import sys

import numpy as np
import pytest
from numpy.testing import assert_allclose

import stability as st
from figures import L1, P1, P2_1, common
from figures.__main__ import FIGURES, main, write
from figures.common import SCENES, STRESS_AXIS, characteristics, kept, result
from figures.grains import packing
from stability.errors import Interrupted
from stability.model import Model
from stability.plotting import unstable_regions
from stability.results import assumptions
from stability.timestepper import integrate

MARCHES = ("N1", "N2", "N3", "F1")  # their runs take half a minute even on 400 elements
# Samples of the reduced scenes: enough for the shape, little enough for a second.
COUNTS = {"delta": 38, "scaled_wavenumber": 6, "wavenumber": 41, "wave_angle": 361}


@pytest.fixture(scope="module")
def small(tmp_path_factory):
    """Return a folder with every scene at a reduced number of samples."""
    folder = tmp_path_factory.mktemp("scenes")
    for path in SCENES.glob("*.toml"):
        text = re.sub(r"elements = \d+", "elements = 400", path.read_text())  # of a march, none of which is resolved
        for axis, count in COUNTS.items():
            text = re.sub(rf"^({axis} *=.*count = )\d+", rf"\g<1>{count}", text, flags=re.M)
        (folder / path.name).write_text(text)
    return folder


@pytest.fixture(scope="module")
def drawn(small, tmp_path_factory):
    """Return a function that draws a figure once and tells the files it wrote."""
    folder, done = tmp_path_factory.mktemp("out"), {}
    return lambda name: done.setdefault(name, write(name, folder, scenes=small)) if name not in done else done[name]


@pytest.fixture(scope="module")
def data(small, tmp_path_factory):
    folder = tmp_path_factory.mktemp("data")
    return lambda name: result(name, folder, scenes=small)


def but_for(*names):
    """Return all figures, those named marked as slow."""
    return [pytest.param(name, marks=pytest.mark.slow) if name in names else name for name in FIGURES]


@pytest.mark.parametrize("name", but_for("I1", "P1", *MARCHES, "X1", "A1", "A3"))
def test_two_runs_write_the_same_bytes(name, drawn, small, tmp_path):
    first, second = drawn(name), write(name, tmp_path, scenes=small)
    assert {path.suffix for path in first} >= {".pdf", ".png", ".txt"}
    for one, other in zip(first, second, strict=True):
        assert one.name == other.name and one.read_bytes() == other.read_bytes()


@pytest.mark.parametrize("name", but_for(*MARCHES, "X1", "A1", "A3"))
def test_fonts_are_embedded_whole_and_columns_are_86_or_178_mm_wide(name, drawn):
    pdf, png, *_ = drawn(name)
    assert b"/FontFile2" in pdf.read_bytes() and b"/Type3" not in pdf.read_bytes()
    pixels = int.from_bytes(png.read_bytes()[16:20])  # of the PNG header
    assert_allclose(pixels / 300 * 25.4, 86 if name in ("I1", "L1") else 178, atol=25.4 / 300)


@pytest.mark.parametrize("name", ["L1", "P1", "P2.1", *(pytest.param(n, marks=pytest.mark.slow) for n in MARCHES)])
def test_captions_list_every_assumed_parameter_with_its_reason(name, drawn):
    files = drawn(name)
    caption = " ".join(files[2].read_text().split())
    kept = [st.open_results(path) for path in files if path.suffix == ".nc"]
    assert kept and any(assumptions(ds) for ds in kept)
    for ds in kept:
        parameters = json.loads(ds.attrs["parameters"])
        for word, why in assumptions(ds).items():
            assert re.search(rf"{word.replace('_', ' ')} = {parameters[word]:g} \S+ \({re.escape(why)}\)", caption)
        assert all(f"{word.replace('_', ' ')} = {value:g}" in caption for word, value in parameters.items())
    assert "{" not in caption


@pytest.mark.parametrize(("figure", "scenes"), [(L1, ["L1"]), (P1, ["P1", "P1-60"]), (P2_1, ["P2.1", "P2.1-tip"])])
def test_no_growth_exceeds_the_largest_level_of_its_colours(figure, scenes, data):
    variable = "scaled_growth_rate" if figure is P1 else "growth_rate"
    assert all(data(scene)[variable].max() < figure.LEVELS[-1] for scene in scenes)


def test_the_major_principal_stress_is_across_the_axis_of_the_hopper(hopper):
    letters = Model("rigid_plastic", "radial_hopper").base(hopper, {"r": 1, "theta": 0}).letters()
    assert letters["A_xy"] == 0 and letters["A_yy"] < letters["A_xx"] and STRESS_AXIS == 90


def test_wedges_of_l1_end_at_28_and_45_degrees(data):
    ds = data("L1")
    edges = characteristics(ds)
    assert edges == {"velocity": [45, 135, 225, 315], "stress": [28, 152, 208, 332]}  # exact: 45 and 45 + 34/2 from 90
    growing = ds.growth_rate.isel(wavenumber=-1).values > 0
    step = ds.wave_angle.values[1]
    found = ds.wave_angle.values[:-1][np.diff(growing)] + step / 2
    assert_allclose(found, sorted(edges["velocity"] + edges["stress"]), atol=step)


def test_the_neutral_curve_of_p2_1_closes_at_7101_per_metre(data):
    ds = data("P2.1-curve")
    assert not ds.unstable_shortest.any()  # no direction is unstable at 1e5 1/m
    q = ds.neutral_wavenumber
    # Computed (November 2026): 7101.2014 at 44.9895 degrees, where the sign of Re lambda also changes with 40 digits.
    # Neighbouring points differ by up to 2 % in q, hence the top of a smooth curve by a few 1e-5.
    assert_allclose(q.max(), 7101.2014, rtol=1e-4)
    assert_allclose(q.isel(q.argmax(...)).wave_angle % 90, 45, atol=0.02)


def test_the_tongues_of_p2_1_are_four_and_closed_at_both_tips(data):
    long, *tongues = unstable_regions(data("P2.1-curve"))
    assert long[0][0] == 0 and long[0][-1] == 360 and long[2].max() < 3  # 1/m: waves longer than the hopper
    assert len(tongues) == 4
    for angle, low, high in tongues:
        assert_allclose(np.log(high / low)[[0, -1]], 0, atol=0.3)  # 3 to 7100 1/m between the tips
        nearest = round(angle.mean() / 90 - 0.5) * 90 + 45
        assert 0 < abs(angle - nearest).min() < 0.01 and abs(angle - nearest).max() < 17  # between 28 and 45 degrees


def test_p2_1_decays_at_short_waves_next_to_the_null_direction(perturbed_hopper):
    found = st.eigenvalues(
        "perturbed", "radial_hopper", perturbed_hopper, {"r": 1, "theta": 0}, [7.2e3, 1e5], [[44.9895], [44.998], [45]]
    )
    assert np.all(found.real < 0)


@pytest.mark.parametrize(
    ("name", "limits"), [("P1", (-0.163784, 0, 0.790818, 0.954602)), ("P1-60", (-0.253652, 0, 1, 1.393847))]
)
def test_limits_of_p1_are_where_the_searched_growth_begins(name, limits, data):
    ds = data(name)
    k = np.sqrt(2) * np.sin(np.radians(json.loads(ds.attrs["parameters"])["friction_angle"]))
    high = k * (1 + np.sqrt(2)) / 2 if name == "P1" else 1 / k + np.sqrt(1 - 1 / k**2)
    assert_allclose(limits, [-k / (2 * (1 + np.sqrt(2))), 0, min(k, 1), high], atol=1e-6)  # exact, to the digits above
    step = np.diff(ds.delta.values)[0]
    growing = ds.scaled_growth_rate > 0
    for where, (low, high) in (
        (growing.isel(scaled_wavenumber=0), limits[::3]),
        (growing.all("scaled_wavenumber"), limits[1:3]),
    ):
        unstable = ds.delta.values[where.values]
        assert_allclose([unstable[0], unstable[-1]], [low, high], atol=1.5 * step)


def test_a_kept_result_is_read_again_until_its_scene_changes(small, tmp_path, monkeypatch):
    runs, run = [], st.run
    monkeypatch.setattr(st, "run", lambda scene: runs.append(scene.path.stem) or run(scene), raising=False)
    scene = tmp_path / "P1.toml"
    scene.write_text((small / "P1.toml").read_text())
    ask = {"folder": tmp_path, "scenes": tmp_path}
    first, second = result("P1", **ask), result("P1", **ask)
    assert len(runs) == 1 and first.identical(second)
    result("P1", fresh=True, **ask)
    assert len(runs) == 2
    scene.write_text(scene.read_text() + "# changed\n")
    result("P1", **ask)
    assert len(runs) == 3


MARCH = """
title = "a few steps"
closure = "perturbed"
flow = "radial_hopper"
[parameters]
friction_angle = 34.0
wall_friction_angle = 9.0
epsilon = 1e-3
wedge_angle = 15.0
outlet_radius = 0.5
inlet_radius = 1.5
gravity = 9.81
[request]
kind = "march"
mesh = { elements = 100 }
snapshots = { from = 0.0, to = 4e-3, count = 3 }
floor = 0.05
checkpoint_every = 2
"""


def test_an_interrupted_march_goes_on_and_is_kept_until_its_sources_change(tmp_path, monkeypatch):
    (tmp_path / "M.toml").write_text(MARCH)
    ask = {"folder": tmp_path, "scenes": tmp_path}
    advanced, taken = integrate.advanced, []

    def counted(*state):
        if len(taken) == 7:
            raise KeyboardInterrupt
        taken.append(state)
        return advanced(*state)

    monkeypatch.setattr(integrate, "advanced", counted)
    with pytest.raises(Interrupted):
        result("M", **ask)
    monkeypatch.setattr(integrate, "advanced", advanced)
    found, alone = result("M", **ask), st.run(tmp_path / "M.toml")
    assert not list(tmp_path.glob("*.checkpoint")) and found.sizes["step"] > 7
    assert found.drop_attrs().identical(alone.drop_attrs())
    assert kept("M", **ask) is not None
    monkeypatch.setattr(common, "signature", lambda scene: {"sources": "changed"})
    assert kept("M", **ask) is None


def test_a_run_that_stands_beside_is_not_made_unless_it_is_asked_for(small, tmp_path, monkeypatch):
    asked = []
    monkeypatch.setitem(FIGURES, "L1", lambda result: asked.append(result("N1-full", beside=True)) or L1.draw(result))
    monkeypatch.setattr(st, "run", lambda scene, run=st.run, **how: run(scene, **how) if "L1" in scene.title else 1 / 0)
    write("L1", tmp_path, scenes=small)
    assert asked == [None]
    with pytest.raises(ZeroDivisionError):
        write("L1", tmp_path, full=True, scenes=small)


def test_grains_do_not_overlap_by_more_than_a_tenth_and_come_from_a_fixed_seed():
    centre, radius = packing(12, 10)
    again, _ = packing(12, 10)
    assert np.array_equal(centre, again)
    distance = np.hypot(*np.moveaxis(centre[:, None] - centre, -1, 0)) + np.eye(len(centre)) * 9
    assert (distance / (radius[:, None] + radius)).min() > 0.9


def test_an_unknown_figure_is_refused_with_the_known_names(monkeypatch, capsys):
    monkeypatch.setattr(sys, "argv", ["figures", "P9"])
    with pytest.raises(SystemExit) as refusal:
        main()
    said = capsys.readouterr().err
    assert refusal.value.code == 2 and "P9" in said and "I1, L1, P1, P2.1" in said
