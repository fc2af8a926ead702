"""Nonlocal granular fluidity (Kamrin & Koval 2012, Henann & Kamrin 2013): short waves decay, long ones may not."""

import pytest
from mpmath import mp, mpf

from tests.closures.benchmarks import FLUIDITY
from tests.closures.evaluate import Waves


def waves(friction: str) -> Waves:
    """Return the waves of a state with the local fluidity at a friction coefficient."""
    constants = ("static_friction", "rate_coefficient", "solid_fraction", "grain_diameter", "pressure")
    mu_s, b, fraction, d, p = (mpf(FLUIDITY[n]) for n in constants)
    mu = mpf(friction)
    rate = (mu - mu_s) / b * mp.sqrt(fraction * p) / d  # 2||D||, from mu = mu_s + b I
    return Waves(
        "nonlocal", "uniform_fluidity", FLUIDITY | {"strain_rate": rate / mp.sqrt(2), "granular_fluidity": rate / mu}
    )


@pytest.mark.parametrize("friction", ["0.3801", "0.4", "0.5", "0.9"])
@pytest.mark.parametrize("angle", ["0", "17", "39.3", "45", "90"])
def test_short_waves_see_a_newtonian_viscosity_in_every_direction(friction, angle):
    found = waves(friction)
    assert abs(found.growth(angle) / (-found["p"] / found["fluidity"]) - 1) < 1e-18


def test_the_base_state_has_the_local_fluidity():
    found = waves("0.5")
    excess = mp.sqrt(2) * found["strain_rate"] / found["fluidity"] - found["mu_s"]
    local = mp.sqrt(found["phi_s"] * found["p"]) * excess / (found["b"] * found["d"] * (excess + found["mu_s"]))
    assert abs(local / found["fluidity"] - 1) < 1e-50


def test_near_yield_a_band_of_long_waves_keeps_the_growth_of_the_local_rheology():
    # The symbol is stable in every direction; what the local mu(I) = mu_s + b I makes ill-posed at low I becomes a
    # band.
    found = waves("0.381")
    assert found.growth("39.3", exponent=0, q=100) > 10 * found["strain_rate"]
    assert found.growth("39.3", exponent=0, q=1000) < 0
