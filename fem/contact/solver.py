"""Contact of all pairs at all positions and torques: compliances, laws and levers put together and solved."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from base import Array
from fem.contact.clear_flanks import stays_clear
from fem.contact.contact_sides import one_side
from fem.contact.contact_state import ContactState
from fem.contact.face_share import FaceShare, share_over_face
from fem.contact.loaded_flanks import LoadedFlanks, loaded_flanks
from fem.contact.moved_share import moved_share
from fem.contact.moved_side import MovedSide, moved_side
from fem.contact.moving_sides import BothMoved, both_moved
from fem.contact.opposite_flanks import OppositeShare, on_shafts, share_with_opposite
from fem.laws.contact_candidates import REACHES
from fem.laws.edge_tables import EdgeTables
from fem.laws.local_law import Film
from fem.laws.mesh_setup import MeshSetup
from gears.sharing.active_set import LoadShare

if TYPE_CHECKING:
    from fem.pair.pair_compliance import PairCompliance

__all__ = ["solve_contact", "solve_one_side"]


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
    if state is None or setup.two_sided or _near(setup, flanks, state):
        state = _two_sided(setup, bodies, force, film, flanks, state, reach, tables)
    return state


def _near(setup: MeshSetup, flanks: LoadedFlanks, state: ContactState) -> bool:
    """Whether the other side may bear: teeth bend by no more than the deflection and the film between them.

    That side's gap is left by j + D - b_1 - b_2 - s', with b the bending of two loaded teeth, b <= D + s each, and
    s' its own film. Teeth that deviations alone make jam are left to one side unless the pair is tight.
    """
    if np.min(flanks.candidates.back_gap) < 0.0 and not setup.pair.tight:
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
    whole = force[:, None, None]
    share, over, open_ = _staying(setup, bodies, whole, flanks)
    closing = share.transmission_error - bodies.turning * whole
    state = ContactState(
        flanks.candidates,
        share,
        flanks.lever_ratios,
        flanks.tilted_lever_ratios,
        flanks.largest,
        closing,
        open_,
        face=over,
    )
    if not setup.moving_contact:
        return state
    side = moved_side(setup, bodies, flanks, float(np.max(force)), tables)
    state = replace(
        state, side=side, lever_ratios=side.lever_ratios, tilted_lever_ratios=side.tilted_lever_ratios
    )
    moved = moved_share(side, bodies, whole, share, over)
    if moved is None:
        return replace(state, settled=False)
    return replace(
        state,
        share=moved.share,
        closing=moved.share.transmission_error - bodies.turning * whole,
        open=moved.open,
        lost=moved.lost,
        face=moved.face,
    )


def _staying(
    setup: MeshSetup, bodies: PairCompliance, whole: Array, flanks: LoadedFlanks
) -> tuple[LoadShare, FaceShare | None, Array]:
    """Share of contacts that stay, of their cells where the face has any, and gaps that are left."""
    sides = one_side(setup, flanks)
    if setup.face is None:
        share = sides.share(whole)
        return share, None, sides.open(share)
    share, over = share_over_face(bodies, whole, sides)
    return share, over, over.open


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
        over = None if alone.face is None else alone.face.forces
        clear = (
            None
            if setup.two_sided
            else stays_clear(setup, bodies, force, film, flanks, alone.share, over, apart, reach)
        )
        if clear is not None:
            return replace(alone, opposite=clear)
    if setup.moving_contact and not on_shafts(setup):
        by_itself = None
        if alone is not None and alone.side is not None:
            by_itself = alone.side, alone.share, alone.face
        solved = both_moved(setup, bodies, force, film, flanks, by_itself, apart, reach, tables)
        return _moved_solution(setup, bodies, force, solved, alone)
    kept = None if alone is None else (alone.share, alone.face)
    solved_sides = share_with_opposite(setup, bodies, force, film, flanks, kept, apart, reach, tables)
    share, opposite = solved_sides.share, solved_sides.opposite
    if alone is not None and not opposite.bears:
        return replace(alone, opposite=opposite)
    return ContactState(
        flanks.candidates,
        share,
        flanks.lever_ratios,
        flanks.tilted_lever_ratios,
        flanks.largest,
        share.transmission_error - bodies.turning * force[:, None, None],
        solved_sides.open,
        alone is None or alone.settled,
        face=solved_sides.face,
        opposite=opposite,
    )


def _moved_solution(
    setup: MeshSetup, bodies: PairCompliance, force: Array, solved: BothMoved, alone: ContactState | None
) -> ContactState:
    """Solution with flanks on both sides that move, for forces (torques,) [N]."""
    share, whole, face = solved.moved.share, force[:, None, None], solved.moved.face
    front, back = solved.sides.front, solved.sides.back
    loaded, behind = slice(0, front.lever_ratios.shape[-1]), slice(front.lever_ratios.shape[-1], None)
    turn, touch = share.transmission_error, front.flanks.candidates.gap.min(axis=-1)
    closing = bodies.turning * whole - turn - touch - setup.pair.backlash
    opposite = OppositeShare(
        back.flanks.candidates,
        back.lever_ratios,
        back.tilted_lever_ratios,
        back.flanks.largest,
        share.forces[..., behind],
        share.pair_stiffness[..., behind],
        solved.moved.open[..., behind],
        solved.rest,
        closing.max(axis=(1, 2)),
        face=None if face is None else face.of_pairs(behind),
    )
    if alone is not None and not opposite.bears:
        return replace(alone, opposite=opposite, settled=solved.settled)
    states = []
    for side, pairs, approach, sign in (
        (front, loaded, turn, 1.0),
        (back, behind, solved.behind, -1.0),
    ):
        part = replace(
            share,
            forces=share.forces[..., pairs],
            transmission_error=approach,
            pair_stiffness=sign * share.pair_stiffness[..., pairs],
        )
        half, further = (loss[..., pairs] for loss in solved.moved.lost)
        states.append(
            ContactState(
                side.flanks.candidates,
                part,
                side.lever_ratios,
                side.tilted_lever_ratios,
                side.flanks.largest,
                approach - bodies.turning * whole,
                solved.moved.open[..., pairs],
                solved.settled,
                side,
                (half, further),
                None if face is None else replace(face.of_pairs(pairs), least=_least(side)),
            )
        )
    return replace(states[0], opposite=opposite, back=states[1])


def _least(side: MovedSide) -> float:
    """Turn at which the first place of the face touches [m]."""
    face = side.setup.face
    return 0.0 if face is None else face.least_gap(side.setup.pair)
