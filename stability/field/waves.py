"""Growth rates about many base states at once, each in directions and at wavenumbers of its own.

Whatever the closure, det(lambda E - L) is a polynomial in lambda, s = i|xi| and the direction: some 40 numbers a base
state. Sorted by harmonics of the direction they are contracted with powers of the wavenumber first, with directions
second: a direction shared by all points costs a matrix product, and derivatives cost little more than values. Roots
miss the eigenvalues by roundings of the largest one: enough for a search.

Rejected: D itself, turned into each wave's frame: 130 ns a direction instead of 10, and only for closures with closed
forms; and `numpy.linalg.eigvals` for the others: microseconds a wave.
"""

from dataclasses import dataclass
from functools import cache, cached_property

import numpy as np

from stability import polynomials, roots
from stability.model import Base
from stability.puiseux import Edge, polygon

SIGN = (1, 1, -1, -1)  # of i^m, m even: real, m odd: imaginary
POLES = 24  # directions looked at, at a third as many wavenumbers
POLE, NEARLY = 1e-9, 1e-3  # parts of the largest value: smaller ones have no sign, or leave a mode nearly undetermined
BLOCK = 2**15  # waves at once: their arrays stay in the caches
ORDERS = ((0, 0), (0, 1), (1, 0), (0, 2), (1, 1), (2, 0))  # of derivatives by the logarithm of |xi| and by the angle


