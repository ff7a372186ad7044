"""Keys of bearings under gears that move and tilt in space: both gears on rigid shafts."""

from __future__ import annotations

from typing import Annotated, ClassVar

from pydantic import Field, model_validator

from base import Fault, InputError, Limit
from flankfilm.coupling.drive.spatial_bearings import (
    DAMPING_TIME,
    PLACE,
    SPRING,
    TILT_SPRING,
    SpatialBearing,
)
from flankfilm.scene.sections.gears import GEARS
from flankfilm.scene.sections.key import key
from flankfilm.scene.sections.section import Limits, Section

MOST = 20
"""Bearings of a gear."""


class SpatialBearingSection(Section):
    """Bearing of a rigid shaft: springs to the housing."""

    ground: ClassVar[Limits] = {
        "position": PLACE,
        "radial": SPRING,
        "axial": SPRING,
        "tilting": TILT_SPRING,
    }

    position_mm: float = key("place along the axis, from the middle of the gear's face", example=-60)
    radial_N_per_m: float = key("radial stiffness, 1e8 to 1e9 for rolling bearings", example=3e8)
    axial_N_per_m: float = key("axial stiffness, 0 for a bearing that is free to slide", 0.0, example=1e8)
    tilting_Nm_per_rad: float = key("stiffness against tilt, 0 for a bearing that tilts freely", 0.0)

    def bearing(self, damping_time: float) -> SpatialBearing:
        """Bearing in SI, with a damping over its stiffness [s]."""
        place, radial, axial, tilting = (self.value(name) for name in type(self).model_fields)
        return SpatialBearing(place, radial, axial, tilting, damping_time)


SpatialBearings = Annotated[tuple[SpatialBearingSection, ...], Field(strict=False)]

_MASS = Limit(0.0, 1e6, "kg")

_SUCH_AS = (
    {"position_mm": -60, "radial_N_per_m": 3e8, "axial_N_per_m": 1e8},
    {"position_mm": 60, "radial_N_per_m": 3e8},
)


class BearingsSection(Section):
    """Bearings of both gears on rigid shafts, for the wanted bearing forces of a helical pair."""

    ground: ClassVar[Limits] = {
        "damping": DAMPING_TIME,
        "pinion_mass": _MASS,
        "wheel_mass": _MASS,
    }

    pinion: SpatialBearings = key(
        "bearings of the pinion's shaft", such_as=_SUCH_AS, min_length=1, max_length=MOST
    )
    wheel: SpatialBearings = key(
        "bearings of the wheel's shaft, with the same keys", such_as=_SUCH_AS, min_length=1, max_length=MOST
    )
    pinion_mass_kg: float = key("mass of the pinion's shaft, at the middle of the face", 0.0)
    wheel_mass_kg: float = key("mass of the wheel's shaft, likewise", 0.0)
    damping_s: float = key("damping of all bearings over their stiffness", 0.0, such_as=5e-6)

    @property
    def each(self) -> tuple[tuple[SpatialBearing, ...], tuple[SpatialBearing, ...]]:
        """Bearings of pinion and wheel in SI."""
        pinion, wheel = (
            tuple(one.bearing(self.damping_s) for one in section) for section in (self.pinion, self.wheel)
        )
        return pinion, wheel

    @property
    def masses(self) -> tuple[float, float]:
        """What moves with pinion and wheel [kg]."""
        return self.pinion_mass_kg, self.wheel_mass_kg

    @model_validator(mode="after")
    def _both_are_held(self) -> BearingsSection:
        faults = []
        for gear in GEARS:
            each = getattr(self, gear)
            if not any(one.axial_N_per_m for one in each):
                allowed = "must hold the gear along its axis: helical gears push along it"
                faults.append(Fault(gear, "", allowed, "Give axial_N_per_m of one of the bearings"))
            places = {one.position_mm for one in each if one.radial_N_per_m}
            tilting = any(one.tilting_Nm_per_rad for one in each)
            if not places or (len(places) == 1 and not tilting):
                allowed = "must hold the gear across its axis and against tilt"
                remedy = "Give radial_N_per_m at two places, or at one with tilting_Nm_per_rad"
                faults.append(Fault(gear, "", allowed, remedy))
        if faults:
            raise InputError(faults)
        return self
