"""Flanks on the other side of the teeth: whether they bear beside the loaded ones, and what both carry then.

The gap of a flank on the other side is the backlash, its own gap and the transmission error D, less what loads on both
sides bend it by:

    g_k = kappa_k (j + gap_k + D) + sum_i X_ki F_i + sum_l B_kl G_l + local(G_k) >= 0,
    sum kappa_i F_i - sum kappa_k G_k = T/r_b1,

with B of the mirrored gears and X of loads on one side seen from the other (``fem.influence.back_compliance``).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from base import Array, Booleans, Integers, part, quantity, record
from fem.contact.cell_contact import CellContact
from fem.contact.contact_sides import ContactSides, both_sides
from fem.contact.contact_state import ContactState, contact_state
from fem.contact.loaded_flanks import LoadedFlanks, loaded_flanks
from fem.contact.moved_share import moved_share
from fem.contact.moved_side import moved_side
from fem.contact.moving_sides import MovedSides
from fem.contact.shared_contacts import SharedContacts, share_staying
from fem.laws.corner_laws import CornerLaws
from fem.laws.local_law import Film
from fem.laws.mesh_setup import MeshSetup
from fem.pair.face_shafts import shafts_under_face
from gears.tooth.errors import LoadSharingError

if TYPE_CHECKING:
    from fem.pair.pair_compliance import PairCompliance

__all__ = ["OppositeFlanks", "share_with_opposite"]

ROUNDING = 1e-12
"""Overlap over the deflection that is none."""


@record
class OppositeFlanks:
    """Contacts on the other side of the teeth at the positions of a cycle; rho and levers of the mirrored gears."""

    no_error = "not estimated in single positions; the cycle has errors of its means and extremes"

    forces: Array = quantity("N", "normal force; zero where unloaded", "position pair")
    pair_stiffness: Array = quantity("N/m", "slope of the force by D, not above zero", "position pair")
    flank_rho: Array = quantity("m", "curvature radii on pinion and wheel", "gear position pair", shown="mm")
    edge: Booleans = quantity("1", "whether a tip edge touches outside the path", "position pair")
    teeth: Integers = quantity("1", "numbers of the teeth of pinion and wheel", "gear position pair")
    lever: Array = quantity(
        "1", "lever of the normal about the axes, over the base radii", "gear position pair"
    )
    gap: Array = quantity(
        "m", "gap that is left along the normal where no force is", "position pair", shown="um"
    )
    lever_loss: Array = part("as of the cycle, where contacts move")
    further_lever_loss: Array = part("the same of further forces")

    def per_deflection(self, slope: Array) -> OppositeFlanks:
        """Measure slopes by another deflection, whose slope by D is given (n,)."""
        return replace(self, pair_stiffness=self.pair_stiffness / slope[:, None])


def share_with_opposite(
    setup: MeshSetup,
    bodies: PairCompliance,
    force: Array,
    film: Film | None,
    flanks: LoadedFlanks,
    alone: ContactState | None,
    apart: Booleans,
    reach: float,
    corner_laws: CornerLaws,
) -> ContactState:
    """Share forces (torques,) [N] among the flanks on both sides; of contacts that stay where moving ones fail.

    Parameters
    ----------
    setup, bodies, film, reach, corner_laws
        As for ``loaded_flanks``.
    force : (torques,) array
        [N]
    flanks : LoadedFlanks
        Of the side that the torque loads.
    alone : ContactState or None
        Solution without the other side, kept where it lets nothing overlap; None without a torque.
    apart : (torques,) boolean array
        Torques for which it is kept whatever it lets overlap.
    """
    other = loaded_flanks(setup.opposite, bodies, film, reach, corner_laws)
    sides = both_sides(setup, bodies, flanks, other)
    moved = None
    if setup.moving_contact:
        front = (
            moved_side(setup, bodies, flanks, corner_laws)
            if alone is None or alone.side is None
            else alone.side
        )
        moved = MovedSides(front, moved_side(setup.opposite, bodies, other, corner_laws))
    clear, kept, rolled = np.zeros((len(force), 1, 1), dtype=bool), None, None
    if alone is not None:
        kept = _beside_nothing(sides, bodies, alone.contacts)
        rolled = kept if moved is None else moved.rolled(bodies, kept)
        clear = _nothing_overlaps(sides, rolled)
        if moved is not None and rolled is kept:  # then solved anew at all positions
            clear = np.full_like(clear, clear.all())
        clear = clear | apart[:, None, None]
    begin, joint, lost = kept, kept, np.zeros(len(force), dtype=bool)
    if kept is None or not clear.all():
        asked = np.where(apart, np.min(force, where=~apart, initial=np.inf), force)[:, None, None]
        asked, begin, lost = _staying(sides, bodies, asked, apart, kept)
        joint = begin if moved is None else moved_share(moved, bodies, asked, begin)
        if joint is None and moved is not None and kept is not None:
            joint = moved_share(moved, bodies, asked, begin.with_kept(kept, ~clear))
        if joint is not None and rolled is not None:
            joint = joint.with_kept(rolled, clear | lost[:, None, None])

    def solve(whole: Array) -> SharedContacts | None:
        stays = share_staying(bodies, whole, sides)
        return stays if moved is None else moved_share(moved, bodies, whole, stays)

    rest = None if joint is None else _at_rest(sides, force, solve)
    contacts = joint or begin
    assert contacts is not None
    return contact_state(
        bodies,
        force,
        sides,
        contacts,
        () if moved is None else moved.sides,
        settled=rest is not None,
        rest=0.0 if rest is None else rest,
        unshared=tuple(np.flatnonzero(lost).tolist()),
    )


def _staying(
    sides: ContactSides, bodies: PairCompliance, whole: Array, apart: Booleans, kept: SharedContacts | None
) -> tuple[Array, SharedContacts, Booleans]:
    """Share forces among contacts that stay.

    Returns
    -------
    whole : (torques, 1, 1) array
        What was shared [N]: another force in place of those for which no load sharing is found beside others.
    contacts : SharedContacts
    lost : (torques,) boolean array
        These.
    """
    try:
        return whole, share_staying(bodies, whole, sides), np.zeros_like(apart)
    except LoadSharingError:
        lost = ~apart & np.array([_lost(sides, bodies, force) for force in whole])
        if kept is None or not lost.any():
            raise
    known = ~(lost | apart)
    if not known.any():
        return whole, kept, lost
    whole = np.where(known[:, None, None], whole, np.min(whole[known]))
    return whole, share_staying(bodies, whole, sides), lost


def _lost(sides: ContactSides, bodies: PairCompliance, whole: Array) -> bool:
    """Whether no load sharing is found under a torque (1, 1) [N]."""
    try:
        share_staying(bodies, whole[None], sides)
    except LoadSharingError:
        return True
    return False


def _beside_nothing(sides: ContactSides, bodies: PairCompliance, loaded: SharedContacts) -> SharedContacts:
    """Contacts of a loaded side that bears alone, beside those of the other and the gaps that are left there."""
    face, (*leading, _, cells) = sides.setups[0].face, loaded.forces.shape
    more = sides.matrix.shape[-1] - sides.count
    whole = loaded.beside(np.zeros((*leading, more, cells)))
    if face.even_load:
        return loaded.beside(sides.open(whole.share)[..., sides.count :, None])
    brought = None if whole.reference is None else {cells: whole.bending}
    contact = CellContact(bodies, np.zeros((len(loaded.forces), 1, 1)), sides, brought)
    beside = loaded.beside(contact.open(face, whole.forces, loaded.turn)[..., sides.count :, :])
    shafts = shafts_under_face(face, sides.setups[0].pair)
    if shafts is None or beside.shafts is None:
        return beside
    _, behind = shafts.touches(whole.bending, sides.lever_ratios, sides.gaps, sides.count)
    behind = np.broadcast_to(behind, beside.shafts.behind.shape)
    return replace(beside, shafts=replace(beside.shafts, behind=behind))


def _nothing_overlaps(sides: ContactSides, contacts: SharedContacts) -> Booleans:
    """Where nothing overlaps on the other side (torques, pitches, positions)."""
    gaps, turn = contacts.open[..., sides.count :], contacts.share.transmission_error
    return np.asarray(np.all(gaps >= -ROUNDING * np.abs(turn)[..., None], axis=-1))


def _at_rest(
    sides: ContactSides, force: Array, solve: Callable[[Array], SharedContacts | None]
) -> Array | None:
    """Turn without torque (pitches, positions) [m]: 0 where teeth are not pressed together, None without a solution.

    Parameters
    ----------
    sides : ContactSides
    force : (torques,) array
        [N]
    solve : callable
        Shares forces (1, pitches, positions) [N] among both sides.
    """
    pressed = sides.pressed()
    if not pressed.any():
        return np.zeros(pressed.shape)
    small = np.where(pressed, 0.0, max(float(np.max(force, initial=0.0)), 1.0))
    free = solve(small[None])
    return None if free is None else np.where(pressed, free.share.transmission_error[0], 0.0)
