"""Limits and orders of convergence of numbers that were found with steps of several sizes."""

from collections.abc import Sequence

import numpy as np


def extrapolated(sizes: np.ndarray, values: np.ndarray, orders: Sequence[int]) -> np.ndarray:
    """Return the limit for vanishing size (Richardson).

    Parameters
    ----------
    sizes : (levels,) of steps, in any unit
    values : (levels, ...) found with them
    orders : of the error's terms, as many as there are levels less one
    """
    powers = (np.asarray(sizes) / np.max(sizes))[:, None] ** np.array([0, *orders])
    return np.tensordot(np.linalg.inv(powers)[0], values, axes=1)


def observed(sizes: np.ndarray, errors: np.ndarray) -> np.ndarray:
    """Return the order that errors (levels, ...) show between the two smallest sizes (levels,)."""
    (*_, a, b), (*_, h, k) = abs(np.asarray(errors)), np.asarray(sizes, float)
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.log(a / b) / np.log(h / k)
