"""Verdicts and fastest waves over a field, against single points, closed forms and dense searches."""

import json

import numpy as np
import pytest
from numpy.testing import assert_allclose

import stability as st
from stability.errors import SceneError
from stability.field import mapping
from stability.field.answers import field_answer
from stability.field.gradients import jets
from stability.field.grids import field_from
from stability.field.mapping import field_cost, field_map
from stability.field.waves import waves_of
from stability.finite import leading
from stability.model import Model
from tests.conftest import HOPPER
from tests.field.fields import hopper, strain

COULOMB, PERTURBED = {"friction_angle": 34}, {"friction_angle": 34, "epsilon": 2e-5}
CODE = {"masked": 0, "stable": 1, "finite": 2, "bounded": 3, "ill-posed": 4, "undecided": 5}


def uniform(delta: float = 0.0, n: int = 12, norm: float = 2.0, size: float = 0.02):
    """Return a uniform strain of that delta and norm on a grid with cells of that size: `uniform_strain` as a field."""
    s = np.sqrt(2 - delta**2)
    x = size * np.arange(n)
    values = strain(*np.meshgrid(x, x), (norm * (delta + s) / 2, 0, 0, norm * (delta - s) / 2))
    return field_from(x, x, **values | {"p": np.full((n, n), 3.0)})


def state(delta: float = 0.0, norm: float = 2.0) -> dict:
    """Return the same base state as parameters of `uniform_strain`."""
    return {"delta": delta, "strain_rate": norm, "pressure": 3.0}


def densest(closure, parameters, wavenumber) -> float:
    """Return the largest growth of uniform strain over a dense fan of directions."""
    base = Model(closure, "uniform_strain").base(parameters, {})
    return leading(
        base.form(np.linspace(0, 180, 7201)).filled(7201).column().eigenvalues(np.atleast_1d(wavenumber))
    ).max()


def test_coulomb_flow_is_ill_posed_everywhere_at_schaeffers_rate():
    ds = field_map("rigid_plastic", uniform(), COULOMB, duration=1.0)
    assert (ds.verdict == CODE["ill-posed"]).all() and (ds.exponent == 2).all() and (ds.firm == 1).all()
    viscosity = np.sqrt(2) * np.sin(np.deg2rad(34)) * 3 / 2
    expected = viscosity / 2 * np.tan(np.deg2rad(17)) ** 2  # mathematics of the closure: (mu/2) tan^2(varphi/2), exact
    assert_allclose(ds.coefficient, expected, rtol=1e-8)  # the search's tolerance
    assert np.isinf(ds.growth_rate).all() and (ds.wavelength == 0).all()
    # c = cos 2phi = -tan(varphi/2) from the stress axis y: 36.1 degrees from the x axis, or its mirror image
    worst = np.rad2deg(np.arccos(np.tan(np.deg2rad(17)))) / 2
    assert_allclose(np.minimum(ds.wave_angle, 180 - ds.wave_angle), worst, atol=1e-3)


@pytest.mark.parametrize(
    ("delta", "kind"), [(-0.3, "stable"), (-0.05, "finite"), (0.2, "bounded"), (0.85, "finite"), (1.2, "stable")]
)
def test_the_perturbed_systems_table_of_delta_comes_out(delta, kind):
    # mathematics: stable below -k/(2 (1 + sqrt 2)) = -0.16, bounded for 0 <= delta <= k = 0.79, stable above 0.95;
    # a strain rate of 1e-6 keeps the kinematics of long waves, of order ||V||, out of the table; mu is 1e6 then, and
    # waves are long
    ds = field_map("perturbed", uniform(delta, norm=1e-6), PERTURBED, longest=1e4)
    growing = (ds.growth_rate > 1e-5).all()
    assert growing == (kind != "stable")
    assert ((ds.verdict == CODE["bounded"]) == (kind == "bounded")).all()


def test_bounded_growth_tends_to_the_closed_form_of_the_null_direction():
    delta, k = 0.3, np.sqrt(2) * np.sin(np.deg2rad(34))
    ds = field_map("perturbed", uniform(delta, norm=1e-6), PERTURBED)
    assert (ds.exponent == 0).all()
    # epsilon lambda -> delta (k - delta)/(2 - delta^2); waves 100 times shorter than the scale are within 1e-4 of it
    assert_allclose(ds.coefficient, delta * (k - delta) / (2 - delta**2) / 2e-5, rtol=1e-4)


