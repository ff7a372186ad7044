"""Keys of an unloaded transmission error: harmonics as a number or a list, and a curve over a base pitch."""

from __future__ import annotations

import itertools
from dataclasses import dataclass
from typing import Annotated, Any, ClassVar

from pydantic import Field, GetCoreSchemaHandler, model_validator
from pydantic_core import CoreSchema, core_schema

from base import Limit
from flankfilm.scene.sections.key import key
from flankfilm.scene.sections.section import Section, refused

__all__ = ["AMPLITUDE_UM", "PHASE_DEG", "POINTS", "ErrorCurveSection", "Harmonics", "harmonics"]

AMPLITUDE_UM = Limit(0.0, 10_000.0, "um", "Check the unit: micrometres")
PHASE_DEG = Limit(-360.0, 360.0, "deg", "Check the unit: degrees")

POINTS = ("position", "error_um")
"""Keys of the curve's points, which are the columns of its file."""

MOST_HARMONICS = 1000
MOST_POINTS = 10_000

ERROR_UM = Limit(-10_000.0, 10_000.0, "um", "Check the unit: micrometres")
POSITION = Limit(-1.0, 2.0, remedy="Count base pitches from A: a period goes from 0 to 1")


@dataclass(frozen=True)
class Harmonics:
    """A number for the first harmonic alone, or a list with one for each; `limit` is in the user's unit."""

    limit: Limit

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        """Make a list of a number, and look at every entry."""
        inner = handler(source)
        checked = core_schema.no_info_after_validator_function(self._checked, inner)
        return core_schema.no_info_before_validator_function(_listed, checked)

    def _checked(self, values: tuple[float, ...]) -> tuple[float, ...]:
        if not 1 <= len(values) <= MOST_HARMONICS:
            raise refused(
                f"must be a number, or 1 to {MOST_HARMONICS} in a list", value=f"{len(values)} entries"
            )
        for number, value in enumerate(values, start=1):
            if not self.limit.holds(value):
                of = f" (harmonic {number})" if len(values) > 1 else ""
                raise refused(str(self.limit), self.limit.remedy, value=f"{value:g}{of}")
        return values


def harmonics(limit: Limit) -> Harmonics:
    """Mark a key that takes a number or a list of harmonics, for ``Annotated``."""
    return Harmonics(limit)


def _listed(value: Any) -> Any:
    """A number as a list of one; a list as it is."""
    if isinstance(value, str):
        raise refused(
            "must be a number, or a list of them", "Write it without quotes; the unit is part of the key"
        )
    if isinstance(value, list):
        return tuple(value)
    return (value,) if isinstance(value, int | float) and not isinstance(value, bool) else value


Points = Annotated[tuple[float, ...], Field(strict=False)]


class ErrorCurveSection(Section):
    """Unloaded transmission error over one base pitch: by points, or in a CSV file with these columns."""

    called: ClassVar[str] = "the curve of the error"

    file: str | None = key(
        "CSV file beside the scene with the columns position and error_um, instead of the points",
        None,
        such_as="e.csv",
    )
    position: Points | None = key(
        "base pitches from A, rising, over at most one of them; straight lines between, and on periodically",
        None,
        such_as=(0.0, 0.5, 0.9),
        min_length=3,
        max_length=MOST_POINTS,
    )
    error_um: Points | None = key(
        "error at each point along the line of action, positive where the wheel lags",
        None,
        of=None,
        such_as=(0.0, 8.0, 3.0),
        min_length=3,
        max_length=MOST_POINTS,
    )

    @model_validator(mode="after")
    def _points_that_rise(self) -> ErrorCurveSection:
        at, heights = self.position, self.error_um
        if at is None or heights is None or len(at) != len(heights):
            counts = " and ".join(str(0 if numbers is None else len(numbers)) for numbers in (at, heights))
            raise refused(f"must have as many position as error_um, not {counts}", "Give pairs, or a file")
        for name, values, limit in (("position", at, POSITION), ("error_um", heights, ERROR_UM)):
            for number, value in enumerate(values, start=1):
                if not limit.holds(value):
                    raise refused(str(limit), limit.remedy, key=name, value=f"{value:g} (point {number})")
        if any(after <= before for before, after in itertools.pairwise(at)):
            raise refused("must rise from point to point", "Sort them; leave out doubles", key="position")
        if at[-1] - at[0] > 1.0 + 1e-9:
            raise refused("must cover one base pitch at most", key="position", value=f"{at[-1] - at[0]:g}")
        return self
