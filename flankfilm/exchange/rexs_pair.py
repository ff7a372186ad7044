"""From the components of a REXS model to the draft of a scene.

Names of components, attributes, relations and roles are those of the REXS schemas 1.0 to 2.0; the flank of a
cylindrical gear is of type flank_geometry up to version 1.1 and cylindrical_gear_flank after it, its tool is
named by an ordered_reference of the gear up to 1.1 and by a manufacturing_step of the flank after it.
"""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

from base import Faults, InputError, shorten
from flankfilm.exchange import rexs_attributes as rexs
from flankfilm.exchange.draft import GEARS, OPEN, Draft
from flankfilm.exchange.rexs_attributes import Attribute
from flankfilm.exchange.rexs_model import Component, Model, Relation
from flankfilm.exchange.rexs_sections import Sections

SAME = 1e-9
"""Relative difference within which two numbers of a file are one number."""

ROUNDED = 1e-4
"""Relative difference of a figure of the transverse section from what follows that is rounding."""

MOST_STAGES = 12
"""Stages that a message lists."""

MODIFICATIONS = re.compile(
    "(triangular_)?(tip|root)_relief|profile_(crowning|slope|twist|deviation)|helix_(crowning|slope|deviation)|"
    "end_relief_(non_)?datum_face|topographical_modification"
)
"""Types of components that modify a flank."""


def stages(model: Model) -> dict[str, Relation]:
    """Stages of cylindrical gears by component id."""
    relations = {}
    for relation in model.relations:
        stage = model.components.get(relation.roles.get("stage", ""))
        if relation.type == "stage" and stage is not None and stage.type == "cylindrical_stage":
            relations[stage.id] = relation
    return relations


def draft_of(model: Model, source: str, stage: str | None = None) -> Draft:
    """Draft a scene from one stage of a model.

    Parameters
    ----------
    model : Model
    source : str
        What faults and notes call the file.
    stage : str, optional
        Id of the stage; needed where the model holds several.

    Raises
    ------
    InputError
        Where there is no such stage, or with everything that the scene cannot have: internal gears, hands that do
        not fit, figures of normal and transverse section that disagree, flanks that differ, tools with protuberance,
        two tools in one pair.
    """
    relation = _chosen(model, source, stage)
    reader = _StageReader(model, source, relation)
    draft = reader.draft()
    reader.faults.raise_if_any()
    return draft


def _chosen(model: Model, source: str, stage: str | None) -> Relation:
    relations = stages(model)
    listed = "; ".join(
        f"--stage {key[:60]}: {shorten(model.components[key].name)}" for key in list(relations)[:MOST_STAGES]
    )
    if len(relations) > MOST_STAGES:
        listed += f"; and {len(relations) - MOST_STAGES} more"
    if not relations:
        kinds = sorted({c.type for c in model.components.values() if c.type.endswith("stage")})
        shown = ", ".join(kind[:60] for kind in kinds[:MOST_STAGES])
        allowed = "holds no stage of cylindrical gears" + (f", but {shown}" if kinds else "")
        raise InputError.at(source, "", allowed, "Pairs of external spur and helical gears are read alone")
    if stage is None and len(relations) > 1:
        raise InputError.at(source, f"{len(relations)} stages", "choose one", listed)
    if stage is not None and stage not in relations:
        raise InputError.at("--stage", shorten(stage), f"is no stage of {source}", listed)
    return relations[stage] if stage is not None else next(iter(relations.values()))


