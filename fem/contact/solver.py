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
    setup: MeshSetup

    def edge_rho(self, approach: Array) -> Array:
        """Places of tip edges (2, pitches, positions, pairs) [m]."""
        return self.own.edge_rho(self.flanks, self.setup, approach)

    def turned(self, state: ContactState) -> Array:
        """Part of the pinion's base radius (positions, pairs) by which levers about the wheel's axis are longer."""
        return np.asarray(state.candidates.lever[0, : self.setup.positions] / state.lever_ratios - 1.0)

    def add_losses(self, state: ContactState, half: Array, whole: Array) -> None:
        """Add what the pinion's flanks take from the levers of forces, and of further ones (2, torques, ...)."""
        force, approach, slope = (
            state.share.forces,
            state.share.transmission_error,
            state.share.pair_stiffness,
        )
        bears = (force > 0.0) & (slope != 0.0)
        size, per_turn = np.where(bears, force, 1.0), np.where(bears, slope, 1.0)
        parts = self.own.rolled(force, approach[..., None]), self.own.cornered(force, approach[..., None])
        for gears, pushed in zip(((0, 1), (0,)), parts, strict=True):
            for gear in gears:
                half[gear] += np.where(bears, pushed.push / size, 0.0)
                whole[gear] += np.where(bears, pushed.less + pushed.stiff / per_turn, 0.0)


@record
class ContactState:
    """Solution of the contact for all torques.

    Leading dimensions of shares are (torques, pitches, positions).

    Attributes
    ----------
    candidates : ContactCandidates
        Contacts that may bear.
    share : LoadShare
        Forces, times ``lever_ratios``; of contacts that stay where moving ones did not settle.
    lever_ratios, tilted_lever_ratios : (positions, pairs) arrays
        kappa of the normal force, and levers of the force that friction tilts, over kappa r_b1.
    largest : (edges,) array
        Force up to which the laws of the tip edges hold [N].
    closing : (torques, pitches, positions) array
        Deflection without the wind-up of the hubs [m].
    open : (torques, pitches, positions, pairs) array
        Gap that remains where a pair does not bear [m].
    moves : ContactMoves or None
        None where contacts stay.
    settled : bool
        Whether moving contacts converged.
    opposite : OppositeShare or None
        Flanks on the other side, where they were looked at.
    moved : MovedShare or None
        Corners of the tips that move.
    face : FaceShare or None
        Forces on the cells of the face.
    side : MovedSide or None
        What moving contacts of the loaded side were solved with.
    back : ContactState or None
        Moving flanks on the other side, seen in the mirror, with the turn D' and its slopes.
    crossing : array or float
        What loads on the other side take from the levers.
    """

    candidates: ContactCandidates
    share: LoadShare
    lever_ratios: Array
    tilted_lever_ratios: Array
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
        return np.asarray(self.candidates.gap.min(axis=-1))

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
        sums = _levered(self.candidates, self.lever_ratios, loaded, lost)
        if other is not None and self.opposite is not None:
            sums = sums - _levered(self.opposite.candidates, self.opposite.lever_ratios, other, behind)
        return sums

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
            half, whole = (loss.copy() for loss in self.face.lost)
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
        return np.asarray(
            self.share.forces[number] * (self.tilted_lever_ratios - self.lever_loss(number)[0][0])
        )

    def flank_rho(self, pair: GearPair, number: int) -> Array:
        """Curvature radii where pinion and wheel are touched (2, pitches, positions, pairs) [m], untouched ones too."""
        share = self.share
        rho = np.repeat(self.candidates.rho[:, None], len(share.forces[number]), axis=1)
        if self.moves is None:
            return rho
        force, approach = share.forces[number], share.transmission_error[number]
        approach = approach if self.face is None else approach + self.face.turned(number)
        rho = rho + np.where(self.candidates.edge, 0.0, moved_places(self.moves, force, approach))
        if self.moved is not None:
            rho = np.where(self.candidates.edge, self.moved.edge_rho(approach), rho)
        ends = [profile.flank_rho for profile in pair.teeth_profiles]
        return np.stack([np.clip(radii, *end) for radii, end in zip(rho, ends, strict=True)])

    def shafts_give_way(self, number: int) -> float:
        """Maximum deflection of both shafts on the face over the module; 0 of rigid ones."""
        held = None if self.face is None else self.face.shafts
        return 0.0 if held is None else float(np.max(held.most[number]))

    def refusal(self, number: int) -> str:
        """Why the solution for a torque is not to be believed, empty if it is."""
        candidates, turned = self.candidates, self.share.forces[number]
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
        if self.moved is not None and deepest > DEEPEST * self.moved.setup.pair.module:
            return (
                f"a deflection of {1e3 * deepest:.2g} mm is more than a quarter of the module, up to which corners "
                "that move have laws; reduce the torque, or let contacts stay"
            )
        if candidates.edge.any() and np.any(turned[..., candidates.edge] > self.largest):
            return "a tip edge presses over more than the strips cover; reduce the torque"
        if np.max(self.closing[number] + self.touch) > candidates.reach_gap:
            return (
                "the deflection closes gaps more than a base pitch outside the path, where no contact was looked "
                "for; reduce the torque or the deviations"
            )
        if np.any(turned[..., candidates.chamfered] > 0):
            return "a chamfer's face touches before its corner does, for which there is no law; reduce the torque"
        return "" if self.opposite is None else self.opposite.refusal(number)


