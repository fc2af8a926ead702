"""A scene -> the cheapest model that holds its tolerance: which matrix, which precision, which sampling, and why.

    matrix     M < D' < D                                   leading, truncated, full
    precision  float32 < float64 < float64, signs proven    draft, standard, certified
    sampling   closed-form boundary < exact neutral curve < adaptive map < full grid

What a scene names is taken as named, with a warning where it misses the tolerance. Without a tolerance nothing is
approximated, and nothing is probed. With one, every candidate is compared with D in float64 on some hundred waves of
the requested grid (`probe`): its error is bounded where a bound suffices, else measured and taken `probe.SAFETY` times.
"""

import json
from collections.abc import Callable
from dataclasses import asdict, dataclass, field, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from stability import estimates
from stability.model import Model
from stability.probe import CONFIRMED, DIGITS, Probe, confirmed, matrix_error, probe, rounding
from stability.scene import Scene

if TYPE_CHECKING:
    from stability.estimates import Estimate
    from stability.timestepper.forecast import Forecast
    from stability.timestepper.march import March

INTERPOLATION = 1e-3  # tolerance of an adaptive map whose scene states none

# Seconds, one core of a 2.5 GHz machine: for choosing between rungs, where factors matter and percents do not.
# M, D' and D cost the same per sample (15 to 16 ns): the coefficients of a direction are formed once, and what is left
# is the same square root. What M and D' save is the frequency, which they do not have.
PER_SAMPLE = 15e-9
FREQUENCY = 1.5  # times that, with the frequency
DRAFT = 0.45  # times that, in float32
PROVING, CERTIFY = 0.1, 40e-9  # once, and per sample
SCATTERED = 15e-6  # per sample of an adaptive map in float64: bookkeeping
PRECISE = 0.6e-3  # per sample in 30 digits
PER_EDGE = 25  # samples of an adaptive map at 1e-3 over the sum of the grid's sides: 12 to 26 on the hopper's maps
DIRECTION, PRECISE_DIRECTION, CURVE_DIRECTION = 1.5e-6, 2e-3, 27e-6
SEARCHED, BOUNDARY = 1e-4, 1e-7  # per sample of a phase diagram: search over directions, closed form
START, PROBING = 0.012, 0.03  # base state and Dataset; the probe

LETTER = {"leading": "M", "truncated": "D'", "full": "D"}
NUMBERS = {"draft": "float32", "standard": "float64", "certified": "float64 with proven signs"}


@dataclass(frozen=True)
class Plan:
    """What will be modelled, why, and what it is expected to miss and to cost.

    ``predicted_error`` is relative as in `probe`; ``error_kind`` is "bound" or "measured" (`probe.SAFETY` included),
    both on the waves of the probe, or "exact" (nothing beyond the rounding of float64). ``interpolation`` is the
    tolerance of an adaptive map.
    """

    matrix: str
    precision: str
    sampling: str
    samples: int
    predicted_seconds: float
    reasons: tuple[str, ...] = ()
    warnings: tuple[str, ...] = ()
    predicted_error: float = 0.0
    error_kind: str = "exact"
    frequency: bool = True
    interpolation: float = 0.0
    probe: Probe | None = field(default=None, repr=False, compare=False)

    @property
    def text(self) -> str:
        """The plan as JSON."""
        return json.dumps({word: value for word, value in asdict(replace(self, probe=None)).items() if word != "probe"})

    def true_error(self, growth_rate: np.ndarray) -> float | None:
        """Return the error of a map (wave_angle, wavenumber) on the probe, or None where nothing was probed."""
        if self.probe is None:
            return None
        return self.probe.error(np.abs(growth_rate[self.probe.rows, self.probe.columns] - self.probe.truth))

    def rows(self, digits: int | None = None) -> list[tuple[str, str]]:
        """Return the rows of an explanation."""
        return [
            ("matrix", self.matrix),
            ("precision", f"{digits} digits" if digits else self.precision),
            ("sampling", f"{self.sampling}, {self.samples} samples"),
            ("error", f"{self.predicted_error:.2g} ({self.error_kind}), of the largest growth rate"),
            ("cost", f"{self.predicted_seconds:.2g} s"),
        ]

    def because(self, *reasons: str, **changes: Any) -> "Plan":
        """Return the plan with changes, and with reasons added."""
        return replace(self, reasons=(*self.reasons, *reasons), **changes)


def plan(scene: Scene) -> "Plan | Forecast | Estimate":
    """Return the cheapest plan whose bounded or measured error meets the tolerance; of a march, its forecast.

    Of requests without a choice it is an estimate.
    """
    return PLANS[scene.request.kind](scene)


