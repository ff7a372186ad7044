"""Keys of the pair and of its gears."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace
from typing import Any, ClassVar, Literal

from pydantic import model_validator

import fem
import gears
from base import Fault, InputError, Limit
from flankfilm.scene.sections.flank_sections import DeviationsSection, WearSection, wrong_counts
from flankfilm.scene.sections.key import BY_ELEMENTS, Traits, key
from flankfilm.scene.sections.rack import RackSection, ToolSection, basic_rack
from flankfilm.scene.sections.section import Limits, Section, refused
from gears.pair.gear_pair import BACKLASH
from gears.pair.gear_pair import LIMITS as PAIR
from gears.tooth.blank import LIMITS as BLANK
from gears.tooth.face import LEAD_LIMITS as LEAD
from gears.tooth.gear import LIMITS as GEAR
from gears.tooth.gear import RELIEF_LIMITS as RELIEF

GEARS = ("pinion", "wheel")

TIP_DIAMETER = Limit.above(0.0, 1e4, "m")

TIP_DIGITS = 12
"""Decimal places of a tip alteration that follows from a tip diameter: below them it is rounding."""

FLANK_FORM = Traits(finite_elements=True, meshed=False)
"""Of what changes the flanks by micrometres."""

LEAD_FORM = replace(FLANK_FORM, along_face=True)
"""Of what changes them along the face."""

SHAFT_STIFFNESS = Traits(beside_segments="counts the shaft twice")


class ReliefSection(Section):
    """Tip relief: material removed normal to the flank."""

    ground = RELIEF

    amount_um: float = key("material removed at the tip", example=20)
    length_mm: float = key("length along the path of contact, from the tip", example=2.0)
    form: Literal["linear", "parabolic"] = key("how the relief grows towards the tip", "linear")

    def relief(self) -> gears.TipRelief:
        """Tip relief in SI."""
        return gears.TipRelief(**self.si())


class BlankSection(Section):
    """Rim and hub as wide as the face, and a thinner web between them that runs all round."""

    ground = BLANK

    rim_thickness_mm: float = key("from the root circle to the inside of the rim", example=6.0)
    web_thickness_mm: float = key("along the axis, at most the face width", example=12.0)
    hub_mm: float | None = key(
        "outer diameter of the hub; the web goes down to the bore if left out",
        None,
        diameter="hub_radius",
        such_as=50.0,
    )
    web_offset_mm: float = key(
        "distance of the web from the middle of the face; only 0, since a web off the middle tilts the rim, which is "
        "three-dimensional",
        0.0,
    )

    def blank(self) -> gears.Blank:
        """Blank in SI."""
        return gears.Blank(**self.si())


class HubSection(Section):
    """Rigid hub of a gear on its shaft, bearings and shaft yielding under it."""

    ground: ClassVar[Limits] = {
        "radial_stiffness": Limit.above(0.0, 1e15, "N/m"),
        "torsional_stiffness": Limit.above(0.0, 1e15, "N m/rad"),
        "hub_radius": GEAR["bore_radius"],
    }

    radial_stiffness_N_per_m: float | None = key(
        "stiffness of bearings and shaft along the line of action; rigid if left out",
        None,
        such_as=5e8,
        traits=SHAFT_STIFFNESS,
    )
    torsional_stiffness_Nm_per_rad: float | None = key(
        "torsional stiffness of the shaft; rigid if left out",
        None,
        such_as=1e6,
        traits=SHAFT_STIFFNESS,
    )
    hub_mm: float | None = key(
        "diameter of the rigid hub, larger than the bore; the bore's if left out",
        None,
        diameter="hub_radius",
        such_as=40.0,
    )

    def support(self) -> fem.Support:
        """Support of the bore in SI."""
        return fem.Support(**self.si())


class GearSection(Section):
    """One gear."""

    ground: ClassVar[Limits] = {**GEAR, **{f"lead.{name}": limit for name, limit in LEAD.items()}}

    teeth: int = key("number of teeth", example=36)
    profile_shift: float = key("profile shift, times the module", 0.0)
    bore_mm: float | None = key(
        "diameter of the bore; half the root diameter if left out", None, diameter="bore_radius", such_as=33.5
    )
    blank: BlankSection | None = key("rim, web and hub; a disc as wide as the face if left out", None)
    generating_shift: float | None = key(
        "shift at which the tool cuts the gear, times the module: thins the teeth and deepens the roots where it is "
        "less than profile_shift, to which it is equal if left out",
        None,
        such_as=0.0,
    )
    tip_alteration: float = key("moves the tip outwards, times the module", 0.0)
    tip_diameter_mm: float | None = key(
        "diameter of the tip circle, in place of tip_alteration, which then follows; by the rack if left out",
        None,
        of=None,
        limit=TIP_DIAMETER,
        such_as=76.0,
    )
    thickness_allowance_um: float = key("thins each tooth, arc at the reference circle", 0.0)
    tip_relief: ReliefSection | None = key(
        "material removed towards the tip; none if left out", None, traits=Traits(meshed=False)
    )
    tip_chamfer_mm: float = key("height of a chamfer of 45 degrees at the tip's edges", 0.0)
    tip_rounding_um: float = key(
        "rounding radius of the tip edges that touch; the default of the finite elements if left out",
        0.0,
        of=None,
        limit=Limit(0.0, 0.05, "m"),
        traits=FLANK_FORM,
    )
    face_width_mm: float | None = key(
        "face width of this gear, where it is wider than the face in contact; pair.face_width_mm if left out",
        None,
        such_as=45,
        traits=replace(BY_ELEMENTS, along_face=True),
    )
    face_offset_mm: float = key(
        "place of the middle of this gear's face along the axis, from that of the face in contact",
        0.0,
        such_as=2,
    )
    crowning_um: float = key(
        "crowning: material removed at both ends of the face, by a parabola over all of it",
        0.0,
        of="lead.crowning",
        such_as=10,
        traits=LEAD_FORM,
    )
    lead_slope_um: float = key(
        "lead slope: deviation over the face width, zero at mid-face; above 0 material lacks towards the end where "
        "alignment.in_plane_um opens the gap",
        0.0,
        of="lead.slope",
        such_as=5,
        traits=LEAD_FORM,
    )
    lead_twist_um: float = key(
        "flank twist (ISO 21771, S_alpha = S_beta): by how much the lead slope at the tip exceeds that at the start of "
        "the active profile, half of it either way; material removed",
        0.0,
        of="lead.twist",
        such_as=6,
        traits=LEAD_FORM,
    )
    end_relief_um: float = key(
        "end relief: material removed at both ends of the face, by a parabola over end_relief_length_mm",
        0.0,
        of="lead.end_relief",
        such_as=8,
        traits=LEAD_FORM,
    )
    end_relief_length_mm: float = key(
        "length of the end relief from either end, at most half the face width",
        0.0,
        of="lead.end_relief_length",
        such_as=5,
        traits=Traits(meshed=False),
    )
    deviations: DeviationsSection | None = key(
        "deviations of the flanks as made; none if left out",
        None,
        such_as={"profile": {"roll_deg": (10.0, 28.0), "material_um": (0.0, -10.0)}},
        traits=FLANK_FORM,
    )
    wear: WearSection | None = key(
        "material worn off the loaded flanks; none if left out",
        None,
        such_as={"roll_deg": (10.0, 20.0, 28.0), "depth_um": (12.0, 0.0, 5.0)},
        traits=FLANK_FORM,
    )
    hub: HubSection | None = key(
        "rigid hub on an elastic shaft and bearings; a rigid shaft in the bore if left out",
        None,
        of="support",
        such_as={"hub_mm": 40.0, "radial_stiffness_N_per_m": 5e8},
        traits=BY_ELEMENTS,
    )

    @model_validator(mode="after")
    def _whole(self) -> GearSection:
        """Refuse lists without an entry for each tooth, and two keys that give the tip circle."""
        if self.tip_diameter_mm is not None and self.tip_alteration:
            value = f"{self.tip_alteration:g}"
            raise refused(
                "follows from tip_diameter_mm", "Give one of them", key="tip_alteration", value=value
            )
        if faults := list(wrong_counts(self.teeth, self.deviations, self.wear)):
            raise InputError(faults)
        return self

    def gear(
        self, module: float, rack: gears.BasicRack, measured: gears.Lead, helix_cosine: float = 1.0
    ) -> gears.Gear:
        """Gear in SI.

        Parameters
        ----------
        module : float
            Of the normal section [m].
        rack : gears.BasicRack
        measured : gears.Lead
            Measured lead and topography, over the whole face.
        helix_cosine : float
            Normal over transverse module, cos(beta).
        """
        return gears.Gear(
            **self.si() | self._tip(module, rack, helix_cosine),
            tip_relief=None if self.tip_relief is None else self.tip_relief.relief(),
            blank=None if self.blank is None else self.blank.blank(),
            lead=self._lead(measured),
        )

    def _lead(self, measured: gears.Lead) -> gears.Lead:
        """Lead in SI; a length of end relief without any is that of a straight lead."""
        lead = self.si_of("lead")
        return replace(measured, **lead if self.end_relief_um else lead | {"end_relief_length": 0.0})

    def _tip(self, module: float, rack: gears.BasicRack, helix_cosine: float) -> dict[str, float]:
        """Tip alteration of a gear whose tip diameter is given; nothing where it is not."""
        diameter = self.value("tip_diameter_mm")
        if diameter is None:
            return {}
        above_reference = 0.5 * (diameter / module - self.teeth / helix_cosine)
        return {"tip_alteration": round(above_reference - rack.h_aP - self.profile_shift, TIP_DIGITS)}

    def support(self) -> fem.Support:
        """Support of the bore in SI: that of the hub, or a rigid shaft."""
        return fem.Support() if self.hub is None else self.hub.support()


class PairSection(Section):
    """Geometry of the pair."""

    ground = PAIR

    module_mm: float = key("module of both gears, of a helical pair that of the normal section", example=2.0)
    face_width_mm: float = key("width of the teeth in contact", example=40.0)
    helix_angle_deg: float = key(
        "helix angle on the reference cylinder; above 0 the pinion is right-handed and the wheel left-handed, and "
        "rack, shifts and backlash are those of the normal section",
        0.0,
        shown=True,
    )
    rack: Literal["ISO 53 A", "ISO 53 B", "ISO 53 C", "ISO 53 D"] | RackSection = key(
        "basic rack of both gears, or a table of its dimensions", "ISO 53 A", of=None, shown=True
    )
    tool: ToolSection | None = key(
        "tool that cuts both gears, in place of the rack's dedendum and fillet radius", None
    )
    pinion: GearSection = key(
        "the driving gear", example={"teeth": 36, "profile_shift": 0.0, "bore_mm": 33.5}
    )
    wheel: GearSection = key(
        "the driven gear, with the same keys", example={"teeth": 40, "profile_shift": 0.0, "bore_mm": 37.5}
    )
    backlash_um: float | None = key(
        "normal backlash, along the line of action; none if left out",
        None,
        of=None,
        limit=BACKLASH,
        example=50,
    )
    centre_distance_mm: float | None = key(
        "distance of the axes instead of the backlash, which then follows; one that is too short for zero backlash"
        " by a rounded digit, up to 0.002 modules, is taken for that of none",
        None,
        such_as=76.0,
    )

    tight: bool = key(
        "whether teeth may be thicker than their gaps, so that both sides bear; refused if false",
        False,
        traits=BY_ELEMENTS,
    )

    @property
    def each(self) -> tuple[GearSection, GearSection]:
        """Pinion and wheel."""
        return self.pinion, self.wheel

    @property
    def helical(self) -> bool:
        """Whether the pair has a helix."""
        return self.helix_angle_deg != 0.0

    def basic_rack(self) -> gears.BasicRack:
        """Rack of both gears, with dedendum and fillet radius by the tool where there is one."""
        return basic_rack(self.rack, self.tool)


def faults_of_leads(raw: Mapping[str, Any]) -> Iterator[Fault]:
    """End relief without a length, in the unchecked file: it is listed beside faults of other keys."""
    pair = raw.get("pair")
    for gear in GEARS:
        keys = pair.get(gear) if isinstance(pair, Mapping) else None
        if not isinstance(keys, Mapping) or not isinstance(keys.get("end_relief_um"), int | float):
            continue
        if keys["end_relief_um"] > 0.0 and not keys.get("end_relief_length_mm"):
            allowed = "must be more than 0 mm with end_relief_um"
            remedy = "Give its length from either end"
            yield Fault(f"pair.{gear}.end_relief_length_mm", "0", allowed, remedy)