@pytest.mark.parametrize("delta", [-0.1, 0.0, 0.1, 0.4])
def test_the_fastest_wave_is_that_of_a_dense_search(delta):
    ds = field_map("perturbed", uniform(delta), PERTURBED, check=False).isel(x=5, y=5)
    parameters = PERTURBED | state(delta)
    # 7,201 directions are 0.025 degrees apart: they miss the top of a hill 1 degree wide by 2e-4 at most.
    q = 2 * np.pi / float(ds.grid_wavelength)
    dense = densest("perturbed", parameters, q)
    assert dense * (1 - 1e-12) <= ds.grid_growth_rate <= dense * (1 + 2e-4)
    best = densest("perturbed", parameters, np.geomspace(q / 10, 30 / np.sqrt(2e-5), 300))
    assert best * (1 - 1e-9) <= ds.growth_rate <= best * (1 + 2e-3)  # 300 wavenumbers are 3 % apart
    if ds.wavelength > 0:
        found = st.eigenvalues("perturbed", "uniform_strain", parameters, {}, 2 * np.pi / ds.wavelength, ds.wave_angle)
        assert_allclose(found.real.max(), ds.growth_rate, rtol=1e-9)


@pytest.mark.parametrize("closure", ["rigid_plastic", "perturbed"])
def test_the_hopper_flow_agrees_with_its_exact_gradients_within_the_estimated_error(closure):
    field, r, theta = hopper(25)
    parameters = COULOMB if closure == "rigid_plastic" else PERTURBED
    ds = field_map(closure, field, parameters)
    assert ds.gradient_error.max() < 2e-3
    for i in [(3, 4), (12, 12), (20, 7), (0, 0)]:
        point = {"r": r[i], "theta": theta[i]}
        base = Model(closure, "radial_hopper").base(HOPPER | parameters, point)
        q = 2 * np.pi / float(ds.grid_wavelength.values[i])
        exact = leading(base.form(np.linspace(0, 180, 3601)).filled(3601).eigenvalues(q)).max()
        # epsilon lambda is 0.0139 at most and changes by up to k/2 = 0.4 with delta, 28 times as fast; mu q^2 in
        # proportion. Directions 0.05 degrees apart cost 1e-4.
        factor = 28 if closure == "perturbed" else 4
        assert_allclose(ds.grid_growth_rate.values[i], exact, rtol=factor * ds.gradient_error.values[i] + 1e-4)
        if closure == "rigid_plastic":
            verdict = st.well_posedness(closure, "radial_hopper", HOPPER | parameters, point)
            assert ds.verdict.values[i] == CODE[verdict.kind] and ds.exponent.values[i] == verdict.exponent
            assert_allclose(ds.coefficient.values[i], verdict.coefficient, rtol=4 * ds.gradient_error.values[i])


def test_where_delta_lies_within_its_error_the_verdict_is_not_called_firm():
    # The hopper's flow has div u = 0 and delta = 0 exactly: differences make it some 1e-4 either way, and the sign of
    # delta is what decides between bounded growth of the shortest waves and none.
    ds = field_map("perturbed", hopper(25)[0], PERTURBED)
    assert (ds.firm == 0).mean() > 0.5 and "within the error bars" in ds.attrs["answer"]
    assert_allclose(ds.dilation, 0, atol=3 * float(ds.gradient_error.max()))


def test_a_general_closure_goes_through_its_pencil():
    field = uniform(n=7)
    parameters = {"friction_angle": 34, "hyperviscosity": 1e-6}
    values = dict(field.values) | {"lap_u": 0 * field.x, "lap_v": 0 * field.x}
    x = field.x[0]
    ds = field_map("hyperstress", field_from(x, x, **values), parameters, check=False).isel(x=3, y=3)
    assert ds.verdict == CODE["finite"]
    viscosity = np.sqrt(2) * np.sin(np.deg2rad(34)) * 3 / 2
    strength = viscosity / 2 * np.tan(np.deg2rad(17)) ** 2
    # strength q^2 - eta q^4 is at most strength^2/(4 eta) = 768 1/s; inertia adds less than ||V|| = 2 1/s
    assert_allclose(ds.growth_rate, strength**2 / 4e-6, rtol=2 / 768)
    found = densest("hyperstress", parameters | state(), float(2 * np.pi / ds.wavelength))
    assert_allclose(ds.growth_rate, found, rtol=1e-4)  # directions 0.025 degrees apart


CRITICAL = {"critical_friction": 0.5, "critical_pressure": 1, "hardening": 3.75, "critical_fraction": 0.6}


