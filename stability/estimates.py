"""What a request will take where there is nothing to choose between: its size, its cost, and what to know about it."""

import json
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from stability.model import Model

# Seconds, one core of a 2.5 GHz machine, from a warm cache of generated modules.
VERDICT = 1.5  # 0.5 with two modes, 2.5 with the directors of double shearing
CURE = {True: 3.0, False: 8.0}  # of a least cure, closed forms or a pencil: waves at 61 values and two bisections
# The parts of a cross-check as the scene of figure X1 asks for them, and the numbers of elements that some hold for.
PARTS = {"cell": 8.0, "neutral": 4.0, "symbol": 1.0, "hopper": 20.0, "saturation": 16.0}
ELEMENTS, POWER = 2000, 1.3
START = 0.5  # of a field map: reading, differentiating
POINT = {True: 30e-6, False: 8e-3}  # of a field map, a point: eigenvalues in closed form, or those of the pencil
CHECKED = 1.5  # times that, where short waves are judged twice
PLACEHOLDER = "uniform_strain"  # a model needs some flow


@dataclass(frozen=True)
class Estimate:
    """What will be computed. ``words`` are rows of an explanation."""

    words: dict[str, str]
    predicted_seconds: float
    reasons: tuple[str, ...]
    warnings: tuple[str, ...] = ()

    @property
    def text(self) -> str:
        """The estimate as JSON."""
        return json.dumps(asdict(self))

    def rows(self, digits: int | None = None) -> list[tuple[str, str]]:
        """Return the rows of an explanation."""
        return [*self.words.items(), ("cost", f"{self.predicted_seconds:.2g} s")]


def well_posedness(scene: Any) -> Estimate:
    """Return what a verdict takes."""
    matrix = "full" if scene.request.matrix == "auto" else scene.request.matrix
    return Estimate(
        {"matrix": matrix, "precision": "balls of 256 bits or more, signs proven"},
        VERDICT,
        (
            "precision: a sign is decided in ball arithmetic or called undecided; what vanishes must vanish again with "
            "twice the bits",
            "sampling: directions between roots of the discriminant are alike, so that one stands for all of them",
        ),
    )


def smallest_cure(scene: Any) -> Estimate:
    """Return what a least cure takes."""
    ask = scene.request
    wanted = f"no wave grows faster than {ask.growth:g} 1/s" if ask.growth else "no short wave grows"
    proof = (
        "precision: that a value does not cure is proven by one wave enclosed in balls; that one cures is a search"
        if ask.growth
        else "precision: the ends of the range that cures are decided in ball arithmetic"
    )
    return Estimate(
        {"parameter": ask.parameter, "wanted": wanted, "precision": "float64, ends in balls"},
        CURE[Model(scene.closure, scene.flow).closed],
        (proof, "sampling: a scan of the bracket, then bisection; nothing is taken for granted between values tried"),
    )


def field_in(ask: Any, folder: Path) -> Any:
    """Return the flow field that the request of a field map names."""
    from stability.field.reading import read_field  # and with it SciPy's trees, which nothing else needs

    return read_field(folder / ask.file, ask.fields, ask.time, ask.density)


def field_map(scene: Any) -> Estimate:
    """Return what a map over a flow field takes."""
    ask = scene.request
    field = field_in(ask, scene.path.parent)
    closed = Model(scene.closure, PLACEHOLDER).closed
    grid = "rows and columns" if field.structured else "scattered points"
    how = "closed forms" if closed else "an eigenproblem for each of hundreds of waves"
    return Estimate(
        {"field": f"{field.source}, {field.x.size} points", "precision": "float64"},
        START + POINT[closed] * field.x.size * (CHECKED if ask.check else 1),
        (
            f"gradients: by {grid}, taken over two stencils, so that their error is estimated",
            f"sampling: every point, by {how}; stability.well_posedness decides single points with proven signs",
        ),
    )


def crosscheck(scene: Any) -> Estimate:
    """Return what a cross-check takes."""
    ask = scene.request
    larger = (ask.elements / ELEMENTS) ** POWER
    seconds = sum(PARTS[part] * (larger if part == "hopper" else 1.0) for part in ask.parts)
    return Estimate(
        {"parts": ", ".join(ask.parts), "mesh": f"{ask.mesh}, {ask.elements} elements of the half hopper"},
        seconds,
        ("sampling: every part runs on several meshes and steps, so that orders are seen and limits extrapolated",),
    )
