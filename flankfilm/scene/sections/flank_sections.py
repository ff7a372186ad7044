"""Keys of a gear's flanks as measured: profiles of all teeth or of each, pitches, wear."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Annotated

from pydantic import Field, model_validator

import gears
from base import Fault, Limit
from flankfilm.scene.sections.curve_sections import POSITIONS, DepthSection, ProfileSection
from flankfilm.scene.sections.key import Traits, key
from flankfilm.scene.sections.map_section import PLACES, MapSection
from flankfilm.scene.sections.point_sections import (
    BETWEEN,
    MOST_POINTS,
    Beyond,
    Form,
    Numbers,
    PointsSection,
    points,
)
from flankfilm.scene.sections.section import Section, refused

LEAD = Limit(-1000.0, 1000.0, "um", "check the unit: micrometres, positive for too much material")


class LeadSection(PointsSection):
    """Measured lead of a gear's flanks, a curve along the face that all teeth have."""

    positions = PLACES
    values = ("material_um", LEAD)

    file: str | None = key(
        "CSV file beside the scene instead of points: columns z_mm, material_um, or a column for each tooth measured",
        None,
        such_as="pinion_lead.csv",
        max_length=1000,
    )
    z_mm: Numbers | None = points(
        "places along the face, rising, 0 at the middle of this gear's face, above 0 where lead_slope_um removes "
        "material",
        such_as=(-20.0, 0.0, 20.0),
    )
    material_um: Numbers | None = points(
        "deviation at each place, normal to the flank; positive: too much material",
        such_as=(-6.0, 0.0, -10.0),
    )
    form: Form = key(BETWEEN, "smooth")
    beyond: Beyond = key(
        "where the trace leaves more than a twentieth of the face out at an end: refuse it, or hold its value",
        "refuse",
    )

    def trace(self) -> gears.LeadTrace:
        """Lead in SI."""
        return gears.LeadTrace(self.value("z_mm"), self.value("material_um"), self.form)


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
        elif clash := self.given_keys(*POSITIONS, "depth_um"):
            yield Fault("teeth", "", f"excludes {' and '.join(clash)}", "Leave one of them out")


class DeviationsSection(Section):
    """Deviations of one gear's flanks: a profile for all or of each tooth, and the pitches of its teeth (ISO 1328)."""

    profile: ProfileSection | None = key(
        "deviation of every flank; none if left out",
        None,
        such_as={"roll_deg": (10.0, 28.0), "material_um": (0.0, -10.0)},
    )
    traces: TracesSection | None = key(
        "measured profile of each tooth instead; one base pitch uses their mean, the revolution every tooth",
        None,
        such_as={"file": "pinion_traces.csv"},
    )
    map: MapSection | None = key(
        "measured map of the flanks instead of profile and lead: its means over the face and over the profile count, "
        "and the rest, its twist, where it is kept",
        None,
        such_as={"file": "pinion_map.csv"},
        traits=Traits(along_face=True),
    )
    lead: LeadSection | None = key(
        "measured lead of the flanks, on top of crowning, slope and end relief: the load is computed along the face",
        None,
        such_as={"z_mm": (-20.0, 0.0, 20.0), "material_um": (-6.0, 0.0, -10.0)},
        traits=Traits(along_face=True),
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
        if len(self.given_keys("single_pitch_um", "cumulative_pitch_um")) > 1:
            raise refused("must have single_pitch_um or cumulative_pitch_um, not both", "Leave one out")
        if len(self.given_keys("profile", "traces")) > 1:
            raise refused("must have profile or traces, not both", "Leave one out")
        if self.map is not None and (clash := self.given_keys("profile", "traces", "lead")):
            raise refused(f"must have map, or {' and '.join(clash)}, not both", "Leave one out")
        return self

    def pitches(self) -> gears.PitchDeviations | None:
        """Pitches in SI; None where they were not given."""
        values = self.si("single_pitch_um", "cumulative_pitch_um")
        if "single" in values:
            return gears.PitchDeviations.from_single(values["single"])
        return gears.PitchDeviations(values["cumulative"]) if "cumulative" in values else None


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
