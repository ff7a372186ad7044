"""From the scene's sections to the objects of the ground floors, in SI.

What a section hands over one to one is its `Section.si`; here stands what takes more than that.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from typing import TypeVar

import fem
import gears
from base import InputError
from flankfilm.building.flanks import lead_trace
from flankfilm.scene.schema import Scene
from flankfilm.scene.sections.gears import GearSection, PairSection, RackSection
from flankfilm.scene.sections.ground import in_keys, under_keys
from flankfilm.scene.sections.heat import GROWTH
from flankfilm.scene.sections.section import Section, required

S = TypeVar("S", bound=Section)
B = TypeVar("B")

ISO_53 = {"A": (1.0, 1.25, 0.38), "B": (1.0, 1.25, 0.3), "C": (1.0, 1.25, 0.25), "D": (1.0, 1.4, 0.39)}
"""Profiles of ISO 53:1998, annex A: addendum, dedendum and tip radius, times the module."""

TIP_DIGITS = 12
"""Decimal places of a tip alteration that follows from a tip diameter: below them it is rounding."""


def gear_pair(scene: Scene) -> gears.GearPair:
    """Build the pair of a scene, grown to its temperatures; without a material it is of steel.

    Raises
    ------
    InputError
        With every fault of the geometry, each under the scene's key.
    """
    return warm_pair(scene).pair


def _cold_pair(scene: Scene) -> gears.GearPair:
    """Build the pair of a scene as it was measured."""
    section = required(scene.pair, "[pair]")
    with under_keys(section, "pair"), _under_tool(section), _under_tip_diameters(section):
        materials = (gears.STEEL, gears.STEEL)
        if scene.material is not None:
            materials = _both(scene.material.each, lambda section: section.material())
        rack = _rack(section)
        pinion, wheel = (_gear(section, name, rack) for name in ("pinion", "wheel"))
        pair = gears.GearPair(pinion=pinion, wheel=wheel, rack=rack, material=materials, **section.si())
        backlash = section.value("backlash_um")
        return pair.with_backlash(backlash) if backlash else pair


def warm_pair(scene: Scene) -> gears.WarmPair:
    """Build the pair of a scene at its temperatures, beside the cold one.

    Raises
    ------
    InputError
        With every fault of the geometry and of the temperatures, each under the scene's key.
    """
    cold = _cold_pair(scene)
    heat = gears.Heat() if scene.heat is None else gears.Heat(**scene.heat.si(*GROWTH))
    try:
        return gears.warm_pair(cold, heat)
    except InputError as error:
        heated = [fault for fault in error.faults if fault.where.startswith("heat.")]
        if not heated:
            with under_keys(scene.pair, "pair"):
                raise
        raise InputError(
            in_keys(replace(fault, where=fault.where.removeprefix("heat.")), scene.heat, "heat")
            for fault in heated
        ) from error


def _both(sections: tuple[S, S], build: Callable[[S], B]) -> tuple[B, B]:
    """What is built of pinion and wheel."""
    first, second = map(build, sections)
    return first, second


def _gear(pair: PairSection, name: str, rack: gears.BasicRack) -> gears.Gear:
    section: GearSection = getattr(pair, name)
    relief, blank = section.tip_relief, section.blank
    width = section.value("face_width_mm") or pair.value("face_width_mm")
    base_radius = 0.5 * pair.value("module_mm") * section.teeth * math.cos(rack.alpha)
    trace = lead_trace(section, name, width, base_radius)
    return gears.Gear(
        **section.si() | _tip(pair, section, rack),
        tip_relief=None if relief is None else gears.TipRelief(**relief.si()),
        blank=None if blank is None else gears.Blank(**blank.si()),
        lead=gears.Lead(**section.si_of("lead"), trace=trace),
    )


def _tip(pair: PairSection, section: GearSection, rack: gears.BasicRack) -> dict[str, float]:
    """Tip alteration of a gear whose tip diameter is given; nothing where it is not."""
    diameter = section.value("tip_diameter_mm")
    if diameter is None:
        return {}
    above_reference = 0.5 * (diameter / pair.value("module_mm") - section.teeth)
    return {"tip_alteration": round(above_reference - rack.h_aP - section.profile_shift, TIP_DIGITS)}


@contextmanager
def _under_tip_diameters(section: PairSection) -> Iterator[None]:
    """Give the faults of a tip alteration to the tip diameter that it follows from."""
    try:
        yield
    except InputError as error:
        tip_diameters = {
            f"{name}.tip_alteration": gear.tip_diameter_mm
            for name, gear in zip(("pinion", "wheel"), section.each, strict=True)
            if gear.tip_diameter_mm is not None
        }
        raise InputError(
            replace(
                fault,
                where=fault.where.replace("tip_alteration", "tip_diameter_mm"),
                value=f"{tip_diameters[fault.where]:.12g}",
                allowed=f"gives tip_alteration = {fault.value}, which {fault.allowed}",
                remedy=fault.remedy.replace("tip_alteration", "tip_diameter_mm"),
            )
            if fault.where in tip_diameters
            else fault
            for fault in error.faults
        ) from error


def _rack(section: PairSection) -> gears.BasicRack:
    """Rack of both gears, with dedendum and fillet radius by the tool where there is one."""
    if isinstance(section.rack, RackSection):
        rack = gears.BasicRack(**section.rack.si())
    else:
        rack = gears.BasicRack(*ISO_53[section.rack[-1]])
    if section.tool is None:
        return rack
    h_aP0, rho_aP0, bulge = (section.tool.value(name) for name in ("h_aP0", "rho_aP0", "protuberance_um"))
    return gears.BasicRack.of_tool(h_aP0, rho_aP0, rack.h_aP, rack.alpha, bulge)


@contextmanager
def _under_tool(section: PairSection) -> Iterator[None]:
    """Give the faults of what a tool's keys say to the tool."""
    try:
        yield
    except InputError as error:
        if section.tool is None:
            raise
        of_tool = {
            "rack.h_fP": "tool.h_fP",
            "rack.rho_fP": "tool.rho_fP",
            "protuberance": "tool.protuberance",
        }
        raise InputError(
            replace(fault, where=of_tool[fault.where], remedy=fault.remedy.replace("h_fP", "h_aP0"))
            if fault.where in of_tool
            else fault
            for fault in error.faults
        ) from error


def pinion_speed(scene: Scene) -> float:
    """Pinion speed [rad/s]."""
    return _operating(scene, "pinion_speed_rpm", "Give the pinion's speed")


def pinion_torque(scene: Scene) -> float:
    """Pinion torque [N m]."""
    return _operating(scene, "pinion_torque_Nm", "Add the section [operating]")


def _operating(scene: Scene, key: str, remedy: str) -> float:
    """Value of a key of [operating], in SI."""
    si_value = scene.operating.value(key) if scene.operating else None
    return float(required(si_value, f"operating.{key}", remedy=remedy))


def supports(scene: Scene) -> tuple[fem.Support, fem.Support] | None:
    """Rigid hubs of both gears; None where both are held on their bores."""
    sections = required(scene.pair, "[pair]").each
    if all(gear.hub is None for gear in sections):
        return None
    return _both(sections, lambda gear: fem.Support() if gear.hub is None else fem.Support(**gear.hub.si()))


def tip_roundings(scene: Scene) -> tuple[float, float]:
    """Radii of the tip edges of pinion and wheel [m]."""
    return _both(required(scene.pair, "[pair]").each, lambda gear: float(gear.value("tip_rounding_um")))
