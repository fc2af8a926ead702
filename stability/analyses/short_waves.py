"""The verdict on a point of a flow as a labelled result."""

from math import nan
from typing import TYPE_CHECKING, Any

import numpy as np

from stability import results
from stability.judge import well_posedness
from stability.model import Model

if TYPE_CHECKING:
    from xarray import Dataset


def short_waves(closure: Any, flow: Any, parameters: dict, point: dict, matrix: str = "full") -> "Dataset":
    """Return the verdict of `well_posedness` as a Dataset.

    Parameters
    ----------
    closure, flow, parameters, point, matrix : as in `stability.well_posedness`

    Returns
    -------
    Dataset with the law of the fastest short waves, the wedges of directions that grow by it, the fastest wave of any
    length where it was looked for, and the base state there; what is not known is NaN. Attributes ``verdict`` (stable,
    ill-posed, ...), ``sentence``, ``latex``, ``law``, ``unit``, ``cause``, ``certified`` and ``notes``
    """
    found = well_posedness(closure, flow, parameters, point, matrix)
    model = Model(closure, flow)
    with np.errstate(all="ignore"):  # what float64 does not hold of the state is NaN
        base = model.base(parameters, point)
        variables, coordinates, attributes = results.of_model(model, parameters, point, base, matrix)
    fastest = found.finite or (nan, nan, nan)
    numbers = {
        "exponent": found.exponent,
        "coefficient": found.coefficient,
        "short_wave_angle": found.worst_angle,
        "narrowing": found.width,
        **{f"fastest_{n}": v for n, v in zip(("growth_rate", "wavenumber", "wave_angle"), fastest, strict=True)},
    }
    variables |= {name: ((), nan if value is None else float(value)) for name, value in numbers.items()}
    variables |= {f"wedge_{end}": (("wedge",), [w[i] for w in found.wedge]) for i, end in enumerate(("from", "to"))}
    attributes |= {"sign": "certified" if found.certified else "not certified"}
    ds = results.dataset(
        variables, coordinates, **attributes,
        verdict=str(found.kind), sentence=str(found), latex=found.latex, law=found.law, unit=found.unit,
        cause=found.cause, certified=found.certified, notes=found.notes,
    )  # fmt: skip
    return ds.drop_dims("wedge") if not found.wedge else ds
