"""The closed form in blocks: against 50 digits, against `spectrum` near neutrality, at the extremes, compiled."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

import stability as st
from stability import compiled, fast, hoisted, spectrum, sweep
from stability.arithmetic import NUMPY, multiprecision
from stability.model import Base, Model
from tests.states import base_of, random_jet

EXACT = multiprecision(50)
CLOSURES = ("perturbed", "rigid_plastic")
POINT = {"r": 1.0, "theta": 0.0}


def given(hopper: dict, closure: str) -> dict:
    return hopper | ({"epsilon": 2e-5} if closure == "perturbed" else {})


class Arrays:
    """A sink that keeps everything, and how many samples were left open."""

    def __init__(self, grid: sweep.Grid):
        shape = (grid.rows, grid.wavenumber.size)
        dtype = np.float32 if grid.draft else float
        self.growth, self.frequency, self.left = np.empty(shape, dtype), np.empty(shape, dtype), np.zeros(shape, bool)

    def place(self, rows, columns, new):
        return self.growth[rows, columns], self.frequency[rows, columns]

    def take(self, rows, columns, growth, ok):
        pass

    def correct(self, rows, columns, eigenvalue):
        self.growth[rows, columns], self.frequency[rows, columns] = eigenvalue.real, eigenvalue.imag
        self.left[rows, columns] = True


def swept(base: Base, wavenumber, wave_angle, matrix="full", positions=1, draft=False) -> Arrays:
    grid = sweep.Grid(base, positions, np.asarray(wave_angle, float), np.asarray(wavenumber, float), matrix, draft)
    return sweep.run(grid, lambda: Arrays(grid))[0]


def doubled(base: Base) -> Base:
    """Return the base state at two equal positions, so that coefficients come by way of tensors."""

    def twice(tensor):
        return tuple(map(twice, tensor)) if isinstance(tensor, tuple) else np.array([tensor, tensor])

    return replace(base, state=twice(base.state))


def norm(base: Base, angle: float, wavenumber: float) -> float:
    """Return ||D|| from the pencil in the flow's frame."""
    L2, L1, L0 = (np.array(part, dtype=float) for part in base.pencil())
    xi = wavenumber * np.array([np.cos(np.deg2rad(angle)), np.sin(np.deg2rad(angle))])
    L = L0 + 1j * np.einsum("a,aij->ij", xi, L1) - np.einsum("a,b,abij->ij", xi, xi, L2)
    C, B, row, corner = L[:2, :2], L[:2, 2:], L[2:, :2], L[2, 2]
    return float(np.linalg.norm(C - B @ (row / corner if corner else row @ C / (row @ B)), 2))


def errors(base: Base, exact: Base, wavenumber, wave_angle, found: Arrays) -> list[tuple[float, float]]:
    """Return (error/||D||, the error of `spectrum`/||D||) of every growth rate."""
    collected = []
    for i, angle in enumerate(map(float, wave_angle)):
        truth, plain = exact.form(EXACT.number(angle)), base.form(angle)
        for j, q in enumerate(map(float, wavenumber)):
            growth = max(e.real for e in truth.eigenvalues(EXACT.number(q)))
            other = max(complex(e).real for e in plain.eigenvalues(q))
            size = norm(base, angle, q)
            collected.append((abs(float(found.growth[i, j] - growth)) / size, abs(float(other - growth)) / size))
    return collected


def random_errors(closure: str, draft: bool, tensors: bool) -> np.ndarray:
    rng, collected = np.random.default_rng(7), []
    for _ in range(40):
        jet, friction, epsilon = (
            random_jet(closure, rng),
            float(rng.uniform(0.05, 1.5)),
            float(10 ** rng.uniform(-6, 0)),
        )
        base, exact = (base_of(closure, jet, friction, epsilon, a) for a in (NUMPY, EXACT))
        q, angle = 10 ** rng.uniform(-2, 5, 5), rng.uniform(0, 360, 4)
        found = swept(doubled(base), q, angle, "full", 2, draft) if tensors else swept(base, q, angle, draft=draft)
        collected += errors(base, exact, q, angle, found)
    return np.array(collected)