def dilating(noise: float, n: int = 16):
    """Return a field of critical-state flow that dilates, with smooth noise."""
    x = np.linspace(0, 1, n)
    X, Y = np.meshgrid(x, x)
    rng = np.random.default_rng(1)

    def smooth(size):
        modes = [(k, m, *rng.normal(size=2)) for k in (1, 2, 3) for m in (1, 2)]
        return noise * size * sum(a * np.sin(k * X + 3 * b + m * Y) for k, m, a, b in modes)

    u, v = 0.9535 * X + smooth(0.2), -0.3211 * Y + smooth(0.2)  # ||V|| about 1, delta about 0.63
    return field_from(x, x, u=u, v=v, p=0.5 + smooth(0.05), phi=0.6 + smooth(0.01))


def test_growth_that_closes_in_on_a_direction_is_ill_posed_too():
    # exponent 1 although the leading matrix is nowhere positive: published, and certified by `well_posedness`
    ds = field_map("critical_state", dilating(0.0), CRITICAL)
    assert (ds.verdict == CODE["ill-posed"]).all() and (ds.exponent == 1).all() and np.isinf(ds.growth_rate).all()
    # slope q sqrt(phi Y_phi f/rho) to O(1/q^(1/2)) and less at a thousand times the scale
    state = {"strain_rate": 1.0060, "delta": 0.6286, "pressure": 0.5, "volume_fraction": 0.6}
    law = st.well_posedness("critical_state", "uniform_fraction", CRITICAL | state, {})
    assert law.exponent == 1
    assert_allclose(ds.coefficient, law.coefficient, rtol=5e-3)


def test_of_hills_close_together_the_higher_one_is_found():
    field = dilating(0.8)
    ds = field_map("critical_state", field, CRITICAL, check=False)
    found = jets(field)
    waves = waves_of(mapping.state("critical_state", CRITICAL, found.narrow, slice(None)), field.x.size)
    q = 2 * np.pi / ds.grid_wavelength.values.ravel()
    dense = waves.growth(np.pi / 3600 * np.arange(3600)[None], q).max(axis=1)
    known = np.isfinite(ds.grid_growth_rate.values.ravel())
    assert known.mean() > 0.9
    assert np.all((ds.grid_growth_rate.values.ravel() >= dense - 1e-9 * abs(dense))[known])


def test_a_point_where_constraints_leave_a_wave_undetermined_is_undecided():
    grains = {"grain_diameter": 1e-3, "solid_fraction": 0.6, "static_friction": 0.38, "rate_coefficient": 0.94,
              "nonlocal_amplitude": 0.48}  # fmt: skip
    x = np.linspace(0, 0.1, 12)
    X, Y = np.meshgrid(x, x)
    codes = []
    for rate in (69.92174, 0.8 * 69.92174):  # at its own fluidity, and with a fluidity that does not belong to it
        flow = strain(X, Y, (rate / np.sqrt(2), 0, 0, -rate / np.sqrt(2))) | {"p": np.ones_like(X)}
        field = field_from(x, x, **flow, fluidity=np.full_like(X, 197.76854))
        codes.append(field_map("nonlocal", field, grains))
    assert (codes[0].verdict == CODE["finite"]).all() and (codes[1].verdict == CODE["undecided"]).all()
    assert np.isnan(codes[1].growth_rate).all() and "undecided" in codes[1].attrs["answer"]
    assert "by the kinematics of the flow itself" in codes[0].attrs["answer"]


def test_points_without_an_error_estimate_are_told_apart_from_doubtful_ones():
    field = uniform(n=20)
    u = field.values["u"].copy()
    u[10, 10] = np.nan
    ds = field_map("rigid_plastic", field_from(field.x[0], field.x[0], **dict(field.values) | {"u": u}), COULOMB)
    assert "the wider stencil lacks values" in ds.attrs["answer"] and "error bars" not in ds.attrs["answer"]


def test_a_divergence_that_the_closure_does_not_allow_is_told():
    field = uniform(0.3)
    ds = field_map("rigid_plastic", field, COULOMB)
    assert "At 144 points div u is more than errors of the gradients explain, up to 0.3 ||V||" in ds.attrs["answer"]
    allowed = field_map("perturbed", field, PERTURBED), field_map("rigid_plastic", uniform(0.0), COULOMB)
    assert not any("div u is more" in ds.attrs["answer"] for ds in allowed)


