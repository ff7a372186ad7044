"""Flanks on one side of the teeth: candidates, compliances, laws and levers of all contacts, put together."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from base import Array, record
from fem.laws.contact_candidates import ContactCandidates, contact_candidates
from fem.laws.cut_off import cut_offs
from fem.laws.edge_tables import EdgeTables
from fem.laws.local_law import Film, FilmLaw, PairLaws
from fem.laws.mesh_setup import MeshSetup

if TYPE_CHECKING:
    from fem.influence.gear_compliance import GearCompliance
    from fem.pair.pair_compliance import PairCompliance

__all__ = ["FlanksInPlace", "LoadedFlanks", "flanks_in_place", "greatest_force", "hub_lever", "loaded_flanks"]


@record
class FlanksInPlace:
    """Contacts on one side, and what stands between them, before anything yields.

    A force along another normal than the line of action has the lever kappa r_b1 about the pinion's axis.

    Attributes
    ----------
    where : ContactCandidates
    kappa : (positions, pairs) array
    oil : FilmLaw or None
    levers : (positions, pairs) array
        Of the tilted forces about the pinion's axis, over kappa r_b1.
    """

    where: ContactCandidates
    kappa: Array
    oil: FilmLaw | None
    levers: Array


@record
class LoadedFlanks(FlanksInPlace):
    """What the contacts on one side yield, as ``share_load`` asks for it.

    In F' = kappa F the equations keep their form, with gap/kappa and bulk_ij/(kappa_i kappa_j); the edges' laws are in
    F' already.

    Attributes
    ----------
    matrix : (positions, pairs, pairs) array
        bulk_ij/(kappa_i kappa_j) [m/N].
    laws : PairLaws
    largest : (edges,) array
        Forces that the tip edges' laws cover [N].
    """

    matrix: Array
    laws: PairLaws
    largest: Array


def flanks_in_place(given: MeshSetup, film: Film | None, reach: float) -> FlanksInPlace:
    """Place the flanks that bear in a setting; arguments as of ``loaded_flanks``."""
    where = contact_candidates(given, reach)
    kappa = np.where(where.touchable, where.lever[0, : given.positions], 1.0)
    ends = float(given.pair.points.A), float(given.pair.points.E)
    on_path = where.touchable & ~where.edge
    oil = None if film is None else FilmLaw(film, np.where(on_path, np.clip(where.place, *ends), np.nan))
    return FlanksInPlace(where, kappa, oil, _levers(given, where) / kappa)


def loaded_flanks(
    given: MeshSetup,
    bodies: PairCompliance,
    film: Film | None,
    reach: float,
    force: float,
    tables: EdgeTables,
) -> LoadedFlanks:
    """Put together what the flanks yield that bear in a setting.

    Parameters
    ----------
    given : MeshSetup
    bodies : PairCompliance
    film : Film or None
    reach : float
        Base pitches outside the path within which tip edges are looked for.
    force : float
        Maximum force by a torque [N].
    tables : EdgeTables
        Laws of the tip edges.
    """
    placed = flanks_in_place(given, film, reach)
    where, kappa = placed.where, placed.kappa
    table, largest = tables.at(where)
    rho1, rho2 = where.rho
    matrix = bodies.bulk(rho1, rho2, where.leaning)
    _leave_out_corner(bodies, matrix, where)
    matrix /= kappa[..., :, None] * kappa[..., None, :]
    on_path = where.touchable & ~where.edge
    middle = 0.5 * float(given.pair.points.A + given.pair.points.E)
    # contacts that move have a separate law near the corner
    near = (
        () if given.moving_contact else cut_offs(given, bodies, where, greatest_force(bodies, where, force))
    )
    place = np.where(on_path, where.place, middle)
    laws = PairLaws(bodies.hertz(place, where.curvature, kappa), where.edge, table, near)
    return LoadedFlanks(where, kappa, placed.oil, placed.levers, matrix, laws, largest)


def greatest_force(bodies: PairCompliance, where: ContactCandidates, force: float) -> float:
    """Maximum force on a pair by a torque's force [N]: teeth that overlap are pressed on both sides without one."""
    overlap, points = -float(np.min(where.back_gap)), bodies.pair.points
    middle = np.array([0.5 * float(points.A + points.E)])
    return force + (overlap / float(bodies.own(middle)[0]) if overlap > 0.0 else 0.0)


def _levers(given: MeshSetup, where: ContactCandidates) -> Array:
    """Levers about the pinion's axis of forces tilted by friction, over r_b1 (positions, pairs); 1 if none can act."""
    lever, arm = where.lever[:, : given.positions], where.tangent_arm[:, : given.positions]
    first, second = given.pair.base_radii
    arm = np.where(where.touchable, arm, 0.0)
    slip = np.sign(arm[0] / first - arm[1] / second)
    # the gears turn on, whichever flanks bear: on the back flanks all surfaces move the other way
    turning = -given.friction if given.back else given.friction
    return np.asarray(np.where(where.touchable, lever[0], 1.0) + turning * slip * arm[0] / first)


def _leave_out_corner(bodies: PairCompliance, matrix: Array, where: ContactCandidates) -> None:
    """Keep of the corner's gear only its turn on the hub: the edge's law holds its tooth and body already.

    The turn stays with that of the other pairs, so that with a weak hub the matrix remains definite.
    """
    width = bodies.pair.face_width
    for corner, chosen in where.corners():
        gear = (bodies.pinion, bodies.wheel)[corner]
        position, column = np.nonzero(chosen)
        rho = np.clip(where.rho[corner][position, column], *gear.rho_range)
        lever = hub_lever(gear, rho, where.leaning[corner][position, column])
        matrix[position, column, column] -= (gear.own(rho) - gear.hub_windup * lever**2) / width


def hub_lever(gear: GearCompliance, rho: Array, leaning: Array) -> Array:
    """Lever about a gear's axis, over its base radius, of forces that lean from its flank's normal.

    It is that of the cross terms along flank and tangent (``PairCompliance.bulk``), at the last place that these know.
    """
    return np.asarray(np.cos(leaning) - np.sin(leaning) * np.clip(rho, *gear.rho_range) / gear.base_radius)
