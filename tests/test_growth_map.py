"""Maps: the same numbers as single waves, memory that does not grow beyond the output, refusals."""

import subprocess
import sys

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

import stability as st
from stability.analyses import growth_map as module
from stability.errors import SceneError

POINT = {"r": 1.0, "theta": 0.0}


def test_a_map_holds_the_leading_eigenvalue_of_every_wave(perturbed_hopper):
    q, angle = np.geomspace(0.1, 1e6, 23), np.linspace(0, 360, 17)
    ds = st.growth_map("perturbed", "radial_hopper", perturbed_hopper, POINT, q, angle)
    found = st.eigenvalues("perturbed", "radial_hopper", perturbed_hopper, POINT, q, angle[:, None])[..., 0]
    # array and scalar functions of NumPy may round differently in the last place
    assert_allclose(ds.growth_rate, found.real, rtol=1e-12, atol=1e-12 * np.abs(found).min())
    assert_allclose(ds.frequency, found.imag, rtol=1e-12, atol=1e-9)
    assert ds.growth_rate.dims == ("wave_angle", "wavenumber") and ds.growth_rate.units == "1/s"


@pytest.mark.parametrize("block", [1, 7, 100, 10**6])
def test_blocks_do_not_change_a_bit(perturbed_hopper, monkeypatch, block):
    ask = ("perturbed", "radial_hopper", perturbed_hopper, POINT, np.geomspace(1, 1e4, 31), np.linspace(0, 90, 19))
    whole = st.growth_map(*ask)
    monkeypatch.setattr(module, "BLOCK", block)
    assert_allclose(st.growth_map(*ask).growth_rate, whole.growth_rate, rtol=1e-12)


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
ask(300)
before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
ds = ask(2000)
print(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before, ds.growth_rate.nbytes * 2)
"""


@pytest.mark.skipif(sys.platform != "linux", reason="ru_maxrss counts KiB on Linux, bytes elsewhere")
def test_memory_does_not_grow_beyond_the_output(perturbed_hopper):
    script = MEMORY.format(hopper=perturbed_hopper)
    run = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    grown, output = map(int, run.stdout.split())
    assert (
        grown * 1024 - output < 24 * 2**20
    )  # the blocks, and what the allocator keeps; the peer's way needs 240 B a sample
