"""Load shared by contacts that move on one side of the teeth, from the solution of contacts that stay."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Protocol

import numpy as np

from base import Array, record
from fem.contact.moved_side import MovedSide
from fem.contact.shared_contacts import SharedContacts, of_pairs, settled_gaps
from fem.pair.face_shafts import HeldShafts, joined, shafts_under_face
from fem.pair.wide_contact import shares_together
from gears.sharing.active_set import ContactForces, LoadShare, share_forces
from gears.sharing.central_path import share_forces_by_path

if TYPE_CHECKING:
    from fem.pair.pair_compliance import PairCompliance

__all__ = ["moved_share", "open_gaps"]


class Rolling(ContactForces, Protocol):
    """Contacts that move, of pairs or of cells."""

    def all_bent(self, loads: Array) -> Array:
        """As ``bent``, at all positions."""

    def bent_by(self, give: Array) -> Rolling:
        """The same where shafts have given way at the cells (..., n) [m]."""

    def parted(self, give: Array) -> Rolling:
        """The same with gaps that are so much larger at the cells (..., n) [m], along the normals."""

    def plus(self, more: Array) -> Rolling:
        """With a further compliance (2, 2, cells, cells) [m/N]."""

    def lever_losses(self, share: LoadShare) -> tuple[Array, Array]:
        """Parts of base radii (2, ..., pairs) by which levers of pairs' forces, and of further ones, are shorter."""


class Moving(Protocol):
    """Flanks whose contacts move, on one side of the teeth or on both."""

    @property
    def sides(self) -> tuple[MovedSide, ...]:
        """Those of each side, the loaded one first."""

    def contacts(self, bodies: PairCompliance, rise: Array, strip: float = 0.0) -> Rolling:
        """Put contacts together."""

    def turned_levers(self) -> Array:
        """Part of the pinion's base radius by which levers about the wheel's axis are longer (positions, pairs)."""


def moved_share(
    flanks: Moving, bodies: PairCompliance, whole: Array, stays: SharedContacts
) -> SharedContacts | None:
    """Solve with contacts that move, for all torques with strips of one width together.

    Parameters
    ----------
    flanks : MovedSide or MovedSides
    bodies : PairCompliance
    whole : (torques, ...) array
        Torques over the base radius [N].
    stays : SharedContacts
        Of contacts that stay: what is begun with, and whose errors are taken over.

    Returns
    -------
    SharedContacts or None
        None where Newton's method does not settle, or where strained teeth have stiffened without bound: the
        deflection is far beyond the first order.
    """
    whole = whole + np.zeros_like(stays.share.stiffness)
    brought, before, reference = None, None, stays.reference
    held_under = flanks.sides[0].setup.face.held_under
    if reference is not None and held_under is not None:
        brought = moved_share(flanks, bodies, np.full((1, 1, 1), held_under), reference)
        if brought is None:
            return None
        before = reference.forces, brought.forces
    forces, remaining_gaps, lost = (
        np.zeros_like(array) for array in (stays.forces, stays.remaining_gaps, stays.lost)
    )
    order, shares, held = [], [], []
    for strip in np.unique(stays.strips):
        torques = np.flatnonzero(stays.strips == strip)
        rise, near, asked = stays.rise[torques], stays.forces[torques], whole[torques]
        contacts = flanks.contacts(bodies, rise, float(strip))
        solved: _Solved | None
        if stays.shafts is not None:
            solved = _on_shafts(flanks, contacts, asked, near, before)
        else:
            solved = _on_rigid_shafts(contacts, asked, near, stays.share.transmission_error[torques])
        if solved is None:
            return None
        forces[torques] = solved.share.forces.reshape(near.shape)
        remaining_gaps[torques] = settled_gaps(solved.open.reshape(near.shape) + rise, forces[torques])
        lost[:, :, torques] = solved.lost
        held += [] if solved.shafts is None else [solved.shafts]
        shares.append(of_pairs(solved.share, near.shape[-1]))
        order.append(torques)
    back = np.argsort(np.concatenate(order))
    share = shares_together(shares, back)
    hubs = 0.0 if bodies.left_out & {"coupling", "hub_windup"} else sum(bodies.hub_windup)
    if np.any(share.stiffness * hubs >= 1.0):  # nothing else yields
        return None
    lost[:, 0] += flanks.turned_levers()
    return replace(
        stays,
        share=replace(share, iterations=share.iterations + stays.share.iterations),
        forces=forces,
        remaining_gaps=remaining_gaps,
        lost=lost,
        shafts=joined(held, back) if held else None,
        reference=brought,
    )


