"""Keys of temperatures: gears and housing grow from what they were measured at, and flanks warm the film."""

from __future__ import annotations

from typing import ClassVar

from flankfilm.scene.key import key
from flankfilm.scene.section import Limits, Section
from gears.heat import LIMITS


class HeatSection(Section):
    """Temperatures of gears and housing, whose growth changes backlash, pressure angle and base pitches.

    The temperature of a gear is that of its flanks as well, where the film forms: one that is given decides both.
    """

    ground: ClassVar[Limits] = LIMITS

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
