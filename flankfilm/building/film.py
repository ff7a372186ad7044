"""From the scene's keys of oil, supply and roughness to the objects of `ehl`, in SI."""

from __future__ import annotations

from dataclasses import replace
from typing import Any, TypedDict

import ehl
import gears
from base import InputError
from ehl.oil.oil_grades import LIMITS as GRADE
from flankfilm import coupling
from flankfilm.scene.schema import Scene
from flankfilm.scene.sections.film import (
    BY_GRADE,
    BY_NUMBERS,
    SHEAR_AND_HEAT,
    LubricantSection,
    RoughnessSection,
)
from flankfilm.scene.sections.ground import under_keys
from flankfilm.scene.sections.heat import GROWTH
from flankfilm.scene.sections.key import ZERO_CELSIUS
from flankfilm.scene.sections.section import required


class Rubbing(TypedDict, total=False):
    """Friction of the asperities and its band."""

    boundary_friction: float
    boundary_band: tuple[float, float] | None


def lubricant(scene: Scene) -> ehl.Lubricant:
    """Build the oil of a scene, as it is at the temperature of the flanks.

    Raises
    ------
    InputError
        Without the section, and with every fault that only the oil's laws find.
    """
    section = required(scene.lubricant, "[lubricant]", "the film")
    flanks = flank_temperatures(scene)
    at = None if flanks is None else 0.5 * sum(flanks)
    if at is not None and section.graded and not GRADE["temperature"].holds(at):
        value, allowed = (
            f"{at - ZERO_CELSIUS:g}",
            "must be from -20 to 150 degC in the mean, where grades are known",
        )
        raise InputError.at("heat.pinion_temperature_C", value, allowed, "Give the oil by its numbers")
    with under_keys(section, "lubricant"):
        return _by_grade(section, at) if section.graded else _by_numbers(section, at)


def flank_temperatures(scene: Scene) -> tuple[float, float] | None:
    """Temperatures of the flanks of pinion and wheel [K]; None where they have the oil's."""
    if scene.heat is None or not scene.heat.given_keys("pinion_temperature_C", "wheel_temperature_C"):
        return None
    heat = gears.Heat(**scene.heat.si(*GROWTH))
    return heat.pinion_temperature, heat.wheel_temperature


def _by_grade(section: LubricantSection, at: float | None) -> ehl.Lubricant:
    """Oil of a grade at its own temperature, or at that of the flanks [K]."""
    arguments = section.si(*BY_GRADE, "temperature_C", "compressible") | (
        {} if at is None else {"temperature": at}
    )
    oil = ehl.Lubricant.from_iso_vg(**arguments)
    return replace(oil, **_law(section), **section.si(*SHEAR_AND_HEAT))


def _by_numbers(section: LubricantSection, at: float | None) -> ehl.Lubricant:
    """Oil by its numbers, which hold at the temperature beside them, or at that of the flanks [K]."""
    numbers = section.si(*BY_NUMBERS, *SHEAR_AND_HEAT, "temperature_C", "compressible")
    oil = ehl.Lubricant(**numbers | _law(section))
    if at is None:
        return oil
    return replace(oil, temperature=at) if section.temperature_C is None else oil.at_temperature(at)


def _law(oil: LubricantSection) -> dict[str, Any]:
    """Numbers by which a law of viscosity is meant."""
    law: dict[str, Any] = {}
    if oil.constant_viscosity:
        law["pressure_viscosity"] = 0.0
    if oil.viscosity_law == "barus":
        law["roelands_z"] = 1.0  # Roelands' law of this index is Barus' law
    return law


def film_model(scene: Scene, name: str) -> coupling.FilmModel:
    """How the films of a scene are computed, by the model of the given name."""
    return coupling.FilmModel(name, scene.film.stiffness, supply(scene), roughness(scene), scene.film.grid)


def supply(scene: Scene) -> ehl.Meniscus | ehl.OilLayer | coupling.PlacedMeniscus | None:
    """Give what a scene holds at the inlet; None for flooded contacts."""
    film = scene.film
    if film.oil_layer_um is not None:
        return ehl.OilLayer(**film.si("oil_layer_um"))
    if film.meniscus_half_widths is not None:
        return coupling.PlacedMeniscus(film.meniscus_half_widths)
    return None if film.meniscus_mm is None else ehl.Meniscus(-film.value("meniscus_mm"))


def roughness(scene: Scene) -> ehl.Roughness | None:
    """Build the roughness of a scene; None for smooth flanks."""
    rough = scene.roughness
    if rough is None:
        return None
    asperities = rough.si("density_per_mm2", "tip_radius_um", "law", "mean_plane_offset")
    with under_keys(scene, ""):
        if rough.sigma_um is not None:
            return ehl.Roughness.of_deviation(rough.value("sigma_um"), **asperities)
        mean, peaks = (_of_flanks(rough, name) for name in ("Ra_um", "Rz_um"))
        return ehl.Roughness.from_drawing(mean, peaks, **asperities)


def boundary_friction(scene: Scene) -> Rubbing:
    """Friction of the asperities of a scene and its band, as losses take them; nothing for smooth flanks."""
    rough = scene.roughness
    if rough is None:
        return {}
    return {"boundary_friction": rough.boundary_friction, "boundary_band": rough.boundary_friction_band}


def _of_flanks(rough: RoughnessSection, name: str) -> tuple[float, float] | None:
    """Roughness of pinion and wheel by the name of its key [m]; None where it was not given."""
    pinion, wheel = rough.value(name), rough.value(f"wheel_{name}")
    return None if pinion is None else (pinion, pinion if wheel is None else wheel)
