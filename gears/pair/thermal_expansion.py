"""Gears and housing that are warmer than they were measured: growth, backlash, and base pitches that differ.

A gear of one temperature grows evenly: all its lengths by s = 1 + alpha (T - T_0), no angle changes, so that its base
circle and its base pitch grow alike. The axes move apart by s_h = 1 + alpha_h (T_h - T_0). With base radii r_b1 s_1
and r_b2 s_2 at the distance a s_h the flanks are still involutes of one line of action,

    cos alpha_w = (r_b1 s_1 + r_b2 s_2)/(a s_h),

and teeth of unequal base pitch do not roll evenly: at a place x behind C on that line a pair of flanks, front or back,
has the gap - x (p_b1 - p_b2)/p_b. All the rest is that of gears that have grown alike, by
s = (z_1 s_1 + z_2 s_2)/(z_1 + z_2), to the first order in s_1 - s_2: the sum of the base radii, hence alpha_w, and the
mean backlash are exact. Left out are the change of the elastic constants and stresses by heat, and temperatures that
differ within a gear.
"""

from __future__ import annotations

import dataclasses
import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from base import Array, Booleans, Faults, Limit, part, quantity, record, rounded_down, rounded_up
from base.results import EXACT
from gears.pair.gear_pair import GearPair
from gears.pair.mesh_checks import ROUNDING, TIGHTEST
from gears.pair.pair_geometry import PairGeometry
from gears.tooth.bisection import bisect
from gears.tooth.errors import GeometryError
from gears.tooth.gear import Gear
from gears.tooth.material import LIMITS as MATERIAL
from gears.tooth.material import STEEL

__all__ = ["Heat", "WarmPair", "warm_pair"]

ROOM = 293.15
"""Temperature at which gears are measured [K]; ISO 1."""

WITHIN = 1e-3
"""Distance from a bound at which a temperature is surely accepted [K]."""

TEMPERATURE = Limit(150.0, 700.0, "K", "give the temperature in kelvins")

LIMITS = {
    "pinion_temperature": TEMPERATURE,
    "wheel_temperature": TEMPERATURE,
    "housing_temperature": TEMPERATURE,
    "reference_temperature": TEMPERATURE,
    "housing_expansion": MATERIAL["thermal_expansion"],
}
"""What the numbers of heat may be."""


@dataclass(frozen=True)
class Heat:
    """Temperatures of a pair and its housing.

    Parameters
    ----------
    pinion_temperature, wheel_temperature, housing_temperature : float
        Of each as a whole [K].
    reference_temperature : float
        At which all lengths were given [K].
    housing_expansion : float
        Coefficient of linear expansion of the housing between the axes [1/K].

    Examples
    --------
    >>> Heat(pinion_temperature=363.15, wheel_temperature=353.15).housing_temperature
    293.15
    """

    pinion_temperature: float = ROOM  # T1, K
    wheel_temperature: float = ROOM  # T2, K
    housing_temperature: float = ROOM  # Th, K
    reference_temperature: float = ROOM  # T0, K
    housing_expansion: float = STEEL.thermal_expansion  # alpha_h, 1/K

    def growths(self, pair: GearPair) -> tuple[float, float, float]:
        """Factors by which pinion, wheel and centre distance grow, s_1, s_2 and s_h."""
        first, second = pair.materials
        coefficients = first.thermal_expansion, second.thermal_expansion, self.housing_expansion
        temperatures = self.pinion_temperature, self.wheel_temperature, self.housing_temperature
        s_1, s_2, s_h = (
            1.0 + coefficient * (temperature - self.reference_temperature)
            for coefficient, temperature in zip(coefficients, temperatures, strict=True)
        )
        return s_1, s_2, s_h


@record
class WarmPair:
    """A pair at its temperatures, beside what it was."""

    no_error = EXACT

    cold: GearPair = part("at the temperature of reference")
    pair: GearPair = part("with both gears grown alike, at the centre distance of the warm housing")
    heat: Heat = part("the temperatures")
    cold_backlash: float = quantity("m", "normal backlash at the temperature of reference", shown="um")
    backlash: float = quantity("m", "mean normal backlash at the temperatures of the gears", shown="um")
    cold_pressure_angle: float = quantity(
        "rad", "working pressure angle at the temperature of reference", shown="deg"
    )
    pressure_angle: float = quantity(
        "rad", "working pressure angle at the temperatures of the gears", shown="deg"
    )
    centre_distance: float = quantity("m", "centre distance at the housing's temperature", shown="mm")
    base_pitch_difference: float = quantity(
        "m", "base pitch of the pinion less that of the wheel, by unequal growth", shown="um"
    )

    headline = ("cold_backlash", "backlash", "base_pitch_difference")


