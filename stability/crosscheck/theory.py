"""The linear theory as the checks need it: a wave's matrix, its leading eigenvalue and both of its eigenvectors.

The pencil is that of `Base`: a disturbance ``w exp(lambda t + i xi.x)`` satisfies ``lambda E w = L(xi) w``.
"""

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from scipy.linalg import eig

from stability.model import Base, Model

UNIFORM = "uniform_strain"


@dataclass(frozen=True, eq=False)
class PlaneWave:
    """A plane wave that grows like exp(eigenvalue t).

    Attributes
    ----------
    eigenvalue : growth rate + i frequency (1/s)
    wavevector : (2,) in 1/m
    field : (3,) complex amplitudes of u, v and p, of velocity amplitude one
    dual : (3,) such that ``dual @ q`` is the wave's amplitude in the fields q, whatever other modes they hold
    """

    eigenvalue: complex
    wavevector: np.ndarray
    field: np.ndarray
    dual: np.ndarray


def wave_matrix(base: Base, wavevector: np.ndarray) -> np.ndarray:
    """Return L(xi), (3, 3) complex, in 1/s, 1/m and m/s2 per unit of u, v and p."""
    two, one, zero = base.pencil()
    s = 1j * np.asarray(wavevector)
    found = np.array(zero, dtype=complex)
    for a in (0, 1):
        found += s[a] * np.array(one[a], dtype=complex)
        for b in (0, 1):
            found += s[a] * s[b] * np.array(two[a][b], dtype=complex)
    return found


def tangent(L: np.ndarray, evolves: Any) -> np.ndarray:
    """Return D: what is left of L (..., 3, 3) without the fields that do not evolve, where these can be eliminated."""
    e = np.array(evolves, dtype=bool)
    inner = np.linalg.solve(L[..., ~e, :][..., ~e], L[..., ~e, :][..., e])
    return L[..., e, :][..., e] - L[..., e, :][..., ~e] @ inner


def plane_wave(base: Base, wavevector: np.ndarray) -> PlaneWave:
    """Return the fastest growing wave of a wavevector in the flow's local frame."""
    E = np.diag(np.array(base.model.evolves, dtype=float))
    values, left, right = eig(wave_matrix(base, wavevector), E, left=True, right=True)
    # A mode that breaks a constraint has an infinite eigenvalue, which rounding may bring back as 1e16 of the others.
    weight = np.abs(np.einsum("ij,ij->j", left.conj(), E @ right))
    finite = np.isfinite(values) & (weight > 1e-12)
    best = np.flatnonzero(finite)[np.argmax(values[finite].real)]
    field = right[:, best] / np.linalg.norm(E @ right[:, best])
    dual = left[:, best].conj() @ E
    return PlaneWave(complex(values[best]), np.asarray(wavevector, float), field, dual / (dual @ field))


def unit(wave_angle: float) -> np.ndarray:
    """Return the unit vector in a direction (degrees)."""
    return np.array([np.cos(np.radians(wave_angle)), np.sin(np.radians(wave_angle))])


def uniform(closure: Any, parameters: dict, drift: float = 0.0) -> Base:
    """Return the base state of uniform strain.

    Parameters
    ----------
    closure : a closure with the fields (u, v, p)
    parameters : words of the closure and of the flow "uniform_strain"
    drift : speed (m/s). Where it is not zero, a spin makes a simple shear of the strain, |delta| < 1, whose material
        moves with this speed along its streamlines: a steady state, in which waves have a frequency
    """
    base = Model(closure, UNIFORM).base(parameters, {})
    if not drift:
        return base
    (_, ((a, _), (_, d)), second), *rest = base.state
    spin = np.sqrt(-a * d)  # makes the determinant of the gradient zero
    along = np.array([spin, -a]) / np.hypot(spin, a)  # which the gradient takes to zero
    gradient = ((a, spin), (-spin, d))
    return replace(base, state=((tuple(drift * along), gradient, second), *rest))
