"""Keys of a gear's flanks as measured: profiles of all teeth or of each, pitches, wear."""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from typing import Annotated, Any, ClassVar, Literal

from pydantic import Field, model_validator

from base import Fault, InputError, Limit
from flankfilm.scene.key import key
from flankfilm.scene.section import Section, refused

Numbers = Annotated[tuple[float, ...], Field(strict=False)]

MOST_POINTS = 10_000
"""Points of a curve."""

POSITIONS = {
    "roll_deg": Limit(0.0, 180.0, "deg", "give roll angles from the start of the involute"),
    "diameter_mm": Limit.above(0.0, 2e4, "mm", "give diameters in millimetres"),
    "roll_length_mm": Limit(0.0, 2e4, "mm", "give lengths of roll, the curvature radii of the flank"),
}
"""Keys by one of which a curve says where its points are, and what they may be."""

EXCESS = Limit(-2000.0, 2000.0, "um", "check the unit: micrometres, positive for too much material")
DEPTH = Limit(0.0, 2000.0, "um", "wear removes material; give what is in excess as a profile")


def _points(meaning: str, such_as: tuple[float, ...]) -> Any:
    """Key of one number for each point of a curve."""
    return key(meaning, None, of=None, such_as=such_as, min_length=2, max_length=MOST_POINTS)


class CurveSection(Section):
    """What curves over a flank have in common: where their points are, and what is between them."""

    values: ClassVar[tuple[str, Limit]]
    """Key of the values at the points, and what they may be."""

    roll_deg: Numbers | None = _points("roll angles of the points, rising", such_as=(10.0, 20.0, 28.0))
    diameter_mm: Numbers | None = _points("or their diameters", such_as=(69.0, 73.0, 76.0))
    roll_length_mm: Numbers | None = _points(
        "or their lengths of roll: curvature radii of the flank", such_as=(6.0, 12.0, 17.0)
    )
    form: Literal["smooth", "linear"] = key(
        "between the points: a smooth curve without overshoot, or straight lines", "smooth"
    )

    @property
    def measured_by(self) -> str:
        """Key that says where the points are; empty where there are none."""
        return next(iter(self.given(*POSITIONS)), "")

    @model_validator(mode="after")
    def _points_that_rise(self) -> CurveSection:
        if faults := tuple(self._faults()):
            raise InputError(faults)
        return self

    def _faults(self) -> Iterator[Fault]:
        """What is wrong with the points; those of a file without any are looked at where it is read."""
        name, limit = self.values
        heights, by = getattr(self, name), self.given(*POSITIONS)
        if len(by) != 1:
            keys = ", ".join(POSITIONS)
            yield Fault("", " and ".join(by), f"must have one of {keys}, and {name}", "Give one of them")
            return
        places = getattr(self, by[0])
        if heights is None or len(heights) != len(places):
            count = 0 if heights is None else len(heights)
            remedy = "Give pairs; leave out points without a value"
            yield Fault("", "", f"must have as many {by[0]} as {name}, not {len(places)} and {count}", remedy)
        yield from _outside(by[0], places, POSITIONS[by[0]])
        yield from _outside(name, heights or (), limit)
        for number, (before, after) in enumerate(itertools.pairwise(places), start=1):
            if after <= before:
                value = f"{before:g}, {after:g} (points {number} and {number + 1})"
                yield Fault(by[0], value, "must rise from point to point", "Sort them; leave out doubles")
                break


def _outside(name: str, values: tuple[float, ...], limit: Limit) -> Iterator[Fault]:
    """The first of values that are not allowed, and how many more there are."""
    bad = [(number, value) for number, value in enumerate(values, start=1) if not limit.holds(value)]
    if bad:
        more = f", and {len(bad) - 1} more" if len(bad) > 1 else ""
        allowed = str(limit).replace("a finite number, ", "")
        yield Fault(name, f"{bad[0][1]:g} (point {bad[0][0]}{more})", allowed, limit.remedy)


class ProfileSection(CurveSection):
    """Deviation of flanks from the involute, a curve through points."""

    values = ("material_um", EXCESS)

    material_um: Numbers | None = _points(
        "deviation at each point, normal to the flank; positive: too much material",
        such_as=(0.0, 0.0, -10.0),
    )


class DepthSection(CurveSection):
    """Depth of wear, a curve through points."""

    values = ("depth_um", DEPTH)

    depth_um: Numbers | None = _points(
        "material worn off at each point, normal to the flank, at least 0", such_as=(12.0, 0.0, 5.0)
    )


