"""The verdict on a point of a flow: whether the initial value problem is well-posed there, and if not, how badly."""

from dataclasses import dataclass, field
from enum import StrEnum
from fractions import Fraction

# Growth of the longest waves by the kinematics of the base state alone, over ||V||. A wave under a constraint sees a
# projection of grad u, which friction makes oblique: by 1/(1 - sin varphi), 2.3 at 34 degrees and 8.5 at 62.
KINEMATIC = 10.0


class Kind(StrEnum):
    """What short waves do; the text is what the verdict says."""

    STABLE = "stable"
    BOUNDED = "unstable, bounded"
    ILL_POSED = "ill-posed"
    SINGULAR = "singular symbol"
    UNDECIDED = "undecided"


def powered(base: str, exponent: Fraction | float, latex: bool = False) -> str:
    """Return a power as text: none for 0, the base alone for 1."""
    if exponent in (0, 1):
        return base if exponent else ""
    if latex:
        return f"{base}^{{{exponent}}}"
    return f"{base}^{exponent}" if Fraction(exponent).denominator == 1 else f"{base}^({exponent})"


def scientific(value: float) -> str:
    """Return a number in LaTeX, to six digits."""
    mantissa, _, power = f"{value:.6g}".partition("e")
    return mantissa + (rf"\cdot 10^{{{int(power)}}}" if power else "")


def spelled(coefficient: float, exponent: Fraction | float, latex: bool = False) -> str:
    """Return ``coefficient |xi|^exponent`` with the coefficient's unit, m^n/s."""
    unit = f"{powered('m', exponent, latex) or '1'}/s"
    if latex:
        wave = powered(r"\,|\boldsymbol{\xi}|", exponent, latex)
        return rf"{scientific(coefficient)}\ \mathrm{{{unit}}}{wave}"
    return f"{coefficient:.12g} {unit} {powered('|xi|', exponent)}".rstrip()


@dataclass(frozen=True)
class Beside:
    """The fastest waves beside the directions of a singular symbol.

    At an angle theta (radians) from ``angle`` (degrees, [0, 180)), towards larger angles (side 1) or smaller ones (-1),
    ``Re lambda ~ coefficient |xi|^exponent theta^-power`` as waves get shorter and then theta smaller. A coefficient of
    0: neither growth nor decay, to all orders that were followed.
    """

    angle: float
    side: int
    exponent: Fraction | float
    power: Fraction
    coefficient: float

    def __str__(self) -> str:
        """Return what these waves do."""
        if not self.coefficient:
            return "beside these directions waves neither grow nor decay"
        if self.coefficient < 0:
            return "beside these directions all waves decay"
        law = spelled(self.coefficient, self.exponent)
        if not self.power:
            return f"beside {self.angle:.8g} deg waves grow as {law}"
        return (
            f"at an angle theta beside {self.angle:.8g} deg, towards {'larger' if self.side > 0 else 'smaller'} "
            f"angles, waves grow as {law} {powered('theta', -self.power)} (theta in radians): at any one wavelength "
            "without bound"
        )

    @property
    def latex(self) -> str:
        """The law in LaTeX."""
        if self.coefficient <= 0:
            return rf"\operatorname{{Re}}\lambda {'<' if self.coefficient else '='} 0\text{{ beside}}"
        theta = powered(rf"\,|\theta-{self.angle:.6g}^\circ|", -self.power, latex=True)
        law = spelled(self.coefficient, self.exponent, latex=True)
        return rf"\operatorname{{Re}}\lambda \sim {law}{theta},\quad \theta\to {self.angle:.6g}^\circ"


