"""Waves about many states at once, and the search for the fastest one, against eigenvalues and dense searches."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from numpy.testing import assert_allclose

from stability.field.guides import guide
from stability.field.search import fastest
from stability.field.waves import ORDERS, waves_of
from stability.finite import leading
from stability.model import Base, Model
from tests.closures.benchmarks import BENCHMARKS

STATES = 6
CLOSURES = list(dict.fromkeys(b.closure for b in BENCHMARKS))
# Random states of the nonlocal law have poles: waves at which its pressure is undetermined, and growth infinite.
SEARCHED = [name for name in CLOSURES if name != "nonlocal"]


@cache
def states(closure: str) -> Base:
    """Return states about the closure's benchmark with everything 10 % off, so that lower orders take part."""
    benchmark = next(b for b in BENCHMARKS if b.closure == closure)
    base = Model(closure, benchmark.flow).base({w: float(v) for w, v in benchmark.parameters.items()}, {})
    rng = np.random.default_rng(2)

    def near(tensor):
        if isinstance(tensor, tuple):
            return tuple(map(near, tensor))
        return np.asarray(tensor, float) * (1 + 0.1 * rng.normal(size=STATES))

    (velocity, ((u_x, u_y), (v_x, v_y)), bends), *others = near(base.state)
    if base.model.closed and base.model.modes == 1:
        v_y = -u_x  # the closure imposes div u = 0, and its closed form relies on it
    return replace(base, state=((velocity, ((u_x, u_y), (v_x, v_y)), bends), *others))


def exact(base: Base, angle: np.ndarray, wavenumber: np.ndarray) -> np.ndarray:
    """Return the growth rates of single waves, one a state, as `stability.eigenvalues` computes them."""
    return leading(base.form(np.rad2deg(angle)).filled(STATES).eigenvalues(wavenumber))


@pytest.mark.parametrize("closure", CLOSURES)
def test_roots_of_the_characteristic_polynomial_are_the_eigenvalues(closure):
    base = states(closure)
    waves, rng = waves_of(base, STATES), np.random.default_rng(1)
    for factor in np.geomspace(1e-2, 1e2, 5):
        angle, q = rng.uniform(0, np.pi, STATES), factor * waves.scale()
        miss = abs(waves.growth(angle[:, None], q)[:, 0] - exact(base, angle, q))
        assert np.all(miss <= 1e-13 * waves.bound(q))  # hundreds of roundings of the largest eigenvalue


@pytest.mark.parametrize("closure", ["perturbed", "rigid_plastic", "critical_state", "cosserat"])
def test_derivatives_of_growth_are_those_of_its_differences(closure):
    waves = waves_of(states(closure), STATES)
    angle, q, h = np.full(STATES, 0.7), 0.5 * waves.scale(), 1e-3
    found = dict(zip(ORDERS, waves.at(q, True).peak(angle), strict=True))
    near = {
        (i, j): waves.at(q * np.exp(i * h)).peak(angle + j * h)[0] for i in (-2, -1, 0, 1, 2) for j in (-2, -1, 0, 1, 2)
    }
    first, second = (1, -8, 0, 8, -1), (-1, 16, -30, 16, -1)
    steps = (-2, -1, 0, 1, 2)
    expected = {
        (0, 1): sum(w * near[0, j] for w, j in zip(first, steps, strict=True)) / (12 * h),
        (1, 0): sum(w * near[j, 0] for w, j in zip(first, steps, strict=True)) / (12 * h),
        (0, 2): sum(w * near[0, j] for w, j in zip(second, steps, strict=True)) / (12 * h * h),
        (2, 0): sum(w * near[j, 0] for w, j in zip(second, steps, strict=True)) / (12 * h * h),
        (1, 1): (near[1, 1] - near[1, -1] - near[-1, 1] + near[-1, -1]) / (4 * h * h),
    }
    size = waves.bound(q)
    for order, value in expected.items():
        # O(h^4), for the mixed one O(h^2), of derivatives as large as the eigenvalue; roundings over h^2
        assert_allclose(found[order] / size, value / size, atol=1e-4 if order == (1, 1) else 1e-7, err_msg=str(order))


@pytest.mark.parametrize("closure", SEARCHED)
def test_the_search_misses_nothing_that_a_dense_one_finds(closure):
    base = states(closure)
    waves = waves_of(base, STATES)
    scale = waves.scale()
    found = fastest(waves, guide(base, STATES), 1e-2 * scale, 1e2 * scale)
    assert_allclose(
        exact(base, found.angle, found.wavenumber), found.growth, atol=1e-13 * waves.bound(100 * scale).max()
    )
    directions = np.pi / 360 * np.arange(360)[None]
    dense = np.max(
        [waves.growth(directions, factor * scale).max(axis=1) for factor in np.geomspace(1e-2, 1e2, 97)], axis=0
    )
    roundings = 1e-13 * waves.bound(100 * scale)
    assert np.all(found.growth >= dense - 1e-9 * abs(dense) - roundings)


@pytest.mark.parametrize("closure", SEARCHED)
def test_at_one_wavelength_the_search_finds_the_best_direction(closure):
    base = states(closure)
    waves = waves_of(base, STATES)
    q = 3 * waves.scale()
    found = fastest(waves, guide(base, STATES), q, q)
    dense = waves.growth(np.pi / 3600 * np.arange(3600)[None], q).max(axis=1)
    assert np.all(found.wavenumber == q)
    assert np.all(found.growth >= dense - 1e-9 * abs(dense) - 1e-13 * waves.bound(q))


def test_the_search_does_not_depend_on_its_company():
    base = states("perturbed")
    waves, hint = waves_of(base, STATES), guide(base, STATES)
    low, high = 1e-2 * waves.scale(), 1e2 * waves.scale()
    together = fastest(waves, hint, low, high)
    for i in range(STATES):
        some = np.array([i])
        alone = fastest(waves.take(some), hint.take(some), low[some], high[some])
        # products of matrices of other shapes may round differently
        assert_allclose(
            (alone.growth[0], alone.wavenumber[0]), (together.growth[i], together.wavenumber[i]), rtol=1e-11
        )