Beyond = Literal["refuse", "hold"]

BEYOND = "where a curve leaves more than a twentieth of the active profile out at an end: refuse it, or hold its value"


class TracesSection(Section):
    """Measured profile of each tooth's loaded flank, in a file or as a list of tables."""

    file: str | None = key(
        "CSV file beside the scene: a position and a column for each tooth, or columns tooth, position, material_um",
        None,
        such_as="pinion_traces.csv",
        max_length=1000,
    )
    teeth: Annotated[tuple[ProfileSection, ...], Field(strict=False)] | None = key(
        "instead of a file: a profile for each tooth, in the order of meshing",
        None,
        such_as=({"roll_deg": (10.0, 28.0), "material_um": (0.0, -10.0)},),
        max_length=MOST_POINTS,
    )
    beyond: Beyond = key(BEYOND, "refuse")

    @model_validator(mode="after")
    def _some(self) -> TracesSection:
        if self.teeth is None:
            raise refused("must have a file, or teeth", "Name the file of the traces")
        return self


class WearSection(DepthSection):
    """Wear of a gear's loaded flanks: material removed, on top of relief and deviations."""

    file: str | None = key(
        "CSV file beside the scene instead of points: columns position, depth_um, or of each tooth as for traces",
        None,
        such_as="pinion_wear.csv",
        max_length=1000,
    )
    teeth: Annotated[tuple[DepthSection, ...], Field(strict=False)] | None = key(
        "instead of points for all teeth: a curve for each tooth, in the order of meshing",
        None,
        such_as=({"roll_deg": (10.0, 28.0), "depth_um": (12.0, 0.0)},),
        max_length=MOST_POINTS,
    )
    factor: float = key(
        "times the depth, for studies over wear; 0 is unworn", 1.0, of=None, limit=Limit(0.0, 1000.0)
    )
    beyond: Beyond = key(f"{BEYOND}; a curve that ends at no depth may", "refuse")

    def _faults(self) -> Iterator[Fault]:
        if self.teeth is None:
            yield from super()._faults()
        elif clash := self.given(*POSITIONS, "depth_um"):
            yield Fault("teeth", "", f"excludes {' and '.join(clash)}", "Leave one of them out")


class DeviationsSection(Section):
    """Deviations of one gear's flanks: a profile for all or of each tooth, and the pitches of its teeth (ISO 1328)."""

    profile: ProfileSection | None = key(
        "deviation of every flank; none if left out",
        None,
        such_as={"roll_deg": (10.0, 28.0), "material_um": (0.0, -10.0)},
    )
    traces: TracesSection | None = key(
        "measured profile of each tooth instead; one base pitch knows their mean, the revolution every tooth",
        None,
        such_as={"file": "pinion_traces.csv"},
    )
    single_pitch_um: Numbers | None = key(
        "single pitch deviations, one for each tooth in the order of meshing",
        None,
        of="single",
        such_as=(2.0, -3.0, 1.0),
    )
    cumulative_pitch_um: Numbers | None = key(
        "cumulative pitch deviations instead of the single ones",
        None,
        of="cumulative",
        such_as=(2.0, -1.0, 0.0),
    )

    @model_validator(mode="after")
    def _one_of_a_kind(self) -> DeviationsSection:
        if len(self.given("single_pitch_um", "cumulative_pitch_um")) > 1:
            raise refused("must have single_pitch_um or cumulative_pitch_um, not both", "Leave one out")
        if len(self.given("profile", "traces")) > 1:
            raise refused("must have profile or traces, not both", "Leave one out")
        return self


def wrong_counts(
    teeth: int, deviations: DeviationsSection | None, wear: WearSection | None
) -> Iterator[Fault]:
    """Faults of lists that have not an entry for each tooth."""
    for name in ("single_pitch_um", "cumulative_pitch_um"):
        values = getattr(deviations, name, None)
        if values is not None and len(values) != teeth:
            allowed = f"must have one value for each of {teeth} teeth"
            yield Fault(f"deviations.{name}", f"{len(values)} values", allowed, "Give every tooth's")
    for path, section in (("deviations.traces", getattr(deviations, "traces", None)), ("wear", wear)):
        if section is None or section.teeth is None or len(section.teeth) == teeth:
            continue
        value, allowed = f"{len(section.teeth)} curves", f"must have one curve for each of {teeth} teeth"
        if section.file:
            yield Fault(f"{path}.file", f"{section.file}: {value}", allowed, "Add the teeth that lack")
        else:
            yield Fault(f"{path}.teeth", value, allowed, "Give every tooth's")
