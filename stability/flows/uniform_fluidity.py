"""Uniform strain with a uniform granular fluidity: a snapshot, steady where the fluidity is the local one."""

from math import inf

from stability.flows.base import Flow
from stability.flows.uniform_strain import UNIFORM_STRAIN
from stability.parameters import Parameter
from stability.symbols import symbol

UNIFORM_FLUIDITY = Flow(
    name="uniform_fluidity",
    title="Uniform plane strain with a uniform fluidity",
    source="as uniform_strain; friction is mu = sqrt(2) strain_rate/granular_fluidity",
    fields={**UNIFORM_STRAIN.fields, symbol("fluidity"): symbol("fluidity_0")},
    body_force=UNIFORM_STRAIN.body_force,
    point=(),
    parameters=(
        *UNIFORM_STRAIN.parameters,
        Parameter("granular_fluidity", "fluidity_0", "1/s", 0, inf, "rate of shear over friction", "base state"),
    ),
    axis=UNIFORM_STRAIN.axis,
)
