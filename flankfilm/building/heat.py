"""From the scene's keys of heat to what films with heat and the mesh's losses are computed from, in SI."""

from __future__ import annotations

from dataclasses import dataclass, replace

import ehl
import gears
from flankfilm.building.film import flank_temperatures, lubricant
from flankfilm.scene.schema import Scene

USUAL_STRESS = 5e6
"""Eyring's stress of an oil that does not say its own [Pa]: the lower end of 5 to 10 MPa, where most oils lie."""


@dataclass(frozen=True)
class Warmth:
    """Temperatures of the flanks, or what decides them.

    Attributes
    ----------
    bulk : (float, float) or None
        Of pinion and wheel [K]; None where they are balanced.
    transfer : (float, float) or None
        Heat transfer of both [W/K], where they are.
    ambient : float or None
        Temperature of what takes the heat then [K].
    """

    bulk: tuple[float, float] | None
    transfer: tuple[float, float] | None = None
    ambient: float | None = None


def shearing_oil(scene: Scene) -> ehl.Lubricant:
    """Oil of a scene, with the usual stress at which it thins unless it has its own."""
    oil = lubricant(scene)
    return oil if oil.eyring_stress is not None else replace(oil, eyring_stress=USUAL_STRESS)


def solids(pair: gears.GearPair) -> tuple[ehl.Solid, ehl.Solid]:
    """What pinion and wheel do with heat, by their materials."""
    first, second = (
        ehl.Solid(material.conductivity, material.density, material.heat_capacity)
        for material in pair.materials
    )
    return first, second


def warmth(scene: Scene) -> Warmth:
    """Temperatures of the flanks: given by [heat], balanced by its heat transfer, or those of the oil."""
    if (temperatures := flank_temperatures(scene)) is not None:
        return Warmth(temperatures)
    at = lubricant(scene).temperature
    transfer = None if scene.heat is None else scene.heat.heat_transfer_W_per_K
    if scene.heat is None or transfer is None:
        return Warmth((at, at))
    ambient = scene.heat.value("ambient_temperature_C")
    return Warmth(None, transfer.each, at if ambient is None else ambient)
