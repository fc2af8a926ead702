"""Eigenvalues of a wave from the pencil itself, for closures with any number of fields and constraints.

With ``L = [[C, B], [row, corner]]``, evolving fields first, constrained ones last, constraints are removed in two steps
of unitary transformations, so that `numpy.linalg.eigvals` sees evolving fields only:

Stage 1  the part of the corner that is regular (its rank is known from the closure) by a Schur complement
Stage 2  what is left, ``row a = 0`` with unknowns that no constraint sees, by projection along B on the kernel of row

Both are done for all waves at once. Where stage 2 does not apply (a constraint hidden deeper), and in multiprecision,
waves are solved one by one: by QZ, or from the characteristic polynomial.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from stability import polynomials, spectrum
from stability.arithmetic import NUMPY, Arithmetic
from stability.errors import PrecisionError, SceneError

WORKS = "eigenvalues, growth_map, largest_growth and well_posedness"
Entries = tuple[tuple[Any, ...], ...]


@dataclass(frozen=True)
class General:
    """The pencil of waves along given directions, in powers of s = i|xi|, for an observer who moves with the flow."""

    name: str
    evolves: tuple[int, ...]
    modes: int
    rank: int
    series: tuple[Entries, ...]  # L0, L1 and L2 along the direction
    speed: Any
    arithmetic: Arithmetic = NUMPY

    @property
    def coefficients(self) -> dict:
        """Refuse: there is no shorter form than the pencil."""
        raise SceneError(
            f"closure {self.name} has {self.modes} modes and no closed form of their eigenvalues: {WORKS} answer for it"
        )

    def _each(self, change: Callable) -> "General":
        parts = tuple(tuple(tuple(change(c) for c in row) for row in matrix) for matrix in self.series)
        return replace(self, series=parts, speed=change(self.speed))

    def filled(self, size: int) -> "General":
        """Return the form with every coefficient an array over the directions, constants too."""
        return self._each(lambda c: np.broadcast_to(np.asarray(c, dtype=float), (size,)))

    def column(self) -> "General":
        """Return the form of many directions with a trailing axis for wavenumbers."""
        return self._each(lambda c: c[:, None] if np.ndim(c) else c)

    def rows(self, index: Any) -> "General":
        """Return the form at some of its directions."""
        return self._each(lambda c: c[index] if np.ndim(c) else c)

    def eigenvalues(self, wavenumber: Any) -> tuple:
        """Return the eigenvalues (1/s) by decreasing real part, Doppler shift included."""
        if self.arithmetic.name == NUMPY.name:
            found = self._sampled(np.asarray(wavenumber, float))
            shift = 1j * np.asarray(self.speed * wavenumber)
            ordered = by_growth(found - shift[..., None])
            return tuple(ordered[..., i] for i in range(self.modes))
        if not self.arithmetic.name.startswith("mpmath, "):
            self.coefficients  # noqa: B018  balls and bounded floats need a closed form: refused there
        return self._precise(wavenumber)

    def _sampled(self, wavenumber: np.ndarray) -> np.ndarray:
        """Return the eigenvalues (waves..., modes) in float64, NaN where a number left its range."""
        zero, one, two = self.series
        n = len(self.evolves)
        entries = [e for matrix in self.series for row in matrix for e in row]
        shape = np.broadcast_shapes(wavenumber.shape, *(np.shape(e) for e in entries))
        L = np.empty((*shape, n, n), complex)
        for i in range(n):
            for j in range(n):
                L[..., i, j].real = zero[i][j] - wavenumber * (wavenumber * two[i][j])
                L[..., i, j].imag = wavenumber * one[i][j]
        flat = L.reshape(-1, n, n)
        fine = np.isfinite(flat).all(axis=(1, 2))
        found = np.full((len(flat), self.modes), np.nan + 0j)
        if self.modes and fine.any():
            found[fine] = finite_eigenvalues(flat[fine], self.evolves, self.modes, self.rank)
        return found.reshape(*shape, self.modes)

    def _precise(self, wavenumber: Any) -> tuple:
        """Return the eigenvalues of one wave as mpmath numbers, from the characteristic polynomial."""
        number = self.arithmetic.complex
        s = number(0, wavenumber)
        zero, one, two = self.series
        L = [
            [zero[i][j] + s * (one[i][j] + s * two[i][j]) for j in range(len(self.evolves))]
            for i in range(len(self.evolves))
        ]
        c = polynomials.characteristic(self.evolves, L, number(1))
        coefficients = [c.get(j, number(0)) for j in range(self.modes, -1, -1)]
        context = number(1).real.context
        try:
            found = context.polyroots(coefficients, maxsteps=400, extraprec=4 * context.prec)
        except (context.NoConvergence, ZeroDivisionError) as e:
            raise PrecisionError(f"closure {self.name}: the roots of the characteristic polynomial: {e}") from e
        tie = context.mpf(2) ** (-context.prec // 2)
        found = [number(value) - number(0, self.speed * wavenumber) for value in found]
        size = max(abs(value) for value in found)
        # Real parts closer than half the digits tie, as those of a conjugate pair do: the imaginary part decides.
        found.sort(key=lambda e: (-context.nint(e.real / (size * tie)) if size else 0, -e.imag))
        return tuple(found)


def along_direction(pencil: tuple, c: Any, s: Any) -> tuple[Entries, ...]:
    """Return L0, L1 and L2 for waves along the direction with cosine c and sine s."""
    ((xx, xy), (yx, yy)), (x, y), zero = pencil
    axes = range(len(zero))
    one = tuple(tuple(c * x[i][j] + s * y[i][j] for j in axes) for i in axes)
    two = tuple(tuple(c * c * xx[i][j] + c * s * (xy[i][j] + yx[i][j]) + s * s * yy[i][j] for j in axes) for i in axes)
    return zero, one, two


def by_growth(found: np.ndarray) -> np.ndarray:
    """Return eigenvalues (waves..., modes) by decreasing real part; parts equal to rounding by imaginary part."""
    found = np.take_along_axis(found, np.argsort(-found.real, axis=-1, kind="stable"), axis=-1)
    size = np.abs(found).max(axis=-1, initial=0)
    for i in range(found.shape[-1] - 1):
        one, other = found[..., i].copy(), found[..., i + 1].copy()
        tie = (abs(one.real - other.real) <= spectrum.TIE * size) & ((one.real > 0) == (other.real > 0))
        swap = tie & (one.imag < other.imag)
        found[..., i], found[..., i + 1] = np.where(swap, other, one), np.where(swap, one, other)
    return found


def finite_eigenvalues(L: np.ndarray, evolves: tuple[int, ...], modes: int, rank: int) -> np.ndarray:
    """Return the finite eigenvalues (waves, modes) of ``lambda E a = L a`` for matrices (waves, n, n)."""
    e = [i for i, on in enumerate(evolves) if on]
    c = [i for i, on in enumerate(evolves) if not on]
    hidden = len(c) - rank
    if modes != len(e) - hidden:
        E = np.diag(evolves).astype(float)
        return np.stack([spectrum.pencil_eigenvalues(E, matrix, modes) for matrix in L])

    def block(rows: list, columns: list) -> np.ndarray:
        return L[:, rows][:, :, columns]

    C, B, row, corner = block(e, e), block(e, c), block(c, e), block(c, c)
    if c and rank == len(c):
        C = C - B @ np.linalg.solve(corner, row)
    elif c:
        if rank:
            U, S, V = np.linalg.svd(corner)
            B, row = B @ adjoint(V), adjoint(U) @ row
            C = C - B[:, :, :rank] @ (row[:, :rank] / S[:, :rank, None])
            B, row = B[:, :, rank:], row[:, rank:]
        kernel = np.linalg.qr(adjoint(row), mode="complete")[0][:, :, hidden:]
        across = adjoint(np.linalg.qr(B, mode="complete")[0][:, :, hidden:])
        with np.errstate(all="ignore"):
            try:
                C = np.linalg.solve(across @ kernel, across @ C @ kernel)
            except np.linalg.LinAlgError:  # B lies in the kernel of row: a mode has gone to infinity
                C = np.linalg.pinv(across @ kernel) @ (across @ C @ kernel) * np.inf
    bad = ~np.isfinite(C).all(axis=(1, 2))
    found = np.linalg.eigvals(np.where(bad[:, None, None], 0, C)).astype(complex)
    found[bad] = np.nan
    return found


def adjoint(matrices: np.ndarray) -> np.ndarray:
    """Return conjugate transposes."""
    return matrices.conj().swapaxes(-1, -2)