@dataclass(frozen=True)
class Waves:
    """Characteristic polynomials of many base states.

    ``terms[j, m]`` holds the coefficients of ``lambda^j |xi|^m``, imaginary for odd m, by harmonics of the direction:
    (cosine or sine of n theta, n // 2, point), n from 0 or 1 to m in steps of two.
    """

    terms: dict[tuple[int, int], np.ndarray]

    @property
    def count(self) -> int:
        """How many base states there are."""
        return next(iter(self.terms.values())).shape[-1]

    @cached_property
    def modes(self) -> int:
        """How many eigenvalues a wave has."""
        return max(j for j, _ in self.terms)

    def take(self, index: np.ndarray | slice) -> "Waves":
        """Return some of the base states."""
        found = Waves({key: term[..., index] for key, term in self.terms.items()})
        if "sizes" in vars(self):
            vars(found)["sizes"] = {key: size[index] for key, size in self.sizes.items()}
        return found

    @cached_property
    def edges(self) -> list[Edge]:
        """The edges of the Newton polygon on which short waves grow or decay without bound, steepest first."""
        return [e for e in polygon(dict.fromkeys(self.terms)) if e.exponent > 0][::-1]

    def along(self, edge: Edge) -> "Waves":
        """Return the same states as short waves see them: growth at wavenumber 1 is that over |xi|^exponent."""
        height = max(m for j, m in self.terms if j == edge.lowest)
        powers = {i: int(height - edge.exponent * i) for i in edge.terms}
        return Waves({(i, m): self.terms[edge.lowest + i, m] for i, m in powers.items()})

    @cached_property
    def sizes(self) -> dict[tuple[int, int], np.ndarray]:
        """The largest harmonic of each term (point,)."""
        return {key: abs(term).max(axis=(0, 1)) for key, term in self.terms.items()}

    def bound(self, wavenumber: np.ndarray) -> np.ndarray:
        """Return the size (point,) of the largest eigenvalue at a wavenumber, to a factor of two or so."""
        size, power = [np.zeros(self.count) for _ in range(self.modes + 1)], self.powers(wavenumber)
        for (j, m), a in self.sizes.items():
            size[j] += a * power[m]
        n, found = self.modes, np.zeros(self.count)
        with np.errstate(all="ignore"):
            for j in range(n):
                ratio = size[j] / size[n]
                found = np.maximum(
                    found, ratio if n - j == 1 else np.sqrt(ratio) if n - j == 2 else ratio ** (1 / (n - j))
                )
        return found

    def poles(self, low: np.ndarray, high: np.ndarray) -> np.ndarray:
        """Return where (point,) the coefficient of the highest power of lambda changes its sign among waves looked at.

        There a mode goes to infinity: the constraints leave it undetermined. A coefficient whose imaginary part does
        not vanish beside the real one keeps the mode finite.
        """
        top = Waves({(0, m): term for (j, m), term in self.terms.items() if j == self.modes})
        angles, seen = np.linspace(0, np.pi, POLES, endpoint=False)[None], np.zeros((2, self.count), bool)
        for part in np.linspace(0, 1, POLES // 3 if len(top.terms) > 1 else 1):
            value = top.at(low * (high / low) ** part).coefficients(angles)[0]
            size = abs(value.real).max(axis=1, keepdims=True)
            real = abs(value.imag).max(axis=1) <= NEARLY * size[:, 0]
            seen |= [real & (sign * value.real > POLE * size).any(axis=1) for sign in (1, -1)]
        return seen[0] & seen[1]

    def powers(self, wavenumber: np.ndarray) -> list[np.ndarray]:
        """Return the powers of the wavenumber up to the highest that occurs."""
        found = [np.ones(self.count)]
        for _ in range(max(m for _, m in self.terms)):
            found.append(found[-1] * wavenumber)
        return found

    def scale(self) -> np.ndarray:
        """Return the largest wavenumber (point,) at which a term balances the highest of its power of lambda.

        Only the highest: others may be roundings of zero, and two of those balance anywhere.
        """
        found = np.zeros(self.count)
        with np.errstate(all="ignore"):
            for (j, m), a in self.sizes.items():
                n = max(k for i, k in self.terms if i == j)
                if n > m:
                    ratio = (a / self.sizes[j, n]) ** (1 / (n - m))
                    found = np.fmax(found, np.where(np.isfinite(ratio), ratio, 0))
        return np.where(found > 0, found, 1.0)

    def at(self, wavenumber: np.ndarray, slopes: bool = False) -> "Ring":
        """Return the waves with one wavenumber (point,), and the slopes by its logarithm if asked for."""
        highest = [max((m for _, m in self.terms if m % 2 == odd), default=odd - 2) for odd in (0, 1)]
        shape = (3 if slopes else 1), self.modes + 1, 2
        even, odd = (np.zeros((*shape, m // 2 + 1, self.count)) for m in highest)
        power = self.powers(wavenumber)
        for (j, m), term in self.terms.items():
            value = term * power[m]
            for order, part in enumerate((even, odd)[m % 2]):
                if order:
                    value *= m
                part[j, :, : term.shape[1]] += value
        return Ring((even, odd))

    def growth(self, angle: np.ndarray, wavenumber: np.ndarray) -> np.ndarray:
        """Return growth rates (point, n) at angles (point or 1, n) in radians and one wavenumber a point."""
        return self.at(wavenumber).growth(angle)


@dataclass(frozen=True)
class Ring:
    """Waves of one wavenumber a point.

    Attributes
    ----------
    parts : real and imaginary part of the characteristic polynomial and, where there are three orders, its first two
        derivatives by the logarithm of the wavenumber: (order, power of lambda, cosine or sine of n theta, n // 2,
        point), n even or odd
    """

    parts: tuple[np.ndarray, np.ndarray]

    def take(self, index: np.ndarray | slice) -> "Ring":
        """Return the waves about some of the base states."""
        return Ring((self.parts[0][..., index], self.parts[1][..., index]))

    def growth(self, angle: np.ndarray) -> np.ndarray:
        """Return growth rates (point, n) at angles (point or 1, n) in radians."""
        count, found = self.parts[0].shape[-1], np.empty((self.parts[0].shape[-1], angle.shape[1]))
        step = max(1, BLOCK // angle.shape[1])
        for part in (slice(i, i + step) for i in range(0, count, step)):
            c = self.take(part).coefficients(angle if angle.shape[0] == 1 else angle[part])
            with np.errstate(all="ignore"):
                found[part] = roots.largest(list(c))
        return found

    def coefficients(self, angle: np.ndarray) -> np.ndarray:
        """Return the coefficients (power of lambda, point, n) at angles (point or 1, n) in radians."""
        _, powers, _, _, count = self.parts[0].shape
        c = np.empty((powers, count, angle.shape[1]), complex)
        for part, table, (basis,) in zip((c.real, c.imag), self.parts, self.harmonics(angle, 0), strict=True):
            if angle.shape[0] == 1:
                shared = basis.reshape(-1, angle.shape[1])
                part[:] = table[0].reshape(powers, len(shared), count).swapaxes(1, 2) @ shared
            else:
                part[:] = np.einsum("jcnp,cnpd->jpd", table[0], basis)
        return c

    def peak(self, angle: np.ndarray) -> np.ndarray:
        """Return growth (1/s) and its derivatives in `ORDERS`, (6, point); zero those that the ring does not have."""
        orders, powers, _, _, count = self.parts[0].shape
        c = np.zeros((len(ORDERS), powers, count), complex)
        for part, table, basis in zip((c.real, c.imag), self.parts, self.harmonics(angle, 2), strict=True):
            for i, (k, d) in enumerate(ORDERS):
                if k < orders:
                    part[i] = np.einsum("jcnp,cnp->jp", table[k], basis[d])
        with np.errstate(all="ignore"):
            return implicit(c, roots.fastest(list(c[0]))).real

    def harmonics(self, angle: np.ndarray, derivatives: int) -> list[np.ndarray]:
        """Return cos n theta and sin n theta and derivatives, (order, 2, n // 2, *angle.shape), n even and n odd."""
        counts = [part.shape[3] for part in self.parts]
        found = [np.empty((1 + derivatives, 2, count, *angle.shape)) for count in counts]
        z = np.cos(angle) + 1j * np.sin(angle)
        turned = np.ones_like(z)
        for n in range(max(2 * counts[0] - 1, 2 * counts[1])):
            if n // 2 < counts[n % 2]:
                cosine, sine = (found[n % 2][:, i, n // 2] for i in (0, 1))
                cosine[0], sine[0] = turned.real, turned.imag
                for d in range(derivatives):
                    np.multiply(sine[d], -n, out=cosine[d + 1])
                    np.multiply(cosine[d], n, out=sine[d + 1])
            turned = turned * z
        return found


@cache
def expansion(m: int) -> np.ndarray:
    """Return the harmonics of ``cos^(m-k) sin^k``, (cosine or sine of n theta, n // 2, k)."""
    found = np.zeros((2, m // 2 + 1, m + 1))
    for k in range(m + 1):
        p = np.ones(1, complex)  # in powers of e^(i theta), from -m on
        for factor in [[0.5, 0, 0.5]] * (m - k) + [[0.5j, 0, -0.5j]] * k:
            p = np.convolve(p, factor)
        for n in range(m % 2, m + 1, 2):
            found[0, n // 2, k] = p[m + n].real * (2 if n else 1)
            found[1, n // 2, k] = -2 * p[m + n].imag
    return found


def implicit(c: np.ndarray, z: np.ndarray) -> np.ndarray:
    """Return a root and its derivatives in `ORDERS`, from those of the coefficients (6, power, point)."""
    value, slope = roots.horner(list(c.swapaxes(0, 1)), np.broadcast_to(z, (6, z.size)))
    bend = sum(j * (j - 1) * c[0, j] * z ** (j - 2) for j in range(2, c.shape[1])) + 0 * z
    one = -1 / slope[0]
    a, q = value[1] * one, value[2] * one
    return np.stack([
        z, a, q,
        (value[3] + 2 * slope[1] * a + bend * a * a) * one,
        (value[4] + slope[1] * q + slope[2] * a + bend * a * q) * one,
        (value[5] + 2 * slope[2] * q + bend * q * q) * one,
    ])  # fmt: skip


def waves_of(base: Base, count: int) -> Waves:
    """Return the waves about the base states of an array of points, for observers who move with the flow."""
    forms: dict[tuple[int, int], np.ndarray] = {}
    for (j, m, k), c in polynomials.symbol(base.model.evolves, base.resting()[0].pencil()).items():
        forms.setdefault((j, m), np.zeros((m + 1, count)))[k] = c
    return Waves({(j, m): SIGN[m % 4] * (expansion(m) @ form) for (j, m), form in forms.items() if np.any(form)})
