"""Writes a gear pair as a REXS file, version 1.4: XML, JSON or either in an archive."""

from __future__ import annotations

import math
from collections.abc import Mapping
from datetime import UTC, datetime
from importlib.metadata import version
from pathlib import Path
from typing import TYPE_CHECKING
from xml.etree import ElementTree as ET

from base import InputError
from flankfilm.exchange import rexs_attributes as rexs
from flankfilm.exchange.rexs_archive import packed
from flankfilm.exchange.rexs_attributes import Attribute
from flankfilm.exchange.rexs_json import json_text

if TYPE_CHECKING:
    from gears import GearPair

VERSION = "1.4"


FORMATS = (".rexs", ".rexsj", ".rexsz")
"""Endings of files: XML, JSON, and XML in a ZIP archive."""


def rexs_file(pair: GearPair, title: str, path: Path) -> tuple[bytes, tuple[str, ...]]:
    """Content of a REXS file in the format that the ending of its name says; see `rexs_text`.

    Raises
    ------
    InputError
        Where the name ends otherwise.
    """
    if path.suffix.lower() not in FORMATS:
        raise InputError.at("--out", str(path), f"must end in {', '.join(FORMATS[:-1])} or {FORMATS[-1]}")
    text, left_out = rexs_text(pair, title)
    if path.suffix.lower() == ".rexsj":
        text = json_text(ET.fromstring(text))
    if path.suffix.lower() == ".rexsz":
        return packed(text, f"{path.stem}.rexs"), left_out
    return text.encode(), left_out


def rexs_text(pair: GearPair, title: str) -> tuple[str, tuple[str, ...]]:
    """Write a pair, as XML, as one stage of two cylindrical gears, each with flanks, tool and material.

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
    size = {
        rexs.CENTRE_DISTANCE: 1e3 * pair.working_centre_distance,
        rexs.COMMON_FACE_WIDTH: 1e3 * pair.face_width,
    }
    stage = writer.component("cylindrical_stage", title, size)
    gears = [writer.gear(pair, index, name) for index, name in enumerate(("Pinion", "Wheel"))]
    writer.relation("stage", stage=stage, gear_1=gears[0], gear_2=gears[1])
    for gear, drives in zip(gears, ("true", "false"), strict=True):
        data = writer.component("cylindrical_stage_gear_data", "", {rexs.IS_DRIVING: drives})
        writer.relation("stage_gear_data", stage=stage, gear=gear, stage_gear_data=data)
    return writer.text(), _left_out(pair)


def _left_out(pair: GearPair) -> tuple[str, ...]:
    omitted = []
    for name, gear in (("pinion", pair.pinion), ("wheel", pair.wheel)):
        if gear.thickness_allowance:
            omitted.append(
                f"{name}: thickness allowance of {1e6 * gear.thickness_allowance:g} µm is not written"
            )
        if gear.tip_relief is not None:
            omitted.append(f"{name}: tip relief is not written")
        if gear.blank is not None:
            omitted.append(f"{name}: blank is not written, the gear is a disc in the file")
    return tuple(omitted)


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

    def component(self, kind: str, name: str, values: Mapping[Attribute, float | str]) -> str:
        """Add a component with values of attributes in the scene's units; return its id."""
        key = str(len(self._kinds) + 1)
        self._kinds[key] = kind
        marks = {"id": key, "type": kind, "name": _printable(name)}
        element = ET.SubElement(self._components, "component", marks)
        for attribute, value in values.items():
            marks = {"id": attribute.name, "unit": attribute.unit.written}
            ET.SubElement(element, "attribute", marks).text = attribute.text(value)
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
        gear, profile = (pair.pinion, pair.wheel)[index], pair.teeth_profiles[index]
        module, angle = {rexs.MODULE: 1e3 * pair.module}, {rexs.PRESSURE_ANGLE: math.degrees(pair.rack.alpha)}
        shift = float(gear.profile_shift)
        size = {
            rexs.HELIX_ANGLE: math.degrees((1.0, -1.0)[index] * pair.helix_angle) + 0.0,  # no -0.0
            rexs.FACE_WIDTH: 1e3 * pair.face_widths[index],
            rexs.TIP_DIAMETER: 2e3 * profile.tip_radius,
            rexs.ROOT_DIAMETER: 2e3 * profile.root_radius,
            rexs.BORE_DIAMETER: 2e3 * profile.bore_radius,
        }
        key = self.component("cylindrical_gear", name, {rexs.TEETH: profile.teeth} | module | size)
        shape = {
            rexs.PROFILE_SHIFT: shift,
            rexs.RACK_ADDENDUM: float(pair.rack.h_aP),
            rexs.TIP_CHAMFER: 1e3 * gear.tip_chamfer,
        }
        depth = {
            rexs.TOOL_ADDENDUM[0]: float(pair.rack.h_fP),
            rexs.TOOL_TIP_RADIUS[0]: float(pair.rack.rho_fP),
        }
        left, right = (
            self.component("cylindrical_gear_flank", f"{name}, {side} flank", angle | shape)
            for side in ("left", "right")
        )
        self.relation("flank", gear=key, left=left, right=right)
        tool = self.component("rack_shaped_tool", f"{name}, basic rack", module | angle | depth)
        for flank in (left, right):
            settings = self.component(
                "cylindrical_gear_manufacturing_settings", "", {rexs.GENERATED_SHIFT: float(gear.cut_shift)}
            )
            self.relation(
                "manufacturing_step", 1, workpiece=flank, tool=tool, manufacturing_settings=settings
            )
        material = pair.materials[index]
        constants = (1e-9 * material.youngs_modulus, material.poisson_ratio, material.density)
        elastic = dict(zip(rexs.MATERIAL.values(), map(float, constants), strict=True))
        self.relation(
            "reference", origin=key, referenced=self.component("material", f"{name}, material", elastic)
        )
        return key

    def text(self) -> str:
        """The file."""
        ET.indent(self._root)
        return '<?xml version="1.0" encoding="UTF-8"?>\n' + ET.tostring(self._root, encoding="unicode") + "\n"


def _printable(text: str) -> str:
    """Text without the control characters that XML cannot hold."""
    return "".join(c if c.isprintable() else " " for c in text)
