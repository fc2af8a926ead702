"""The verdict on a point of a flow: whether the initial value problem is well-posed there, and if not, how badly."""

from dataclasses import dataclass, field
from enum import StrEnum
from fractions import Fraction


class Kind(StrEnum):
    """What short waves do; the text is what the verdict says."""

    STABLE = "stable"
    BOUNDED = "unstable, bounded"
    ILL_POSED = "ill-posed"
    SINGULAR = "singular symbol"
    UNDECIDED = "undecided"


@dataclass(frozen=True)
class Verdict:
    """What the shortest waves do about a frozen base state, over all directions.

    Attributes
    ----------
    kind : "stable" (no short wave grows), "unstable, bounded" (short waves grow at a bounded or vanishing rate),
        "ill-posed" (without bound), "singular symbol" (constraints leave a mode undetermined), "undecided"
    exponent : n in ``sup Re lambda ~ coefficient |xi|^n``; of the slowest decay where the kind is stable
    wedge : (from, to) in degrees from the flow's axis, within [0, 360), of every range of directions that grow with
        that exponent; opposite directions grow alike. Zero width: only the directions that close in on one
    worst_angle : degrees, of the largest coefficient in [0, 180)
    coefficient : that coefficient, in SI units
    width : how the growing directions about a single one narrow, ``|xi|^-width``; 0 for wedges
    cause : the terms of the balance laws without which that growth is gone
    finite : (growth rate, wavenumber, wave_angle) of the fastest wave found at any wavelength, or None
    certified : whether every sign was decided in balls, no direction left out
    notes : what was taken for granted, or why nothing was decided
    """

    kind: Kind
    exponent: Fraction | float | None = None
    wedge: tuple[tuple[float, float], ...] = ()
    worst_angle: float | None = None
    coefficient: float | None = None
    width: Fraction = Fraction(0)
    cause: tuple[str, ...] = ()
    finite: tuple[float, float, float] | None = None
    certified: bool = False
    notes: tuple[str, ...] = field(default=())

    @property
    def law(self) -> str:
        """The growth of the fastest short waves as text."""
        if self.exponent is None or self.coefficient is None:
            return ""
        power = "" if self.exponent == 0 else " |xi|" if self.exponent == 1 else f" |xi|^{self.exponent}"
        return f"{self.coefficient:.12g}{power}"

    def __str__(self) -> str:
        """Return the verdict as sentences."""
        if self.kind is Kind.UNDECIDED:
            return f"undecided: {'; '.join(self.notes)}."
        if self.kind is Kind.SINGULAR:
            where = f" along {self.directions}" if self.wedge else ""
            return f"singular symbol: the constraints leave a mode undetermined{where}."
        sentences = {
            Kind.STABLE: f"stable at short waves: no direction grows, the slowest decay is {self.law or 'zero'}",
            Kind.BOUNDED: f"unstable, bounded: short waves grow as {self.law}",
            Kind.ILL_POSED: f"ill-posed: short waves grow without bound, as {self.law}",
        }
        text = sentences[self.kind]
        if self.worst_angle is not None and self.law:
            text += f", at {self.worst_angle:.10g} deg"
        if self.kind is not Kind.STABLE:
            text += f"; growing directions: {self.directions}"
            if self.cause:
                text += f"; caused by {', '.join(self.cause)}"
        elif self.finite:
            growth, wavenumber, angle = self.finite
            if growth > 0:
                text += f"; but at wavenumber {wavenumber:.4g} and {angle:.4g} deg waves grow at {growth:.6g} 1/s"
            else:
                text += "; no wavelength was found to grow"
        return text + (". Signs are certified." if self.certified else ". Signs are not certified.")

    @property
    def directions(self) -> str:
        """The growing directions as text."""
        if self.wedge == ((0.0, 360.0),):
            return "all"
        if all(b > a for a, b in self.wedge):
            return ", ".join(f"{a:.8g} to {b:.8g} deg" for a, b in self.wedge)
        only = ", ".join(f"{a:.8g}" for a, _ in self.wedge)
        return f"those that close in on {only} deg as |xi|^-{self.width}" if self.width else f"{only} deg alone"

    def _repr_latex_(self) -> str:
        if self.exponent is None or self.coefficient is None:
            return rf"$\text{{{self.kind}}}$"
        n = "" if self.exponent == 0 else rf"\,|\boldsymbol{{\xi}}|^{{{self.exponent}}}"
        at = rf",\quad \theta = {self.worst_angle:.6g}^\circ" if self.worst_angle is not None else ""
        mantissa, _, power = f"{self.coefficient:.6g}".partition("e")
        number = mantissa + (rf"\cdot 10^{{{int(power)}}}" if power else "")
        return rf"$\sup\operatorname{{Re}}\lambda \sim {number}{n}{at}\quad\text{{({self.kind})}}$"
