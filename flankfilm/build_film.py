"""From the scene's keys of oil, supply and roughness to the objects of `ehl`, in SI."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, TypeVar

from base import Fault, InputError
from flankfilm.scene.film_schema import LubricantSection
from flankfilm.scene.schema import Scene

if TYPE_CHECKING:
    from ehl import LineContact, Lubricant, Meniscus, OilLayer, Roughness

T = TypeVar("T")

ZERO_CELSIUS = 273.15

_KEYS = {
    "viscosity": "lubricant.viscosity_Pa_s",
    "pressure_viscosity": "lubricant.pressure_viscosity_per_GPa",
    "density": "lubricant.density_kg_per_m3",
    "roelands_z": "lubricant.roelands_z",
    "vg": "lubricant.iso_vg",
    "temperature": "lubricant.temperature_C",
    "viscosity_index": "lubricant.viscosity_index",
    "density_15": "lubricant.density_15_kg_per_m3",
    "roughness.deviation": "roughness.sigma_um",
    "roughness.density": "roughness.density_per_mm2",
    "roughness.tip_radius": "roughness.tip_radius_um",
    "supply.thickness": "film.oil_layer_um",
}
"""The scene's keys for what a fault of the film's solver names."""


def lubricant(scene: Scene) -> Lubricant:
    """Build the oil of a scene.

    Raises
    ------
    InputError
        Without the section, and with every fault that only the oil's laws can tell.
    """
    oil = scene.lubricant
    if oil is None:
        raise InputError([Fault("[lubricant]", "", "is required by the film", "Add the section [lubricant]")])
    return _explained(lambda: _graded(oil) if oil.graded else _by_numbers(oil))


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
        return OilLayer(1e-6 * film.oil_layer_um)
    if film.meniscus_half_widths is not None:
        return Meniscus(-film.meniscus_half_widths * contact.half_width)
    if film.meniscus_mm is None:
        return None
    if 1e-3 * film.meniscus_mm <= contact.half_width:
        edge = 1e3 * contact.half_width
        told = f"must be more than {edge:.4g}, the half-width of a contact on the path"
        remedy = "Nearer in no film forms; move it out, or give meniscus_half_widths"
        raise InputError([Fault("film.meniscus_mm", f"{film.meniscus_mm:g}", told, remedy)])
    return Meniscus(-1e-3 * film.meniscus_mm)


def roughness(scene: Scene) -> Roughness | None:
    """Build the roughness of a scene; None for smooth flanks."""
    from ehl import Roughness

    rough = scene.roughness
    if rough is None:
        return None
    return _explained(
        lambda: Roughness(
            deviation=1e-6 * rough.sigma_um,
            density=1e6 * rough.density_per_mm2,
            tip_radius=1e-6 * rough.tip_radius_um,
            law=rough.law,
            offset=rough.mean_plane_offset,
        )
    )


def _by_numbers(oil: LubricantSection) -> Lubricant:
    from ehl import Lubricant

    alpha = 0.0 if oil.constant_viscosity else 1e-9 * (oil.pressure_viscosity_per_GPa or 0.0)
    return Lubricant(
        viscosity=oil.viscosity_Pa_s or 0.0,
        pressure_viscosity=alpha,
        density=oil.density_kg_per_m3 or 870.0,
        # Roelands' law of index 1 is Barus' law
        roelands_z=1.0 if oil.viscosity_law == "barus" else oil.roelands_z,
        compressible=oil.compressible,
    )


def _graded(oil: LubricantSection) -> Lubricant:
    from dataclasses import replace

    from ehl import Lubricant

    found = Lubricant.from_iso_vg(
        oil.iso_vg or 0.0,
        (oil.temperature_C or 0.0) + ZERO_CELSIUS,
        viscosity_index=95.0 if oil.viscosity_index is None else oil.viscosity_index,
        base=oil.base or "mineral",
        density_15=oil.density_15_kg_per_m3,
        compressible=oil.compressible,
    )
    if oil.viscosity_law == "barus":
        return replace(found, roelands_z=1.0)
    return replace(found, pressure_viscosity=0.0) if oil.constant_viscosity else found


def _explained(build: Callable[[], T]) -> T:
    """Build, with the faults of the film's solver under the scene's keys."""
    try:
        return build()
    except InputError as error:
        raise InputError(
            Fault(_KEYS.get(f.where, f.where), f.value, f.allowed, f.remedy) for f in error.faults
        ) from error
