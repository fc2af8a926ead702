"""Linear stability and well-posedness of granular flow.

>>> import stability as st
>>> hopper = dict(friction_angle=34, wall_friction_angle=9, wedge_angle=15,
...               outlet_radius=0.5, inlet_radius=1.5, gravity=9.81)
>>> growth = st.eigenvalues("rigid_plastic", "radial_hopper", hopper, dict(r=1, theta=0), 1e4, 37).real
>>> f"{growth[0]:.4e}"  # 1/s: a wave between the two characteristics grows without bound as it gets shorter
'6.9798e+06'
"""

__version__ = "0.1.0"

from stability.closures import CLOSURES
from stability.flows import FLOWS

# Everything else is imported when it is first used: `import stability` needs neither SymPy nor Matplotlib nor xarray.
_PLACES = {
    "eigenvalues": "stability.api",
    "tangent_matrix": "stability.api",
    "growth_map": "stability.analyses.growth_map",
    "largest_growth": "stability.analyses.reductions",
    "adaptive_map": "stability.analyses.adaptive",
    "neutral_curve": "stability.analyses.neutral_curve",
    "phase_diagram": "stability.analyses.phase_diagram",
    "well_posedness": "stability.judge",
    "short_wave": "stability.judge",
    "Verdict": "stability.verdict",
    "symbol_map": "stability.symbolmap",
    "enclosure": "stability.proof",
    "certify": "stability.analyses.certify",
    "load_scene": "stability.scene",
    "run": "stability.runner",
    "resume": "stability.resuming",
    "Field": "stability.field.grids",
    "field_from": "stability.field.grids",
    "read_field": "stability.field.reading",
    "field_map": "stability.field.mapping",
    "field_cost": "stability.field.mapping",
    "field_answer": "stability.field.answers",
    "field_verdicts": "stability.field.pictures",
    "field_growth": "stability.field.pictures",
    "write_vtk": "stability.field.writing",
    "smallest_cure": "stability.cure",
    "Cure": "stability.cure",
    "open_results": "stability.results",
    "Closure": "stability.closures.base",
    "Flow": "stability.flows.base",
    "Parameter": "stability.parameters",
}

__all__ = ["CLOSURES", "FLOWS", *_PLACES]


def __getattr__(name: str):
    if name not in _PLACES:
        raise AttributeError(f"module 'stability' has no attribute {name!r}")
    from importlib import import_module

    return getattr(import_module(_PLACES[name]), name)


def __dir__() -> list[str]:
    return sorted([*globals(), *_PLACES])
