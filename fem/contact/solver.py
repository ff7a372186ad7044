"""Contact of all pairs at all positions and torques: compliances, laws and levers put together and solved."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from base import Array
from fem.contact.clear_flanks import stays_clear
from fem.contact.contact_sides import one_side
from fem.contact.contact_state import ContactState, contact_state
from fem.contact.loaded_flanks import LoadedFlanks, loaded_flanks
from fem.contact.moved_share import moved_share
from fem.contact.moved_side import moved_side
from fem.contact.opposite_flanks import share_with_opposite
from fem.contact.shared_contacts import share_staying
from fem.laws.contact_candidates import LINES_REACH, REACHES
from fem.laws.corner_laws import CornerLaws
from fem.laws.local_law import Film
from fem.laws.mesh_setup import MeshSetup

if TYPE_CHECKING:
    from fem.pair.pair_compliance import PairCompliance

__all__ = ["solve_contact", "solve_one_side"]

STIFF = 0.06
"""Stiffness of a helical mesh per width over the plane modulus, less than which it hardly is: lines go on beyond the
path as far as a deflection by it closes gaps, and farther where the deflection is more."""


def solve_contact(
    setup: MeshSetup,
    bodies: PairCompliance,
    force: Array,
    film: Film | None,
    corner_laws: CornerLaws | None = None,
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
    corner_laws : CornerLaws, optional
        Laws of the tip edges of gears that are set up likewise, to be used again.
    """
    corner_laws = corner_laws or CornerLaws(setup, bodies)
    if setup.face.held_under is not None:  # what has brought the shafts there must find its contacts as well
        force = np.append(force, setup.face.held_under)
    state: ContactState | None = None
    # without a torque overlap alone says how far contacts reach
    for reach in _reaches(setup, bodies, force):
        flanks = loaded_flanks(setup, bodies, film, reach, corner_laws)
        state = solve_one_side(setup, bodies, force, flanks, corner_laws) if np.all(force) else None
        if state is None or np.max(state.closing + state.touch) <= flanks.candidates.reach_gap:
            break
    if state is not None and setup.helical:
        return state
    if state is None or setup.two_sided or _near(setup, flanks, state):
        state = _two_sided(setup, bodies, force, film, flanks, state, reach, corner_laws)
    return state


def _reaches(setup: MeshSetup, bodies: PairCompliance, force: Array) -> tuple[float, ...]:
    """Base pitches outside the path within which tip edges are looked for, one after the other.

    On lines of contact as far as a deflection closes gaps that goes with the force alone, so that all positions of an
    arc have cells alike.
    """
    if not (setup.helical and setup.beyond_path):
        return REACHES if np.all(force) else REACHES[-1:]
    softest = min(gear.law.plane_modulus for gear in (bodies.pinion, bodies.wheel))
    deflection = float(np.max(force)) / (STIFF * softest * setup.pair.face_width)
    edges = setup.flanks.edges(LINES_REACH)
    near = [edges.closed_by(times * deflection) / setup.pair.base_pitch for times in (1.0, 2.0, 4.0)]
    return (*near, LINES_REACH)


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
    if (shafts := state.contacts.shafts) is not None:  # which close gaps farther where they tilt
        reached = reached + (shafts.most * setup.pair.module - shafts.touch).reshape(reached.shape)
    return bool(np.any(flanks.candidates.back_gap < reached + 3.0 * film))


def solve_one_side(
    setup: MeshSetup, bodies: PairCompliance, force: Array, flanks: LoadedFlanks, corner_laws: CornerLaws
) -> ContactState:
    """Solution with the loaded flanks alone."""
    sides, whole = one_side(setup, flanks), force[:, None, None]
    stays = share_staying(bodies, whole, sides)
    if not setup.moving_contact:
        return contact_state(bodies, force, sides, stays)
    side = moved_side(setup, bodies, flanks, corner_laws)
    moved = moved_share(side, bodies, whole, stays)
    return contact_state(bodies, force, sides, moved or stays, (side,), settled=moved is not None)


def _two_sided(
    setup: MeshSetup,
    bodies: PairCompliance,
    force: Array,
    film: Film | None,
    flanks: LoadedFlanks,
    alone: ContactState | None,
    reach: float,
    corner_laws: CornerLaws,
) -> ContactState:
    """Solution with the flanks on both sides, but for torques that are refused with one."""
    apart = np.zeros(len(force), dtype=bool)
    if alone is not None:
        apart = np.array([bool(alone.refusal(n)) for n in range(len(force))])
        if apart.all():
            return alone
        if not setup.two_sided:
            clear = stays_clear(setup, bodies, force, film, flanks, alone, apart, reach)
            if clear is not None:
                return replace(alone, opposite=clear)
    state = share_with_opposite(setup, bodies, force, film, flanks, alone, apart, reach, corner_laws)
    if alone is None or (state.opposite is not None and state.opposite.bears):
        return state
    return replace(
        alone, opposite=state.opposite, settled=state.settled, rest=state.rest, unshared=state.unshared
    )
