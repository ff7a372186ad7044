"""Keys of the pair and of its materials."""

from __future__ import annotations

from dataclasses import replace
from typing import ClassVar, Literal

from pydantic import model_validator

from base import InputError, Limit
from flankfilm.scene.flank_sections import DeviationsSection, WearSection, wrong_counts
from flankfilm.scene.key import key
from flankfilm.scene.section import Limits, Section, refused
from gears.blank import LIMITS as BLANK
from gears.gear import LIMITS as GEAR
from gears.gear import RELIEF_LIMITS as RELIEF
from gears.material import LIMITS as MATERIAL
from gears.material import Material
from gears.named_materials import MATERIALS, named_material
from gears.pair import BACKLASH
from gears.pair import LIMITS as PAIR
from gears.rack import LIMITS as RACK


class RackSection(Section):
    """Basic rack in modules, for racks outside ISO 53."""

    ground = RACK

    h_aP: float = key("addendum, times the module", example=1.0)
    h_fP: float = key("dedendum, times the module", example=1.25)
    rho_fP: float = key("radius of the fillet, times the module", example=0.38)
    alpha_deg: float = key("pressure angle", 20.0)


class ToolSection(Section):
    """Rack-shaped tool that cuts both gears, in place of dedendum and fillet radius of the rack."""

    ground: ClassVar[Limits] = {**RACK, "protuberance": Limit(-1.0, 1.0, "m")}

    h_aP0: float = key(
        "addendum of the tool, times the module: the rack's dedendum h_fP", of="h_fP", example=1.25
    )
    rho_aP0: float = key("radius of the tool's tip, times the module", of="rho_fP", example=0.38)
    protuberance_um: float = key(
        "protuberance of the tool; only 0, since fillets are those of a tool with straight flanks", 0.0
    )


class ReliefSection(Section):
    """Tip relief: material removed normal to the flank."""

    ground = RELIEF

    amount_um: float = key("material removed at the tip", example=20)
    length_mm: float = key("length along the path of contact, from the tip", example=2.0)
    form: Literal["linear", "parabolic"] = key("how the relief grows towards the tip", "linear")


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


class HubSection(Section):
    """Rigid hub of a gear on its shaft, bearings and shaft yielding under it."""

    ground: ClassVar[Limits] = {
        "radial_stiffness": Limit.above(0.0, 1e15, "N/m"),
        "torsional_stiffness": Limit.above(0.0, 1e15, "N m/rad"),
        "hub_radius": GEAR["bore_radius"],
    }

    radial_stiffness_N_per_m: float | None = key(
        "stiffness of bearings and shaft along the line of action; rigid if left out", None, such_as=5e8
    )
    torsional_stiffness_Nm_per_rad: float | None = key(
        "stiffness of the shaft against turning; rigid if left out", None, such_as=1e6
    )
    hub_mm: float | None = key(
        "diameter of the rigid hub, larger than the bore; the bore's if left out",
        None,
        diameter="hub_radius",
        such_as=40.0,
    )


class GearSection(Section):
    """One gear."""

    ground = GEAR

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
    thickness_allowance_um: float = key("thins each tooth, arc at the reference circle", 0.0)
    tip_relief: ReliefSection | None = key("material removed towards the tip; none if left out", None)
    tip_chamfer_mm: float = key("height of a chamfer of 45 degrees at the tip's edges", 0.0)
    tip_rounding_um: float = key(
        "radius of the tip's edges, where they touch; the finite elements' own if left out",
        0.0,
        of=None,
        limit=Limit(0.0, 0.05, "m"),
    )
    deviations: DeviationsSection | None = key(
        "deviations of the flanks as made; none if left out",
        None,
        such_as={"profile": {"roll_deg": (10.0, 28.0), "material_um": (0.0, -10.0)}},
    )
    wear: WearSection | None = key(
        "material worn off the loaded flanks; none if left out",
        None,
        such_as={"roll_deg": (10.0, 20.0, 28.0), "depth_um": (12.0, 0.0, 5.0)},
    )
    hub: HubSection | None = key(
        "rigid hub on a shaft and bearings that yield; a rigid shaft in the bore if left out",
        None,
        of="support",
        such_as={"hub_mm": 40.0, "radial_stiffness_N_per_m": 5e8},
    )

    @model_validator(mode="after")
    def _an_entry_for_each_tooth(self) -> GearSection:
        if faults := tuple(wrong_counts(self.teeth, self.deviations, self.wear)):
            raise InputError(faults)
        return self


