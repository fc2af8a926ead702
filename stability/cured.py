"""What was found out about the values of a regularising parameter, and the sentences that say so and no more."""

from dataclasses import dataclass
from math import inf


@dataclass(frozen=True)
class Cure:
    """The least value of a regularising parameter that was found to cure, and how far up values go on curing.

    Cures need not grow with the parameter: each statement is about values that were evaluated.

    Attributes
    ----------
    parameter, unit : which one
    growth : what a cure is, 1/s: 0 where no short wave may grow; else no wave may grow faster
    tried : (least, largest, how many) of the values of the scan, equally far apart in the logarithm, some two a decade
    below, above : neighbours after bisection, of which ``below`` does not cure and ``above`` does; they differ by
        ``rtol``, by some times that where balls had to correct float64. ``below`` is None, and ``above`` the least
        value tried, where that one cures: nothing is then known about smaller ones
    last, beyond : the same where the values cease to cure that do from ``above`` on; ``beyond`` is None, and ``last``
        the largest value tried, where that one cures
    again : (from, to) of each further run of values of the scan, beyond ``beyond``, that cure
    growth_below, growth_above : largest growth rates there, 1/s; inf where short waves grow without bound, NaN where
        there is no ``below``
    wavenumber, wave_angle, band_width : the fastest wave at ``above``, 1/m and degrees, and its length in m. None where
        none was found to grow, or to be of a length of its own: the longest waves all grow by the kinematics, and
        growth that rises to a bound has the shortest waves for its fastest (wavenumber inf)
    certified : (below, above): whether that is proven in ball arithmetic
    certified_upper : the same of (last, beyond)
    notes : what the rest rests on
    """

    parameter: str
    unit: str
    growth: float
    tried: tuple[float, float, int]
    below: float | None
    above: float
    last: float
    beyond: float | None
    again: tuple[tuple[float, float], ...]
    growth_below: float
    growth_above: float
    wavenumber: float | None
    wave_angle: float | None
    band_width: float | None
    certified: tuple[bool, bool]
    certified_upper: tuple[bool, bool]
    notes: tuple[str, ...] = ()

    def __str__(self) -> str:
        """Return the cure as sentences."""
        return " ".join([*self.sentences, *self.notes])

    @property
    def sentences(self) -> list[str]:
        """What was found, without the notes."""
        return [self._edge(), self._range(), *self._left(), self._proven()]

    def _value(self, value: float) -> str:
        return f"{value:.10g} {self.unit}" if self.unit != "1" else f"{value:.10g}"

    def _edge(self) -> str:
        what = f"no wave grows faster than {self.growth:g} 1/s" if self.growth else "no short wave grows"
        if self.below is None:
            return f"{self.parameter} = {self._value(self.above)}, the least value tried, cures: {what}."
        return f"{self.parameter} = {self._value(self.above)} cures: {what}; {self._value(self.below)} does not."

    def _range(self) -> str:
        least, largest, count = self.tried
        text = f"Of {count} values tried from {least:g} to {self._value(largest)}, "
        if self.beyond is None:
            return text + ("all cure." if self.below is None else "all larger ones cure and no smaller one.")
        text += "" if self.below is None else "no smaller one cures, and "
        text += f"all larger ones do up to {self._value(self.last)}; {self._value(self.beyond)} does not, "
        runs = " and ".join(f"from {a:.4g} to {b:.4g}" if a < b else f"at {a:.4g}" for a, b in self.again)
        return text + (f"but those {runs} cure again." if runs else "nor does any beyond.")

    def _left(self) -> list[str]:
        if self.band_width is not None:
            return [f"Bands of {self.band_width:.4g} m remain there, growing at {self.growth_above:.4g} 1/s."]
        if self.wavenumber == inf:
            near = f"the shorter a wave, the closer it comes to {self.growth_above:.4g} 1/s"
            return [f"What remains there has no width: {near}."]
        return []

    def _proven(self) -> str:
        ends = {self.below: self.certified[0], self.beyond: self.certified_upper[1]}
        cure = {self.above: self.certified[1], self.last: self.certified_upper[0]}
        said = [f"{self._value(v)} does not cure" for v, proven in ends.items() if proven and v is not None]
        said += [f"{self._value(v)} cures" for v, proven in cure.items() if proven]
        return f"Certified: {', '.join(said) or 'nothing'}."
