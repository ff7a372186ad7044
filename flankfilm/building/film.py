"""The oil, the supply and the roughness of a scene as objects of `ehl`, at the temperature of its flanks."""

from __future__ import annotations

import ehl
from base import InputError
from ehl.oil.oil_grades import LIMITS as GRADE
from flankfilm import coupling
from flankfilm.scene.schema import Scene
from flankfilm.scene.sections.ground import under_keys
from flankfilm.scene.sections.key import ZERO_CELSIUS
from flankfilm.scene.sections.roughness import Rubbing
from flankfilm.scene.sections.section import required


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
        return section.lubricant(at)


def flank_temperatures(scene: Scene) -> tuple[float, float] | None:
    """Temperatures of the flanks of pinion and wheel [K]; None where they have the oil's."""
    return None if scene.heat is None else scene.heat.flank_temperatures


def film_model(scene: Scene, name: str) -> coupling.FilmModel:
    """How the films of a scene are computed, by the model of the given name."""
    return coupling.FilmModel(
        name, scene.film.stiffness, scene.film.inlet(), roughness(scene), scene.film.grid
    )


def supply(scene: Scene) -> ehl.Meniscus | ehl.OilLayer | coupling.PlacedMeniscus | None:
    """Supply that a scene holds at the inlet; None for flooded contacts."""
    return scene.film.inlet()


def roughness(scene: Scene) -> ehl.Roughness | None:
    """Build the roughness of a scene; None for smooth flanks."""
    with under_keys(scene, ""):
        return None if scene.roughness is None else scene.roughness.roughness()


def boundary_friction(scene: Scene) -> Rubbing:
    """Friction of the asperities of a scene and its band, as losses take them; nothing for smooth flanks."""
    return {} if scene.roughness is None else scene.roughness.rubbing