def solve_contact(
    setup: MeshSetup,
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
    setup : MeshSetup
    bodies : PairCompliance
    force : (torques,) array
        [N], all above 0 or all 0.
    film : Film or None
    tables : EdgeTables, optional
        Laws of the tip edges of gears that are set up likewise, to be used again.
    """
    tables, most = tables or EdgeTables(setup, bodies), float(np.max(force))
    state: ContactState | None = None
    # without a torque overlap alone says how far contacts reach
    for reach in REACHES if np.all(force) else REACHES[-1:]:
        flanks = loaded_flanks(setup, bodies, film, reach, most, tables)
        state = solve_one_side(setup, bodies, force, flanks, tables) if np.all(force) else None
        if state is None or np.max(state.closing + state.touch) <= flanks.candidates.reach_gap:
            break
    if state is None or setup.two_sided or _near(flanks, state, setup.pair.tight):
        state = _two_sided(setup, bodies, force, film, flanks, state, reach, tables)
    return state


def _near(flanks: LoadedFlanks, state: ContactState, tight: bool) -> bool:
    """Whether the other side may bear: teeth bend by no more than the deflection and the film between them.

    That side's gap is left by j + D - b_1 - b_2 - s', with b the bending of two loaded teeth, b <= D + s each, and
    s' its own film. Teeth that deviations alone make jam are left to one side unless the pair is tight.
    """
    if np.min(flanks.candidates.back_gap) < 0.0 and not tight:
        return False
    film = 0.0
    if flanks.oil is not None:
        film = float(np.max(flanks.oil.approach(np.zeros_like(state.share.forces))))
    reached = state.closing.reshape(len(state.closing), -1)
    return bool(np.any(flanks.candidates.back_gap < reached + 3.0 * film))


def solve_one_side(
    setup: MeshSetup, bodies: PairCompliance, force: Array, flanks: LoadedFlanks, tables: EdgeTables
) -> ContactState:
    """Solution with the loaded flanks alone."""
    from gears.sharing.load_sharing import share_load

    candidates, matrix, laws, oil = flanks.candidates, flanks.matrix, flanks.laws, flanks.oil
    whole, gaps = force[:, None, None], candidates.gap - candidates.gap.min(axis=-1, keepdims=True)
    friction_lever_ratios, over = flanks.tilted_lever_ratios if setup.friction else None, None
    if setup.face is None:
        share = share_load(whole, matrix, laws, gaps, oil, friction_lever_ratios)
    else:
        share, over = share_over_face(
            setup,
            bodies,
            whole,
            candidates,
            flanks.lever_ratios,
            matrix,
            laws,
            gaps,
            oil,
            friction_lever_ratios,
        )
    moves, settled, own, side, tilted_lever_ratios, lever_ratios = (
        None,
        True,
        None,
        None,
        flanks.tilted_lever_ratios,
        flanks.lever_ratios,
    )
    if setup.moving_contact:
        side = moved_side(setup, bodies, flanks, float(np.max(force)), tables)
        moves, own, pairs, tilted_lever_ratios, lever_ratios = (
            side.moves,
            side.own,
            side.pairs,
            side.tilted_lever_ratios,
            side.lever_ratios,
        )
        if own is not None:
            matrix, gaps = own.matrix, own.gaps
        if over is None:
            moved = moved_share(share, whole, pairs)
            share, settled = share if moved is None else moved, moved is not None
        else:
            moved_face = moved_over_face(setup, bodies, whole, flanks, lever_ratios, pairs, over)
            (share, over), settled = (
                (share, over) if moved_face is None else moved_face,
                moved_face is not None,
            )
    if over is None:
        propped = 0.0 if oil is None else oil.approach(np.zeros_like(share.forces))
        bent = (matrix @ share.forces[..., None])[..., 0] + gaps
        remaining_gaps = bent - propped - share.transmission_error[..., None]
        if moves is not None:
            remaining_gaps = remaining_gaps + share.transmission_error[..., None] * moves.rolled(share.forces)
        if own is not None:
            remaining_gaps = (
                remaining_gaps + own.pushed(share.forces, share.transmission_error[..., None]).approach
            )
    else:
        remaining_gaps = over.open
    closing = share.transmission_error - bodies.turning * whole
    moved_by = None if own is None else MovedShare(own, flanks, setup)
    return ContactState(
        candidates,
        share,
        lever_ratios,
        tilted_lever_ratios,
        flanks.largest,
        closing,
        remaining_gaps,
        moves,
        settled,
        moved=moved_by,
        face=over,
        side=side,
    )


def _two_sided(
    setup: MeshSetup,
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
            None
            if setup.two_sided
            else stays_clear(setup, bodies, force, film, flanks, alone.share, apart, reach)
        )
        if clear is not None:
            return replace(alone, opposite=clear)
    if setup.moving_contact and setup.face is None:
        by_itself = None if alone is None else (alone.share, alone.side)
        solved = both_moved(setup, bodies, force, film, flanks, by_itself, apart, reach, tables)
        return _moved_solution(setup, bodies, force, solved, alone)
    share, opposite, remaining_gaps = share_with_opposite(
        setup, bodies, force, film, flanks, None if alone is None else alone.share, apart, reach, tables
    )
    if alone is not None and not opposite.bears:
        return replace(alone, opposite=opposite)
    closing = share.transmission_error - bodies.turning * force[:, None, None]
    moves, settled = (None, True) if alone is None else (alone.moves, alone.settled)
    return ContactState(
        flanks.candidates,
        share,
        flanks.lever_ratios,
        flanks.tilted_lever_ratios,
        flanks.largest,
        closing,
        remaining_gaps,
        moves,
        settled,
        opposite,
    )


def _moved_solution(
    setup: MeshSetup, bodies: PairCompliance, force: Array, solved: BothMoved, alone: ContactState | None
) -> ContactState:
    """Solution with flanks on both sides that move, for forces (torques,) [N]."""
    problem, share, whole = solved.problem, solved.share, force[:, None, None]
    front, back = solved.front.flanks, solved.back.flanks
    turn, loads = share.transmission_error, problem.split(share.forces)
    slopes, open_ = problem.split(share.pair_stiffness), problem.split(problem.unloaded(share.forces, turn))
    closing = bodies.turning * whole - turn - front.candidates.gap.min(axis=-1) - setup.pair.backlash
    opposite = OppositeShare(
        back.candidates,
        solved.back.lever_ratios,
        solved.back.tilted_lever_ratios,
        back.largest,
        loads[1],
        slopes[1],
        open_[1],
        solved.rest,
        False,
        closing.max(axis=(1, 2)),
    )
    if alone is not None and not opposite.bears:
        return replace(alone, opposite=opposite, settled=solved.settled)
    turns, signs, settings = (turn, problem.behind(turn)), (1.0, -1.0), (setup, setup.opposite)
    crossing, sides = problem.crossed(share.forces), []
    for k, side in enumerate((solved.front, solved.back)):
        part = replace(
            share, forces=loads[k], transmission_error=turns[k], pair_stiffness=signs[k] * slopes[k]
        )
        moved = None if side.own is None else MovedShare(side.own, side.flanks, settings[k])
        closed = turns[k] - bodies.turning * whole
        laws = (
            side.lever_ratios,
            side.tilted_lever_ratios,
            side.flanks.largest,
            closed,
            open_[k],
            side.moves,
            solved.settled,
        )
        sides.append(ContactState(side.flanks.candidates, part, *laws, moved=moved, crossing=crossing[k]))
    return replace(sides[0], opposite=opposite, back=sides[1])


def _levered(
    candidates: ContactCandidates, lever_ratios: Array, forces: Array, lost: Array | float = 0.0
) -> Array:
    """Sum by the levers of the normals (2, positions)."""
    lever = np.where(forces != 0.0, candidates.lever, 0.0) / lever_ratios
    return np.asarray(np.sum((lever - lost) * forces, axis=-1))