def warm_pair(pair: GearPair, heat: Heat) -> WarmPair:
    """Let a pair and its housing grow to their temperatures.

    Parameters
    ----------
    pair : GearPair
        At the temperature of reference.
    heat : Heat

    Returns
    -------
    WarmPair
        Its pair has both gears grown alike; hand `base_pitch_difference` to `fem.mesh_cycle`.

    Raises
    ------
    GeometryError
        Temperatures out of bounds; a backlash that heat leaves negative in a pair that is not tight, or below a
        tenth of the module in one that is; whatever else the grown pair is refused for.

    Examples
    --------
    >>> from gears import Gear
    >>> pair = GearPair(Gear(36), Gear(40), module=2e-3, face_width=40e-3).with_backlash(50e-6)
    >>> warm = warm_pair(pair, Heat(363.15, 353.15, 323.15))
    >>> round(1e6 * warm.backlash, 1), round(1e6 * warm.base_pitch_difference, 2)
    (29.3, 0.68)
    """
    with Faults(GeometryError) as faults:
        faults.fields(heat, LIMITS)
    s_1, s_2, s_h = heat.growths(pair)
    warm = pair
    if (s_1, s_2, s_h) != (1.0, 1.0, 1.0):
        backlash = _backlash(pair, heat)
        least = _least(pair)
        if backlash < least:
            raise _eaten(pair, heat, backlash, least)
        warm = GearPair(**_grown(pair, heat))
    return WarmPair(
        pair,
        warm,
        heat,
        pair.backlash,
        warm.backlash,
        pair.working_pressure_angle,
        warm.working_pressure_angle,
        warm.working_centre_distance,
        pair.base_pitch * (s_1 - s_2),
    )


def _least(pair: GearPair) -> float:
    """Backlash that the pair may have [m]."""
    return -TIGHTEST * pair.module if pair.tight else -ROUNDING * pair.module


def _grown(pair: GearPair, heat: Heat) -> dict[str, Any]:
    """What the pair is made of, with both gears grown alike and the axes moved apart."""
    s_1, s_2, s_h = heat.growths(pair)
    teeth = pair.pinion.teeth + pair.wheel.teeth
    mean = (pair.pinion.teeth * s_1 + pair.wheel.teeth * s_2) / teeth
    arguments = {field.name: getattr(pair, field.name) for field in dataclasses.fields(pair)}
    return arguments | {
        "pinion": _larger(pair.pinion, mean),
        "wheel": _larger(pair.wheel, mean),
        "module": pair.module * mean,
        "face_width": pair.face_width * mean,
        "centre_distance": pair.working_centre_distance * s_h,
    }


def _larger(gear: Gear, factor: float) -> Gear:
    """Gear with all its lengths multiplied."""
    relief, blank = gear.tip_relief, gear.blank
    if relief is not None:
        relief = dataclasses.replace(relief, amount=relief.amount * factor, length=relief.length * factor)
    if blank is not None:
        lengths = {field.name: getattr(blank, field.name) for field in dataclasses.fields(blank)}
        larger = {name: size * factor for name, size in lengths.items() if size is not None}
        blank = dataclasses.replace(blank, **larger)
    return dataclasses.replace(
        gear,
        bore_radius=None if gear.bore_radius is None else gear.bore_radius * factor,
        thickness_allowance=gear.thickness_allowance * factor,
        tip_chamfer=gear.tip_chamfer * factor,
        face_width=None if gear.face_width is None else gear.face_width * factor,
        face_offset=gear.face_offset * factor,
        tip_relief=relief,
        blank=blank,
    )


def _backlash(pair: GearPair, heat: Heat) -> float:
    """Backlash of the grown pair, minus infinity where its base circles do not leave a line of action [m]."""
    grown = PairGeometry(**_grown(pair, heat))
    apart = grown.working_centre_distance > sum(grown.base_radii)
    return float(grown.backlash) if apart else -math.inf


def _eaten(pair: GearPair, heat: Heat, backlash: float, least: float) -> GeometryError:
    """Error of heat that takes the backlash, at the temperature that takes most of it."""
    room = heat.reference_temperature
    cold = dataclasses.replace(
        heat, pinion_temperature=room, wheel_temperature=room, housing_temperature=room
    )

    def alone(name: str) -> float:
        return _backlash(pair, dataclasses.replace(cold, **{name: getattr(heat, name)}))

    key = min(("pinion_temperature", "wheel_temperature", "housing_temperature"), key=alone)
    part_temperature, housing = float(getattr(heat, key)), key == "housing_temperature"
    low, high = (part_temperature, TEMPERATURE.high) if housing else (TEMPERATURE.low, part_temperature)

    def short(temperature: Array) -> Booleans:
        remaining = _backlash(pair, dataclasses.replace(heat, **{key: float(temperature[0])}))
        return np.array([remaining < least if housing else remaining > least])

    bound = float(bisect(short, np.array([low]), np.array([high]))[0])
    allowed = f"must be at least {rounded_up(bound + WITHIN)} K"
    if not housing:
        allowed = f"must be at most {rounded_down(bound - WITHIN)} K"
    if not low + WITHIN < bound < high - WITHIN:
        allowed = "must leave some backlash, which no temperature of this part alone does"
    said = f"{1e6 * backlash:.4g} um" if math.isfinite(backlash) else "nothing"
    remedy = (
        f"heat leaves {said} of a backlash of {1e6 * pair.backlash:.4g} um: give more backlash or a longer "
    )
    remedy += "centre distance"
    if not pair.tight and backlash >= -TIGHTEST * pair.module:
        remedy += ", or let both sides of the teeth bear: tight = true"
    return GeometryError.at(f"heat.{key}", f"{part_temperature:g}", allowed, remedy)
