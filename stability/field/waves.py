"""Growth rates about many base states at once, each in directions and at wavenumbers of its own.

`Closed` serves closures with two velocities and one constraint: some 130 ns a direction and 40 ns a wave. `Pencils`
serves every other one, through `numpy.linalg.eigvals`: some microseconds a wave. Both return the largest real part to
roundings of the largest entry of D: enough for a search, whose winner is evaluated again by `Base.form`.
"""

from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np

from stability import hoisted
from stability.finite import leading
from stability.model import Base


class Waves(Protocol):
    """Base states about which waves grow."""

    @property
    def count(self) -> int:
        """How many base states there are."""

    def growth(self, angle: np.ndarray, wavenumber: np.ndarray) -> np.ndarray:
        """Return growth rates (point, direction, wavenumber).

        Angles are (point, direction) in radians; wavenumbers broadcast to (point, direction, wavenumber).
        """

    def take(self, index: np.ndarray) -> "Waves":
        """Return some of the base states."""


@dataclass(frozen=True)
class Closed:
    """Base states of a closure with closed forms, as tensors of its pencil (`hoisted`)."""

    tensors: hoisted.Tensors
    modes: int
    short: bool = False  # only what is left of it at the shortest waves: the terms of highest order

    @property
    def count(self) -> int:
        """How many base states there are."""
        return len(self.tensors.velocity)

    def take(self, index: np.ndarray) -> "Closed":
        """Return some of the base states."""
        return Closed(self.tensors.at(index), self.modes, self.short)  # type: ignore[arg-type]

    def leading(self) -> "Closed":
        """Return the same states as the shortest waves see them: growth at wavenumber 1 is that over |xi|^2."""
        return Closed(self.tensors, self.modes, True)

    def matrices(self, angle: np.ndarray) -> tuple[list, list]:
        """Return D (two modes) or C (one) and B by order, in the frame of waves (point, direction)."""
        t = self.tensors
        c, s = np.cos(angle), np.sin(angle)
        cc, cs, ss = c * c, c * s, s * s

        def along(table: np.ndarray, order: int) -> list:
            """Contract the directions of derivatives: components of the rest, in the flow's frame."""
            k = table.shape[1] >> order
            e = [table[:, i, None] for i in range(table.shape[1])]
            if order == 0:
                return e
            if order == 1:
                return [c * e[i] + s * e[k + i] for i in range(k)]
            return [cc * e[i] + cs * (e[k + i] + e[2 * k + i]) + ss * e[3 * k + i] for i in range(k)]

        def turned(m: list) -> list:
            """Turn a matrix into the frame (chi, tau)."""
            xx, xy, yx, yy = m
            mixed, twist = cs * (xy + yx), cs * (yy - xx)
            return [cc * xx + mixed + ss * yy, twist + cc * xy - ss * yx, twist + cc * yx - ss * xy,
                    ss * xx - mixed + cc * yy]  # fmt: skip

        orders = (2,) if self.short else (0, 1, 2)
        C = [turned(along(t.C[n], n)) if n in orders else None for n in range(3)]
        B: list = [None] * 3
        if not (self.short and self.modes == 2):
            for n in range(3):
                if np.any(t.B[n]) and (not self.short or n == 1):
                    x, y = along(t.B[n], n)
                    B[n] = [c * x + s * y, c * y - s * x]
        return C, B

    def growth(self, angle: np.ndarray, wavenumber: np.ndarray) -> np.ndarray:
        """Return growth rates (point, direction, wavenumber)."""
        C, B = self.matrices(angle)
        with np.errstate(all="ignore"):
            return self.pair(angle, C, B, wavenumber) if self.modes == 2 else single(C, B, wavenumber)

    def pair(self, angle: np.ndarray, C: list, B: list, q: np.ndarray) -> np.ndarray:
        """Return the larger real part of two modes, D = C - B row/corner."""
        zero = np.zeros(angle.shape)
        D = [[zero] * 4, *([zero] * 4 if m is None else m for m in C)]  # by order, from -1 on
        if not self.short:
            c, s = np.cos(angle), np.sin(angle)
            square = (c * c, c * s, s * c, s * s)
            row, corner = (
                sum(f * table[:, i, None] for i, f in enumerate(square))
                for table in (self.tensors.row, self.tensors.corner)
            )
            for n, b in enumerate(B):
                if b is not None:
                    D[n] = [D[n][0] - b[0] * row / corner, D[n][1], D[n][2] - b[1] * row / corner, D[n][3]]
        a, b, c_, d = ([order[i] for order in D] for i in range(4))
        h = [(x - y) / 2 for x, y in zip(a, d, strict=True)]
        # The discriminant h^2 + D12 D21 in powers of s = i q, from -2 on; D12 has no order -1.
        t: list[Any] = [sum(h[i] * h[n - i] for i in range(max(0, n - 3), min(n, 3) + 1)) for n in range(7)]
        for i in (1, 2, 3):
            for j in range(4):
                t[i + j] = t[i + j] + b[i] * c_[j]
        z, k = q * q, [e[..., None] for e in t]
        if self.short:
            real, imaginary = k[6] * z * z, 0.0 * z
            trace = -z * (a[3] + d[3])[..., None]
        else:
            real = (k[6] * z - k[4]) * z + k[2] - k[0] / z
            imaginary = ((k[3] - k[5] * z) * z - k[1]) / q
            trace = (a[1] + d[1])[..., None] - z * (a[3] + d[3])[..., None]
        root = np.sqrt((np.sqrt(real * real + imaginary * imaginary) + abs(real)) / 2)
        root = np.where(real > 0, root, abs(imaginary) / (2 * np.where(root == 0, 1, root)))
        return trace / 2 + root

    def scale(self, angle: np.ndarray) -> np.ndarray:
        """Return the wavenumber (point,) at which the terms of lower order are as large as the highest ones."""
        C, B = self.matrices(angle)

        def size(m: list | None) -> Any:
            return 0.0 if m is None else np.max([np.abs(e).max(axis=1) for e in np.broadcast_arrays(*m)], axis=0)

        zeroth = size(C[0])
        if self.modes == 2 and B[1] is not None:
            t = self.tensors
            zeroth = zeroth + size(B[1]) * np.abs(t.row).max(axis=1) / np.abs(t.corner).max(axis=1)
        with np.errstate(all="ignore"):
            return np.maximum(np.sqrt(zeroth / size(C[2])), size(C[1]) / size(C[2]))


