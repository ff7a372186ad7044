"""Writes a gear pair as a REXS file (XML, version 1.4)."""

from __future__ import annotations

import math
from datetime import UTC, datetime
from importlib.metadata import version
from typing import TYPE_CHECKING
from xml.etree import ElementTree as ET

if TYPE_CHECKING:
    from gears import GearPair, Material

VERSION = "1.4"


def rexs_text(pair: GearPair, title: str) -> tuple[str, tuple[str, ...]]:
    """Write a pair as one stage of two cylindrical gears, each with flanks, tool and material.

    Parameters
    ----------
    pair : GearPair
    title : str
        Name of the stage.

    Returns
    -------
    (str, tuple of str)
        The file's text; what REXS has no place for or is left out here.
    """
    writer = _Writer(title)
    stage = writer.component(
        "cylindrical_stage",
        title,
        center_distance=(1e3 * pair.working_centre_distance, "mm"),
        common_face_width=_mm(pair.face_width),
    )
    gears = []
    for index, name in enumerate(("Pinion", "Wheel")):
        gears.append(writer.gear(pair, index, name))
    writer.relation("stage", stage=stage, gear_1=gears[0], gear_2=gears[1])
    for gear, drives in zip(gears, ("true", "false"), strict=True):
        data = writer.component("cylindrical_stage_gear_data", "", is_driving_gear=(drives, "none"))
        writer.relation("stage_gear_data", stage=stage, gear=gear, stage_gear_data=data)
    return writer.text(), _left_out(pair)


def _left_out(pair: GearPair) -> tuple[str, ...]:
    told = []
    for name, gear in (("pinion", pair.pinion), ("wheel", pair.wheel)):
        if gear.thickness_allowance:
            told.append(
                f"{name}: thickness allowance of {1e6 * gear.thickness_allowance:g} µm is not written"
            )
        if gear.tip_relief is not None:
            told.append(f"{name}: tip relief is not written")
    return tuple(told)


class _Writer:
    def __init__(self, title: str) -> None:
        self._root = ET.Element(
            "model",
            {
                "version": VERSION,
                "applicationId": "flankfilm",
                "applicationVersion": version("flankfilm"),
                "date": datetime.now(UTC).isoformat(timespec="seconds"),
            },
        )
        self._relations = ET.SubElement(self._root, "relations")
        self._components = ET.SubElement(self._root, "components")
        self._kinds: dict[str, str] = {}

    def component(self, kind: str, name: str, **attributes: tuple[float | str, str]) -> str:
        """Add a component with attributes (value, unit); return its id."""
        key = str(len(self._kinds) + 1)
        self._kinds[key] = kind
        element = ET.SubElement(
            self._components, "component", {"id": key, "type": kind, "name": _printable(name)}
        )
        for attribute, (value, unit) in attributes.items():
            own = ET.SubElement(element, "attribute", {"id": attribute, "unit": unit})
            own.text = value if isinstance(value, str) else repr(float(f"{value:.14g}"))
        return key

    def relation(self, kind: str, order: int | None = None, **roles: str) -> None:
        """Add a relation: role to component id."""
        marks = {"id": str(len(self._relations) + 1), "type": kind}
        if order is not None:
            marks["order"] = str(order)
        element = ET.SubElement(self._relations, "relation", marks)
        for role, key in roles.items():
            ET.SubElement(element, "ref", {"id": key, "role": role, "hint": self._kinds[key]})

    def gear(self, pair: GearPair, index: int, name: str) -> str:
        """Add one gear with its flanks, its tool and its material."""
        gear = (pair.pinion, pair.wheel)[index]
        profile = pair.teeth_profiles[index]
        key = self.component(
            "cylindrical_gear",
            name,
            number_of_teeth=(str(profile.teeth), "none"),
            normal_module=_mm(pair.module),
            helix_angle_reference_diameter=(0.0, "deg"),
            face_width=_mm(pair.face_width),
            tip_diameter=_mm(2.0 * profile.tip_radius),
            root_diameter=_mm(2.0 * profile.root_radius),
            inner_diameter=_mm(2.0 * profile.bore_radius),
        )
        flanks = [
            self.component(
                "cylindrical_gear_flank",
                f"{name}, {side} flank",
                normal_pressure_angle=(math.degrees(pair.rack.alpha), "deg"),
                addendum_modification_coefficient=(gear.profile_shift, "none"),
                addendum_coefficient_basic_profile=(pair.rack.h_aP, "none"),
                tooth_tip_chamfer=_mm(gear.tip_chamfer),
            )
            for side in ("left", "right")
        ]
        self.relation("flank", gear=key, left=flanks[0], right=flanks[1])
        tool = self.component(
            "rack_shaped_tool",
            f"{name}, basic rack",
            normal_module=_mm(pair.module),
            normal_pressure_angle=(math.degrees(pair.rack.alpha), "deg"),
            addendum_coefficient_reference_profile=(pair.rack.h_fP, "none"),
            tip_radius_factor=(pair.rack.rho_fP, "none"),
        )
        for flank in flanks:
            settings = self.component(
                "cylindrical_gear_manufacturing_settings",
                "",
                generated_addendum_modification_coefficient=(gear.profile_shift, "none"),
            )
            self.relation(
                "manufacturing_step", 1, workpiece=flank, tool=tool, manufacturing_settings=settings
            )
        self.relation("reference", origin=key, referenced=self._material(pair.materials[index], name))
        return key

    def _material(self, material: Material, name: str) -> str:
        return self.component(
            "material",
            f"{name}, material",
            elastic_modulus=(1e-6 * material.youngs_modulus, "N / mm^2"),
            poisson_ratio=(material.poisson_ratio, "none"),
            density=(1e-3 * material.density, "kg / dm^3"),
        )

    def text(self) -> str:
        """The file."""
        ET.indent(self._root)
        return '<?xml version="1.0" encoding="UTF-8"?>\n' + ET.tostring(self._root, encoding="unicode") + "\n"


def _mm(length: float) -> tuple[float, str]:
    return 1e3 * length, "mm"


def _printable(text: str) -> str:
    """Text without the control characters that XML cannot hold."""
    return "".join(c if c.isprintable() else " " for c in text)
