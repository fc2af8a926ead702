"""The fastest direction in closed form, at a given wavenumber: where a search starts.

With A's mean m and half difference R along its axis of extension psi, ``chi.A chi = m + R cos 2(theta - psi)``, so that
``C = -2 R cos 2(theta - psi)`` and delta = 2 m in the letters of (P5) and (P8D).
"""

from dataclasses import dataclass, replace

import numpy as np

from stability.model import Base

LAYER = 0.2  # of the width 1/sqrt(1 + 2 L) over which D' varies across its null direction
RANKED = 12  # wavenumbers between which closed forms choose
WIDEST = np.deg2rad(4)  # window of a search: growth varies over some 20 degrees


@dataclass(frozen=True)
class Guide:
    """What closed forms need at every point; ``kind`` says which of them holds."""

    kind: str
    axis: np.ndarray  # psi, radians
    delta: np.ndarray
    radius: np.ndarray  # R
    k: np.ndarray
    scale: np.ndarray  # mu epsilon/2: L over q^2

    @property
    def ranked(self) -> bool:
        """Whether closed forms also tell which wavenumber is the best one."""
        return self.kind == "perturbed"

    @property
    def guided(self) -> bool:
        """Whether the direction found is the best one of a closed form."""
        return self.kind in ("coulomb", "perturbed")

    def take(self, index: np.ndarray) -> "Guide":
        """Return the guide at some points."""
        parts = {n: getattr(self, n)[index] for n in ("axis", "delta", "radius", "k", "scale")}
        return replace(self, **parts)

    @property
    def never(self) -> bool:
        """Whether the leading symbol is known to make nothing grow: Tr M < 0 and Det M >= 0 for every A (P5, P6)."""
        return self.kind == "perturbed"

    def leading(self) -> "Guide":
        """Return the guide to the leading symbol alone."""
        return self if self.kind == "coulomb" else replace(self, kind="none")

    def wavenumber(self, low: np.ndarray, high: np.ndarray) -> np.ndarray:
        """Return the wavenumber, of some from end to end, that grows most by (P8T), (P8D) in the guide's direction."""
        span, best, top = np.log(high / low), low, np.full(low.shape, -np.inf)
        for part in np.linspace(0, 1, RANKED):
            q = low * np.exp(part * span)
            L = self.scale * q * q
            C = -(self.k + 2 * L * self.delta) / (2 + 2 * L)
            d, a = (self.delta + C) / 2, (self.delta - C) / 2
            trace = -L * (2 + self.delta * C) - (1 - self.k * a)
            minus = -L * ((1 + 2 * L) * d * d + a * a - self.k * a)  # of the determinant
            growth = 2 * minus / (np.sqrt(np.maximum(trace * trace + 4 * minus, 0)) - trace)
            best, top = np.where(growth > top, q, best), np.maximum(growth, top)
        return best

    def directions(self, wavenumber: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return angles and widths (point, n), radians, at one wavenumber a point; n = 0 without a guide."""
        if self.kind == "none":
            nothing = np.empty((self.axis.size, 0))
            return nothing, nothing
        L = self.scale * wavenumber**2
        with np.errstate(all="ignore"):
            if self.kind == "coulomb":
                # (L5): c (c + sin varphi)/(1 + c sin varphi) is least at c = -tan(varphi/2)
                sine = self.k / np.sqrt(2)
                cosine = sine / (1 + np.sqrt(1 - sine * sine))
            else:
                # (P8D): (1 + 2 L) d^2 + a^2 - k a is least at C = -(k + 2 L delta)/(2 + 2 L); without epsilon, d = 0
                C = -(self.k + 2 * L * self.delta) / (2 + 2 * L) if self.kind == "perturbed" else -self.delta
                cosine = -C / (2 * self.radius)
        half = np.arccos(np.clip(cosine, -1, 1)) / 2
        width = np.minimum(WIDEST, LAYER / np.sqrt(1 + 2 * L))
        return np.stack([self.axis + half, self.axis - half], axis=1), np.stack([width, width], axis=1)


KINDS = {"rigid_plastic": "coulomb", "viscous": "coulomb", "perturbed": "perturbed"}


def guide(base: Base, count: int) -> Guide:
    """Return the guide of a closure's base states."""
    model = base.model
    letters = base.letters() if model.closed else {}
    kind = KINDS.get(model.closure_name, "null" if model.modes == 2 else "none")
    if not {"A_xx", "A_xy", "A_yy", "mu", "k"} <= letters.keys() or (kind == "perturbed" and model.modes != 2):
        kind = "none"
    if kind == "none":
        zero = np.zeros(count)
        return Guide(kind, zero, zero, zero, zero, zero)
    xx, xy, yy, mu, k = (
        np.broadcast_to(np.asarray(letters[n], float), (count,)) for n in ("A_xx", "A_xy", "A_yy", "mu", "k")
    )
    scale = mu * base.parameters.get("epsilon", 0.0) / 2
    return Guide(kind, np.arctan2(xy, (xx - yy) / 2) / 2, xx + yy, np.hypot((xx - yy) / 2, xy), k, scale)
