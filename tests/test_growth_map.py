"""Maps: the same numbers as single waves, memory that does not grow beyond the output, refusals."""

import subprocess
import sys

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

import stability as st
from stability import fast
from stability.analyses import growth_map as module
from stability.analyses.reductions import largest_growth
from stability.errors import SceneError

POINT = {"r": 1.0, "theta": 0.0}


def test_a_map_holds_the_leading_eigenvalue_of_every_wave(perturbed_hopper):
    q, angle = np.geomspace(0.1, 1e6, 23), np.linspace(0, 360, 17)
    ds = st.growth_map("perturbed", "radial_hopper", perturbed_hopper, POINT, q, angle)
    found = st.eigenvalues("perturbed", "radial_hopper", perturbed_hopper, POINT, q, angle[:, None])[..., 0]
    # four roundings of a trace that is at most 2^22 times the growth rate (`fast.NEAR`)
    assert_allclose(ds.growth_rate, found.real, rtol=2e-9, atol=0)
    assert_array_equal(np.sign(ds.growth_rate), np.sign(found.real))
    # the trace of D is real to 1e-7, so the frequency, 1e4 rad/s here, carries roundings of terms no larger than itself
    assert_allclose(ds.frequency, found.imag, rtol=2e-9, atol=1e-9)
    assert ds.growth_rate.dims == ("wave_angle", "wavenumber") and ds.growth_rate.units == "1/s"


@pytest.mark.parametrize("block", [1, 7, 100, 10**6])
@pytest.mark.parametrize("where", [(module, "BLOCK"), (fast, "BLOCK")])
def test_blocks_change_nothing_beyond_roundings(perturbed_hopper, monkeypatch, block, where):
    ask = ("perturbed", "radial_hopper", perturbed_hopper, POINT, np.geomspace(1, 1e4, 31), np.linspace(0, 90, 19))
    whole = st.growth_map(*ask)
    monkeypatch.setattr(*where, block)
    cut = st.growth_map(*ask)  # BLAS treats the edges of a matrix with kernels of their own: not the same bits
    assert_allclose(cut.growth_rate, whole.growth_rate, rtol=2e-9, atol=0)  # `fast.NEAR`
    assert_allclose(cut.frequency, whole.frequency, rtol=2e-9, atol=1e-9)


@pytest.mark.parametrize("closure", ["perturbed", "rigid_plastic"])
@pytest.mark.parametrize("places", [1, 40])
def test_threads_do_not_change_a_bit(hopper, monkeypatch, closure, places):
    monkeypatch.setattr(module, "BLOCK", 500)
    point = {"r": np.linspace(0.6, 1.4, places), "theta": np.linspace(-5, 5, places)}
    parameters = hopper | ({"epsilon": 2e-5} if closure == "perturbed" else {})
    ask = (closure, "radial_hopper", parameters, point, np.geomspace(1, 1e5, 31), np.linspace(0, 90, 19))
    one, three = st.growth_map(*ask), st.growth_map(*ask, threads=3)
    for name in ("growth_rate", "frequency"):
        assert_array_equal(one[name], three[name])


@pytest.mark.parametrize("threads", [0, -1, 1.5, True])
def test_a_number_of_threads_that_is_none_is_refused(perturbed_hopper, threads):
    with pytest.raises(SceneError, match="threads"):
        st.growth_map("perturbed", "radial_hopper", perturbed_hopper, POINT, [1.0], [0.0], threads=threads)


def test_an_unknown_accuracy_is_refused(perturbed_hopper):
    with pytest.raises(SceneError, match="standard, draft"):
        st.growth_map("perturbed", "radial_hopper", perturbed_hopper, POINT, [1.0], [0.0], accuracy="best")


def test_the_growth_rate_comes_without_the_frequency_too(perturbed_hopper):
    ask = ("perturbed", "radial_hopper", perturbed_hopper, POINT, np.geomspace(1, 1e4, 31), np.linspace(0, 90, 19))
    alone = st.growth_map(*ask, frequency=False)
    assert "frequency" not in alone
    # the same formula with its arrays in other places: BLAS may round a last bit otherwise
    assert_allclose(alone.growth_rate, st.growth_map(*ask).growth_rate, rtol=1e-9)


@pytest.mark.parametrize("matrix", ["full", "truncated", "leading"])
def test_a_draft_is_float32_and_states_its_bound(perturbed_hopper, matrix):
    q = np.geomspace(1e-6, 1e12, 91)  # q^4 is far outside float32
    ask = ("perturbed", "radial_hopper", perturbed_hopper, POINT, q, np.linspace(3, 177, 59), matrix)
    draft, standard = st.growth_map(*ask, accuracy="draft"), st.growth_map(*ask)
    assert draft.growth_rate.dtype == np.float32
    assert (draft.error_bound, standard.error_bound) == ("1e-6 ||D||", "4e-15 ||D||")
    size = np.abs(st.eigenvalues(*ask[:4], q, ask[5][:, None], matrix)).max(axis=-1)  # no more than ||D||
    for name in ("growth_rate", "frequency"):
        assert np.all(np.abs(draft[name] - standard[name]) <= 1e-6 * (size + np.abs(standard[name])))


