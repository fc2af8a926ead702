"""The harness's own claims: baselines and C agree with the package, ratios and report say what they should."""

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

import stability as st
from benchmarks import accuracy, baselines, certified, curves, native, pareto, report, timing
from benchmarks.cases import CHARACTERISTIC, Case, polar, positions, zoom
from benchmarks.rows import Group, Limit, Row, timed

needs_compiler = pytest.mark.skipif(native.compiler() is None, reason="no C compiler")


def leading(case: Case) -> np.ndarray:
    """Return the growth rates that the package finds wave by wave."""
    return st.eigenvalues(*case.question, case.wavenumber, case.wave_angle[:, None])[..., 0].real


@pytest.fixture(scope="module")
def case() -> Case:
    return polar(400)


@pytest.fixture(scope="module")
def norm(case) -> np.ndarray:
    return baselines.norms(baselines.tangent(case)())


@pytest.mark.parametrize("cse", [False, True])
@pytest.mark.parametrize("method", [baselines.by_eigvals, baselines.by_formula])
def test_the_users_ways_agree_with_the_package(case, norm, cse, method):
    found = method(baselines.tangent(case, cse)())
    assert np.max(np.abs(found - leading(case)) / norm) < 1e-9  # an error of substance is of order 1


@needs_compiler
@pytest.mark.parametrize("frequency", [False, True])
def test_c_agrees_with_the_package(case, norm, frequency):
    assert np.max(np.abs(native.growth(case, frequency)() - leading(case)) / norm) < 1e-9


@needs_compiler
def test_every_path_to_many_positions_agrees_with_50_digits():
    many = positions(5, 4, 6)
    exact = accuracy.truth(many, 20)
    for call in (native.growth(many), lambda: baselines.by_formula(baselines.tangent(many)())):
        assert exact.errors(call()).max() < accuracy.FLOAT64


def test_the_gate_sees_an_error_of_the_last_digits(case):
    exact, growth = accuracy.truth(case, 20), leading(case)
    assert exact.errors(growth).max() < accuracy.FLOAT64 < exact.errors(growth * (1 + 1e-12)).max()


def test_exactly_is_the_float_and_not_the_decimal_that_it_prints_as():
    (found,) = accuracy.exactly(np.array([0.1]))
    assert str(found).startswith("0.1000000000000000055511151231257827")


def test_a_characteristic_is_where_m_loses_its_determinant():
    around = zoom(9, 1.0)
    on = st.eigenvalues(*around.question, 100.0, CHARACTERISTIC, "leading")
    assert abs(np.prod(on)) < 1e-12 * np.abs(on).max() ** 2 and around.wave_angle[1] == CHARACTERISTIC


def test_ratios_are_medians_of_rounds_and_ignore_rounds_sat_out():
    timings = {"a": np.array([2.0, 3.0, 10.0]), "b": np.array([1.0, 1.0, 2.0]), "slow": np.array([8.0, 8.0, np.nan])}
    assert timing.ratio(timings, "a", "b") == timing.Ratio(3.0, 2.0)
    assert timing.ratio(timings, "slow", "b") == timing.Ratio(8.0, 8.0)
    assert timing.Ratio(1.2, 1.0).steady and not timing.Ratio(3.0, 2.0).steady


def test_every_variant_is_timed_in_turn_and_slow_ones_sit_out(monkeypatch):
    order: list[str] = []
    clock = {"a": 0.01, "slow": 1.0}

    def fake(call, repeats=1):
        call()
        return clock[order[-1]]

    monkeypatch.setattr(timing, "seconds", fake)
    found = timing.interleaved({name: lambda name=name: order.append(name) for name in clock}, rounds=4)
    assert order == ["a", "a", "slow", "a", "a", "slow", "a", "a", "a", "a"]  # fast ones are warmed each time
    assert_array_equal(np.isnan(found["slow"]), [False, False, True, True])


def test_limits_hold_from_above_or_from_below():
    assert Limit(5.5).met(5.5) and not Limit(5.5).met(5.6)
    assert Limit(20, at_least=True).met(20) and not Limit(20, at_least=True).met(19)


@pytest.fixture
def groups() -> list[Group]:
    timings = {"C": np.array([1e-9, 1e-9]), "package": np.array([6e-9, 6e-9]), "user": np.array([3e-6, 2e-6])}
    limits = {("package", "C"): Limit(5.5), ("user", "package"): Limit(200, at_least=True)}
    some = Group("some", "What it is.", rows=timed(timings, "C", {"C": 1e-16}, limits), notes=["a note"])
    return [some, Group("more", "Counts.", rows=[Row("missed", measured=0.0, limit=Limit(0))])]


def test_the_report_shows_ratios_targets_and_reasons(groups, monkeypatch):
    monkeypatch.setitem(report.REASONS, "some: package", "it was made up")
    text = report.rendered(groups)
    assert "2 of 3 are met" in text and "some: package: 6, target ≤ 5.5. Reason: it was made up." in text
    assert "| package | 6 |  | 6 | 6 | ≤ 5.5 | **no** |" in text
    assert "| user, over package |  |  | 417 | 333 | ≥ 200 | yes |" in text
    assert "Note: a note." in text and "| C | 1 | 1.0e-16 | 1 | 1 |" in text


def test_a_missed_target_without_a_reason_says_so(groups):
    assert report.UNKNOWN in report.rendered(groups)


def test_every_reason_belongs_to_a_group_and_a_row():
    assert all(": " in key and text for key, text in report.REASONS.items())


def test_the_pareto_front_keeps_what_nothing_beats():
    rungs = [pareto.Point("p", n, t, e) for n, t, e in [("fast", 1, 1e-3), ("good", 2, 1e-9), ("beaten", 3, 1e-6)]]
    assert [p.rung for p in pareto.front(rungs[::-1])] == ["fast", "good"]


def test_figure_x2_and_its_data_are_written(tmp_path):
    rungs = [pareto.Point(panel, n, 1e-8, 1e-50) for panel in ("growth-rates", "neutral-wavenumbers") for n in "ab"]
    pareto.write(rungs, tmp_path / "X2.csv")
    assert len((tmp_path / "X2.csv").read_text().splitlines()) == 5
    assert {path.suffix for path in pareto.draw(rungs, tmp_path)} == {".pdf", ".png", ".txt"}


def test_contours_and_roots_find_the_exact_crossings():
    few = curves.waves(64, 200)
    exact = curves.exact_roots(64)
    assert any(exact)
    for found, tolerance in (
        (curves.curve(few), 1e-12),
        (curves.roots_loop(few), 1e-6),
        (curves.contour(few, lambda: leading(few)), 0.05),
    ):
        errors, missed = curves.judged(found, exact)
        assert missed == 0 and errors.max() < tolerance


def test_a_crossing_that_is_not_found_counts_as_missed():
    found = np.full((2 * curves.STRIDE, 1), np.nan)
    found[0, 0] = 1.0
    errors, missed = curves.judged(found, [[1.0, 2.0], [3.0]])
    assert missed == 2
    assert_allclose(errors, [0.0, 1.0], rtol=0, atol=0)


def test_the_referee_in_arb_agrees_with_the_package(case):
    pytest.importorskip("flint", reason="python-flint is not installed")
    row = certified.spot_checks(case, np.sign(leading(case)).astype(np.int8))
    assert row.value == 0 and row.met
    wrong = certified.spot_checks(case, -np.sign(leading(case)).astype(np.int8))
    assert wrong.value == certified.SPOT_CHECKS and not wrong.met