@pytest.mark.parametrize("tensors", [False, True])
@pytest.mark.parametrize("closure", CLOSURES)
def test_errors_over_random_states_stay_within_the_stated_bound(closure, tensors):
    error, plain = random_errors(closure, False, tensors).T
    # Where friction is steep (k > 1) the constraint's projection is nearly singular: there the coefficients themselves,
    # and so `spectrum` too, lose digits.
    assert np.all(error <= 4e-15 + 16 * plain)
    assert np.quantile(error, 0.98) <= 4e-15
    if closure == "perturbed":
        assert error.max() <= 4e-15  # measured 1.1e-15


@pytest.mark.parametrize("tensors", [False, True])
@pytest.mark.parametrize("closure", CLOSURES)
def test_errors_of_a_draft_stay_within_its_bound(closure, tensors):
    assert random_errors(closure, True, tensors)[:, 0].max() <= 1e-6  # measured 1.2e-7 and 1.9e-7


@pytest.mark.parametrize("closure", CLOSURES)
def test_errors_on_the_hopper_stay_within_the_stated_bound(hopper, closure):
    rng = np.random.default_rng(8)
    base, exact = (
        Model(closure, "radial_hopper", a).base(given(hopper, closure), {"r": 1.0, "theta": 5.0})
        for a in (NUMPY, EXACT)
    )
    q, angle = 10 ** rng.uniform(0, 6, 12), rng.uniform(0, 360, 12)
    assert np.array(errors(base, exact, q, angle, swept(base, q, angle)))[:, 0].max() <= 4e-15


@pytest.mark.parametrize("closure", CLOSURES)
def test_tensors_give_the_coefficients_of_the_forms(closure):
    rng = np.random.default_rng(9)
    angle = np.linspace(0, 350, 36)
    for _ in range(20):
        jet = random_jet(closure, rng)
        base = base_of(closure, jet, float(rng.uniform(0.05, 0.7)), float(10 ** rng.uniform(-6, 0)))
        form = base.form(angle)
        directions = hoisted.directions(*NUMPY.direction(angle, NUMPY))
        found, speed = hoisted.coefficients(hoisted.tensors(base, 1), directions, base.model.modes)
        assert_allclose(speed, form.speed, rtol=0, atol=1e-14 * np.abs(speed).max())
        for part, series in found.items():
            for n, c in series.items():
                expected = np.broadcast_to(form.coefficients[part].get(n, 0.0), angle.shape)
                assert_allclose(c, expected, rtol=0, atol=1e-12 * np.abs(c).max())


def near_neutral(hopper: dict) -> tuple[Base, np.ndarray, np.ndarray]:
    """Return a base state and waves of which many are within 1e-6 and 1e-9 of the neutral curve."""
    parameters = given(hopper, "perturbed")
    neutral = st.neutral_curve("perturbed", "radial_hopper", parameters, POINT, np.array([30.0, 37.0, 41.0]))
    q = neutral.neutral_wavenumber.values
    q = np.sort(q[np.isfinite(q)])
    offsets = np.array([-1e-6, -1e-9, 1e-9, 1e-6])
    return Model("perturbed", "radial_hopper").base(parameters, POINT), np.ravel(q[:, None] * (1 + offsets)), neutral


def test_near_neutrality_the_numbers_are_those_of_spectrum(hopper):
    base, q, neutral = near_neutral(hopper)
    angle = neutral.wave_angle.values
    for b, positions in ((base, 1), (doubled(base), 2)):
        found = swept(b, q, angle, positions=positions)
        assert found.left.any()
        expected = np.array([[max(e.real for e in base.form(a).eigenvalues(x)) for x in q] for a in angle])
        expected = np.tile(expected, (positions, 1))
        assert_allclose(found.growth[found.left], expected[found.left], rtol=1e-11, atol=0)
        assert_allclose(found.growth, expected, rtol=2e-9, atol=0)  # `fast.NEAR`
        assert_array_equal(found.growth > 0, expected > 0)


def test_few_samples_of_the_papers_map_are_left_open(hopper):
    base = Model("perturbed", "radial_hopper").base(given(hopper, "perturbed"), POINT)
    left = swept(base, np.geomspace(1, 1e5, 300), np.linspace(0, 360, 301)).left
    assert 0 < left.mean() < 3e-3  # 4e-4 near neutrality, 1.4e-3 along the axes of A, where real parts tie


