"""The registry of flows (base states). A further flow is one new file beside this one and one line here."""

from stability.registry import Registry

FLOWS = Registry(
    "flow",
    {
        "radial_hopper": "stability.flows.radial_hopper:RADIAL_HOPPER",
        "radial_hopper_compatible": "stability.flows.radial_hopper:RADIAL_HOPPER_COMPATIBLE",
        "uniform_strain": "stability.flows.uniform_strain:UNIFORM_STRAIN",
        "uniform_fraction": "stability.flows.uniform_fraction:UNIFORM_FRACTION",
        "uniform_fluidity": "stability.flows.uniform_fluidity:UNIFORM_FLUIDITY",
    },
)
