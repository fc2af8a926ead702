"""The registry of closures. A further rheology is one new file beside this one and one line here."""

from stability.registry import Registry

CLOSURES = Registry(
    "closure",
    {
        "rigid_plastic": "stability.closures.drucker_prager:RIGID_PLASTIC",
        "perturbed": "stability.closures.drucker_prager:PERTURBED",
    },
)