def marched(scene: Any) -> "March":
    """Return what a scene asks the time-stepper for."""
    from stability.timestepper.march import March

    ask, noise = scene.request, scene.request.perturbation
    more = {"noise": noise.size, "seed": noise.seed} if noise else {}
    if scene.tolerance.newton is not None:
        more["newton"] = scene.tolerance.newton
    return March(
        closure=scene.closure,
        flow=scene.flow,
        parameters=scene.parameters,
        mesh=ask.mesh.model_dump(),
        snapshots=ask.snapshots.samples.tolist(),
        **ask.step.model_dump(),
        scheme=ask.scheme,
        floor=ask.floor,
        solver=ask.solver,
        every=ask.checkpoint_every,
        **more,
    )


def _phase_diagram(scene: Any) -> Plan:
    ask = scene.request
    samples = ask.delta.samples.size * ask.scaled_wavenumber.samples.size
    boundary = START + BOUNDARY * samples
    if not ask.growth:
        why = (
            "sampling: only the regions are asked for; their boundary is known in closed form, so no wave is evaluated"
        )
        return Plan("truncated", "standard", "closed-form boundary", samples, boundary, (why,))
    why = (
        "sampling: growth rates are asked for, so the largest over all directions is searched at every sample; the "
        f"regions alone (growth = false) would take {boundary:.2g} s"
    )
    return Plan("truncated", "standard", "grid", samples, START + SEARCHED * samples, (why,))


def _neutral_curve(scene: Any) -> Plan:
    ask, size = scene.request, scene.request.wave_angle.samples.size
    matrix, why = ("full", "which is exact") if ask.matrix == "auto" else (ask.matrix, "as the scene names it")
    reasons = [f"matrix: {LETTER[matrix]}, {why}"]
    reasons.append("sampling: the neutral waves of a direction are roots of one polynomial: no map is sampled for them")
    reasons += [] if ask.resolve is None else ["cost: the directions that resolve inserts come on top"]
    return Plan(matrix, "standard", "exact neutral curve", size, START + CURVE_DIRECTION * size, tuple(reasons))


def _growth_map(scene: Any) -> Plan:
    ask, tolerance = scene.request, scene.tolerance
    samples = ask.wave_angle.samples.size * ask.wavenumber.samples.size
    found = Plan("full", "certified" if tolerance.certified else "standard", "grid", samples, 0.0)
    inexact = ask.matrix in ("truncated", "leading") or ask.sampling == "adaptive" or tolerance.accuracy == "draft"
    if tolerance.growth is not None or tolerance.digits or inexact:
        found = _cheapest(scene, found)
    else:
        named = "as the scene names it" if ask.matrix == "full" else "since no tolerance allows a cheaper one"
        found = found.because(f"matrix: D, {named}", f"precision: {NUMBERS[found.precision]}")
    found = replace(found, frequency=_frequency(ask, found.matrix))
    if not found.frequency and ask.frequency is None:
        found = found.because(
            f"frequency: left out, {LETTER[found.matrix]} has not that of D; frequency = true asks for D"
        )
    found = _sampled(scene, found)
    if tolerance.growth is None or found.predicted_error <= tolerance.growth:
        return found
    words = {"matrix": ask.matrix, "sampling": ask.sampling, "accuracy": tolerance.accuracy}
    named = ", ".join(f'{word} = "{value}"' for word, value in words.items() if value != "auto")
    return replace(found, warnings=(
        f"the tolerance growth = {tolerance.growth:g} may be missed: predicted error {found.predicted_error:.2g} "
        f"({found.error_kind}) with {named or 'the best that there is'}",
    ))  # fmt: skip


def _frequency(ask: Any, matrix: str) -> bool:
    """Return whether a map holds the frequency: as asked, else unless the plan itself takes a matrix without it."""
    return ask.frequency if ask.frequency is not None else matrix == "full" or ask.matrix != "auto"


def per_sample(found: Plan) -> float:
    """Return the seconds that a sample of the full grid takes."""
    each = PER_SAMPLE * (FREQUENCY if found.frequency else 1) * (DRAFT if found.precision == "draft" else 1)
    return each + (CERTIFY if found.precision == "certified" else 0)


def grid_seconds(found: Plan, directions: int) -> float:
    """Return the seconds that the full grid takes."""
    once = START + (PROBING if found.probe else 0) + (PROVING if found.precision == "certified" else 0)
    return once + per_sample(found) * found.samples + DIRECTION * directions


def _candidates(scene: Any, found: Plan) -> tuple[list[Plan], list[str]]:
    """Return the pairs of matrix and precision that the scene admits, and why it admits no more."""
    ask, tolerance = scene.request, scene.tolerance
    needs = {"digits are": tolerance.digits, "the frequency is": ask.frequency, "proven signs are": tolerance.certified}
    sharp = next((word for word, wanted in needs.items() if wanted), None)
    free = tolerance.growth is not None  # without a tolerance nothing is approximated but what the scene names
    cheaper = list(LETTER) if free and not sharp else ["full"]
    matrices = cheaper if ask.matrix == "auto" else [ask.matrix]
    precisions = ["draft", "standard"] if free and tolerance.accuracy == "auto" else [tolerance.accuracy]
    if tolerance.digits or tolerance.certified or precisions == ["auto"]:
        precisions = [found.precision]
    said = [f"matrix: D, since {sharp} asked for"] if sharp and ask.matrix == "auto" else []
    return [replace(found, matrix=m, precision=p) for m in matrices for p in precisions], said