def test_points_at_rest_without_pressure_or_without_values_are_masked_and_counted():
    field = uniform(n=20)
    u, p = field.values["u"].copy(), field.values["p"].copy()
    v = field.values["v"].copy()
    p[0, :4] = -1.0
    p[0, 4] = 0.0
    u[5:10, 5:10], v[5:10, 5:10] = 0.0, 0.0  # nothing moves over five points each way: 3 x 3 of them see no strain
    u[15, 15] = np.nan
    ds = field_map("rigid_plastic", field_from(field.x[0], field.x[0], u=u, v=v, p=p), COULOMB)
    assert json.loads(ds.attrs["masked"]) == {"without values or neighbours": 9, "at rest": 9, "without pressure": 5}
    assert (ds.verdict == 0).sum() == 23 and np.isnan(ds.growth_rate.values[ds.verdict.values == 0]).all()
    assert "Not judged: 9 without values or neighbours, 9 at rest, 5 without pressure." in ds.attrs["answer"]


def test_the_answer_tells_the_equations_from_the_scheme():
    said = {
        "rigid_plastic": "100 % of them are ill-posed",
        "viscous": "100 % of them are stable",
    }
    for closure, words in said.items():
        parameters = COULOMB | ({"kinematic_viscosity": 1.0} if closure == "viscous" else {})
        ds = field_map(closure, uniform(), parameters, duration=1e-3, longest=0.1)
        assert words in ds.attrs["answer"], ds.attrs["answer"]
    assert "decays" in ds.attrs["answer"]
    fine = field_map("perturbed", uniform(-0.01, size=1e-3), PERTURBED, longest=0.1)
    assert "the mesh resolves them" in fine.attrs["answer"]
    coarse = field_map("perturbed", uniform(-0.01, size=0.05), PERTURBED)
    assert "does not resolve" in coarse.attrs["answer"]
    part = coarse.where(coarse.x > 10)
    assert field_answer(part).startswith("No point could be judged")


def test_results_depend_neither_on_chunks_nor_on_threads(monkeypatch):
    one = field_map("perturbed", hopper(20)[0], PERTURBED)
    monkeypatch.setattr(mapping, "CHUNK", 37)
    other = field_map("perturbed", hopper(20)[0], PERTURBED, threads=2)
    for name in one.data_vars:
        assert_allclose(other[name], one[name], rtol=1e-12, err_msg=name)  # sums over the tensors' entries may reorder


def test_memory_is_that_of_the_field_and_of_one_chunk(monkeypatch):
    import tracemalloc

    field = uniform(n=100)
    field_map("rigid_plastic", uniform(), COULOMB)
    peak = []
    for chunk in (250, 1000):
        monkeypatch.setattr(mapping, "CHUNK", chunk)
        tracemalloc.start()
        field_map("rigid_plastic", field, COULOMB, check=False)
        peak.append(tracemalloc.get_traced_memory()[1])
        tracemalloc.stop()
    # Jets over both stencils, masks and results: some 100 numbers a point; a chunk of 1000 adds some 700 a point of it.
    assert peak[0] < 1.5 * 8 * 100 * field.x.size and peak[1] < peak[0] + 8 * 1000 * 1000


def test_a_hundred_thousand_points_are_judged():
    ds = field_map("rigid_plastic", uniform(n=317, size=1e-3), COULOMB, check=False)
    assert ds.verdict.size > 1e5 and (ds.verdict == CODE["ill-posed"]).all()


def test_the_cost_is_told_before():
    assert 0 < field_cost("rigid_plastic", uniform(), COULOMB) < 10  # 144 points


@pytest.mark.parametrize(
    ("closure", "parameters", "options", "words"),
    [
        ("rigid_plastic", {}, {}, "friction_angle is missing"),
        ("hyperstress", {"friction_angle": 34, "hyperviscosity": 1e-4}, {}, "needs lap_u, lap_v"),
        ("rigid_plastic", COULOMB, {"duration": -1.0}, "duration = -1.0 is no number"),
        ("rigid_plastic", COULOMB, {"floor": -1.0}, "floor = -1.0 is no number"),
        ("rigid_plastic", COULOMB, {"cells": "2"}, "cells = '2' is no number"),
        ("rigid_plastic", COULOMB, {"cells": 0.0}, "cells = 0.0 is no number"),
    ],
)
def test_a_question_without_an_answer_is_refused_in_words(closure, parameters, options, words):
    with pytest.raises(SceneError, match=words):
        field_map(closure, uniform(), parameters, **options)