@pytest.mark.parametrize("closure", CLOSURES)
@pytest.mark.parametrize("matrix", ["full", "truncated", "leading"])
def test_wavenumbers_from_1e_minus_6_to_1e12_give_the_eigenvalues(hopper, closure, matrix):
    q, angle = np.geomspace(1e-6, 1e12, 37), np.linspace(1, 359, 23)
    ask = (closure, "radial_hopper", given(hopper, closure), POINT)
    ds = st.growth_map(*ask, q, angle, matrix)
    every = st.eigenvalues(*ask, q, angle[:, None], matrix)
    found = every[..., 0]
    assert np.all(np.isfinite(ds.growth_rate)) and np.all(np.isfinite(ds.frequency))
    assert_allclose(ds.growth_rate, found.real, rtol=2e-9, atol=0)
    assert_array_equal(np.sign(ds.growth_rate), np.sign(found.real))
    assert np.all(np.abs(ds.frequency - found.imag) <= 4e-15 * np.abs(every).max(axis=-1))


def kernel(trace: float, gap: float, twist: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return growth rate, frequency and whether they hold, of one sample in two equal rows."""
    values = {"trace": trace, "gap": gap, "twist": twist, "shift": 0.0}
    t = fast.Table({name: (np.full((2, 1), value), np.ones((1, 2))) for name, value in values.items()})
    growth, frequency = np.empty((2, 2)), np.empty((2, 2))
    with np.errstate(all="ignore"):
        ok = fast.pair(t, slice(0, 2), growth, frequency, fast.Scratch(float))
    return growth[0, 0], frequency[0, 0], ok[0, 0]


@pytest.mark.parametrize(
    "q", [3 + 4j, -3 + 4j, -3 - 4j, 3 - 4j, 1e-9 + 1j, -1e-9 - 1j, 5 + 1e-12j, -5 - 1e-12j, 1e60 + 2j]
)
def test_the_branch_free_root_is_the_root(q):
    growth, frequency, _ = kernel(0.0, q.real / 2, q.imag / 2)
    root = np.sqrt(complex(q))
    assert_allclose([growth, frequency], [root.real, root.imag], rtol=1e-15, atol=0)


@pytest.mark.parametrize("gap, twist", [(0.0, 0.0), (1e200, 1e200), (-1.0, 1e-20)])
def test_what_cannot_be_represented_or_ordered_is_left_open(gap, twist):
    assert not kernel(-1.0, gap, twist)[2]


@pytest.fixture
def numba_everywhere(monkeypatch):
    pytest.importorskip("numba", reason="numba is not installed: the extra `fast`")
    monkeypatch.setattr(compiled, "PAYS", 0)


@pytest.mark.parametrize("places", [1, 3])
def test_the_compiled_path_agrees_and_keeps_every_sign(hopper, numba_everywhere, monkeypatch, places):
    point = {"r": np.linspace(0.6, 1.4, places), "theta": np.linspace(-5, 5, places)}
    waves = np.geomspace(1, 1e5, 301), np.linspace(0, 360, 91)
    ask = ("perturbed", "radial_hopper", given(hopper, "perturbed"), point, *waves)
    found = st.growth_map(*ask)
    alone = st.growth_map(*ask, frequency=False)
    monkeypatch.setattr(compiled, "PAYS", 10**18)
    plain = st.growth_map(*ask)
    assert_array_equal(np.sign(found.growth_rate), np.sign(plain.growth_rate))
    assert_array_equal(alone.growth_rate, found.growth_rate)
    assert_allclose(found.growth_rate, plain.growth_rate, rtol=4e-9, atol=0)  # each within 2e-9
    assert np.abs(found.growth_rate - plain.growth_rate).max() > 0  # it was the other path


def test_compiling_is_not_tried_below_2e8_samples(hopper):
    base = Model("perturbed", "radial_hopper").base(given(hopper, "perturbed"), POINT)
    assert compiled.PAYS == 2e8
    assert not compiled.pays(sweep.Grid(base, 1, np.zeros(10), np.ones(10), "full"))


def test_leading_first_agrees_with_the_leading_mode_of_a_sweep(hopper):
    form = Model("perturbed", "radial_hopper").base(given(hopper, "perturbed"), POINT).form(40.0)
    assert sweep.leading(form, 100.0) == spectrum.leading_first(*form.eigenvalues(100.0))[0]
