"""The kinds of requests, a table each, and the whole of a scene."""

from math import inf
from typing import Annotated, Any, Literal, get_args

from pydantic import Field, field_validator, model_validator

from stability.scene.shape import Assumption, Axis, Entry, Interval, Matrix, Table, Tolerance

MAX_ELEMENTS = 1_000_000  # of a mesh: its factors fill some 20 GB
MIN_ELEMENTS = 100  # of a mesh that waves are looked at on
MAX_CELLS, MAX_COURSES = 4096, 16  # in a wavelength; of meshes, and of values of epsilon

Part = Literal["cell", "neutral", "symbol", "hopper", "saturation"]


class GrowthMap(Table):
    """Growth rate and frequency over wavenumber and direction.

    ``frequency`` true asks for it, which only D has; None leaves it out where a cheaper matrix will do.
    """

    kind: Literal["growth_map"]
    point: dict[str, float] = {}
    wavenumber: Axis
    wave_angle: Axis
    matrix: Matrix = "auto"
    sampling: Literal["auto", "grid", "adaptive"] = "auto"
    frequency: bool | None = None


class NeutralCurve(Table):
    """Wavenumbers where the growth rate changes sign, per direction."""

    kind: Literal["neutral_curve"]
    point: dict[str, float] = {}
    wavenumber: Interval | None = None
    wave_angle: Axis
    resolve: float | None = Field(default=None, gt=0)
    matrix: Matrix = "auto"


class PhaseDiagram(Table):
    """Stable, unstable and ill-posed over the rate of dilation and the scaled wavenumber.

    ``growth`` false asks for the regions alone, which the boundary in closed form decides.
    """

    kind: Literal["phase_diagram"]
    delta: Axis
    scaled_wavenumber: Axis
    growth: bool = True


class WellPosed(Table):
    """What the shortest waves do at a point."""

    kind: Literal["well_posedness"]
    point: dict[str, float] = {}
    matrix: Literal["auto", "full", "truncated"] = "auto"


class SmallestCure(Table):
    """The least value of a parameter, which the scene leaves open, that cures a point."""

    kind: Literal["smallest_cure"]
    point: dict[str, float] = {}
    parameter: str = Field(default="epsilon", min_length=1)
    growth: float = Field(default=0.0, ge=0)
    rtol: float = Field(default=1e-6, ge=1e-14, lt=1)
    bracket: Interval | None = None
    longest: float | None = Field(default=None, gt=0)


class MeshOf(Table):
    """A mesh of the hopper: about so many elements, over half the wedge or the whole of it."""

    kind: Literal["polar", "graded", "diamond"] = "polar"
    elements: int = Field(ge=4, le=MAX_ELEMENTS)
    half: bool = True


class Steps(Table):
    """The time steps that a march may take, in s."""

    first: float = 1e-5
    largest: float = 5e-4
    smallest: float = 1e-9

    @model_validator(mode="after")
    def _ordered(self) -> "Steps":
        if min(self.first, self.largest, self.smallest) > 0 and not self.smallest <= self.first <= self.largest:
            raise ValueError(
                f"must have smallest <= first <= largest, got {self.smallest:g}, {self.first:g}, {self.largest:g} s"
            )
        return self


class Noise(Table):
    """A random velocity added to the base state, relative to sqrt(g r_0)."""

    size: float
    seed: int = Field(default=1, ge=0)


class March(Table):
    """The flow in time from the base state on; it ends at the last snapshot."""

    kind: Literal["march"]
    mesh: MeshOf
    snapshots: Axis
    step: Steps = Steps()
    scheme: Literal["backward_euler", "bdf2"] = "backward_euler"
    floor: float
    solver: Literal["direct", "iterative"] = "direct"
    perturbation: Noise | None = None
    checkpoint_every: int = Field(default=20, ge=1)

    @field_validator("snapshots")
    @classmethod
    def _later(cls, snapshots: Any) -> Any:
        if snapshots.samples[0] < 0:
            raise ValueError("must not begin before t = 0 s, where the march starts")
        if not snapshots.samples[-1] > 0:
            raise ValueError("must end after t = 0 s, where the march starts")
        return snapshots


class Course(Table):
    """A wave that saturates in the periodic cell: for one epsilon, on meshes of so many cells in a wavelength."""

    epsilon: float
    cells: tuple[Annotated[int, Field(ge=4, le=MAX_CELLS)], ...] = Field(
        min_length=1, max_length=MAX_COURSES, strict=False
    )


class CrossCheck(Table):
    """The time-stepper and the linear theory, each checked by the other; None leaves a number to the cross-check."""

    kind: Literal["crosscheck"]
    point: dict[str, float]
    parts: tuple[Part, ...] = Field(default=get_args(Part), min_length=1, strict=False)
    elements: int = Field(default=2000, ge=MIN_ELEMENTS, le=MAX_ELEMENTS)
    mesh: Literal["polar", "graded", "diamond"] = "diamond"
    duration: float = 0.045
    step: float = 5e-4
    noise: float = 1e-3
    seed: int = Field(default=1, ge=0)
    delta: float = 0.0
    floor: float = 0.05
    saturation: tuple[Course, ...] | None = Field(default=None, min_length=1, max_length=MAX_COURSES, strict=False)

    @field_validator("step")
    @classmethod
    def _within(cls, step: float, info: Any) -> float:
        if 0 < info.data.get("duration", inf) < step:
            raise ValueError(f"must not exceed duration = {info.data['duration']:g} s")
        return step


class FieldMap(Table):
    """The verdict at every point of a flow field in a file; ``file`` is relative to the scene's folder."""

    kind: Literal["field_map"]
    file: str = Field(min_length=1)
    fields: dict[str, str] = {}
    time: float | None = None
    density: float = 1.0
    duration: float | None = None
    cells: float = 2.0
    longest: float | None = None
    check: bool = True


Request = Annotated[
    GrowthMap | NeutralCurve | PhaseDiagram | WellPosed | SmallestCure | FieldMap | March | CrossCheck,
    Field(discriminator="kind"),
]


class Layout(Table):
    """The tables of a scene."""

    title: str
    closure: str
    flow: str
    parameters: dict[str, Entry] = {}
    assumed: dict[str, Assumption] = {}
    request: Request
    tolerance: Tolerance = Tolerance()


def kind_of(table: type[Table]) -> str:
    """Return the word of a kind of request."""
    return get_args(table.model_fields["kind"].annotation)[0]


# What a scene may ask for.
REQUESTS: dict[str, type[Table]] = {kind_of(table): table for table in get_args(get_args(Request)[0])}
