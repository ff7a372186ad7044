"""Contacts beside a sharp tip corner as fields take them: the strips' pressure instead of Hertz's.

Two of five positions of a mesh cycle have such a contact (the article's pair, 600 N m). Hertz's field cut off at the
corner would have 2.5 instead of 1.1 GPa at A.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from base import record
from fem.cycle.result import MeshCycle
from fem.elasticity import flamant
from fem.elasticity.line_load import flank_points
from fem.elasticity.plane_elasticity import reduced_modulus
from fem.elasticity.ring import Ring
from fem.elasticity.support import held_profiles
from fem.fields.near_field import Contact
from fem.fields.tip_sector import tip_sector
from fem.laws.tip_pressure import TipPressure, tip_pressure
from fem.pair.pair_compliance import PairCompliance

if TYPE_CHECKING:
    from gears import ToothProfile

__all__ = ["CornerPressure", "corner_contact", "corner_pressure"]

NEAR_CORNER = 1.5
"""Half-widths from a sharp corner within which a contact's pressure is that of strips."""

UNBOUNDED, LEAST_UNRESOLVED = 1.2, 0.01
"""Pressure beside a corner over Hertz's largest one above which stresses are only indicative, and the smallest distance
[modules] up to which they are."""


@record
class CornerPressure:
    """Pressure that a corner makes or cuts off, the same on both gears.

    Attributes
    ----------
    corner : {0, 1}
        The gear whose corner is near.
    pressure : TipPressure
    unresolved : float
        Distance from the corner up to which stresses are only indicative [m].
    """

    corner: int
    pressure: TipPressure
    unresolved: float


def corner_pressure(
    cycle: MeshCycle, row: int, column: int, half_width: float, bodies: PairCompliance
) -> CornerPressure | None:
    """Pressure of a contact by the strips that bear.

    Parameters
    ----------
    cycle : MeshCycle
    row, column : int
        Of the cycle.
    half_width : float
        Of the contact's pressure, or one that is assumed [m].
    bodies : PairCompliance

    Returns
    -------
    CornerPressure or None
        None where no corner presses or cuts off the pressure, or its law is another.
    """
    corner = _near_corner(cycle, row, column, half_width, bodies)
    if corner is None:
        return None
    pair = bodies.pair
    place = float(pair.points.A + (cycle.position[row] + cycle.pair_offset[column]) * pair.base_pitch)
    line_load = float(cycle.forces[row, column]) / pair.face_width
    pressure = tip_pressure(bodies, corner, place, line_load)
    radius = pair.path_at(np.clip(place, pair.points.A, pair.points.E)).radius
    hertz = float(flamant.hertz_half_width(line_load, radius, reduced_modulus(pair, cycle.plane))[0])
    unresolved = _unresolved(pressure, 2 * line_load / (np.pi * hertz), pair.module)
    return CornerPressure(corner, pressure, unresolved)


def _near_corner(
    cycle: MeshCycle, row: int, column: int, half_width: float, bodies: PairCompliance
) -> int | None:
    """Gear whose corner presses or cuts off the pressure; None where it does neither, or its law is another."""
    for corner, gear in enumerate((bodies.pinion, bodies.wheel)):
        rho = cycle.flank_rho[corner][row, column]
        away = (gear.rho_end**2 - rho**2) / (2 * gear.base_radius)
        if cycle.strips_at_corners[corner] and away < NEAR_CORNER * half_width:
            return corner
    return None


def corner_contact(
    near: CornerPressure, tooth: int, gear: int, ring: Ring, bodies: PairCompliance
) -> Contact:
    """Contact on one gear.

    Parameters
    ----------
    near : CornerPressure
    tooth : int
        Of the gear, counted anticlockwise.
    gear : {0, 1}
    ring : Ring
        Of the gear.
    bodies : PairCompliance
    """
    of = _on_corner if gear == near.corner else _on_flank
    contact = of(tooth, ring, held_profiles(bodies.pair, bodies.supports)[gear], bodies, near.pressure)
    return replace(contact, unresolved=near.unresolved)


def _unresolved(pressure: TipPressure, hertz: float, module: float) -> float:
    """Distance from the corner up to which the pressure, unbounded there, is well above Hertz's largest one."""
    if pressure.distance[0] > pressure.width[0]:  # it does not reach the corner
        return 0.0
    above = np.minimum.accumulate(pressure.pressure > UNBOUNDED * hertz)
    end = float(np.max((pressure.distance + 0.5 * pressure.width)[above], initial=0.0))
    return max(end, LEAST_UNRESOLVED * module)


def _on_corner(
    tooth: int, ring: Ring, profile: ToothProfile, bodies: PairCompliance, pressure: TipPressure
) -> Contact:
    """Contact on the gear with the corner: its resultant on the ring, its strips on a separate sector."""
    middle = np.sqrt(profile.flank_rho[1] ** 2 - 2 * profile.base_radius * pressure.mean(pressure.distance))
    at = flank_points(ring.mesh, np.array([middle]))
    away = -np.sign(at.towards_tip().lean) * pressure.mean(pressure.lean)
    sector = tip_sector(profile, bodies.sizes, bodies.refinements, pressure)
    load = float(np.sum(pressure.loads))
    corner = flank_points(sector.mesh, np.array([profile.flank_rho[1]])).points[0]
    return Contact(tooth, replace(at, lean=away), load, 0.5 * pressure.extent, sector=sector, corner=corner)


def _on_flank(
    tooth: int, ring: Ring, profile: ToothProfile, bodies: PairCompliance, pressure: TipPressure
) -> Contact:
    """Contact on the gear whose flank the corner touches: the strips' pressure on a half-plane."""
    arc = pressure.touched**2 / (2 * profile.base_radius)
    middle = pressure.mean(arc)
    at = flank_points(ring.mesh, np.array([np.sqrt(2 * profile.base_radius * middle)]))
    hand = np.sign(at.towards_tip().lean)
    stretch = abs(arc[-1] - arc[0]) / abs(pressure.distance[-1] - pressure.distance[0])
    strips = np.stack([hand * (arc - middle), stretch * pressure.width, pressure.loads])
    load, half_width = float(np.sum(pressure.loads)), 0.5 * stretch * pressure.extent
    corner = flank_points(ring.mesh, pressure.touched[:1]).points[0]
    return Contact(tooth, at, load, half_width, strips=strips, corner=corner)
