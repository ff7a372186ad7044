"""From the scene's keys of oil, supply and roughness to the objects of `ehl`, in SI."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import ehl
from flankfilm import coupling
from flankfilm.scene.film import BY_GRADE, BY_NUMBERS, RoughnessSection
from flankfilm.scene.ground import under_keys
from flankfilm.scene.schema import Scene
from flankfilm.scene.section import required


def lubricant(scene: Scene) -> ehl.Lubricant:
    """Build the oil of a scene.

    Raises
    ------
    InputError
        Without the section, and with every fault that only the oil's laws find.
    """
    oil = required(scene.lubricant, "[lubricant]", "the film")
    law: dict[str, Any] = {}
    if oil.constant_viscosity:
        law["pressure_viscosity"] = 0.0
    if oil.viscosity_law == "barus":
        law["roelands_z"] = 1.0  # Roelands' law of this index is Barus' law
    with under_keys(oil, "lubricant"):
        if not oil.graded:
            return ehl.Lubricant(**oil.si(*BY_NUMBERS, "compressible") | law)
        graded = ehl.Lubricant.from_iso_vg(**oil.si(*BY_GRADE, "compressible"))
        return replace(graded, **law) if law else graded


def film_model(scene: Scene, name: str) -> coupling.FilmModel:
    """How the films of a scene are computed, by the model of the given name."""
    return coupling.FilmModel(name, scene.film.stiffness, _supply(scene), roughness(scene), scene.film.grid)


def _supply(scene: Scene) -> ehl.Meniscus | ehl.OilLayer | coupling.PlacedMeniscus | None:
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


def _of_flanks(rough: RoughnessSection, name: str) -> tuple[float, float] | None:
    """Roughness of pinion and wheel by the name of its key [m]; None where it was not given."""
    pinion, wheel = rough.value(name), rough.value(f"wheel_{name}")
    return None if pinion is None else (pinion, pinion if wheel is None else wheel)
