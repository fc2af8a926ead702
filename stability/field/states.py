"""From the jets of a field to base states of a closure: what is masked, and how an exact constraint is restored."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from stability import codegen
from stability.closures import CLOSURES
from stability.errors import SceneError
from stability.field.gradients import Jet, Jets
from stability.model import Base, Model
from stability.parameters import merged, to_si

# A model needs some flow; only its name is used here, and this one is in the cache of whoever has used the package.
PLACEHOLDER = "uniform_strain"


def base_of(closure: Any, parameters: Mapping, jets: Mapping[str, Jet]) -> Base:
    """Return the base states of a closure about all points of a field.

    Raises
    ------
    SceneError : a parameter is wrong, or the field lacks a value that the closure needs
    """
    model = Model(closure, PLACEHOLDER)
    if missing := [c for f in model.fields for c in (f if isinstance(f, tuple) else (f,)) if c not in jets]:
        raise SceneError(
            f"closure {model.closure_name} needs {', '.join(missing)}, which the field does not hold: it has "
            f"{', '.join(jets)}; name them when the field is read (fields={{...}})"
        )
    constants = to_si(merged(codegen.load(CLOSURES, closure)["PARAMETERS"]), parameters)
    state = tuple(
        tuple(zip(*(jets[c] for c in f), strict=True)) if isinstance(f, tuple) else jets[f] for f in model.fields
    )
    return Base(model, constants, state, (0.0, 0.0), {})


def constrained(model: Model) -> bool:
    """Return whether the closure imposes div u = 0 exactly, in identities that its compiled form relies on."""
    return model.closed and model.modes == 1


def solenoidal(jets: Mapping[str, Jet]) -> dict[str, Jet]:
    """Return the jets with half of the divergence, and of its gradient, taken off u_x and v_y each."""
    (u, (u_x, u_y), ((u_xx, u_xy), (_, u_yy))), (v, (v_x, v_y), ((v_xx, v_xy), (_, v_yy))) = jets["u"], jets["v"]
    half, x, y = (u_x + v_y) / 2, (u_xx + v_xy) / 2, (u_xy + v_yy) / 2
    u_xx, u_xy, v_xy, v_yy = u_xx - x, u_xy - y, v_xy - x, v_yy - y
    return dict(jets) | {
        "u": (u, (u_x - half, u_y), ((u_xx, u_xy), (u_xy, u_yy))),
        "v": (v, (v_x, -(u_x - half)), ((v_xx, v_xy), (v_xy, v_yy))),
    }


def strain_norm(jets: Mapping[str, Jet]) -> np.ndarray:
    """Return ||V||."""
    (_, (u_x, u_y), _), (_, (v_x, v_y), _) = jets["u"], jets["v"]
    return np.sqrt(u_x**2 + v_y**2 + (u_y + v_x) ** 2 / 2)


def strain_error(jets: Jets) -> np.ndarray:
    """Return the estimated error of the velocity gradient, root of the sum of squares over its entries."""
    return np.sqrt(sum(jets.error(letter, axis) ** 2 for letter in ("u", "v") for axis in (0, 1)))


def masks(jets: Jets, norm: np.ndarray, floor: float) -> dict[str, np.ndarray]:
    """Return the points that cannot be judged, by reason in the order of precedence; no point is in two.

    Parameters
    ----------
    floor : ||V|| below this part of its root mean square over the field is rest
    """
    every = [jets.narrow[n] for n in jets.narrow]
    known = np.all([np.isfinite(a) for f, g, H in every for a in (f, *g, *H[0], H[1][1])], axis=0)
    with np.errstate(all="ignore"):
        typical = np.sqrt(np.mean(norm[known] ** 2)) if known.any() else 0.0
        still = known & ~(norm > floor * typical)
        p = jets.narrow["p"][0] if "p" in jets.narrow else np.ones(norm.shape)
        loose = known & ~still & ~(p > 0)
    return {"without values or neighbours": ~known, "at rest": still, "without pressure": loose}


def taken(jets: Mapping[str, Jet], index: Any) -> dict[str, Jet]:
    """Return the jets of some points."""

    def of(tensor: Any) -> Any:
        return tuple(map(of, tensor)) if isinstance(tensor, tuple) else tensor[index]

    return {name: of(jet) for name, jet in jets.items()}