@dataclass(frozen=True)
class Verdict:
    """What the shortest waves do about a frozen base state, over all directions.

    Attributes
    ----------
    kind : "stable" (no short wave grows), "unstable, bounded" (short waves grow at a bounded or vanishing rate),
        "ill-posed" (without bound), "singular symbol" (constraints leave a mode undetermined), "undecided"
    exponent : n in ``sup Re lambda ~ coefficient |xi|^n``; of the slowest decay where the kind is stable
    wedge : (from, to) in degrees from the flow's axis, both in [0, 360), of every range of directions that grow with
        that exponent, or whose symbol is singular; opposite directions grow alike. From is larger than to where the
        range passes 0; (0, 360): all directions. Zero width: only the directions that close in on one
    worst_angle : degrees, of the largest coefficient in [0, 180); None where it is the same in all of them
    coefficient : that coefficient, in SI units, m^n/s
    width : how the growing directions about a single one narrow, ``|xi|^-width``; 0 for wedges
    cause : the terms of the balance laws without which that growth is gone; of a singular symbol, those that the
        vanishing coefficient is made of, or the laws that say nothing here
    finite : (growth rate, wavenumber, wave_angle) of the fastest wave found at any wavelength, or None: not looked for,
        or beyond the range of float64
    longest : whether that is the longest wave that was tried, towards which growth rises: there the base state's own
        gradients, frozen here, outlast the closure. A wave of other length that grows is preferred
    strain_rate : ||V|| of the base state, 1/s; None where it has no velocity, and for D', which leaves gradients out
    vanishing : (power of lambda, power of |xi|) of the coefficient that makes the symbol singular
    beside : what waves do beside those directions
    siblings : registered closures of the same source, for other states: "name (title)"
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
    longest: bool = False
    strain_rate: float | None = None
    vanishing: tuple[int, int] | None = None
    beside: Beside | None = None
    siblings: tuple[str, ...] = ()

    @property
    def law(self) -> str:
        """The growth of the fastest short waves as text, in SI units."""
        if self.exponent is None or self.coefficient is None:
            return ""
        return f"{self.coefficient:.12g} {powered('|xi|', self.exponent)}".rstrip()

    @property
    def unit(self) -> str:
        """The unit of the coefficient, m^n/s."""
        return "" if self.exponent is None else f"{powered('m', self.exponent) or '1'}/s"

    def __str__(self) -> str:
        """Return the verdict as sentences."""
        if self.kind is Kind.UNDECIDED:
            text = f"undecided: {'; '.join(self.notes)}."
        elif self.kind is Kind.SINGULAR:
            text = self._singular()
        else:
            text = self._graded() + (". Signs are certified." if self.certified else ". Signs are not certified.")
        return " ".join([text, *(f"The same source has a further law, for other states: {s}." for s in self.siblings)])

    def _graded(self) -> str:
        known = self.exponent is not None and self.coefficient is not None
        law = spelled(self.coefficient, self.exponent) if known else ""  # type: ignore[arg-type]
        text = {
            Kind.STABLE: f"stable at short waves: no direction grows, the slowest decay is {law or 'zero'}",
            Kind.BOUNDED: f"unstable, bounded: short waves grow as {law}",
            Kind.ILL_POSED: f"ill-posed: short waves grow without bound, as {law}",
        }[self.kind]
        if known:
            text += ", alike in all directions" if self.worst_angle is None else f", at {self.worst_angle:.10g} deg"
        if self.kind is Kind.STABLE:
            return text + self._finite()
        text += f"; growing directions: {self.directions}"
        return text + (f"; caused by {', '.join(self.cause)}" if self.cause else "")

    def _finite(self) -> str:
        """Return what waves of finite length do about a state whose short waves decay."""
        if self.finite is None:
            return ""
        growth, wavenumber, angle = self.finite
        if not growth > 0:
            return "; no wavelength was found to grow"
        where = f"wavenumber {wavenumber:.4g} 1/m and {angle:.4g} deg"
        slow = f"||V|| = {self.strain_rate:.4g} 1/s" if self.strain_rate else ""
        if self.longest and self.strain_rate and growth <= KINEMATIC * self.strain_rate:
            return f"; what grows are the longest waves, by the base flow's own kinematics ({slow})"
        if self.longest:
            return (
                f"; growth rises towards long waves: {growth:.6g} 1/s at {where}, the longest tried, for which a base "
                "state that changes from place to place cannot be frozen"
            )
        if self.strain_rate and growth <= self.strain_rate:
            return f"; at {where} waves grow at {growth:.6g} 1/s, no faster than the base flow deforms ({slow})"
        return f"; but at {where} waves grow at {growth:.6g} 1/s"

    def _singular(self) -> str:
        text = "singular symbol: the constraints leave a mode undetermined"
        text += f" along {self.directions}" if self.wedge else " in every direction"
        if self.vanishing:
            power, order = self.vanishing
            term = " ".join(filter(None, (powered("lambda", power), powered("|xi|", order)))) or "1"
            text += f": there the coefficient of {term} in det(lambda E - L) vanishes"
            text += f", made of {', '.join(self.cause)}" if self.cause else ""
        elif self.cause:
            text += f": {', '.join(self.cause)}"
        return f"{text}; {self.beside}." if self.beside else f"{text}."

    @property
    def directions(self) -> str:
        """The growing directions as text."""
        if self.wedge == ((0.0, 360.0),):
            return "all"
        if all(b != a for a, b in self.wedge):
            return ", ".join(f"{a:.8g} to {b:.8g} deg" for a, b in self.wedge)
        only = ", ".join(f"{a:.8g}" for a, _ in self.wedge)
        return (
            f"those that close in on {only} deg as {powered('|xi|', -self.width)}"
            if self.width
            else f"{only} deg alone"
        )

    @property
    def latex(self) -> str:
        """The verdict in LaTeX, for mathematical mode."""
        if self.kind is Kind.SINGULAR:
            return self._singular_latex()
        if self.exponent is None or self.coefficient is None:
            return rf"\text{{{self.kind}}}"
        at = "" if self.worst_angle is None else rf",\quad \theta = {self.worst_angle:.6g}^\circ"
        law = spelled(self.coefficient, self.exponent, latex=True)
        return rf"\sup\operatorname{{Re}}\lambda \sim {law}{at}\quad\text{{({self.kind})}}"

    def _singular_latex(self) -> str:
        parts = [rf"\text{{{self.kind}}}"]
        if self.vanishing:
            power, order = self.vanishing
            term = powered(r"\lambda", power, latex=True) + powered(r"|\boldsymbol{\xi}|", order, latex=True)
            angles = r",\,".join(rf"{a:.6g}^\circ" for a, _ in self.wedge)
            parts.append(rf"\left[{term}\right]\det(\lambda E - L) = 0\text{{ at }}\theta = {angles}")
        return r";\quad ".join([*parts, *([self.beside.latex] if self.beside else [])])

    def _repr_latex_(self) -> str:
        return f"${self.latex}$"
