"""Contact of all pairs at all positions and torques: compliances, laws and levers put together and solved."""

from __future__ import annotations

from dataclasses import replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from base import Array, record
from fem.contact.clear_flanks import stays_clear
from fem.contact.face_share import FaceShare, share_over_face
from fem.contact.loaded_flanks import LoadedFlanks, loaded_flanks
from fem.contact.moving_contact import ContactMoves, moved_places, moved_share
from fem.contact.moving_corners import DEEPEST, MovedFlanks
from fem.contact.moving_face import moved_over_face
from fem.contact.moving_sides import BothMoved, MovedSide, both_moved, moved_side
from fem.contact.opposite_flanks import OppositeShare, share_with_opposite
from fem.laws.contact_candidates import REACHES, ContactCandidates
from fem.laws.edge_tables import EdgeTables
from fem.laws.local_law import Film
from fem.laws.mesh_setup import MeshSetup
from fem.pair.pair_compliance import PairCompliance

if TYPE_CHECKING:
    from gears import GearPair, LoadShare

__all__ = ["ContactState", "solve_contact", "solve_one_side"]

FAR_APART = 0.5
"""Deflection of shafts in modules above which teeth mesh on another path."""


@record
class MovedShare:
    """What contacts that move with corners were solved with."""

    own: MovedFlanks
    flanks: LoadedFlanks
    given: MeshSetup

    def edge_rho(self, approach: Array) -> Array:
        """Places of tip edges (2, pitches, positions, pairs) [m]."""
        return self.own.edge_rho(self.flanks, self.given, approach)

    def turned(self, found: ContactState) -> Array:
        """Part of the pinion's base radius (positions, pairs) by which levers about the wheel's axis are longer."""
        return np.asarray(found.where.lever[0, : self.given.positions] / found.kappa - 1.0)

    def add_losses(self, found: ContactState, half: Array, whole: Array) -> None:
        """Add what the pinion's flanks take from the levers of forces, and of further ones (2, torques, ...)."""
        force, approach, slope = (
            found.share.forces,
            found.share.transmission_error,
            found.share.pair_stiffness,
        )
        bears = (force > 0.0) & (slope != 0.0)
        size, per_turn = np.where(bears, force, 1.0), np.where(bears, slope, 1.0)
        parts = self.own.rolled(force, approach[..., None]), self.own.cornered(force, approach[..., None])
        for gears, one in zip(((0, 1), (0,)), parts, strict=True):
            for gear in gears:
                half[gear] += np.where(bears, one.push / size, 0.0)
                whole[gear] += np.where(bears, one.less + one.stiff / per_turn, 0.0)


