"""The gears of a scene as objects of the ground floors, from its sections together; each builds its part."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from typing import TypeVar

import fem
import gears
from base import InputError
from flankfilm.building.flanks import measured_lead
from flankfilm.scene.schema import Scene
from flankfilm.scene.sections.gears import GEARS, GearSection, PairSection
from flankfilm.scene.sections.ground import in_keys, under_keys
from flankfilm.scene.sections.rack import under_tool
from flankfilm.scene.sections.section import Section, required
from gears.tooth.helix import Helix

S = TypeVar("S", bound=Section)
B = TypeVar("B")


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
    with under_keys(section, "pair"), under_tool(section.tool), _under_tip_diameters(section):
        materials = (gears.STEEL, gears.STEEL)
        if scene.material is not None:
            materials = _both(scene.material.each, lambda section: section.material())
        rack = section.basic_rack()
        pinion, wheel = (_gear(section, name, rack) for name in GEARS)
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
    heat = gears.Heat() if scene.heat is None else scene.heat.growth()
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
    """Gear of a pair, with the measured lead that covers its face."""
    section: GearSection = getattr(pair, name)
    module = pair.value("module_mm")
    width = section.value("face_width_mm") or pair.value("face_width_mm")
    helix = Helix(pair.value("helix_angle_deg"), rack.alpha)
    base_radius = 0.5 * module * section.teeth * math.cos(rack.alpha) / helix.base_cosine
    return section.gear(module, rack, measured_lead(section, name, width, base_radius), helix.cosine)


@contextmanager
def _under_tip_diameters(section: PairSection) -> Iterator[None]:
    """Give the faults of a tip alteration to the tip diameter that it follows from."""
    try:
        yield
    except InputError as error:
        tip_diameters = {
            f"{name}.tip_alteration": gear.tip_diameter_mm
            for name, gear in zip(GEARS, section.each, strict=True)
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


def pinion_speed(scene: Scene) -> float:
    """Pinion speed [rad/s]."""
    return _operating(scene, "pinion_speed_rpm", "Give the pinion's speed")


def pinion_speed_if_any(scene: Scene) -> float | None:
    """Pinion speed [rad/s]; None where the scene does not say it."""
    return None if scene.rpm is None else pinion_speed(scene)


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
    return _both(sections, lambda gear: gear.support())


def tip_roundings(scene: Scene) -> tuple[float, float]:
    """Radii of the tip edges of pinion and wheel [m]."""
    return _both(required(scene.pair, "[pair]").each, lambda gear: float(gear.value("tip_rounding_um")))
