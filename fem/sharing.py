"""Contact of all pairs at all positions and torques: compliances, laws and levers put together and solved."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from base import Array, record
from fem.bodies import Compliance
from fem.contact_candidates import REACHES, ContactCandidates, contact_candidates
from fem.cut_off import cut_offs
from fem.edge_tables import EdgeTables
from fem.local_law import Film, FilmLaw, PairLaws
from fem.moving_contact import ContactMoves, contact_moves, moved_share
from fem.setting import Setting

if TYPE_CHECKING:
    from gears import LoadShare

__all__ = ["Solution", "solve"]


@record
class Solution:
    """Solution for all torques: shares with leading dimensions (torques, pitches, positions of one).

    kappa and levers belong to the normal and to the tilted force, largest is what the tip edges' laws cover,
    closing the deflection less the hubs' wind-up, open the gap that is left where a pair does not bear. With moving
    contacts that do not settle, share is the one of contacts that stay, and settled is False.
    """

    where: ContactCandidates
    share: LoadShare
    kappa: Array
    levers: Array
    largest: Array
    closing: Array
    open: Array
    moves: ContactMoves | None
    settled: bool

    @property
    def touch(self) -> Array:
        """Transmission error at which the gears touch without load (pitches, positions) [m]."""
        return np.asarray(self.where.gap.min(axis=-1))

    def refusal(self, number: int) -> str:
        """Why the solution for a torque is not to be believed, empty if it is."""
        where, turned = self.where, self.share.forces[number]
        if not self.settled:
            most = 1e3 * np.max(self.share.transmission_error)
            return (
                f"a deflection of {most:.2g} mm is far beyond the first order of contacts that move; reduce the "
                "torque, or let contacts stay (moving_contact)"
            )
        if where.edge.any() and np.any(turned[..., where.edge] > self.largest):
            return "a tip edge presses over more than the strips cover; reduce the torque"
        if np.max(self.closing[number] + self.touch) > where.reach_gap:
            return (
                "the deflection closes gaps more than a base pitch outside the path, where no contact was looked "
                "for; reduce the torque or the deviations"
            )
        if np.any(turned[..., where.chamfered] > 0):
            return "a chamfer's face touches before its corner does, for which there is no law; reduce the torque"
        return ""


def solve(
    given: Setting, bodies: Compliance, force: Array, film: Film | None, tables: EdgeTables | None = None
) -> Solution:
    """Solve, with candidates farther out if the deflection reaches beyond the first ones.

    Parameters
    ----------
    given : Setting
    bodies : Compliance
    force : (torques,) array
        [N]
    film : Film or None
    tables : EdgeTables, optional
        Laws of the tip edges of gears that are set up likewise, to be used again.
    """
    from gears.load_sharing import share_load

    tables = tables or EdgeTables(given, bodies)
    for reach in REACHES:
        where = contact_candidates(given, reach)
        kappa = np.where(where.touchable, where.lever[0, : given.positions], 1.0)
        table, largest = tables.at(where)
        rho1, rho2 = where.rho
        matrix = bodies.bulk(rho1, rho2, where.leaning)
        _leave_out_corner(bodies, matrix, where)
        # A force along another normal than the line of action has the lever kappa r_b1 about the pinion's
        # axis. In F' = kappa F the equations keep their form, with gap/kappa and bulk_ij/(kappa_i kappa_j);
        # the edges' laws are in F' already.
        matrix /= kappa[..., :, None] * kappa[..., None, :]
        on_path = where.touchable & ~where.edge
        middle = given.pair.points.A + 0.5 * (given.pair.points.E - given.pair.points.A)
        # contacts that move have a law of their own near the corner
        near = () if given.moving_contact else cut_offs(given, bodies, where, float(np.max(force)))
        laws = PairLaws(bodies.hertz(np.where(on_path, rho1, middle)), where.edge, table, near)
        oil = None if film is None else FilmLaw(film, np.where(on_path, rho1, np.nan))
        levers = _levers(given, where) / kappa
        touch = where.gap.min(axis=-1)
        share = share_load(
            force[:, None, None],
            matrix,
            laws,
            where.gap - touch[..., None],
            oil,
            levers if given.friction else None,
        )
        moves, settled = contact_moves(bodies, where) if given.moving_contact else None, True
        if moves is not None:
            gaps = where.gap - touch[..., None]
            moved = moved_share(share, force[:, None, None], matrix, laws, gaps, oil, levers, moves)
            settled = moved is not None
            share = share if moved is None else moved
        closing = share.transmission_error - bodies.turning * force[:, None, None]
        if np.max(closing + touch) <= where.reach_gap:
            break
    propped = 0.0 if oil is None else oil.approach(np.zeros_like(share.forces))
    bent = (matrix @ share.forces[..., None])[..., 0] + where.gap - touch[..., None]
    left = bent - propped - share.transmission_error[..., None]
    if moves is not None:
        left = left + share.transmission_error[..., None] * moves.rolled(share.forces)
    return Solution(where, share, kappa, levers, largest, closing, left, moves, settled)


def _levers(given: Setting, where: ContactCandidates) -> Array:
    """Levers about the pinion's axis of forces tilted by friction, over r_b1 (positions, pairs)."""
    lever, arm = where.lever[:, : given.positions], where.tangent_arm[:, : given.positions]
    first, second = given.pair.base_radii
    arm = np.where(where.touchable, arm, 0.0)
    slip = np.sign(arm[0] / first - arm[1] / second)
    return np.asarray(lever[0] + given.friction * slip * arm[0] / first)


def _leave_out_corner(bodies: Compliance, matrix: Array, where: ContactCandidates) -> None:
    """Keep of the corner's gear only its turn on the hub: the edge's law holds its tooth and body already.

    The turn stays with that of the other pairs, so that with a weak hub the matrix remains definite.
    """
    width = bodies.pair.face_width
    for corner, chosen in where.corners():
        gear = (bodies.pinion, bodies.wheel)[corner]
        position, column = np.nonzero(chosen)
        rho = np.clip(where.rho[corner][position, column], *gear.rho_range)
        angle = where.leaning[corner][position, column]
        lever = np.cos(angle) - np.sin(angle) * rho / gear.base_radius
        matrix[position, column, column] -= (gear.own(rho) - gear.hub_windup * lever**2) / width
