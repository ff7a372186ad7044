"""The file of a study: keys that vary or follow, their ranges, the design of the rows, and the outputs wanted."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Annotated, Any, Literal, TypeVar

from pydantic import Field, ValidationError, model_validator

from base import InputError
from flankfilm.scene.explain import explain_all
from flankfilm.scene.reader import parse_toml, read_text, refuse_long_lists
from flankfilm.scene.section import Section

MOST_ROWS = 1_000_000

MOST_KEYS = 100
"""Varied keys; a scene has fewer."""

LARGEST = 1e15
"""Of a varied number; no key of a scene takes a larger one."""

Bounded = Annotated[float, Field(ge=-LARGEST, le=LARGEST)]

Value = bool | int | float | str


class Range(Section):
    """Values from one end to the other."""

    from_: Bounded = Field(alias="from", description="one end of the range")
    to: Bounded = Field(description="the other end, the larger number")
    steps: int | None = Field(default=None, ge=2, le=MOST_ROWS, description="of a grid or a list")
    log: bool = Field(default=False, description="equal ratios instead of equal steps")
    whole: bool = Field(default=False, description="round to whole numbers, such as teeth")

    @model_validator(mode="after")
    def _a_range(self) -> Range:
        if not self.from_ < self.to:
            raise ValueError(f"from = {self.from_:g} must lie below to = {self.to:g}")
        if self.log and self.from_ <= 0:
            raise ValueError(f"log needs from > 0, not {self.from_:g}")
        return self

    def at(self, unit: float) -> Value:
        """Value at a place between 0 and 1."""
        if self.log:
            low, high = math.log(self.from_), math.log(self.to)
            value = math.exp(low + unit * (high - low))
        else:
            value = self.from_ + unit * (self.to - self.from_)
        # twelve digits: 0.1 is written as 0.1, whatever the way that led there
        value = min(max(float(f"{value:.12g}"), self.from_), self.to) + 0.0
        return round(value) if self.whole else value


class Follow(Section):
    """A key that follows a varied one: times * value + plus."""

    of: str = Field(description="the varied key that is followed")
    times: Bounded = Field(default=1.0, description="factor of its value")
    plus: Bounded = Field(default=0.0, description="added to that")


class RowsFile(Section):
    """What a study and an optimisation have in common: a scene, keys that vary or follow, and keys that are set."""

    title: str = Field(default="", max_length=200, description="title of the study")
    scene: str | dict[str, Any] = Field(description="a scene file beside this one, or the scene itself")
    vary: Any = Field(description="keys of the scene that vary, each with a range or a list of values")
    follow: Annotated[dict[str, Follow], Field(max_length=MOST_KEYS)] = Field(
        default_factory=dict, description="keys of the scene that follow a varied one"
    )
    set: dict[str, Value] = Field(
        default_factory=dict, description="keys of the scene that have another value throughout"
    )

    @model_validator(mode="after")
    def _leaders_and_places(self) -> RowsFile:
        if not self.vary:
            raise ValueError('vary needs a key of the scene, such as "pair.pinion.profile_shift"')
        for key, rule in self.follow.items():
            if rule.of not in self.vary:
                raise ValueError(f'follow "{key}" follows "{rule.of}", which is not varied')
        twice = (self.vary.keys() & self.follow.keys()) | (
            self.set.keys() & (self.vary.keys() | self.follow.keys())
        )
        if twice:
            raise ValueError(f"{', '.join(sorted(twice))} stands in two of vary, follow and set")
        return self


class StudyFile(RowsFile):
    """A whole study file."""

    outputs: Annotated[tuple[str, ...], Field(strict=False, min_length=1, max_length=200)] = Field(
        description="computed for every row; the names are listed below"
    )
    design: Literal["grid", "list", "latin-hypercube", "sobol"] = Field(
        default="grid",
        description="all combinations, values side by side, or sampled points of the ranges",
    )
    samples: int | None = Field(
        default=None, ge=1, le=MOST_ROWS, description="number of rows of a sampled design"
    )
    seed: int = Field(default=1, ge=0, description="of a sampled design; the same seed gives the same rows")
    vary: Annotated[
        dict[str, Range | Annotated[tuple[Value, ...], Field(strict=False, min_length=1)]],
        Field(max_length=MOST_KEYS),
    ] = Field(description="keys of the scene that vary, each with a range or a list of values")

    @model_validator(mode="after")
    def _one_design(self) -> StudyFile:
        sampled = self.design in ("latin-hypercube", "sobol")
        if sampled and self.samples is None:
            raise ValueError(f'design = "{self.design}" needs samples')
        if not sampled and self.samples is not None:
            raise ValueError(f'samples belongs to sampled designs, not to "{self.design}"')
        for key, values in self.vary.items():
            if isinstance(values, Range) and not sampled and values.steps is None:
                raise ValueError(f'vary "{key}" needs steps in a {self.design}')
        return self


F = TypeVar("F", bound=RowsFile)


def read_rows_file(path: Path, kind: type[F]) -> F:
    """Read and check a study or an optimisation file, apart from the scene in it."""
    raw = parse_toml(read_text(path), str(path))
    refuse_long_lists({key: value for key, value in raw.items() if key != "vary"})
    try:
        return kind.model_validate(raw)
    except ValidationError as error:
        raise InputError(explain_all(error.errors(), kind)) from error
