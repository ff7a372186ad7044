"""Keys of temperatures: gears and housing grow from what they were measured at."""

from __future__ import annotations

from typing import ClassVar

from flankfilm.scene.key import key
from flankfilm.scene.section import Limits, Section
from gears.heat import LIMITS


class HeatSection(Section):
    """Temperatures of gears and housing, whose growth changes backlash, pressure angle and base pitches."""

    ground: ClassVar[Limits] = LIMITS

    pinion_temperature_C: float = key(
        "temperature of the pinion", 20.0, celsius="pinion_temperature", such_as=90.0
    )
    wheel_temperature_C: float = key(
        "temperature of the wheel", 20.0, celsius="wheel_temperature", such_as=80.0
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
