"""What is drawn is what the Datasets hold; files are the same in every run."""

import subprocess
import sys

import numpy as np
import pytest
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure
from numpy.testing import assert_allclose

import stability as st
from stability import plotting, results


@pytest.fixture
def polar():
    return Figure().add_subplot(projection="polar")


def growth_map(growth) -> "results.xr.Dataset":
    """Return a map of the given function of wavenumber (columns) and direction in degrees (rows)."""
    angle, q = np.linspace(0, 360, 181), np.geomspace(1, 1e4, 81)
    values = growth(q, angle[:, None])
    return results.dataset(
        {"growth_rate": (("wave_angle", "wavenumber"), values)}, {"wave_angle": angle, "wavenumber": q}
    )


def neutral_curve(rows: list, longest: list, shortest: list) -> "results.xr.Dataset":
    """Return a curve whose crossings are given per direction; each crossing turns the verdict of the one below."""
    size = max(map(len, rows))
    q = np.array([row + [np.nan] * (size - len(row)) for row in rows])
    up = np.array(
        [[(i + first) % 2 == 0 and i < len(row) for i in range(size)] for row, first in zip(rows, longest, strict=True)]
    )
    dims = ("wave_angle", "crossing")
    return results.dataset(
        {
            "neutral_wavenumber": (dims, q),
            "unstable_above": (dims, up.astype(np.int8)),
            "unstable_longest": ("wave_angle", longest),
            "unstable_shortest": ("wave_angle", shortest),
        },
        {"wave_angle": np.arange(len(rows), dtype=float)},
        wavenumber_range=[0.1, 1e5],
    )


def test_the_zero_contour_lies_where_growth_changes_sign(polar):
    ds = growth_map(lambda q, angle: 1e3 * np.log10(q / 100) + 0 * angle)
    plotting.polar_growth(ds, polar, (10, 100, 1000, 10000))
    (line,) = [c for c in polar.collections if c.get_facecolor().size == 0 or not c.filled]
    radius = np.concatenate([p.vertices[:, 1] for p in line.get_paths() if len(p.vertices)])
    assert_allclose(radius, 2, atol=1e-3)  # log10 of 100 1/m; the map has a step of 0.05


def test_growth_is_orange_and_decay_is_blue(polar):
    ds = growth_map(lambda q, angle: np.where(angle < 180, 50.0, -50.0) + 0 * q)
    found = plotting.polar_growth(ds, polar, (10, 100))
    red, _, blue = found.get_facecolor()[:, :3].T
    assert np.all((red > blue) == (np.arange(4) >= 2))


def test_colours_darken_with_growth_more_than_with_decay():
    """In greyscale a fast growth is darker than any decay."""
    grey = {
        name: [np.dot(to_rgb(c), (0.299, 0.587, 0.114)) for c in getattr(plotting, name)]
        for name in ("GROWTH", "DECAY")
    }
    assert np.all(np.diff(grey["GROWTH"]) < 0) and np.all(np.diff(grey["DECAY"]) < 0)
    assert min(grey["DECAY"]) > max(grey["GROWTH"][2:])


@pytest.mark.parametrize(("decay", "labels"), [(True, ["$-10^{4}$", "$-10^{2}$", "$0$", "$10^{2}$", "$10^{4}$"]),
                                               (False, ["$0$", "$10^{2}$", "$10^{4}$"])])  # fmt: skip
def test_the_bar_shows_growth_rates_and_not_their_scale(polar, decay, labels):
    ds = growth_map(lambda q, angle: q * np.cos(np.radians(angle)))
    drawn = plotting.polar_growth(ds, polar, (100, 1e4), decay=decay)
    cax = polar.figure.add_axes((0, 0, 1, 0.1))
    plotting.growth_bar(drawn, (100, 1e4), cax, "growth rate")
    assert [t.get_text() for t in cax.get_xticklabels()] == labels


def test_radius_is_labelled_in_decades(polar):
    plotting.radius(polar, 0.3, 1e4, label_from=10)
    assert_allclose(polar.get_yticks(), [0, 1, 2, 3])
    assert [t.get_text() for t in polar.get_yticklabels()] == ["", "$10^{1}$", "$10^{2}$", "$10^{3}$"]


def test_a_tongue_between_stable_directions_is_one_region():
    ds = neutral_curve([[], [10, 20], [5, 200], []], longest=[0, 0, 0, 0], shortest=[0, 0, 0, 0])
    ((angle, low, high),) = plotting.unstable_regions(ds)
    assert angle.tolist() == [1, 2] and low.tolist() == [10, 5] and high.tolist() == [20, 200]