@dataclass
class _StageReader:
    """Reads the numbers of one stage and gathers what is wrong with them."""

    model: Model
    source: str
    relation: Relation
    faults: Faults = field(default_factory=Faults)
    notes: list[str] = field(default_factory=list)

    def draft(self) -> Draft:
        stage = self.model.components[self.relation.roles["stage"]]
        gears = self._gears(stage)
        if gears is None:
            return Draft("", self.source, ("", ""))
        flanks = [self.model.others("flank", "gear", gear.id, "left", "right") for gear in gears]
        beta = self._helix_angle(gears)
        alpha = self._common(rexs.PRESSURE_ANGLE, [f for pair in flanks for f in pair])
        module = self._module(gears, beta)
        self._check_sections(gears, flanks, Sections(module, alpha, beta))
        rack = self._rack(gears, flanks, module, alpha)
        pair = {
            "module_mm": module,
            "face_width_mm": self._face_width(stage, gears),
            "helix_angle_deg": beta,
            "rack": rack,
            "centre_distance_mm": self._number(stage, rexs.CENTRE_DISTANCE),
        }
        for role, gear, own in zip(GEARS, gears, flanks, strict=True):
            pair[role] = self._gear(gear, own, module, rack, math.cos(math.radians(beta)))
        material = self._material(gears)
        self._modifications(gears, flanks)
        first, second = gears
        return Draft(
            title=stage.name or "Imported pair",
            source=f"{self.source}: {stage}, REXS {self.model.version}, written by {self.model.application}",
            names=(str(first), str(second)),
            pair=pair,
            material=material,
            notes=self.notes,
        )

    def _number(self, component: Component, attribute: Attribute) -> float | None:
        """Number of an attribute in the scene's unit, or None where the component lacks it."""
        if attribute.name not in component.attributes:
            return None
        text, unit = component.attributes[attribute.name]
        scale = attribute.unit.scales.get(unit.replace(" ", ""))
        if scale is None:
            self._refuse(component, attribute, f"{text} {unit}", f"must be in {attribute.unit}")
            return None
        try:
            value = float(text)
        except ValueError:
            value = math.nan
        if not math.isfinite(value):
            self._refuse(component, attribute, text, "must be a finite number")
            return None
        return float(f"{value * scale:.12g}") if scale != 1.0 else value

    def _numbers(self, components: Sequence[Component], attribute: Attribute) -> dict[str, float]:
        """Numbers of an attribute by the id of the component, for those that have it."""
        return {c.id: v for c in components if (v := self._number(c, attribute)) is not None}

    def _refuse(
        self, component: Component, attribute: Attribute, value: str, allowed: str, remedy: str = ""
    ) -> None:
        place = f"{self.source}: {component}: {attribute.name}"
        self.faults.add(place, shorten(value), allowed, remedy)

    def _gears(self, stage: Component) -> tuple[Component, Component] | None:
        """Driving gear and driven gear; gear 1 drives where the file does not say."""
        listed = [self.model.components.get(self.relation.roles.get(r, "")) for r in ("gear_1", "gear_2")]
        first, second = listed
        for role, gear in zip(("gear_1", "gear_2"), listed, strict=True):
            if gear is None:
                self.faults.add(f"{self.source}: {stage}", "", f"has no {role}", "Export it again")
            elif gear.type != "cylindrical_gear":
                allowed = "is no external cylindrical gear; internal and other gears are out of scope"
                self.faults.add(f"{self.source}: {stage}: {role}", str(gear), allowed)
        if first is None or second is None or self.faults.found:
            return None
        drives = {}
        for relation in self.model.related("stage_gear_data", "stage", stage.id):
            data = self.model.components.get(relation.roles.get("stage_gear_data", ""))
            drives_it = data.attributes.get(rexs.IS_DRIVING.name, ("", ""))[0] if data is not None else ""
            drives[relation.roles.get("gear", "")] = drives_it == "true"
        if drives.get(second.id) and not drives.get(first.id):
            return second, first
        if not drives.get(first.id):
            self.notes.append(f"The file does not say which gear drives: gear 1, {first}, is the pinion.")
        return first, second

    def _helix_angle(self, gears: tuple[Component, Component]) -> float:
        """Helix angle of the pinion [deg], above 0 right-handed; the wheel has the other hand."""
        pinion, wheel = (self._number(gear, rexs.HELIX_ANGLE) for gear in gears)
        said = [gear for gear in gears if rexs.HELIX_ANGLE.name in gear.attributes]
        if pinion is None or wheel is None:
            for gear in gears:
                if gear not in said:
                    hand = f"of the other hand than {said[0]}" if said else "a spur gear"
                    self.notes.append(f"{gear} has no helix angle in the file: {hand}.")
            return pinion if pinion is not None else -wheel + 0.0 if wheel is not None else 0.0
        if abs(pinion + wheel) > SAME * max(abs(pinion), abs(wheel)):
            allowed = (
                f"must be {-pinion + 0.0:g} deg: an external pair has one helix angle, and opposite hands"
            )
            remedy = "Above 0 is right-handed; without signs the file says no hands"
            self._refuse(gears[1], rexs.HELIX_ANGLE, f"{wheel:g} deg", allowed, remedy)
        return pinion + 0.0

    def _module(self, gears: tuple[Component, Component], beta: float) -> float:
        """Normal module [mm]; by the transverse one where the file gives that alone."""
        module = self._common(rexs.MODULE, gears)
        if math.isnan(module) and not self.faults.found:
            transverse = self._common(rexs.TRANSVERSE_MODULE, gears)
            if not math.isnan(transverse):
                module = float(f"{transverse * math.cos(math.radians(beta)):.12g}")
                self.notes.append(f"The file has no normal_module: m_t cos(beta) = {module:g} mm is taken.")
        return module

    def _check_sections(
        self, gears: tuple[Component, Component], flanks: list[list[Component]], sections: Sections
    ) -> None:
        """Refuse figures of the transverse section that disagree with those of the normal one."""
        for gear, own in zip(gears, flanks, strict=True):
            teeth = self._number(gear, rexs.TEETH)
            for attribute, follows, law in sections.of_gear(math.nan if teeth is None else teeth):
                self._agrees(gear, attribute, follows, law)
            for flank in own:
                self._agrees(flank, *sections.of_flank())

    def _agrees(self, component: Component, attribute: Attribute, follows: float, law: str) -> None:
        """Refuse a figure that is another than what follows from the normal section, but for rounding."""
        value = self._number(component, attribute)
        if value is not None and abs(abs(value) - abs(follows)) > ROUNDED * abs(follows) + SAME:
            unit = next(iter(attribute.unit.scales))
            allowed = f"must be {follows:.7g} {unit} by the normal section and the helix angle, {law}"
            remedy = "One of them is of the other section: normal_module is m_t cos(beta)"
            self._refuse(component, attribute, f"{value:g} {unit}", allowed, remedy)

    def _common(self, attribute: Attribute, components: Sequence[Component]) -> float:
        """The one number that all components have that say it."""
        said = self._numbers(components, attribute)
        if not said:
            return OPEN
        values = list(said.values())
        for key, value in said.items():
            if abs(value - values[0]) > SAME * abs(values[0]):
                allowed = f"must be {values[0]:g}, as in the rest of the pair"
                remedy = "Flanks and gears that differ are out of scope"
                self._refuse(self.model.components[key], attribute, f"{value:g}", allowed, remedy)
        return values[0]

    def _gear(
        self,
        gear: Component,
        flanks: list[Component],
        module: float,
        rack: dict[str, float],
        helix_cosine: float,
    ) -> dict[str, Any]:
        teeth = self._number(gear, rexs.TEETH)
        shift = self._common(rexs.PROFILE_SHIFT, flanks)
        if math.isnan(shift):
            shift = self._common(rexs.PROFILE_SHIFT_LENGTH, flanks) / module
        cut = self._generating_shift(gear, flanks, shift)
        tip = self._number(gear, rexs.TIP_DIAMETER)
        alteration = OPEN
        if tip is not None and teeth is not None:
            exact = 0.5 * (tip / module - teeth / helix_cosine) - rack["h_aP"] - shift
            alteration = 0.0 if abs(exact) < 1e-9 else float(f"{exact:.12g}")
        root = self._number(gear, rexs.ROOT_DIAMETER)
        if root is not None and teeth is not None:
            own = module * (teeth / helix_cosine + 2.0 * ((shift if cut is None else cut) - rack["h_fP"]))
            if abs(own - root) > 0.01 * module:
                self.notes.append(
                    f"{gear}: root_diameter {root:g} mm in the file, {own:g} mm by shift and tool: the file's "
                    "machining allowance or tooth thickness is not taken over."
                )
        for allowance in rexs.ALLOWANCES:
            if nonzero := [v for v in self._numbers(flanks, allowance).values() if v]:
                self.notes.append(
                    f"{gear}: {allowance.name} {nonzero[0]:g} mm is not taken over: the tooth is as finished."
                )
        return {
            "teeth": OPEN if teeth is None else int(teeth) if teeth.is_integer() else teeth,
            "profile_shift": shift,
            **({} if cut is None else {"generating_shift": cut}),
            "tip_alteration": _or_default(alteration),
            "bore_mm": self._number(gear, rexs.BORE_DIAMETER) or None,
            "tip_chamfer_mm": _or_default(self._common(rexs.TIP_CHAMFER, flanks)),
        }

    def _generating_shift(self, gear: Component, flanks: list[Component], shift: float) -> float | None:
        """Shift at which the only tool cuts a gear, where it is another than the profile shift."""
        if self._tool(gear, flanks, silent=True) is None:
            return None
        settings = [
            setting
            for flank in flanks
            for setting in self.model.others(
                "manufacturing_step", "workpiece", flank.id, "manufacturing_settings"
            )
        ]
        cut = self._common(
            rexs.GENERATED_SHIFT, list({component.id: component for component in settings}.values())
        )
        return None if math.isnan(cut) or abs(cut - shift) <= SAME else cut

    def _rack(
        self,
        gears: tuple[Component, Component],
        flanks: list[list[Component]],
        module: float,
        alpha: float,
    ) -> dict[str, float]:
        all_flanks = [f for pair in flanks for f in pair]
        addendum = _or_default(self._common(rexs.RACK_ADDENDUM, all_flanks))
        rack = {
            "h_aP": 1.0 if addendum is None else addendum,  # with a tip diameter only h_aP + k counts
            "h_fP": OPEN,
            "rho_fP": OPEN,
            "alpha_deg": alpha,
        }
        tools = [self._tool(g, f) for g, f in zip(gears, flanks, strict=True)]
        racks = []
        for tool in tools:
            if tool is None:
                return rack
            for attribute in rexs.PROTUBERANCE:
                if self._number(tool, attribute):
                    value = tool.attributes[attribute.name][0]
                    self._refuse(tool, attribute, value, "must be 0: protuberance is out of scope")
            shape = (rexs.TOOL_ADDENDUM, rexs.TOOL_TIP_RADIUS)
            racks.append([self._in_modules(tool, attributes, module) for attributes in shape])
        first, second = racks
        for name, a, b in zip(("addendum", "tip radius"), first, second, strict=True):
            if abs(a - b) > SAME * abs(a):
                allowed = f"must be {a:g} modules, as that of {tools[0]}: a pair has one basic rack"
                self.faults.add(f"{self.source}: {tools[1]}: {name}", f"{b:g}", allowed)
        return rack | {"h_fP": first[0], "rho_fP": first[1]}

    def _in_modules(self, tool: Component, attributes: tuple[Attribute, ...], module: float) -> float:
        """First of several attributes with one meaning that the tool has, in modules."""
        for attribute in attributes:
            if (value := self._number(tool, attribute)) is not None:
                return value if attribute.unit is rexs.PURE else float(f"{value / module:.12g}")
        return OPEN

    def _tool(self, gear: Component, flanks: list[Component], silent: bool = False) -> Component | None:
        """The rack-shaped tool that cut a gear, where it is the only tool."""
        candidates = [
            t for f in flanks for t in self.model.others("manufacturing_step", "workpiece", f.id, "tool")
        ]
        for kind in ("ordered_reference", "reference"):
            candidates += self.model.others(kind, "origin", gear.id, "referenced")
        tools = list({tool.id: tool for tool in candidates if tool.type.endswith("_tool")}.values())
        if len(tools) == 1 and tools[0].type == "rack_shaped_tool":
            return tools[0]
        if tools and not silent:
            self.notes.append(
                f"{gear}: made by {', '.join(map(str, tools))}: the fillet of one rack-shaped tool alone is generated."
            )
        return None

    def _face_width(self, stage: Component, gears: tuple[Component, Component]) -> float:
        common = self._number(stage, rexs.COMMON_FACE_WIDTH)
        if common:
            return common
        widths = list(self._numbers(gears, rexs.FACE_WIDTH).values())
        if len(widths) == 2 and widths[0] != widths[1]:
            listed = " and ".join(f"{w:g}" for w in widths)
            self.notes.append(f"Face widths {listed} mm: the smaller one carries and is taken.")
        return min(widths, default=OPEN)

    def _material(self, gears: tuple[Component, Component]) -> dict[str, Any]:
        """Keys of the scene's section: one material, or one each; none where the file does not give both."""
        materials = []
        for gear in gears:
            named = self.model.others("reference", "origin", gear.id, "referenced")
            material = next((c for c in named if c.type == "material"), None)
            if material is None:
                continue
            own = {key: self._number(material, attribute) for key, attribute in rexs.MATERIAL.items()}
            if own["youngs_modulus_GPa"] is not None and own["poisson_ratio"] is not None:
                materials.append(own)
        if len(materials) < 2:
            return {}
        return materials[0] if materials[0] == materials[1] else dict(zip(GEARS, materials, strict=True))

    def _modifications(self, gears: tuple[Component, Component], flanks: list[list[Component]]) -> None:
        own = {c.id for c in gears} | {f.id for pair in flanks for f in pair}
        for relation in self.model.relations:
            members = set(relation.roles.values())
            if not members & own:
                continue
            for component in (self.model.components.get(i) for i in sorted(members - own)):
                if component is not None and MODIFICATIONS.fullmatch(component.type):
                    self.notes.append(f"{component} is not taken over; tip_relief is a key of the scene.")


def _or_default(value: float) -> float | None:
    """None, which stands for the scene's default, where the file lacks a value that a scene can do without."""
    return None if math.isnan(value) else value
