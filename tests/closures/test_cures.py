"""A viscosity and a hyperstress against the growth of Coulomb flow, tan^2(varphi/2) mu q^2/2 (Schaeffer 1987)."""

import pytest
from mpmath import mp, mpf

from tests.closures.benchmarks import COULOMB
from tests.closures.evaluate import Waves


def strength(waves) -> mpf:
    """Return the largest growth of Coulomb flow over q^2."""
    return waves["mu"] / 2 * mp.tan(waves["varphi"] / 2) ** 2


@pytest.mark.parametrize("viscosity", ["1e-6", "0.03", "0.5"])
def test_a_viscosity_is_subtracted_from_the_growth_of_coulomb_flow(viscosity):
    waves = Waves("viscous", "uniform_strain", COULOMB | {"kinematic_viscosity": viscosity})
    assert abs(waves.worst()[1] - (strength(waves) - mpf(viscosity))) < mpf(10) ** -20


def test_the_least_viscosity_that_cures_is_half_mu_times_tan_squared():
    waves = Waves("viscous", "uniform_strain", COULOMB | {"kinematic_viscosity": "1"})
    with mp.workdps(60):
        least = strength(waves)
    for factor, sign in (("0.999999999999", 1), ("1.000000000001", -1)):
        enough = Waves("viscous", "uniform_strain", COULOMB | {"kinematic_viscosity": mpf(factor) * least})
        assert mp.sign(enough.worst()[1]) == sign


def test_a_hyperstress_subtracts_the_fourth_power_of_the_wavenumber():
    # At a finite wavenumber inertia adds -d_tau u_tau, the rate of strain along the front; at strain rate 1e-30 it is
    # 1e-30 of what is compared, while mu q^2 stays of order one when the pressure is as small.
    state = COULOMB | {"strain_rate": "1e-30", "pressure": "1e-30", "hyperviscosity": "1e-4"}
    waves = Waves("hyperstress", "uniform_strain", state)
    fastest = mp.degrees(mp.acos(mp.tan(waves["varphi"] / 2)) / 2)  # as without it: test_coulomb
    for q in ("1", "10", "40"):
        expected = strength(waves) * mpf(q) ** 2 - mpf("1e-4") * mpf(q) ** 4
        rates = [waves.growth(fastest + shift, 0, q) for shift in (mpf(-1) / 100, 0, mpf(1) / 100)]
        assert abs(rates[1] / expected - 1) < 1e-12 and max(rates) == rates[1]


def test_the_cutoff_of_a_hyperstress_is_where_both_powers_meet():
    state = COULOMB | {"strain_rate": "1e-30", "pressure": "1e-30", "hyperviscosity": "1e-4"}
    waves = Waves("hyperstress", "uniform_strain", state)
    with mp.workdps(60):
        fastest = mp.degrees(mp.acos(mp.tan(waves["varphi"] / 2)) / 2)
        cutoff = mp.sqrt(waves["mu"] / mpf("1e-4") * mp.tan(waves["varphi"] / 2) ** 2 / 2)
    for factor, sign in (("0.999999999999", 1), ("1.000000000001", -1)):
        assert mp.sign(waves.growth(fastest, 0, cutoff * mpf(factor))) == sign
    assert len(waves.eigenvalues(30, q=1)) == 1  # three constraints leave one mode