@record
class ContactState:
    """Solution for all torques: shares with leading dimensions (torques, pitches, positions of one).

    kappa and levers belong to the normal and to the tilted force, largest is what the tip edges' laws cover,
    closing the deflection less the hubs' wind-up, open the gap that is left where a pair does not bear. With moving
    contacts that do not settle, share is the one of contacts that stay, and settled is False. opposite: the flanks on
    the other side, where they were looked at; back, where these move: they seen in the mirror, with the turn D' and its
    slopes; crossing: what loads on the other side take from levers. face: what the cells of the face bear.
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
    opposite: OppositeShare | None = None
    moved: MovedShare | None = None
    face: FaceShare | None = None
    side: MovedSide | None = None
    back: ContactState | None = None
    crossing: Array | float = 0.0

    @property
    def touch(self) -> Array:
        """Transmission error at which the gears touch without load (pitches, positions) [m]."""
        return np.asarray(self.where.gap.min(axis=-1))

    def deflection(self, number: int) -> Array:
        """Turn under a torque less that without any, on shafts that are held (pitches, positions) [m]."""
        moved = self.share.transmission_error[number]
        return np.asarray(moved if self.opposite is None else moved - self.opposite.rest)

    def turn(self, number: int) -> Array:
        """Turn of the pinion under a torque, from where gears without deviations touch (pitches, positions) [m]."""
        bent = 0.0 if self.face is None else self.face.bent(number)
        return np.asarray(self.share.transmission_error[number] + bent + self.touch)

    def moments(self, loaded: Array, other: Array | None, lost: Array, behind: Array | float) -> Array:
        """Sums of forces kappa F, or of their slopes, by their levers about pinion and wheel (2, positions).

        Parameters
        ----------
        loaded : (positions, pairs) array
            Of the loaded flanks.
        other : (positions, pairs) array or None
            Of those on the other side, which turn the gears the other way.
        lost, behind : (2, positions, pairs) arrays
            Parts of the levers of either side that contacts which move lose.
        """
        found = _levered(self.where, self.kappa, loaded, lost)
        if other is not None and self.opposite is not None:
            found = found - _levered(self.opposite.where, self.opposite.kappa, other, behind)
        return found

    @cached_property
    def _lever_losses(self) -> tuple[Array, Array]:
        force = self.share.forces
        if self.moves is None:
            return np.zeros((2, *force.shape)), np.zeros((2, *force.shape))
        if self.face is None or self.face.lost is None:
            tilted = self.moves.rolled(force) + self.crossing
            half, whole = 0.5 * np.stack([tilted, tilted]), np.stack([tilted, tilted])
            if self.moved is not None:
                self.moved.add_losses(self, half, whole)
        else:
            half, whole = (one.copy() for one in self.face.lost)
        if self.moved is not None:
            turned = self.moved.turned(self)
            half[0] += turned
            whole[0] += turned
        return half, whole

    def lever_loss(self, number: int) -> tuple[Array, Array]:
        """Parts of both base radii by which levers of forces, and of further ones, are shorter.

        (2, pitches, positions, pairs) each, nothing for contacts that stay: half of what tilted flanks take from
        further forces, and what the pinion's corner gains by the turn D.
        """
        first, second = self._lever_losses
        return first[:, number], second[:, number]

    def lever_loss_behind(self, number: int) -> tuple[Array, Array]:
        """The same of the flanks on the other side."""
        if self.back is not None:
            return self.back.lever_loss(number)
        nothing = np.zeros((2, 1, 1, 1))
        return nothing, nothing

    def torques(self, number: int) -> Array:
        """Torque of each pair over the pinion's base radius (pitches, positions, pairs) [N]."""
        return np.asarray(self.share.forces[number] * (self.levers - self.lever_loss(number)[0][0]))

    def flank_rho(self, pair: GearPair, number: int) -> Array:
        """Curvature radii where pinion and wheel are touched (2, pitches, positions, pairs) [m], untouched ones too."""
        share = self.share
        rho = np.repeat(self.where.rho[:, None], len(share.forces[number]), axis=1)
        if self.moves is None:
            return rho
        force, approach = share.forces[number], share.transmission_error[number]
        approach = approach if self.face is None else approach + self.face.turned(number)
        rho = rho + np.where(self.where.edge, 0.0, moved_places(self.moves, force, approach))
        if self.moved is not None:
            rho = np.where(self.where.edge, self.moved.edge_rho(approach), rho)
        ends = [profile.flank_rho for profile in pair.teeth_profiles]
        return np.stack([np.clip(one, *end) for one, end in zip(rho, ends, strict=True)])

    def shafts_give_way(self, number: int) -> float:
        """Maximum deflection of both shafts on the face over the module; 0 of rigid ones."""
        held = None if self.face is None else self.face.shafts
        return 0.0 if held is None else float(np.max(held.most[number]))

    def refusal(self, number: int) -> str:
        """Why the solution for a torque is not to be believed, empty if it is."""
        where, turned = self.where, self.share.forces[number]
        if not self.settled:
            most = 1e3 * np.max(self.share.transmission_error)
            return (
                f"a deflection of {most:.2g} mm is far beyond the first order of contacts that move; reduce the "
                "torque, or let contacts stay"
            )
        if (far := self.shafts_give_way(number)) > FAR_APART:
            return (
                f"the shafts give way by {far:.2g} modules along the line of action, on which the teeth no longer mesh "
                "as they do; give stiffer shafts or bearings, bring them nearer to the gears, or reduce the torque"
            )
        deepest = float(np.max(self.share.transmission_error[number]))
        if self.moved is not None and deepest > DEEPEST * self.moved.given.pair.module:
            return (
                f"a deflection of {1e3 * deepest:.2g} mm is more than a quarter of the module, up to which corners "
                "that move have laws; reduce the torque, or let contacts stay"
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
        return "" if self.opposite is None else self.opposite.refusal(number)


def solve_contact(
    given: MeshSetup,
    bodies: PairCompliance,
    force: Array,
    film: Film | None,
    tables: EdgeTables | None = None,
) -> ContactState:
    """Solve, with candidates farther out if the deflection reaches beyond the first ones.

    The flanks on the other side are looked at where the deflection is more than their gap, without a force, or where
    the setting asks for them.

    Parameters
    ----------
    given : MeshSetup
    bodies : PairCompliance
    force : (torques,) array
        [N], all above 0 or all 0.
    film : Film or None
    tables : EdgeTables, optional
        Laws of the tip edges of gears that are set up likewise, to be used again.
    """
    tables, most = tables or EdgeTables(given, bodies), float(np.max(force))
    found: ContactState | None = None
    # without a torque overlap alone says how far contacts reach
    for reach in REACHES if np.all(force) else REACHES[-1:]:
        flanks = loaded_flanks(given, bodies, film, reach, most, tables)
        found = solve_one_side(given, bodies, force, flanks, tables) if np.all(force) else None
        if found is None or np.max(found.closing + found.touch) <= flanks.where.reach_gap:
            break
    if found is None or given.both or _near(flanks, found, given.pair.tight):
        found = _two_sided(given, bodies, force, film, flanks, found, reach, tables)
    return found


def _near(flanks: LoadedFlanks, found: ContactState, tight: bool) -> bool:
    """Whether the other side may bear: teeth bend by no more than the deflection and the film between them.

    That side's gap is left by j + D - b_1 - b_2 - s', with b the bending of two loaded teeth, b <= D + s each, and
    s' its own film. Teeth that deviations alone make jam are left to one side unless the pair is tight.
    """
    if np.min(flanks.where.back_gap) < 0.0 and not tight:
        return False
    film = 0.0
    if flanks.oil is not None:
        film = float(np.max(flanks.oil.approach(np.zeros_like(found.share.forces))))
    reached = found.closing.reshape(len(found.closing), -1)
    return bool(np.any(flanks.where.back_gap < reached + 3.0 * film))


def solve_one_side(
    given: MeshSetup, bodies: PairCompliance, force: Array, flanks: LoadedFlanks, tables: EdgeTables
) -> ContactState:
    """Solution with the loaded flanks alone."""
    from gears.sharing.load_sharing import share_load

    where, matrix, laws, oil = flanks.where, flanks.matrix, flanks.laws, flanks.oil
    whole, gaps = force[:, None, None], where.gap - where.gap.min(axis=-1, keepdims=True)
    arms, over = flanks.levers if given.friction else None, None
    if given.face is None:
        share = share_load(whole, matrix, laws, gaps, oil, arms)
    else:
        share, over = share_over_face(
            given, bodies, whole, where, flanks.kappa, matrix, laws, gaps, oil, arms
        )
    moves, settled, own, side, levers, kappa = None, True, None, None, flanks.levers, flanks.kappa
    if given.moving_contact:
        side = moved_side(given, bodies, flanks, float(np.max(force)), tables)
        moves, own, pairs, levers, kappa = side.moves, side.own, side.pairs, side.levers, side.kappa
        if own is not None:
            matrix, gaps = own.matrix, own.gaps
        if over is None:
            moved = moved_share(share, whole, pairs)
            share, settled = share if moved is None else moved, moved is not None
        else:
            both = moved_over_face(given, bodies, whole, flanks, kappa, pairs, over)
            (share, over), settled = (share, over) if both is None else both, both is not None
    if over is None:
        propped = 0.0 if oil is None else oil.approach(np.zeros_like(share.forces))
        bent = (matrix @ share.forces[..., None])[..., 0] + gaps
        left = bent - propped - share.transmission_error[..., None]
        if moves is not None:
            left = left + share.transmission_error[..., None] * moves.rolled(share.forces)
        if own is not None:
            left = left + own.pushed(share.forces, share.transmission_error[..., None]).approach
    else:
        left = over.open
    closing = share.transmission_error - bodies.turning * whole
    moved_by = None if own is None else MovedShare(own, flanks, given)
    return ContactState(
        where,
        share,
        kappa,
        levers,
        flanks.largest,
        closing,
        left,
        moves,
        settled,
        moved=moved_by,
        face=over,
        side=side,
    )


def _two_sided(
    given: MeshSetup,
    bodies: PairCompliance,
    force: Array,
    film: Film | None,
    flanks: LoadedFlanks,
    alone: ContactState | None,
    reach: float,
    tables: EdgeTables,
) -> ContactState:
    """Solution with the flanks on both sides, but for torques that are refused with one."""
    apart = np.zeros(len(force), dtype=bool)
    if alone is not None:
        apart = np.array([bool(alone.refusal(n)) for n in range(len(force))])
        if apart.all():
            return alone
        clear = (
            None if given.both else stays_clear(given, bodies, force, film, flanks, alone.share, apart, reach)
        )
        if clear is not None:
            return replace(alone, opposite=clear)
    if given.moving_contact and given.face is None:
        by_itself = None if alone is None else (alone.share, alone.side)
        found = both_moved(given, bodies, force, film, flanks, by_itself, apart, reach, tables)
        return _moved_solution(given, bodies, force, found, alone)
    share, opposite, left = share_with_opposite(
        given, bodies, force, film, flanks, None if alone is None else alone.share, apart, reach, tables
    )
    if alone is not None and not opposite.bears:
        return replace(alone, opposite=opposite)
    closing = share.transmission_error - bodies.turning * force[:, None, None]
    moves, settled = (None, True) if alone is None else (alone.moves, alone.settled)
    return ContactState(
        flanks.where,
        share,
        flanks.kappa,
        flanks.levers,
        flanks.largest,
        closing,
        left,
        moves,
        settled,
        opposite,
    )


def _moved_solution(
    given: MeshSetup, bodies: PairCompliance, force: Array, found: BothMoved, alone: ContactState | None
) -> ContactState:
    """Solution with flanks on both sides that move, for forces (torques,) [N]."""
    problem, share, whole = found.problem, found.share, force[:, None, None]
    front, back = found.front.flanks, found.back.flanks
    turn, loads = share.transmission_error, problem.split(share.forces)
    slopes, open_ = problem.split(share.pair_stiffness), problem.split(problem.unloaded(share.forces, turn))
    closing = bodies.turning * whole - turn - front.where.gap.min(axis=-1) - given.pair.backlash
    opposite = OppositeShare(
        back.where,
        found.back.kappa,
        found.back.levers,
        back.largest,
        loads[1],
        slopes[1],
        open_[1],
        found.rest,
        False,
        closing.max(axis=(1, 2)),
    )
    if alone is not None and not opposite.bears:
        return replace(alone, opposite=opposite, settled=found.settled)
    turns, signs, settings = (turn, problem.behind(turn)), (1.0, -1.0), (given, given.opposite)
    crossing, sides = problem.crossed(share.forces), []
    for k, side in enumerate((found.front, found.back)):
        part = replace(
            share, forces=loads[k], transmission_error=turns[k], pair_stiffness=signs[k] * slopes[k]
        )
        moved = None if side.own is None else MovedShare(side.own, side.flanks, settings[k])
        closed = turns[k] - bodies.turning * whole
        laws = side.kappa, side.levers, side.flanks.largest, closed, open_[k], side.moves, found.settled
        sides.append(ContactState(side.flanks.where, part, *laws, moved=moved, crossing=crossing[k]))
    return replace(sides[0], opposite=opposite, back=sides[1])


def _levered(where: ContactCandidates, kappa: Array, forces: Array, lost: Array | float = 0.0) -> Array:
    """Sum by the levers of the normals (2, positions)."""
    lever = np.where(forces != 0.0, where.lever, 0.0) / kappa
    return np.asarray(np.sum((lever - lost) * forces, axis=-1))
