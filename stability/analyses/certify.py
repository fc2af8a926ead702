"""Certified signs of a stored growth map: all of its samples, or some of them."""

import json
from typing import Any

import numpy as np

from stability import results
from stability.certified import Certifier, Tally, arithmetic_note
from stability.errors import SceneError


def certify(
    ds: "results.xr.Dataset", samples: int | None = None, seed: int = 0, closure: Any = None, flow: Any = None
) -> "results.xr.Dataset":
    """Return the Dataset with the certified ``sign`` of every growth rate, and how each was decided.

    Parameters
    ----------
    ds : result of `growth_map`
    samples : None for all, else how many to draw at random; the others keep the sign that they have
    seed : of the draw
    closure, flow : those of the result, if they are not registered

    Returns
    -------
    Dataset with ``sign``: 1 grows, -1 decays, 0 undecided (a tie up to `certified.LAST_BITS` bits). Attributes:
    ``sign_decided``, the count of samples by arithmetic; ``sign_disagreements``, how many float64 growth rates had
    another sign; ``sign_undecided``, the wave and the point of every tie, with growth rate and radius of its enclosure;
    ``sign``, the summary in words.

    Raises
    ------
    SceneError : not a growth map, or ``samples`` out of range
    """
    if "growth_rate" not in ds:
        raise SceneError("certify needs a growth map: this result has no growth_rate")
    total = ds.growth_rate.size
    if samples is not None and not 1 <= samples <= total:
        raise SceneError(f"samples = {samples} lies outside [1, {total}]: it is the number of samples to check")
    growth = ds.growth_rate.values
    chosen = np.ones(growth.shape, bool)
    if samples is not None:
        draw = np.random.default_rng(seed).choice(total, samples, replace=False)
        chosen = np.isin(np.arange(total), draw).reshape(growth.shape)
    if closure is None or flow is None:
        named = results.registered(ds)
        closure, flow = closure or named[0], flow or named[1]
    sign, tally = np.sign(growth).astype(np.int8), Tally()
    ties: list[dict] = []  # the point of every tie
    wavenumber, wave_angle = ds.wavenumber.values, ds.wave_angle.values
    parameters = json.loads(ds.attrs["parameters"])
    coordinates = [c for c in ds.coords if c not in ("wavenumber", "wave_angle")]
    for index in np.ndindex(growth.shape[:-2]):
        point = {c: float(ds[c].values[index]) for c in coordinates}
        one = Certifier(closure, flow, parameters, point, ds.attrs["matrix"])
        sign[index] = np.where(chosen[index], one.signs(wavenumber, wave_angle, tally, chosen[index]), sign[index])
        ties += [point] * (len(tally.undecided) - len(ties))
    told = zip(ties, tally.undecided, tally.enclosures, strict=True)
    names = ("wave_angle", "wavenumber", "growth_rate", "radius")
    undecided = [point | dict(zip(names, (*wave, *enclosure), strict=True)) for point, wave, enclosure in told]
    float_sign = np.sign(growth)
    disagreements = int(((sign != 0) & (sign != float_sign)).sum())
    dims = ds.growth_rate.dims
    out = ds.assign(sign=(dims, sign, dict(zip(("units", "long_name"), results.VARIABLES["sign"], strict=True))))
    return results.described(
        out,
        sign=summary(tally, disagreements),
        sign_decided=tally.by,
        sign_disagreements=disagreements,
        sign_undecided=undecided,
    )


def summary(tally: Tally, disagreements: int) -> str:
    """Return how the signs were decided, in a sentence."""
    count = sum(tally.by.values())
    shares = ", ".join(f"{name} {100 * n / count:.4g} %" for name, n in tally.by.items())
    beyond = f"; beyond float64: {arithmetic_note()}" if set(tally.by) - {"float64"} else ""
    return (
        f"certified: {count} samples decided by {shares}{beyond}; {disagreements} float64 growth rates had another sign"
    )
