"""Keys of temperatures: gears and housing grow from what they were measured at, and flanks warm the film."""

from __future__ import annotations

from typing import ClassVar

from pydantic import model_validator

import gears
from base import Limit
from flankfilm.scene.sections.key import key
from flankfilm.scene.sections.section import Limits, Section, refused
from gears.pair.thermal_expansion import LIMITS, TEMPERATURE

GROWTH = (
    "pinion_temperature_C",
    "wheel_temperature_C",
    "housing_temperature_C",
    "reference_temperature_C",
    "housing_expansion_per_K",
)
"""Keys by which gears and housing grow."""

_TRANSFER = Limit(1e-3, 1e6, "W/K", "heat transfer coefficient times area of a gear; 1 to 100 W/K are usual")


class HeatTransfer(Section):
    """What takes the losses of the mesh away from the gears."""

    ground: ClassVar[Limits] = {"pinion": _TRANSFER, "wheel": _TRANSFER}

    pinion: float = key("of the pinion, in W/K", example=10.0)
    wheel: float = key("of the wheel, in W/K", example=12.0)

    @property
    def each(self) -> tuple[float, float]:
        """Of pinion and wheel [W/K]."""
        return self.pinion, self.wheel


class HeatSection(Section):
    """Temperatures of gears and housing, whose growth changes backlash, pressure angle and base pitches.

    The temperature of a gear is that of its flanks as well, where the film forms: one that is given decides both.
    """

    ground: ClassVar[Limits] = {**LIMITS, "ambient_temperature": TEMPERATURE}

    pinion_temperature_C: float | None = key(
        "temperature of the pinion and its flanks; if left out 20, and flanks are as warm as the oil unless that of "
        "the wheel is given",
        None,
        celsius="pinion_temperature",
        such_as=90.0,
    )
    wheel_temperature_C: float | None = key(
        "the same of the wheel", None, celsius="wheel_temperature", such_as=80.0
    )
    housing_temperature_C: float = key(
        "temperature of the housing between the axes", 20.0, celsius="housing_temperature", such_as=60.0
    )
    reference_temperature_C: float = key(
        "temperature at which all lengths are given", 20.0, celsius="reference_temperature"
    )
    housing_expansion_per_K: float = key(
        "coefficient of linear expansion of the housing; steel if left out", 11.5e-6, such_as=23e-6
    )
    heat_transfer_W_per_K: HeatTransfer | None = key(
        "heat transfer coefficient times area of each gear, instead of the gears' temperatures: flanks then reach "
        "the temperature that removes the losses of the mesh, and gears do not grow",
        None,
        of=None,
        such_as={"pinion": 10.0, "wheel": 12.0},
    )
    ambient_temperature_C: float | None = key(
        "temperature of the oil and air in the housing that take this heat; the oil's if left out",
        None,
        celsius="ambient_temperature",
        such_as=60.0,
    )

    @model_validator(mode="after")
    def _temperatures_given_or_balanced(self) -> HeatSection:
        temperature_keys = self.given_keys("pinion_temperature_C", "wheel_temperature_C")
        if temperature_keys and self.heat_transfer_W_per_K is not None:
            raise refused(
                f"must have {' and '.join(temperature_keys)}, or heat_transfer_W_per_K",
                "Leave one of them out",
            )
        if self.heat_transfer_W_per_K is None and self.ambient_temperature_C is not None:
            raise refused(
                "must have heat_transfer_W_per_K beside ambient_temperature_C", "Give both, or none"
            )
        return self

    def growth(self) -> gears.Heat:
        """Temperatures and expansion of gears and housing, in SI."""
        return gears.Heat(**self.si(*GROWTH))

    @property
    def flank_temperatures(self) -> tuple[float, float] | None:
        """Temperatures of the flanks of pinion and wheel [K]; None where they have the oil's."""
        if not self.given_keys("pinion_temperature_C", "wheel_temperature_C"):
            return None
        heat = self.growth()
        return heat.pinion_temperature, heat.wheel_temperature
