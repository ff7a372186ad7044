"""From the scene's keys of oil, supply and roughness to the objects of `ehl`, in SI."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from base import InputError
from flankfilm.scene.film import BY_GRADE, BY_NUMBERS, LubricantSection
from flankfilm.scene.ground import under_keys
from flankfilm.scene.schema import Scene

if TYPE_CHECKING:
    from ehl import Lubricant, Meniscus, OilLayer, Roughness
    from flankfilm.coupling import FilmModel, PlacedMeniscus


def lubricant(scene: Scene) -> Lubricant:
    """Build the oil of a scene.

    Raises
    ------
    InputError
        Without the section, and with every fault that only the oil's laws find.
    """
    oil = scene.lubricant
    if oil is None:
        raise InputError.at("[lubricant]", "", "is required by the film", "Add the section [lubricant]")
    with under_keys(oil, "lubricant"):
        return _graded(oil) if oil.graded else _by_numbers(oil)


def film_model(scene: Scene, name: str) -> FilmModel:
    """How the films of a scene are computed, by the model of the given name."""
    from flankfilm.coupling import FilmModel

    return FilmModel(name, scene.film.stiffness, _supply(scene), roughness(scene), scene.film.grid)


def _supply(scene: Scene) -> Meniscus | OilLayer | PlacedMeniscus | None:
    """Give what a scene holds at the inlet; None for flooded contacts."""
    from ehl import Meniscus, OilLayer
    from flankfilm.coupling import PlacedMeniscus

    film = scene.film
    if film.oil_layer_um is not None:
        return OilLayer(**film.si("oil_layer_um"))
    if film.meniscus_half_widths is not None:
        return PlacedMeniscus(film.meniscus_half_widths)
    return None if film.meniscus_mm is None else Meniscus(-film.value("meniscus_mm"))


def roughness(scene: Scene) -> Roughness | None:
    """Build the roughness of a scene; None for smooth flanks."""
    from ehl import Roughness

    rough = scene.roughness
    if rough is None:
        return None
    with under_keys(scene, ""):
        return Roughness(**rough.si())


def _by_numbers(oil: LubricantSection) -> Lubricant:
    from ehl import Lubricant

    given = oil.si(*BY_NUMBERS, "compressible")
    if oil.constant_viscosity:
        given["pressure_viscosity"] = 0.0
    if oil.viscosity_law == "barus":
        given["roelands_z"] = 1.0  # Roelands' law of this index is Barus' law
    return Lubricant(**given)


def _graded(oil: LubricantSection) -> Lubricant:
    from ehl import Lubricant

    found = Lubricant.from_iso_vg(**oil.si(*BY_GRADE, "compressible"))
    if oil.viscosity_law == "barus":
        return replace(found, roelands_z=1.0)
    return replace(found, pressure_viscosity=0.0) if oil.constant_viscosity else found
