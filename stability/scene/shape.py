"""The shape of a scene: tables that all kinds of requests share, as pydantic models."""

from math import inf
from typing import Annotated, Any, Literal

import numpy as np
from pydantic import BaseModel, ConfigDict, Discriminator, Field, Tag, field_validator, model_validator

MAX_SAMPLES = 100_000  # along one axis


class Table(BaseModel):
    """A TOML table: no unknown keys, no text for numbers, no nan or inf, and nothing changes afterwards."""

    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False, strict=True)


class Entry(Table):
    """A number of [parameters], alone or with the reason for it."""

    value: float
    why: str = ""

    @model_validator(mode="before")
    @classmethod
    def _alone(cls, given: Any) -> Any:
        return given if isinstance(given, dict) else {"value": given}


class Assumption(Entry):
    """A number of [assumed]: the reason is not optional."""

    why: str = Field(min_length=1)


class Interval(Table):
    """Two ends."""

    start: float = Field(alias="from")
    stop: float = Field(alias="to")

    @field_validator("stop")
    @classmethod
    def _ordered(cls, stop: float, info: Any) -> float:
        if not info.data.get("start", -inf) < stop:
            raise ValueError(f"must exceed from = {info.data['start']:g}")
        return stop


class Spaced(Interval):
    """Evenly spaced samples, both ends included: 0 to 360 degrees holds the full turn twice, so that a plot closes."""

    count: int = Field(ge=2, le=MAX_SAMPLES)
    spacing: Literal["linear", "log"] = "linear"

    @field_validator("spacing")
    @classmethod
    def _positive(cls, spacing: str, info: Any) -> str:
        if spacing == "log" and not info.data.get("start", 1) > 0:
            raise ValueError(f"needs from > 0, got {info.data['start']:g}")
        return spacing

    @property
    def samples(self) -> np.ndarray:
        """Return the samples as an array."""
        return (np.geomspace if self.spacing == "log" else np.linspace)(self.start, self.stop, self.count)


class Listed(Table):
    """Samples written out, in increasing order."""

    values: tuple[float, ...] = Field(min_length=1, max_length=MAX_SAMPLES, strict=False)

    @model_validator(mode="before")
    @classmethod
    def _plain(cls, given: Any) -> Any:
        return {"values": given} if isinstance(given, list) else given

    @field_validator("values")
    @classmethod
    def _increasing(cls, values: tuple) -> tuple:
        if any(a >= b for a, b in zip(values, values[1:], strict=False)):
            raise ValueError("must increase from each value to the next")
        return values

    @property
    def samples(self) -> np.ndarray:
        """Return the samples as an array."""
        return np.array(self.values)


def _form(given: Any) -> str | None:
    if isinstance(given, dict):
        return "<listed>" if "values" in given else "<spaced>"
    return "<listed>" if isinstance(given, list) else None


Axis = Annotated[Annotated[Spaced, Tag("<spaced>")] | Annotated[Listed, Tag("<listed>")], Discriminator(_form)]
Matrix = Literal["auto", "full", "truncated", "leading"]


class Tolerance(Table):
    """What a result must hold; `plan` picks the cheapest model that does.

    ``growth`` is relative to the largest growth rate, and for a wave that decays faster than that to its own rate.
    ``accuracy`` names a precision: draft is float32, standard float64, certified float64 with proven signs, which is
    what ``sign`` certified asks for too. ``digits`` evaluates in multiprecision. ``newton`` is for a march: the last
    update of Newton's method, relative to the scales of the fields.
    """

    growth: float | None = Field(default=None, gt=0, lt=1)
    sign: Literal["float", "certified"] = "float"
    accuracy: Literal["auto", "draft", "standard", "certified"] = "auto"
    digits: int | None = Field(default=None, ge=16, le=1000)
    newton: float | None = Field(default=None, gt=0, lt=1)

    @model_validator(mode="after")
    def _consistent(self) -> "Tolerance":
        if self.accuracy == "draft" and (self.digits or self.sign == "certified"):
            raise ValueError(
                'asks for a draft (float32) and for more at once: leave out accuracy = "draft", or the rest'
            )
        return self

    @property
    def certified(self) -> bool:
        """Whether signs must be proven."""
        return "certified" in (self.sign, self.accuracy)