@record
class _Solved:
    """Share of cells, gaps that are left, what levers lose, and shafts where the load has brought them."""

    share: LoadShare
    open: Array
    lost: tuple[Array, Array]
    shafts: HeldShafts | None = None


def _on_rigid_shafts(contacts: Rolling, whole: Array, near: Array, approach: Array) -> _Solved | None:
    """Solve from contacts that stay."""
    share = _solved(contacts, whole, near, approach)
    if share is None:
        return None
    return _Solved(share, open_gaps(contacts, share), contacts.lever_losses(share))


def _on_shafts(
    flanks: Moving, contacts: Rolling, whole: Array, near: Array, brought: tuple[Array, Array] | None
) -> _Solved | None:
    """Solve on shafts that give way, held where the load brings them, or where forces on cells have brought them.

    Those forces are of contacts that stay, and of moving ones.
    """
    first = flanks.sides[0]
    count, shafts = first.lever_ratios.shape[-1], shafts_under_face(first.setup.face, first.setup.pair)
    assert shafts is not None
    # corners touch at the approach of the flanks, to which shafts do not contribute
    give = shafts.give(near if brought is None else brought[0], count)
    contacts = contacts.bent_by(give.reshape(*give.shape[:-2], -1))
    held_by = None if brought is None else brought[1].reshape(*brought[1].shape[:-2], -1)
    if held_by is not None:
        contacts = contacts.parted(shafts.parting(held_by, count))
    yielding = contacts.plus(shafts.compliance) if held_by is None else contacts
    share = _solved(yielding, whole, near, None)
    if share is None:
        return None
    turn = share.transmission_error
    open_ = open_gaps(yielding, share)
    at = contacts.linearised(share.forces, turn, contacts.all_bent(share.forces))
    by_tilt = np.zeros_like(share.forces) + shafts.levers(near.shape[-2], count)
    bears, wanted = share.forces > 0.0, np.ones(turn.shape, dtype=bool)
    slopes = at.jacobian.solved(at.own, at.reach, by_tilt, bears, wanted)
    lever_ratios = np.concatenate([side.flanks.lever_ratios for side in flanks.sides], axis=-1)
    gaps = np.concatenate([side.flanks.gaps for side in flanks.sides], axis=-1)
    share, held = shafts.held(share, lever_ratios, gaps, slopes, at.further_lever_ratios, count, held_by)
    share = replace(share, stiffness=share.stiffness - at.stiff)
    lost = yielding.lever_losses(replace(share, transmission_error=turn))
    return _Solved(share, open_, lost, held)


def open_gaps(contacts: Rolling, share: LoadShare) -> Array:
    """Gaps that a share leaves to contacts that do not bear (..., n) [m]; inf where nothing can touch."""
    bent = contacts.all_bent(share.forces)
    gaps = contacts.unloaded(share.forces, share.transmission_error, bent)
    return np.where(contacts.touchable, gaps, np.inf)


def _solved(contacts: Rolling, whole: Array, near: Array, approach: Array | None) -> LoadShare | None:
    """Forces on cells, from those of contacts that stay (torques, ..., pairs, cells), or from as much spread evenly.

    Along the central path where cells come and go in circles from both.
    """
    even = np.repeat(near.mean(axis=-1, keepdims=True), near.shape[-1], axis=-1)
    for start in (near,) if np.array_equal(near, even) else (near, even):
        loads = start.reshape(*near.shape[:-2], -1)
        share = share_forces(contacts, whole, loads, approach)
        if share is not None:
            return share
    return share_forces_by_path(contacts, whole, loads)
