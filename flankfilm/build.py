"""From the scene's keys to the objects of the ground floors, in SI."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from base import Fault, InputError
from flankfilm.scene.schema import (
    DeviationsSection,
    ElasticSection,
    GearSection,
    HubSection,
    PairSection,
    RackSection,
    Scene,
)

if TYPE_CHECKING:
    from fem import Support
    from gears import BasicRack, Gear, GearDeviations, GearPair, Material

ISO_53 = {"A": (1.0, 1.25, 0.38), "B": (1.0, 1.25, 0.3), "C": (1.0, 1.25, 0.25), "D": (1.0, 1.4, 0.39)}
"""Profiles of ISO 53:1998, annex A: addendum, dedendum and tip radius, times the module."""


def gear_pair(scene: Scene) -> GearPair:
    """Build the pair of a scene.

    Raises
    ------
    InputError
        With every fault of the geometry, each under the scene's key.
    """
    from gears import GearPair, GeometryError, Material

    section = scene.pair
    if section is None:
        raise InputError([Fault("[pair]", "", "is required", "Add the section [pair]")])
    steel = Material(youngs_modulus=206e9, poisson_ratio=0.3, density=7850.0)
    try:
        pair = GearPair(
            pinion=_gear(section.pinion, section),
            wheel=_gear(section.wheel, section),
            module=1e-3 * section.module_mm,
            face_width=1e-3 * section.face_width_mm,
            rack=_rack(section),
            material=_materials(scene) or (steel, steel),
            centre_distance=None if section.centre_distance_mm is None else 1e-3 * section.centre_distance_mm,
        )
        return pair if not section.backlash_um else pair.with_backlash(1e-6 * section.backlash_um)
    except GeometryError as error:
        raise InputError([_scene_fault(fault) for fault in error.faults]) from error


def pinion_speed(scene: Scene) -> float:
    """Pinion speed [rad/s]."""
    operating = scene.operating
    if operating is None or operating.pinion_speed_rpm is None:
        raise InputError([Fault("operating.pinion_speed_rpm", "", "is required", "Give the pinion's speed")])
    return operating.pinion_speed_rpm * math.pi / 30


def pinion_torque(scene: Scene) -> float:
    """Pinion torque [N m]."""
    if scene.operating is None:
        raise InputError(
            [Fault("operating.pinion_torque_Nm", "", "is required", "Add the section [operating]")]
        )
    return scene.operating.pinion_torque_Nm


def supports(scene: Scene) -> tuple[Support, Support] | None:
    """Rigid hubs of both gears; None where both are held on their bores."""
    if scene.pair is None or (scene.pair.pinion.hub is None and scene.pair.wheel.hub is None):
        return None
    first, second = (_support(section.hub) for section in (scene.pair.pinion, scene.pair.wheel))
    return first, second


def _support(section: HubSection | None) -> Support:
    from fem import Support

    if section is None:
        return Support()
    return Support(
        radial_stiffness=section.radial_stiffness_N_per_m or math.inf,
        torsional_stiffness=section.torsional_stiffness_Nm_per_rad or math.inf,
        hub_radius=None if section.hub_mm is None else 0.5e-3 * section.hub_mm,
    )


def tip_roundings(scene: Scene) -> tuple[float, float]:
    """Radii of the tip edges of pinion and wheel [m]."""
    if scene.pair is None:
        return 0.0, 0.0
    return 1e-6 * scene.pair.pinion.tip_rounding_um, 1e-6 * scene.pair.wheel.tip_rounding_um


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
    curve = section.profile
    profile = (
        None
        if curve is None
        else ProfileDeviation.over_roll_angle(
            base_radius,
            [math.radians(angle) for angle in curve.roll_deg],
            [1e-6 * value for value in curve.material_um],
        )
    )
    pitches = None
    if pitch and section.single_pitch_um is not None:
        pitches = PitchDeviations.from_single([1e-6 * value for value in section.single_pitch_um])
    elif pitch and section.cumulative_pitch_um is not None:
        pitches = PitchDeviations(tuple(1e-6 * value for value in section.cumulative_pitch_um))
    return None if profile is None and pitches is None else GearDeviations(profile, pitches)


def _gear(section: GearSection, pair: PairSection) -> Gear:
    from gears import Gear, TipRelief

    relief = section.tip_relief
    return Gear(
        teeth=section.teeth,
        profile_shift=section.profile_shift,
        bore_radius=None if section.bore_mm is None else 0.5e-3 * section.bore_mm,
        tip_alteration=section.tip_alteration,
        thickness_allowance=1e-6 * section.thickness_allowance_um,
        tip_chamfer=1e-3 * section.tip_chamfer_mm,
        tip_relief=None
        if relief is None
        else TipRelief(amount=1e-6 * relief.amount_um, length=1e-3 * relief.length_mm, form=relief.form),
    )


def _rack(section: PairSection) -> BasicRack:
    from gears import BasicRack

    if isinstance(section.rack, RackSection):
        own = section.rack
        return BasicRack(h_aP=own.h_aP, h_fP=own.h_fP, rho_fP=own.rho_fP, alpha=math.radians(own.alpha_deg))
    h_aP, h_fP, rho_fP = ISO_53[section.rack[-1]]
    return BasicRack(h_aP=h_aP, h_fP=h_fP, rho_fP=rho_fP)


def _materials(scene: Scene) -> tuple[Material, Material] | None:
    section = scene.material
    if section is None:
        return None
    if section.pinion is not None and section.wheel is not None:
        return _material(section.pinion), _material(section.wheel)
    common = ElasticSection.model_validate(section.model_dump(exclude_none=True))
    return _material(common), _material(common)


def _material(section: ElasticSection) -> Material:
    from gears import Material

    return Material(
        youngs_modulus=1e9 * section.youngs_modulus_GPa,
        poisson_ratio=section.poisson_ratio,
        density=section.density_kg_per_m3,
    )


_KEYS = {
    "module": "module_mm",
    "face_width": "face_width_mm",
    "bore_radius": "bore_mm",
    "thickness_allowance": "thickness_allowance_um",
    "tip_chamfer": "tip_chamfer_mm",
    "tip_relief.amount": "tip_relief.amount_um",
    "tip_relief.length": "tip_relief.length_mm",
    "centre_distance": "centre_distance_mm",
    "backlash": "backlash_um",
    "youngs_modulus": "youngs_modulus_GPa",
}
"""The scene's keys for the attributes that a geometry fault names."""


def _scene_fault(fault: Fault) -> Fault:
    owner, _, attribute = (
        fault.where.partition(".")
        if fault.where.startswith(("pinion", "wheel", "rack"))
        else (
            "",
            "",
            fault.where,
        )
    )
    key = _KEYS.get(attribute, attribute)
    where = ".".join(part for part in ("pair", owner, key) if part)
    return Fault(where, fault.value, fault.allowed, fault.remedy[:1].upper() + fault.remedy[1:])
