"""From the scene's keys of oil, supply and roughness to the objects of `ehl`, in SI."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from base import Fault, InputError
from flankfilm.scene.film import BY_GRADE, BY_NUMBERS, LubricantSection
from flankfilm.scene.ground import under_keys
from flankfilm.scene.schema import Scene

if TYPE_CHECKING:
    from ehl import LineContact, Lubricant, Meniscus, OilLayer, Roughness


def lubricant(scene: Scene) -> Lubricant:
    """Build the oil of a scene.

    Raises
    ------
    InputError
        Without the section, and with every fault that only the oil's laws find.
    """
    oil = scene.lubricant
    if oil is None:
        raise InputError([Fault("[lubricant]", "", "is required by the film", "Add the section [lubricant]")])
    with under_keys(oil, "lubricant"):
        return _graded(oil) if oil.graded else _by_numbers(oil)


def supply_of(scene: Scene, contact: LineContact) -> Meniscus | OilLayer | None:
    """Give what a scene holds at a contact's inlet; None for a flooded one.

    A meniscus in half-widths is placed by the contact's own load, and stays in that place when the load
    changes from there.

    Raises
    ------
    InputError
        For a meniscus inside the dry contact.
    """
    from ehl import Meniscus, OilLayer

    film = scene.film
    if film.oil_layer_um is not None:
        return OilLayer(**film.si("oil_layer_um"))
    if film.meniscus_half_widths is not None:
        return Meniscus(-film.meniscus_half_widths * contact.half_width)
    if film.meniscus_mm is None:
        return None
    ahead = film.value("meniscus_mm")
    if ahead <= contact.half_width:
        allowed = (
            f"must be more than {1e3 * contact.half_width:.4g} mm, the half-width of a contact on the path"
        )
        remedy = "Nearer in no film forms; move it out, or give meniscus_half_widths"
        raise InputError([Fault("film.meniscus_mm", f"{film.meniscus_mm:g}", allowed, remedy)])
    return Meniscus(-ahead)


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
