"""One published benchmark per closure: the state it is tested at, and the exponent n in ``sup Re lambda ~ q^n`` there.

The exponents are checked against each closure's own pencil in `test_benchmarks.py`, and against the verdicts of the
package in docs/closures.md, which ``python -m docs.tables`` makes from this table.
"""

from dataclasses import dataclass, field


@dataclass(frozen=True)
class Benchmark:
    """A closure at a state.

    Attributes
    ----------
    closure, flow, parameters : what is evaluated; decimals as text
    state : the parameters in a few words
    exponent : n, or None where every short wave decays
    why : one sentence
    test : the module beside this one that reproduces the published numbers
    peak : None, or (direction in degrees, m) where the fastest wave is found in a band that narrows as q^-m
    """

    closure: str
    flow: str
    parameters: dict = field(repr=False)
    state: str
    exponent: int | None
    why: str
    test: str
    peak: tuple[str, float] | None = None


STRAIN = {"delta": "0", "strain_rate": "1", "pressure": "1"}
COULOMB = {"friction_angle": "34", **STRAIN}
GRAINS = {"grain_diameter": "1", "solid_fraction": "0.5"}
GLASS = {
    **GRAINS,
    "static_friction": "0.342",
    "dynamic_friction": "0.557",
    "reference_inertial_number": "0.069",
    "delta": "0",
    "pressure": "2",
}
BULK = {
    "grain_diameter": "1",
    "static_friction": "0.4",
    "dynamic_friction": "0.6",
    "reference_inertial_number": "0.3",
    "dilation_slope": "0.2",
    "maximum_fraction": "0.6",
    "volume_fraction": "0.58",  # I = 0.1
    **STRAIN,
}
CIDR = {
    "grain_diameter": "1",
    "static_strength": "0.4",
    "dynamic_strength": "0.6",
    "reference_inertial_number": "0.3",
    "critical_pressure": "1",
    "hardening": "3.75",
    "critical_fraction": "0.6",
    "volume_fraction": "0.6",
    "pressure": "0.1",
    "strain_rate": "0.05",
    "delta": "0.1",
}
CRITICAL = {
    "critical_friction": "0.5",
    "critical_pressure": "1",
    "hardening": "3.75",
    "critical_fraction": "0.6",
    "volume_fraction": "0.6",
    "pressure": "0.5",  # f = 1/2: the leading matrix vanishes at 30 degrees
    "strain_rate": "1",
    "delta": "0.6324555320336759",  # f sqrt(2/(1 + f^2))
}
# mu = 0.5, so I = 0.12/0.94; the fluidity is the local one
FLUIDITY = {
    "grain_diameter": "1e-3",
    "solid_fraction": "0.6",
    "static_friction": "0.38",
    "rate_coefficient": "0.94",
    "nonlocal_amplitude": "0.48",
    "delta": "0",
    "pressure": "1",
    "strain_rate": "69.92174",
    "granular_fluidity": "197.76854",
}
MICROPOLAR = {"coupling": "1", "internal_length": "1e-3", "micro_inertia": "1e-6"}


def at(I: str) -> dict:
    """Return the part of a state that gives the inertial number I to grains of 1 m at p = 2, solid fraction 1/2."""
    return {"strain_rate": f"{float(I) / 2**0.5!r}"}  # I = sqrt(2) d ||V||/sqrt(solid_fraction p)


