"""The file of a study: keys that vary or follow, their ranges, the design of the rows, and the outputs wanted."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from statistics import NormalDist
from typing import Annotated, Any, ClassVar, Literal, TypeVar

from pydantic import Discriminator, Field, Tag, ValidationError, model_validator

from base import Fault, Faults, InputError
from flankfilm.scene.explain import explain_all
from flankfilm.scene.reader import parse_toml, read_text, refuse_long_lists
from flankfilm.scene.sections.section import Section, refused

MOST_ROWS = 1_000_000

MOST_KEYS = 100
"""Varied keys; a scene has fewer."""

LARGEST = 1e15
"""Of a varied number; no key of a scene takes a larger one."""

DEVIATIONS = 3.0
"""Standard deviations from the middle of a normal range to its ends."""

_NORMAL = NormalDist()

_OUTSIDE = _NORMAL.cdf(-DEVIATIONS)
"""Probability of a normal distribution beyond one end."""

Bounded = Annotated[float, Field(ge=-LARGEST, le=LARGEST)]

Value = bool | int | float | str


class Range(Section):
    """Values from one end to the other."""

    from_: Bounded = Field(alias="from", description="one end of the range")
    to: Bounded = Field(description="the other end, the larger number")
    steps: int | None = Field(default=None, ge=2, le=MOST_ROWS, description="of a grid or a list")
    log: bool = Field(default=False, description="equal ratios instead of equal steps")
    whole: bool = Field(default=False, description="round to whole numbers, such as teeth")
    normal: bool = Field(
        default=False,
        description="crowded about the middle by a normal distribution, whose ends are three standard deviations away; "
        "nothing is drawn beyond them; else evenly spread",
    )

    @model_validator(mode="after")
    def _a_range(self) -> Range:
        if not self.from_ < self.to:
            allowed = f"must lie below to = {self.to:g}"
            raise refused(allowed, "give the smaller number first", key="from", value=f"{self.from_:g}")
        if self.log and self.from_ <= 0:
            allowed = "must be more than 0 with log = true"
            raise refused(allowed, "raise it, or leave log out", key="from", value=f"{self.from_:g}")
        return self

    def at(self, unit: float) -> Value:
        """Value at a place between 0 and 1."""
        if self.normal:
            unit = 0.5 + _NORMAL.inv_cdf(_OUTSIDE + unit * (1.0 - 2.0 * _OUTSIDE)) / (2.0 * DEVIATIONS)
        if self.log:
            low, high = math.log(self.from_), math.log(self.to)
            value = math.exp(low + unit * (high - low))
        else:
            value = self.from_ + unit * (self.to - self.from_)
        # twelve digits: 0.1 is written as 0.1, and 0 as 0, whatever the way that led there
        if abs(value) < 1e-12 * max(abs(self.from_), abs(self.to)):
            value = 0.0
        value = min(max(float(f"{value:.12g}"), self.from_), self.to) + 0.0
        return round(value) if self.whole else value

    def place(self, value: float) -> float:
        """Place of a value: 0 to 1 within the range, below or above outside it."""
        if self.log:
            if value <= 0:
                return -math.inf
            place = math.log(value / self.from_) / math.log(self.to / self.from_)
        else:
            place = (value - self.from_) / (self.to - self.from_)
        if not self.normal:
            return place
        return (_NORMAL.cdf(2.0 * DEVIATIONS * (place - 0.5)) - _OUTSIDE) / (1.0 - 2.0 * _OUTSIDE)


class Follow(Section):
    """A key that follows a varied one: times * value + plus."""

    of: str = Field(description="the varied key that is followed")
    times: Bounded = Field(default=1.0, description="factor of its value")
    plus: Bounded = Field(default=0.0, description="added to that")


def _kind(value: Any) -> str:
    """Which of two forms a value has, said before it is judged, so that its faults are those of one form."""
    return "TableSection" if isinstance(value, dict | Range) else "PlainSection"


Listed = Annotated[tuple[Value, ...], Field(strict=False, min_length=1)]

Varied = Annotated[
    Annotated[Listed, Tag("PlainSection")] | Annotated[Range, Tag("TableSection")], Discriminator(_kind)
]
"""What a key of a study varies over."""

NamedOrGiven = Annotated[
    Annotated[str, Tag("PlainSection")] | Annotated[dict[str, Any], Tag("TableSection")], Discriminator(_kind)
]
"""A scene."""


class RowsFile(Section):
    """What a study and an optimisation have in common: a scene, keys that vary or follow, and keys that are set."""

    start: ClassVar[str]
    """Where a file to begin with is."""

    title: str = Field(default="", max_length=200, description="title of the study")
    scene: NamedOrGiven = Field(description="a scene file beside this one, or the scene itself")
    vary: Any = Field(description="keys of the scene that vary, each with a range or a list of values")
    follow: Annotated[dict[str, Follow], Field(max_length=MOST_KEYS)] = Field(
        default_factory=dict, description="keys of the scene that follow a varied one"
    )
    set: dict[str, Value] = Field(
        default_factory=dict, description="keys of the scene that have another value throughout"
    )

    @model_validator(mode="after")
    def _leaders_and_places(self) -> RowsFile:
        with Faults() as faults:
            if not self.vary:
                faults.add("vary", "", "needs a key of the scene", 'such as "pair.pinion.profile_shift"')
            for key, rule in self.follow.items():
                if rule.of not in self.vary:
                    remedy = f"follow one that is: {', '.join(self.vary)}"
                    faults.add(f"follow.{key}.of", rule.of, "is not varied", remedy)
            fixed = self.set.keys() & (self.vary.keys() | self.follow.keys())
            for key in sorted(fixed | (self.vary.keys() & self.follow.keys())):
                allowed = "stands in more than one of vary, follow and set"
                faults.add(key, "", allowed, f"take it out of {'set' if key in fixed else 'follow'}")
        return self


class StudyFile(RowsFile):
    """A whole study file."""

    called: ClassVar[str] = "the study"
    start: ClassVar[str] = "start from the study in docs/howto/studies.md"

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
    vary: Annotated[dict[str, Varied], Field(max_length=MOST_KEYS)] = Field(
        description="keys of the scene that vary, each with a range or a list of values"
    )

    @model_validator(mode="after")
    def _one_design(self) -> StudyFile:
        sampled = self.design in ("latin-hypercube", "sobol")
        with Faults() as faults:
            if sampled and self.samples is None:
                faults.add("samples", "", f'is required by design = "{self.design}"', "such as samples = 64")
            if not sampled and self.samples is not None:
                allowed = f'belongs to sampled designs, not to "{self.design}"'
                faults.add("samples", self.samples, allowed, 'leave it out, or take design = "sobol"')
            for key, values in self.vary.items():
                if isinstance(values, Range) and not sampled and values.steps is None:
                    faults.add(
                        f"vary.{key}.steps", "", f"is required by a {self.design}", "such as steps = 5"
                    )
        return self


def in_file(fault: Fault, vary: Mapping[str, object]) -> Fault:
    """Fault of a row's scene, with what to do about it where the row's keys are given."""
    span = vary.get(fault.where)
    if isinstance(span, Range) and not span.whole and fault.allowed.startswith("must be a whole number"):
        return replace(fault, remedy="add whole = true to its range")
    return fault


F = TypeVar("F", bound=RowsFile)


def read_rows_file(path: Path, kind: type[F]) -> F:
    """Read and check a study or an optimisation file, apart from the scene in it."""
    raw = parse_toml(read_text(path, f"name another file, or {kind.start}"), str(path), kind.start)
    refuse_long_lists({key: value for key, value in raw.items() if key != "vary"})
    try:
        return kind.model_validate(raw)
    except ValidationError as error:
        raise InputError(explain_all(error.errors(), kind)) from error