def _cheapest(scene: Any, found: Plan) -> Plan:
    """Return the plan with matrix and precision chosen by their errors on the probe."""
    ask, allowed = scene.request, scene.tolerance.growth
    angles, wavenumbers = ask.wave_angle.samples, ask.wavenumber.samples
    base = Model(scene.closure, scene.flow).base(scene.parameters, ask.point)
    waves = probe(base, angles, wavenumbers)
    q = wavenumbers[waves.columns]
    forms = {m: base.form(angles[waves.rows], m).filled(q.size) for m in LETTER}
    candidates, said = _candidates(scene, found)
    rows = []
    for one in candidates:
        error, kind = 0.0, "exact"
        if one.matrix != "full":
            error, kind = matrix_error(forms["full"], forms[one.matrix], q, waves, allowed)
        if one.precision == "draft":
            error, kind = (
                error + waves.error(rounding(forms[one.matrix], q)),
                "measured" if kind == "measured" else "bound",
            )
        one = replace(one, predicted_error=error, error_kind=kind, probe=waves, frequency=_frequency(ask, one.matrix))
        rows.append(replace(one, predicted_seconds=grid_seconds(one, angles.size)))
    rows.sort(key=lambda row: row.predicted_seconds)  # of equal costs the simplest stays first
    good = [row for row in rows if allowed is None or row.predicted_error <= allowed]
    best = good[0] if good else min(rows, key=lambda row: row.predicted_error)
    told = f"probe: {waves.rows.size} waves of the grid; largest growth rate {waves.scale:.4g} 1/s"
    if allowed is not None:
        truth = confirmed(scene.closure, scene.flow, scene.parameters, ask.point, waves, angles, wavenumbers)
        told += f"; float64 agrees with {DIGITS} digits within {truth:.1g} at {CONFIRMED} of them"
    for row in rows:
        verdict = "taken" if row is best else "would do too" if row in good else f"misses {allowed:g}"
        how = row.error_kind if row.error_kind != "exact" else "rounding only"
        name, cost = NUMBERS[row.precision], f", {1e9 * per_sample(row):.2g} ns a sample"
        if scene.tolerance.digits:
            name, cost = f"{scene.tolerance.digits} digits", ""
        said.append(f"{LETTER[row.matrix]} in {name}: error {row.predicted_error:.2g} ({how}){cost}: {verdict}")
    return best.because(told, *said)


def _sampled(scene: Any, found: Plan) -> Plan:
    """Return the plan with its sampling and cost."""
    ask, tolerance = scene.request, scene.tolerance
    n, m = ask.wave_angle.samples.size, ask.wavenumber.samples.size
    few, dear, full = min(n * m, PER_EDGE * (n + m)), bool(tolerance.digits), grid_seconds(found, n)
    seconds = START + PROBING + few * (PRECISE if dear else SCATTERED) + n * (PRECISE_DIRECTION if dear else DIRECTION)
    if ask.sampling != "adaptive" and not dear:
        why = "as the scene names it" if ask.sampling == "grid" else f"adaptive sampling would take {seconds:.2g} s"
        said = f"sampling: full grid, {n * m} samples in {full:.2g} s; {why}"
        return found.because(said, predicted_seconds=full)
    left = (tolerance.growth or INTERPOLATION) - found.predicted_error
    miss = left if left > 0 else INTERPOLATION
    why = f"all in {tolerance.digits} digits would take {PRECISE * n * m:.2g} s" if dear else (
        f"as the scene names it, though the full grid would take {full:.2g} s: samples cost less than the bookkeeping"
    )  # fmt: skip
    return found.because(
        f"sampling: adaptive, about {few} of {n * m} samples in {seconds:.2g} s; {why}",
        sampling="adaptive", samples=few, predicted_seconds=seconds, interpolation=miss,
        predicted_error=found.predicted_error + miss, error_kind="measured",
    )  # fmt: skip


def _march(scene: Any) -> "Forecast":
    from stability.timestepper.forecast import forecast  # and with it SciPy's solvers, which nothing else needs

    return forecast(marched(scene))


PLANS: dict[str, Callable[[Any], Any]] = {
    "phase_diagram": _phase_diagram,
    "neutral_curve": _neutral_curve,
    "growth_map": _growth_map,
    "march": _march,
    "well_posedness": estimates.well_posedness,
    "smallest_cure": estimates.smallest_cure,
    "crosscheck": estimates.crosscheck,
    "field_map": estimates.field_map,
}