def places_and_waves() -> tuple:
    return (
        {"r": np.linspace(0.6, 1.4, 7), "theta": np.linspace(-5, 5, 7)},
        np.geomspace(1, 1e5, 53),
        np.arange(0, 360, 9),
    )


@pytest.mark.parametrize("threads", [1, 2])
@pytest.mark.parametrize("closure", ["perturbed", "rigid_plastic"])
def test_reductions_are_those_of_the_map(hopper, monkeypatch, closure, threads):
    monkeypatch.setattr(fast, "BLOCK", 300)
    parameters = hopper | ({"epsilon": 2e-5} if closure == "perturbed" else {})
    point, q, angle = places_and_waves()
    ask = (closure, "radial_hopper", parameters, point, q, angle)
    growth = st.growth_map(*ask).growth_rate
    found = largest_growth(*ask, threads=threads)
    flat = growth.values.reshape(7, -1)
    assert_array_equal(found.largest_growth_rate, flat.max(axis=1))
    i, j = np.divmod(flat.argmax(axis=1), q.size)
    assert_array_equal(found.wave_angle, angle[i])
    assert_array_equal(found.wavenumber, q[j])
    assert_allclose(found.unstable_share, (flat > 0).mean(axis=1), rtol=1e-15, atol=0)


def test_reductions_at_one_point_are_numbers(perturbed_hopper):
    found = largest_growth("perturbed", "radial_hopper", perturbed_hopper, POINT, [1.0, 200.0], [40.0, 90.0])
    assert found.largest_growth_rate.shape == () and found.wave_angle == 40 and found.wavenumber == 200


def test_positions_come_first(perturbed_hopper):
    q, angle = np.array([10.0, 100.0]), np.array([0.0, 40.0, 80.0])
    places = {"r": [0.7, 1.0, 1.2, 1.4], "theta": [0.0, 5.0, -5.0, 2.0]}
    ds = st.growth_map("perturbed", "radial_hopper", perturbed_hopper, places, q, angle)
    assert ds.growth_rate.dims == ("position", "wave_angle", "wavenumber") and ds.growth_rate.shape == (4, 3, 2)
    for i in range(4):
        point = {name: values[i] for name, values in places.items()}
        alone = st.growth_map("perturbed", "radial_hopper", perturbed_hopper, point, q, angle)
        assert_allclose(ds.growth_rate[i], alone.growth_rate, rtol=1e-11)
        assert_allclose(ds.viscosity[i], alone.viscosity, rtol=1e-14)


def test_progress_reports_every_row_once(perturbed_hopper, monkeypatch):
    monkeypatch.setattr(module, "BLOCK", 10)
    seen = []
    st.growth_map(
        "perturbed", "radial_hopper", perturbed_hopper, POINT, np.geomspace(1, 10, 5), np.arange(9.0),
        progress=lambda done, total: seen.append((done, total)),
    )  # fmt: skip
    assert_array_equal(seen, [(2, 9), (4, 9), (6, 9), (8, 9), (9, 9)])


def test_the_base_state_and_its_residuals_are_recorded(perturbed_hopper):
    point = {"r": 1.0, "theta": 5.0}
    ds = st.growth_map("perturbed", "radial_hopper", perturbed_hopper, point, [1.0], [0.0])
    assert_allclose(ds.momentum_residual_y, -2.19, atol=0.005)  # computed at 40 digits
    assert_allclose(ds.viscosity, 1.51373436127025, rtol=1e-13)  # computed at 40 digits
    assert ds.dilation == pytest.approx(0, abs=1e-16)  # div u = 0 exactly


@pytest.mark.parametrize("bad", [0.0, -1.0, np.nan, np.inf])
def test_a_wave_without_length_is_refused(perturbed_hopper, bad):
    with pytest.raises(SceneError, match="wavenumber"):
        st.growth_map("perturbed", "radial_hopper", perturbed_hopper, POINT, [1.0, bad], [0.0])


MEMORY = """
import resource, numpy as np, stability as st
hopper = {hopper!r}
def ask(n):
    waves = np.geomspace(1, 1e5, n), np.linspace(0, 360, n)
    return st.growth_map("perturbed", "radial_hopper", hopper, dict(r=1.0, theta=0.0), *waves)
ask(10)
before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
ds = ask({n})
print(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before, ds.growth_rate.nbytes * 2)
"""


@pytest.mark.skipif(sys.platform != "linux", reason="ru_maxrss counts KiB on Linux, bytes elsewhere")
@pytest.mark.parametrize("n", [1000, 2000])
def test_memory_is_the_output_and_four_mebibytes(perturbed_hopper, n):
    script = MEMORY.format(hopper=perturbed_hopper, n=n)
    run = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    grown, output = map(int, run.stdout.split())
    assert grown * 1024 - output < 4 * 2**20  # measured 1.9 and 2.1 MiB; the peer's way needs 240 B a sample
