"""Micropolar Coulomb flow: the band of growth and its end, after Muhlhaus & Vardoulakis 1987."""

import pytest
from mpmath import mp, mpf

from tests.closures.benchmarks import COULOMB, MICROPOLAR
from tests.closures.evaluate import Waves

SLOW = {"strain_rate": "1e-30", "pressure": "1e-30"}  # mu is of order one, inertia of the base flow 1e-30


def waves(coupling, **given) -> Waves:
    """Return the waves of a state in which only stresses matter."""
    return Waves("cosserat", "uniform_strain", COULOMB | MICROPOLAR | SLOW | {"coupling": coupling} | given)


def parts(found: Waves) -> tuple:
    """Return tan^2(varphi/2), mu and the direction of fastest growth of Coulomb flow."""
    t = mp.tan(found["varphi"] / 2)
    return t**2, mp.sqrt(2) * mp.sin(found["varphi"]) * found["p"] / found["strain_rate"], mp.degrees(mp.acos(t) / 2)


@pytest.mark.parametrize("coupling", ["0.01", "0.05", "0.5", "2"])
def test_short_waves_lose_half_the_coupling(coupling):
    found = waves(coupling)
    T, mu, angle = parts(found)
    assert abs(found.growth(angle) / (mu * (T - mpf(coupling)) / 2) - 1) < 1e-18


def test_long_waves_are_those_of_coulomb_flow():
    found = waves("1")
    T, mu, angle = parts(found)
    assert abs(found.growth(angle, q="1e-6") / (mu * T / 2) - 1) < 1e-12


@pytest.mark.parametrize("coupling", ["0.1", "0.5", "2"])
@pytest.mark.parametrize("inertia", ["1e-6", "1e-3"])
def test_the_band_ends_at_a_wavelength_of_the_internal_length(coupling, inertia):
    # Derived from the two balances at lambda = 0: l^2 q_c^2 = 2 c T/(c - T), T = tan^2(varphi/2), whatever the inertia
    found = waves(coupling, micro_inertia=inertia)
    T, _, angle = parts(found)
    with mp.workdps(60):
        c = mpf(coupling)
        end = mp.sqrt(2 * c * T / (c - T)) / found["l"]
    for factor, sign in (("0.999999999999", 1), ("1.000000000001", -1)):
        assert mp.sign(found.growth(angle, exponent=0, q=end * mpf(factor))) == sign


def test_directions_outside_the_wedge_of_coulomb_flow_stay_stable_at_every_wavelength():
    found = waves("0.5")
    for q in ("1", "1e3", "1e5"):
        assert all(found.growth(angle, exponent=0, q=q) < 0 for angle in ("0", "20", "46", "80"))