def single(C: list, B: list, q: np.ndarray) -> np.ndarray:
    """Return the real part of the one mode ``C_tt - (B_t/B_c) C_ct``."""

    def value(parts: list, i: int) -> tuple[Any, Any]:
        zero, one, two = (None if m is None else m[i][..., None] for m in parts)
        real = 0.0 if zero is None else zero
        return real if two is None else real - q * q * two, 0.0 if one is None else q * one

    (across, _), (mixed, turn) = value(C, 3), value(C, 1)
    (b, bi), (t, ti) = value(B, 0), value(B, 1)
    size = b * b + bi * bi
    real, imaginary = (t * b + ti * bi) / size, (ti * b - t * bi) / size
    return across - real * mixed + imaginary * turn


@dataclass(frozen=True)
class Pencils:
    """Base states of a closure without closed forms."""

    base: Base
    count: int

    def take(self, index: np.ndarray) -> "Pencils":
        """Return some of the base states."""
        return Pencils(self.base.at(index), int(np.arange(self.count)[index].size))

    def growth(self, angle: np.ndarray, wavenumber: np.ndarray) -> np.ndarray:
        """Return growth rates (point, direction, wavenumber)."""
        angle = np.broadcast_to(angle, (self.count, angle.shape[1]))
        shape = (*angle.shape, wavenumber.shape[2])
        rows = np.repeat(np.arange(self.count), angle.shape[1])
        form = self.base.at(rows).form(np.rad2deg(angle).ravel()).filled(rows.size).column()
        q = np.broadcast_to(wavenumber, shape).reshape(rows.size, -1)
        with np.errstate(all="ignore"):
            return leading(form.eigenvalues(q)).reshape(shape)


def waves_of(base: Base, count: int) -> Closed | Pencils:
    """Return the waves about the base states of an array of points."""
    if base.model.closed:
        return Closed(hoisted.tensors(base, count), base.model.modes)
    return Pencils(base, count)
