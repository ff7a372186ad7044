"""From the scene's sections to the objects of the ground floors, in SI.

What a section hands over one to one is its `Section.si`; here stands what takes more than that.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from base import InputError
from flankfilm.scene.gears import DeviationsSection, GearSection, PairSection, RackSection
from flankfilm.scene.ground import under_keys
from flankfilm.scene.schema import Scene

if TYPE_CHECKING:
    from fem import Support
    from gears import BasicRack, Gear, GearDeviations, GearPair

ISO_53 = {"A": (1.0, 1.25, 0.38), "B": (1.0, 1.25, 0.3), "C": (1.0, 1.25, 0.25), "D": (1.0, 1.4, 0.39)}
"""Profiles of ISO 53:1998, annex A: addendum, dedendum and tip radius, times the module."""


def gear_pair(scene: Scene) -> GearPair:
    """Build the pair of a scene; without a material it is of steel.

    Raises
    ------
    InputError
        With every fault of the geometry, each under the scene's key.
    """
    from gears import STEEL, GearPair, Material

    section = scene.pair
    if section is None:
        raise InputError.at("[pair]", "", "is required", "Add the section [pair]")
    with under_keys(section, "pair"):
        first, second = (
            (STEEL, STEEL)
            if scene.material is None
            else (Material(**material.si()) for material in scene.material.each)
        )
        pair = GearPair(
            pinion=_gear(section.pinion),
            wheel=_gear(section.wheel),
            rack=_rack(section),
            material=(first, second),
            **section.si(),
        )
        backlash = section.value("backlash_um")
        return pair.with_backlash(backlash) if backlash else pair


def _gear(section: GearSection) -> Gear:
    from gears import Gear, TipRelief

    relief = section.tip_relief
    return Gear(**section.si(), tip_relief=None if relief is None else TipRelief(**relief.si()))


def _rack(section: PairSection) -> BasicRack:
    from gears import BasicRack

    if isinstance(section.rack, RackSection):
        return BasicRack(**section.rack.si())
    h_aP, h_fP, rho_fP = ISO_53[section.rack[-1]]
    return BasicRack(h_aP=h_aP, h_fP=h_fP, rho_fP=rho_fP)


def pinion_speed(scene: Scene) -> float:
    """Pinion speed [rad/s]."""
    return _operating(scene, "pinion_speed_rpm", "Give the pinion's speed")


def pinion_torque(scene: Scene) -> float:
    """Pinion torque [N m]."""
    return _operating(scene, "pinion_torque_Nm", "Add the section [operating]")


def _operating(scene: Scene, key: str, remedy: str) -> float:
    """Value of a key of [operating], in SI."""
    found = scene.operating.value(key) if scene.operating else None
    if found is None:
        raise InputError.at(f"operating.{key}", "", "is required", remedy)
    return float(found)


def supports(scene: Scene) -> tuple[Support, Support] | None:
    """Rigid hubs of both gears; None where both are held on their bores."""
    from fem import Support

    if scene.pair is None or (scene.pair.pinion.hub is None and scene.pair.wheel.hub is None):
        return None
    first, second = (
        Support() if gear.hub is None else Support(**gear.hub.si())
        for gear in (scene.pair.pinion, scene.pair.wheel)
    )
    return first, second


def tip_roundings(scene: Scene) -> tuple[float, float]:
    """Radii of the tip edges of pinion and wheel [m]."""
    if scene.pair is None:
        return 0.0, 0.0
    first, second = (gear.value("tip_rounding_um") for gear in (scene.pair.pinion, scene.pair.wheel))
    return first, second


def deviations(
    scene: Scene, pair: GearPair, *, pitch: bool
) -> tuple[GearDeviations | None, GearDeviations | None] | None:
    """Deviations of both gears; those of the pitches only where every tooth counts.

    A mesh cycle of one base pitch stands for all teeth: it knows the profiles alone.
    """
    if scene.pair is None:
        return None
    sections = (scene.pair.pinion, scene.pair.wheel)
    first, second = (
        _deviations(section.deviations, radius, pitch)
        for section, radius in zip(sections, pair.base_radii, strict=True)
    )
    return None if first is None and second is None else (first, second)


def _deviations(section: DeviationsSection | None, base_radius: float, pitch: bool) -> GearDeviations | None:
    from gears import GearDeviations, PitchDeviations, ProfileDeviation

    if section is None:
        return None
    curve, given = section.profile, section.si()
    profile = None if curve is None else ProfileDeviation.over_roll_angle(base_radius, **curve.si())
    pitches = None
    if pitch and "single" in given:
        pitches = PitchDeviations.from_single(given["single"])
    elif pitch and "cumulative" in given:
        pitches = PitchDeviations(given["cumulative"])
    return None if profile is None and pitches is None else GearDeviations(profile, pitches)
