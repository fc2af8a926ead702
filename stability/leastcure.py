"""The least cure of a point of a flow as a labelled result."""

from math import nan
from typing import TYPE_CHECKING, Any

from stability import results
from stability.cure import smallest_cure
from stability.model import Model

if TYPE_CHECKING:
    from xarray import Dataset

VALUES = {"cure_below": "below", "cure_from": "above", "cure_to": "last", "cure_beyond": "beyond"}


def least_cure(closure: Any, flow: Any, parameters: dict, point: dict, **asked: Any) -> "Dataset":
    """Return the answer of `smallest_cure` as a Dataset.

    Parameters
    ----------
    closure, flow, parameters, point, asked : as in `stability.smallest_cure`

    Returns
    -------
    Dataset with the ends of the lowest run of values that cure and their neighbours that do not, the fastest wave at
    its least value, and the base state there; what is not known is NaN. Attributes ``parameter``, ``sentence``,
    ``notes``, ``tried``, ``again``, ``certified`` (below, from) and ``certified_upper`` (to, beyond)
    """
    found = smallest_cure(closure, flow, parameters, point, **asked)
    model, given = Model(closure, flow), {**parameters, found.parameter: found.above}
    variables, coordinates, attributes = results.of_model(model, given, point, model.base(given, point), "full")
    numbers = {name: getattr(found, attribute) for name, attribute in VALUES.items()} | {
        "growth_below": found.growth_below,
        "fastest_growth_rate": found.growth_above,
        "fastest_wavenumber": found.wavenumber,
        "fastest_wave_angle": found.wave_angle,
        "band_width": found.band_width,
    }
    variables |= {name: ((), nan if value is None else float(value)) for name, value in numbers.items()}
    attributes["sign"] = "certified" if all(found.certified) else "certified in part" if any(
        found.certified + found.certified_upper) else "not certified"  # fmt: skip
    ds = results.dataset(
        variables, coordinates, **attributes, parameter=found.parameter, sentence=" ".join(found.sentences),
        growth=found.growth, tried=found.tried, again=found.again, certified=found.certified,
        certified_upper=found.certified_upper, notes=found.notes,
    )  # fmt: skip
    for name in VALUES:
        ds[name].attrs["units"] = found.unit
    return ds