def test_long_waves_and_a_wedge_are_two_regions_that_reach_the_ends_of_the_range():
    ds = neutral_curve([[1], [1, 10], [1, 12], [1]], longest=[1, 1, 1, 1], shortest=[0, 1, 1, 0])
    long, wedge = plotting.unstable_regions(ds)
    assert long[1].tolist() == [0.1] * 4 and long[2].tolist() == [1] * 4
    assert wedge[0].tolist() == [1, 2] and wedge[1].tolist() == [10, 12] and wedge[2].tolist() == [1e5] * 2


def test_the_line_around_a_tongue_is_closed(polar):
    plotting.radius(polar, 1, 1e4)
    ds = neutral_curve([[], [10, 20], [5, 200], []], longest=[0, 0, 0, 0], shortest=[0, 0, 0, 0])
    plotting.polar_neutral(ds, polar)
    (line,) = polar.get_lines()
    x, y = line.get_data()
    assert np.all(np.isfinite(y)) and (x[0], y[0]) == (x[-1], y[-1])


def test_no_line_is_drawn_along_the_end_of_the_range(polar):
    plotting.radius(polar, 1, 1e4)
    ds = neutral_curve([[], [10], [12], []], longest=[0, 0, 0, 0], shortest=[0, 1, 1, 0])
    plotting.polar_neutral(ds, polar, colour=None)
    (line,) = polar.get_lines()
    assert_allclose(10 ** line.get_ydata()[[0, 1]], [10, 12], rtol=1e-12)  # the edge of the wedge towards long waves
    assert np.isnan(line.get_ydata()[2:4]).all() and not polar.collections


def test_the_boundary_of_a_phase_diagram_is_the_exact_one():
    ds = st.phase_diagram(34, np.linspace(-0.3, 1.1, 29), [0.1, 1, 10])
    ax = Figure().add_subplot()
    plotting.phase(ds, ax, (1e-3, 1e-2, 1e-1))
    x, y = ax.get_lines()[0].get_data()
    inside = (y > 0.1) & (y < 10)
    assert inside.sum() >= 4
    assert_allclose(y[inside], ds.critical_scaled_wavenumber.values[inside], rtol=1e-15)
    assert np.nanmin(y) == 0.1 and np.nanmax(y) == 10  # it leaves the picture at the border ...
    assert np.isnan(y[np.abs(x - 0.4) < 0.3]).all()  # ... and does not run along it


def test_a_caption_lists_parameters_assumptions_and_residuals(hopper):
    ds = st.growth_map("rigid_plastic", "radial_hopper", hopper, {"r": 1, "theta": 0}, [1.0], [0.0])
    ds = results.described(ds, assumed={"wedge_angle": "not given", "outlet_radius": "not given"})
    text = " ".join(plotting.caption("What  is\nseen.", ds).split())
    assert text.startswith(
        "What is seen. Parameters: friction angle = 34 deg, wall friction angle = 9 deg, inlet radius"
    )
    assert "Assumed: wedge angle = 15 deg (not given); outlet radius = 0.5 m (not given)." in text
    assert "Base state at r = 1 m, theta = 0 deg: it misses a steady flow by" in text


def test_a_caption_says_what_two_results_share_once():
    one = st.phase_diagram(34, [0.0], [1.0])
    assert plotting.caption("Seen.", one, one).count("friction angle") == 1
    assert plotting.caption("Seen.", one, st.phase_diagram(60, [0.0], [1.0])).count("friction angle") == 2


def test_saved_files_are_the_same_in_every_run_and_carry_no_date(tmp_path):
    figure = Figure(figsize=(1, 1))
    figure.text(0.5, 0.5, "text")
    paths = plotting.save(figure, tmp_path, "picture", "A caption, 45°.\n")
    first = [path.read_bytes() for path in paths]
    assert [path.name for path in paths] == ["picture.pdf", "picture.png", "picture.txt"]
    assert sorted(tmp_path.iterdir()) == sorted(paths)  # nothing temporary is left
    again = plotting.save(figure, tmp_path, "picture", "A caption, 45°.\n")
    assert first == [path.read_bytes() for path in again]
    assert not any(word in content for content in first for word in (b"Date", b"Software", b"Matplotlib", b"Creator"))


def test_plotting_imports_neither_pyplot_nor_sympy():
    code = "import sys, stability.plotting as p; print('matplotlib.pyplot' in sys.modules, 'sympy' in sys.modules)"
    found = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True, timeout=60)
    assert found.stdout.split() == ["False", "False"]
