"""Curves through points as scenes have them: what all kinds have in common."""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Mapping
from typing import Annotated, Any, ClassVar, Literal

from pydantic import Field, model_validator

from base import Fault, InputError, Limit
from flankfilm.scene.sections.key import key
from flankfilm.scene.sections.section import Section

__all__ = [
    "BETWEEN",
    "MOST_POINTS",
    "Beyond",
    "Form",
    "Numbers",
    "PointsSection",
    "not_rising",
    "outside",
    "points",
]

Numbers = Annotated[tuple[float, ...], Field(strict=False)]

MOST_POINTS = 10_000
"""Points of a curve."""

Form = Literal["smooth", "linear"]

BETWEEN = "between the points: a smooth curve without overshoot, or straight lines"


def points(meaning: str, such_as: tuple[float, ...]) -> Any:
    """Key of one number for each point of a curve."""
    return key(meaning, None, of=None, such_as=such_as, min_length=2, max_length=MOST_POINTS)


Beyond = Literal["refuse", "hold"]


class PointsSection(Section):
    """What curves through points have in common: where their points are, and what is between them."""

    positions: ClassVar[Mapping[str, Limit]]
    """Keys by one of which it is said where the points are, and what they may be."""

    values: ClassVar[tuple[str, Limit]]
    """Key of the values at the points, and what they may be."""

    @property
    def measured_by(self) -> str:
        """Key that says where the points are; empty where there are none."""
        return next(iter(self.given_keys(*self.positions)), "")

    @model_validator(mode="after")
    def _points_that_rise(self) -> PointsSection:
        if faults := tuple(self._faults()):
            raise InputError(faults)
        return self

    def _faults(self) -> Iterator[Fault]:
        """What is wrong with the points; those of a file without any are looked at where it is read."""
        name, limit = self.values
        heights, by = getattr(self, name), self.given_keys(*self.positions)
        if len(by) != 1:
            keys = ", ".join(self.positions)
            prefix = "one of " if len(self.positions) > 1 else ""
            yield Fault("", " and ".join(by), f"must have {prefix}{keys}, and {name}", "Give one of them")
            return
        places = getattr(self, by[0])
        if heights is None or len(heights) != len(places):
            count = 0 if heights is None else len(heights)
            remedy = "Give pairs; leave out points without a value"
            yield Fault("", "", f"must have as many {by[0]} as {name}, not {len(places)} and {count}", remedy)
        yield from outside(by[0], places, self.positions[by[0]])
        yield from outside(name, heights or (), limit)
        yield from not_rising(by[0], places)


def outside(name: str, values: tuple[float, ...], limit: Limit) -> Iterator[Fault]:
    """The first of values that are not allowed, and how many more there are."""
    bad = [(number, value) for number, value in enumerate(values, start=1) if not limit.holds(value)]
    if bad:
        more = f", and {len(bad) - 1} more" if len(bad) > 1 else ""
        allowed = str(limit).replace("a finite number, ", "")
        yield Fault(name, f"{bad[0][1]:g} (point {bad[0][0]}{more})", allowed, limit.remedy)


def not_rising(name: str, places: tuple[float, ...]) -> Iterator[Fault]:
    """The first of places that do not rise."""
    for number, (before, after) in enumerate(itertools.pairwise(places), start=1):
        if after <= before:
            value = f"{before:g}, {after:g} (points {number} and {number + 1})"
            yield Fault(name, value, "must rise from point to point", "Sort them; leave out doubles")
            break
