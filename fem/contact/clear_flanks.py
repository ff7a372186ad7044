"""Flanks on the other side of the teeth that surely do not bear, found without their laws.

The gap that the loaded side alone leaves there needs the places of the contacts and X, what loads on one side of the
teeth do to the other (``fem.contact.opposite_flanks``): not how the flanks of that side yield themselves. X of the mesh
before the last refinement, known with the flanks' own compliance, is within 0.2 %; where more than `DOUBT` of all that
loads close is left open by it, no flank bears.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from base import Array, Booleans
from fem.contact.contact_sides import between
from fem.contact.contact_state import ContactState
from fem.contact.loaded_flanks import FlanksInPlace, flanks_in_place
from fem.contact.shared_contacts import SharedContacts
from fem.influence.gear_shape import COARSE
from fem.laws.local_law import Film
from fem.laws.mesh_setup import MeshSetup
from fem.pair.face_setting import FREE_ENDS
from fem.pair.face_shafts import shafts_under_face

if TYPE_CHECKING:
    from fem.pair.pair_compliance import PairCompliance

__all__ = ["stays_clear"]

DOUBT = 0.01
"""Part of what all loads do to the other side by which that is in doubt, whatever their signs."""

DOUBT_OF_ENDS = 0.04
"""Part of the deflection by which free ends of the face leave gaps less than even loads do: 0.024, 0.028 and 0.018 at
most on 36/40 teeth that are 2, 4 and 10 modules wide."""

ROLLED = 0.2
"""Part of X by which a module of roll changes it; 0.16 at most with a pinion of POM."""


def stays_clear(
    setup: MeshSetup,
    bodies: PairCompliance,
    force: Array,
    film: Film | None,
    flanks: FlanksInPlace,
    alone: ContactState,
    apart: Booleans,
    reach: float,
) -> ContactState | None:
    """Gaps that are left on the other side at least, where nothing bears there under any torque; else None.

    Parameters
    ----------
    setup, bodies, force, film, flanks, alone, apart, reach
        As for ``share_with_opposite``.
    """
    other = flanks_in_place(setup.opposite, film, reach)
    touch = flanks.candidates.gap.min(axis=-1, keepdims=True)
    backlash = setup.backlash + other.candidates.gap + touch
    behind = _less_film(other.lever_ratios * backlash, other)
    first = _less_film(flanks.gaps, flanks) / flanks.lever_ratios
    if np.any(first.min(axis=-1) + (behind / other.lever_ratios).min(axis=-1) < 0.0):
        return None  # both sides are pressed without a torque
    matrix = np.swapaxes(between(setup, bodies, flanks.candidates, other.candidates, COARSE), 1, 2)
    cells, deflection = alone.contacts.forces, alone.share.transmission_error
    # closed by no more than the heaviest cell's line load on the whole face, opened by no less than the lightest one
    heaviest, lightest = (
        cells.shape[-1] * load[..., None] for load in (cells.max(axis=-1), cells.min(axis=-1))
    )
    moved = (np.minimum(matrix, 0.0) @ heaviest + np.maximum(matrix, 0.0) @ lightest)[..., 0]
    sizes = (np.abs(matrix) @ heaviest)[..., 0]
    doubt = np.full(sizes.shape, DOUBT)
    if setup.moving_contact:  # both sides roll on, by D and by D + j
        turn = deflection + max(setup.backlash, 0.0)
        doubt += (ROLLED / setup.pair.module * turn)[..., None]
    opened = other.lever_ratios * deflection[..., None]
    clearance = behind + opened + moved - doubt * sizes + _given_way(alone, other)
    if setup.face.model == FREE_ENDS:
        clearance = clearance - DOUBT_OF_ENDS * deflection[..., None]
    if not np.all((clearance > 0.0) | apart[:, None, None, None]):
        return None
    touched = alone.contacts.turn + setup.backlash + touch[..., 0] + other.candidates.gap.min(axis=-1)
    nothing = np.zeros_like(clearance)
    share = replace(alone.share, forces=nothing, pair_stiffness=nothing, transmission_error=-touched)
    closing = bodies.turning * force[:, None, None] - touched
    return ContactState(setup.opposite, other, None, SharedContacts.even(share, clearance), closing)


def _given_way(alone: ContactState, other: FlanksInPlace) -> Array | float:
    """By how much shafts open the gaps of the other side at least, beyond the turn on shafts that are held [m]."""
    shafts = shafts_under_face(alone.setup.face, alone.setup.pair)
    if shafts is None:
        return 0.0
    forces = alone.contacts.bending
    give = shafts.bent(forces, forces.shape[-2], 1).sum(axis=-2).min(axis=-1)
    turn = alone.contacts.turn - alone.share.transmission_error
    return np.asarray(other.lever_ratios * turn[..., None] + give[..., None])


def _less_film(gap: Array, flanks: FlanksInPlace) -> Array:
    return gap if flanks.oil is None else gap - flanks.oil.approach(np.zeros_like(gap))
