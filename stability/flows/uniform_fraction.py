"""Uniform strain of a compressible medium: a volume fraction of its own beside velocity and pressure."""

from stability.flows.base import Flow
from stability.flows.uniform_strain import UNIFORM_STRAIN
from stability.parameters import Parameter
from stability.symbols import symbol

UNIFORM_FRACTION = Flow(
    name="uniform_fraction",
    title="Uniform plane strain at a uniform volume fraction",
    source="as uniform_strain, a snapshot: where delta is not zero the volume fraction changes with time",
    fields={**UNIFORM_STRAIN.fields, symbol("phi"): symbol("volume_fraction")},
    body_force=UNIFORM_STRAIN.body_force,
    point=(),
    parameters=(
        *UNIFORM_STRAIN.parameters,
        Parameter("volume_fraction", "volume_fraction", "1", 0, 1, "volume fraction of the grains", "base state"),
    ),
    axis=UNIFORM_STRAIN.axis,
)
