"""Faults of what losses of a mesh are asked from."""

from __future__ import annotations

import numpy as np

import ehl
from base import Faults, Limit
from ehl.discrete.regimes import BOUNDARY
from fem.contact.moving_contact import COMPLIANT
from flankfilm.coupling.films.films import Held, PlacedMeniscus
from flankfilm.coupling.mesh.loaded_teeth import LoadedTeeth

BALANCE = Limit.above(0.0, 1e6, "W/K", "heat transfer coefficient times area; 1 to 100 W/K are usual")
TEMPERATURE = Limit(200.0, 600.0, "K", "353.15 is 80 degC")
POSITIONS = Limit(2, whole=True)


def check_bodies(
    faults: Faults, teeth: LoadedTeeth, lubricant: ehl.Lubricant, solids: tuple[ehl.Solid, ehl.Solid]
) -> None:
    """Note what is missing of the oil and the bodies, and friction that is given where it is sought."""
    if lubricant.eyring_stress is None:
        remedy = "5e6 to 1e7 Pa is usual: a Newtonian oil's friction and heat have no bound at the pressures of gears"
        faults.add("lubricant.eyring_stress", None, "must be given for losses", remedy)
    if teeth.flanks.friction:
        faults.add("flanks.friction", teeth.flanks.friction, "must be 0: it is found here", "leave it out")
    remedy = "give ehl.Solid(conductivity, density, heat_capacity) of pinion and wheel"
    if len(solids) != 2 or not all(isinstance(solid, ehl.Solid) for solid in solids):
        faults.add("solids", solids, "must be two of ehl.Solid", remedy)
        return
    for name, body, material in zip(("pinion", "wheel"), solids, teeth.pair.materials, strict=True):
        if material.youngs_modulus < COMPLIANT and body == ehl.STEEL:
            description = f"steel, of a {name} of {1e-9 * material.youngs_modulus:.3g} GPa"
            faults.add("solids", description, "must be the gear's own", remedy)


def check_temperatures(
    faults: Faults,
    bulk: tuple[float, float] | None,
    transfer: tuple[float, float] | None,
    ambient: float | None,
) -> None:
    """Note temperatures and heat transfer that are out of bounds or do not go together."""
    for name, two, limit in (("bulk_temperatures", bulk, TEMPERATURE), ("heat_transfer", transfer, BALANCE)):
        if two is None:
            continue
        if np.shape(two) != (2,):
            faults.add(name, two, "must be two numbers", "give pinion and wheel")
            continue
        for value in two:
            faults.number(name, value, limit)
    if ambient is not None:
        faults.number("ambient_temperature", ambient, TEMPERATURE)
    if bulk is not None and transfer is not None:
        faults.add("bulk_temperatures", bulk, "must be left out beside heat_transfer", "give one of them")
    if (ambient is None) != (transfer is None):
        present, missing = "ambient_temperature", "heat_transfer"
        if ambient is None:
            present, missing = missing, present
        faults.add(missing, None, f"must be given beside {present}", "give both, or neither")


def check_numbers(
    faults: Faults,
    boundary: float,
    band: tuple[float, float] | None,
    positions: int,
    roughness: ehl.Roughness | None,
    supply: Held,
) -> None:
    """Note faults of the rest."""
    faults.number("boundary_friction", boundary, BOUNDARY)
    if band is not None and not _around(band, boundary):
        allowed = f"must be two numbers from 0 to {BOUNDARY.high:g} with {boundary:g} between them"
        faults.add("boundary_band", band, allowed, "(0.08, 0.12) is usual")
    faults.number("positions", positions, POSITIONS)
    if roughness is not None and not isinstance(roughness, ehl.Roughness):
        faults.add("roughness", roughness, "must be an ehl.Roughness", "build one, or leave it out")
    if supply is not None and not isinstance(supply, ehl.Meniscus | ehl.OilLayer | PlacedMeniscus):
        allowed = "must be an ehl.Meniscus, an ehl.OilLayer or a coupling.PlacedMeniscus"
        faults.add("supply", supply, allowed, "build one, or leave it out for flooded contacts")


def _around(band: tuple[float, float], boundary: float) -> bool:
    """Whether a band is two numbers, the lower first, with a friction between them."""
    if np.shape(band) != (2,):
        return False
    low, high = band
    return BOUNDARY.holds(low) and BOUNDARY.holds(high) and low <= boundary <= high
