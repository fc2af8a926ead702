"""The registry of closures. A further rheology is one new file beside this one and one line here."""

from stability.registry import Registry

CLOSURES = Registry(
    "closure",
    {
        "rigid_plastic": "stability.closures.drucker_prager:RIGID_PLASTIC",
        "perturbed": "stability.closures.drucker_prager:PERTURBED",
        "deviatoric": "stability.closures.deviatoric:DEVIATORIC",
        "viscous": "stability.closures.viscous:VISCOUS",
        "hyperstress": "stability.closures.viscous:HYPERSTRESS",
        "mu_i": "stability.closures.mu_i:MU_I",
        "mu_i_regularised": "stability.closures.mu_i_regularised:MU_I_REGULARISED",
        "mu_i_regularised_low": "stability.closures.mu_i_regularised:MU_I_REGULARISED_LOW",
        "mu_i_phi_i": "stability.closures.mu_i_phi_i:MU_I_PHI_I",
        "compressible_i": "stability.closures.compressible_i:COMPRESSIBLE_I",
        "critical_state": "stability.closures.critical_state:CRITICAL_STATE",
        "double_shearing": "stability.closures.double_shearing:DOUBLE_SHEARING",
        "nonlocal": "stability.closures.nonlocal_fluidity:NONLOCAL",
        "cosserat": "stability.closures.cosserat:COSSERAT",
    },
)