BENCHMARKS = (
    Benchmark(
        "rigid_plastic",
        "uniform_strain",
        COULOMB,
        "34 degrees",
        2,
        "Friction alone cannot hold a wave whose front lies between a velocity and a stress characteristic.",
        "test_coulomb",
    ),
    Benchmark(
        "perturbed",
        "uniform_strain",
        COULOMB | {"epsilon": "1e-3", "delta": "0.3"},
        "0 < δ < k",
        0,
        "The leading matrix is never positive; the direction where it vanishes grows at δ(k − δ)/(ε(2 − δ²)).",
        "test_coulomb",
    ),
    Benchmark(
        "perturbed",
        "uniform_strain",
        COULOMB | {"epsilon": "1e-3"},
        "δ = 0",
        -2,
        "Growth and leading matrix vanish in one direction; beside it a growth of k²/(16 ε² Λ) is left.",
        "test_coulomb",
        ("45", 2),
    ),
    Benchmark(
        "deviatoric",
        "uniform_strain",
        COULOMB | {"epsilon": "1e-3", "delta": "0.3"},
        "0 < ∣δ∣ < 1",
        2,
        "Stress and full strain rate are no longer parallel, so the leading matrix has a positive eigenvalue.",
        "test_coulomb",
    ),
    Benchmark(
        "viscous",
        "uniform_strain",
        COULOMB | {"kinematic_viscosity": "0.1"},
        "ν above (μ/2) tan²(φ_f/2)",
        None,
        "The viscosity takes ν q² from the growth of Coulomb flow, which is at most (μ/2) tan²(φ_f/2) q².",
        "test_cures",
    ),
    Benchmark(
        "viscous",
        "uniform_strain",
        COULOMB | {"kinematic_viscosity": "0.01"},
        "ν below (μ/2) tan²(φ_f/2)",
        2,
        "Too little viscosity: both terms grow as q², and friction wins.",
        "test_cures",
    ),
    Benchmark(
        "hyperstress",
        "uniform_strain",
        COULOMB | {"hyperviscosity": "1e-4"},
        "any η_g > 0",
        None,
        "η_g q⁴ beats the q² of Coulomb flow beyond q_c; a band of longer waves still grows.",
        "test_cures",
    ),
    Benchmark(
        "mu_i",
        "uniform_strain",
        GLASS | at("0.1"),
        "I between the neutral numbers",
        None,
        "Friction that rises with the rate acts as a viscosity for I in the middle range.",
        "test_mu_i",
    ),
    Benchmark(
        "mu_i",
        "uniform_strain",
        GLASS | at("1e-3"),
        "I below or above them",
        2,
        "Where friction hardly depends on I the flow is a Coulomb flow again.",
        "test_mu_i",
    ),
    Benchmark(
        "mu_i_regularised",
        "uniform_strain",
        GLASS | at("1") | {"high_rate_friction": "0.05"},
        "I below 17.9",
        None,
        "Friction keeps rising with I, so that its rate dependence does not die out.",
        "test_mu_i_regularised",
    ),
    Benchmark(
        "mu_i_regularised_low",
        "uniform_strain",
        GLASS
        | at("1e-3")
        | {"high_rate_friction": "0.05", "low_rate_exponent": "1.9", "branch_inertial_number": "0.0039717826838072"},
        "I below I_1",
        None,
        "Friction falls to zero with I just slowly enough (α < 2) to stay dissipative.",
        "test_mu_i_regularised",
    ),
    Benchmark(
        "mu_i_phi_i",
        "uniform_fraction",
        BULK | {"bulk_friction": "0.1"},
        "μ_b < 1 − 7μ/6",
        2,
        "Pressure rises with the rate of shear, and a wave along the extension axis is driven by it.",
        "test_compressible",
    ),
    Benchmark(
        "mu_i_phi_i",
        "uniform_fraction",
        BULK | {"bulk_friction": "0.9"},
        "μ_b > 1 − 7μ/6",
        None,
        "Enough dissipation in changes of volume; what is left acts on the volume fraction at a bounded rate.",
        "test_compressible",
    ),
    Benchmark(
        "compressible_i",
        "uniform_fraction",
        CIDR,
        "the three conditions hold",
        0,
        "The leading matrix is symmetric and negative; the volume fraction grows or decays at a bounded rate.",
        "test_compressible",
    ),
    Benchmark(
        "critical_state",
        "uniform_fraction",
        CRITICAL,
        "dilating",
        1,
        "The leading matrix vanishes where cos 2φ = f; there dilation softens the medium, λ² = q² φ Y_φ f/ρ.",
        "test_critical_state",
        ("30", 0.5),
    ),
    Benchmark(
        "double_shearing",
        "uniform_strain",
        COULOMB,
        "34 degrees",
        1,
        "A first-order system without real characteristics in time: the stress axes turn with the shear.",
        "test_double_shearing",
    ),
    Benchmark(
        "nonlocal",
        "uniform_fluidity",
        FLUIDITY,
        "μ above μ_s",
        None,
        "The fluidity cannot follow short waves, which see a Newtonian viscosity p/g.",
        "test_nonlocal",
    ),
    Benchmark(
        "cosserat",
        "uniform_strain",
        COULOMB | MICROPOLAR,
        "coupling above tan²(φ_f/2)",
        None,
        "Spin cannot follow short waves, and the antisymmetric stress resists them.",
        "test_cosserat",
    ),
    Benchmark(
        "cosserat",
        "uniform_strain",
        COULOMB | MICROPOLAR | {"coupling": "0.05"},
        "coupling below tan²(φ_f/2)",
        2,
        "Too weak an antisymmetric stress: the spin regularises nothing.",
        "test_cosserat",
    ),
)
