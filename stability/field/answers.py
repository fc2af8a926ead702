"""The answer in words: whether a structure of the mesh's size is the scheme's or the equations'."""

import json
from typing import TYPE_CHECKING

import numpy as np

from stability.verdict import KINEMATIC

if TYPE_CHECKING:
    from xarray import Dataset

FEW = 1.0  # e-folds: a wave that grows by less than e during the time stays what it was
RESOLVED = 8.0  # cells a wavelength: what a second-order scheme carries with a few per cent of error
LONGEST = 0.99  # of the longest wave looked at: the fastest one stands at the end of the search
SURE, SMALL = 2.0, 0.01  # estimated errors, and parts of ||V||: a divergence beyond both is the field's, and matters
WORTH = 0.01  # of the points: fewer are told by their count in the last sentence only

SAID = {
    4: "ill-posed: waves grow the faster the shorter they are, so whatever is narrowest on a mesh wins and gets "
       "narrower with it. The equations do that, on every mesh and with every scheme",
    3: "unstable at every short wavelength, but at a bounded rate",
    2: "well-posed and unstable to waves of finite length",
    1: "stable: nothing grows. What is seen at the mesh's size there is the scheme's or the initial state's",
    5: "undecided in float64: ask stability.well_posedness at such points",
}  # fmt: skip


def field_answer(ds: "Dataset") -> str:
    """Return sentences about a field map, or about a part of it (``ds.where(...)``, ``ds.sel(...)``)."""
    code = np.nan_to_num(ds["verdict"].values.ravel().astype(float)).astype(int)
    judged = code > 0
    total = int(judged.sum())
    if not total:
        return "No point could be judged. " + counted(ds, code.size)
    found = [f"{total} points were judged with {ds.attrs['closure']}."]
    for kind in (4, 3, 2, 1, 5):
        here = code == kind
        if here.sum() >= max(1, WORTH * total):
            share = f"{100 * here.sum() / total:.3g} % of them are "
            found.append(share + SAID[kind] + (detail(ds, here) if kind in (2, 3) else "") + ".")
    found.append(mesh_waves(ds, judged))
    found.append(divergence(ds, judged))
    if "firm" in ds:
        loose, blind = judged & (ds["firm"].values.ravel() != 1), np.isnan(ds["gradient_error"].values.ravel())
        if n := int((loose & ~blind).sum()):
            found.append(f"At {n} points the verdict changes within the error bars of the field's gradients: "
                         "there it is not decided.")  # fmt: skip
        if n := int((loose & blind).sum()):
            found.append(f"At {n} points the wider stencil lacks values, and the gradients have no error estimate.")
    return " ".join(filter(None, [*found, counted(ds, code.size - total)]))


def detail(ds: "Dataset", here: np.ndarray) -> str:
    """Return how long the fastest waves are, in metres and in cells, and whether the mesh carries them."""
    names = ("growth_rate", "wavelength", "grid_wavelength", "strain_rate_norm")
    growth, length, cell, norm = (ds[n].values.ravel()[here] for n in names)
    ratio = np.median(length / cell) * float(ds.attrs["cells"])
    if not ratio:
        return ", which is largest for the shortest waves: structures of a few cells are the equations', and their " \
               "width stays tied to the mesh"  # fmt: skip
    text = f"; the fastest one is {np.median(length):.3g} m long in the median ({ratio:.3g} cells, " \
           f"{np.median(growth):.3g} 1/s)"  # fmt: skip
    if np.median(length) >= LONGEST * float(ds.attrs["longest"]):
        if np.median(growth / norm) <= KINEMATIC:
            rate = f"{np.median(growth):.3g} 1/s in the median"
            return f"; what grows are the longest waves looked at, at {rate}, by the " \
                   "kinematics of the flow itself and not by the closure"  # fmt: skip
        return text + ", the longest looked at: growth rises towards long waves, for which the field is not uniform"
    if ratio >= RESOLVED:
        return text + ": bands of that width are the equations', and the mesh resolves them; narrower ones are not"
    return text + ", which this mesh does not resolve: bands of a few cells will narrow until cells are finer than that"


def mesh_waves(ds: "Dataset", judged: np.ndarray) -> str:
    """Return what waves of the mesh's shortest length do in the given time."""
    folds = ds["grid_e_folds"].values.ravel()[judged]
    folds = folds[np.isfinite(folds)]
    if not folds.size:
        return "The mesh's shortest waves could not be evaluated."
    grow, many = np.mean(folds > 0), np.mean(folds > FEW)
    when = ds.attrs["duration"]
    head = f"Waves of {float(ds.attrs['cells']):g} cells grow at {100 * grow:.3g} % of the points"
    if not grow:
        return head + ": noise of the mesh's size decays."
    tail = f"{head}, by e^{np.median(folds[folds > 0]):.3g} in the median and e^{folds.max():.3g} at most in {when}"
    if many < WORTH:
        return tail + ": too little to make a band out of noise in that time."
    return tail + f"; at {100 * many:.3g} % by more than e: noise of the mesh's size becomes a band there."


def divergence(ds: "Dataset", judged: np.ndarray) -> str:
    """Return a warning where the field has a divergence that the closure does not allow."""
    dilation, error = (ds[n].values.ravel() for n in ("dilation", "gradient_error"))
    loose = judged & (abs(dilation) > np.maximum(SURE * error, SMALL))
    if not int(ds.attrs["solenoidal"]) or loose.sum() < max(1, WORTH * judged.sum()):
        return ""
    return f"At {loose.sum()} points div u is more than errors of the gradients explain, up to " \
           f"{abs(dilation[loose]).max():.3g} ||V||: this closure imposes div u = 0, and what was judged there is " \
           "the flow without its divergence. Choose a closure that allows one."  # fmt: skip


def counted(ds: "Dataset", left: int) -> str:
    """Return what was masked, by reason; of a part of a field only how many points are left."""
    masked = json.loads(ds.attrs["masked"]) if isinstance(ds.attrs["masked"], str) else ds.attrs["masked"]
    told = ", ".join(f"{n} {why}" for why, n in masked.items() if n)
    if left != sum(masked.values()):
        return f"Not judged, or not of this part: {left}."
    return f"Not judged: {told}." if told else "Every point was judged."