class PairSection(Section):
    """Geometry of the pair."""

    ground = PAIR

    module_mm: float = key("module of both gears", example=2.0)
    face_width_mm: float = key("width of the teeth in contact", example=40.0)
    rack: Literal["ISO 53 A", "ISO 53 B", "ISO 53 C", "ISO 53 D"] | RackSection = key(
        "basic rack of both gears, or a table of its own dimensions", "ISO 53 A", of=None, shown=True
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
        "distance of the axes, if not by the backlash, which then follows; one that is short of no backlash by a "
        "rounded digit, up to 0.002 modules, is taken for that of none",
        None,
        such_as=76.0,
    )

    tight: bool = key(
        "whether teeth may be thicker than their gaps, so that both sides bear; refused if false", False
    )

    @property
    def each(self) -> tuple[GearSection, GearSection]:
        """Pinion and wheel."""
        return self.pinion, self.wheel


class ElasticSection(Section):
    """Elastic constants and density of one material, by its name or each by itself."""

    ground = MATERIAL

    name: str | None = key(
        "of the list of materials, of which the other keys change single constants",
        None,
        of=None,
        such_as="steel",
    )
    youngs_modulus_GPa: float | None = key("Young's modulus", None, example=206)
    poisson_ratio: float | None = key("Poisson's ratio", None, example=0.3)
    density_kg_per_m3: float | None = key(
        "density, for the moments of inertia; 7850 if left out without a name", None, example=7850
    )
    thermal_expansion_per_K: float | None = key(
        "coefficient of linear expansion by heat; 11.5e-6 of steel if left out without a name",
        None,
        such_as=11.5e-6,
    )
    conductivity_W_per_m_K: float | None = key(
        "thermal conductivity, of films with heat; 46 of steel if left out without a name", None, such_as=46
    )
    heat_capacity_J_per_kg_K: float | None = key(
        "heat capacity, of films with heat; 470 of steel if left out without a name", None, such_as=470
    )

    @model_validator(mode="after")
    def _by_name_or_by_constants(self) -> ElasticSection:
        _refuse_unknown(self.name)
        if self.name is None and len(self.given("youngs_modulus_GPa", "poisson_ratio")) < 2:
            raise refused("must have youngs_modulus_GPa and poisson_ratio, or a name")
        return self

    def material(self) -> Material:
        """Material in SI."""
        if self.name is not None:
            return replace(named_material(self.name), **self.si())
        return Material(**{"density": 7850.0, **self.si()})


def _refuse_unknown(name: str | None) -> None:
    """Refuse a name that is not in the list of materials."""
    if name is not None and name not in MATERIALS:
        listed = ", ".join(MATERIALS)
        raise refused(
            "must be a name of the list of materials", f"One of {listed}", where="name", value=repr(name)
        )


class MaterialSection(Section):
    """One material for both gears, or one each in `pinion` and `wheel`."""

    ground = MATERIAL

    name: str | None = key(
        "of both gears in the list of materials, of which the next keys change single constants",
        None,
        of=None,
        such_as="steel 16MnCr5",
    )
    youngs_modulus_GPa: float | None = key("Young's modulus of both gears", None, example=206)
    poisson_ratio: float | None = key("Poisson's ratio of both gears", None, example=0.3)
    density_kg_per_m3: float | None = key("density of both gears; 7850 if left out", None, example=7850)
    thermal_expansion_per_K: float | None = key(
        "coefficient of linear expansion of both gears; 11.5e-6 of steel if left out", None, such_as=11.5e-6
    )
    conductivity_W_per_m_K: float | None = key(
        "thermal conductivity of both gears, of films with heat; 46 of steel if left out", None, such_as=46
    )
    heat_capacity_J_per_kg_K: float | None = key(
        "heat capacity of both gears, of films with heat; 470 of steel if left out", None, such_as=470
    )
    pinion: ElasticSection | None = key("material of the pinion alone, instead of the keys above", None)
    wheel: ElasticSection | None = key("material of the wheel alone, beside that of the pinion", None)

    @model_validator(mode="after")
    def _one_material_or_two(self) -> MaterialSection:
        _refuse_unknown(self.name)
        common = self.name is not None or len(self.given("youngs_modulus_GPa", "poisson_ratio")) == 2
        if not common and len(self.given("pinion", "wheel")) < 2:
            raise refused(
                "must have a name, or youngs_modulus_GPa and poisson_ratio, for both gears, "
                "or both [material.pinion] and [material.wheel]"
            )
        if (self.si() or self.name) and self.given("pinion", "wheel"):
            raise refused(
                "must be one material for both gears or one each, not both at once", "Leave one out"
            )
        return self

    @property
    def each(self) -> tuple[ElasticSection, ElasticSection]:
        """Materials of pinion and wheel."""
        if self.pinion is not None and self.wheel is not None:
            return self.pinion, self.wheel
        common = ElasticSection.model_validate(self.model_dump(exclude_none=True))
        return common, common
