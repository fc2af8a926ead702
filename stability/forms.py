"""The reduced form of a wave: what its eigenvalues need, in powers of the wavenumber."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from stability import spectrum
from stability.arithmetic import NUMPY, Arithmetic


@dataclass(frozen=True)
class Form:
    """The coefficients of the eigenvalues of a wave in powers of i|xi|, and the flow's speed along the wave."""

    coefficients: dict
    speed: Any
    arithmetic: Arithmetic = NUMPY

    def _each(self, change: Callable) -> "Form":
        parts = {part: {n: change(c) for n, c in series.items()} for part, series in self.coefficients.items()}
        return replace(self, coefficients=parts, speed=change(self.speed))

    def filled(self, size: int) -> "Form":
        """Return the form with every coefficient an array over the directions, constants too."""
        return self._each(lambda c: np.broadcast_to(np.asarray(c, dtype=float), (size,)))

    def column(self) -> "Form":
        """Return the form of many directions with a trailing axis for wavenumbers."""
        return self._each(lambda c: c[:, None] if np.ndim(c) else c)

    def rows(self, index: Any) -> "Form":
        """Return the form at some of its directions."""
        return self._each(lambda c: c[index] if np.ndim(c) else c)

    def eigenvalues(self, wavenumber: Any) -> tuple:
        """Return the eigenvalues (1/s), Doppler shift included."""
        if "trace" in self.coefficients:
            found: tuple = spectrum.pair(self.coefficients, wavenumber, self.arithmetic)
        else:
            found = (spectrum.single(self.coefficients, wavenumber),)
        return tuple(e - 1j * (self.speed * wavenumber) for e in found)
