"""Load shared by contacts that move on one side of the teeth, from the solution of contacts that stay."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from base import Array, Integers, record
from fem.contact.cell_coupling import CellCoupling
from fem.contact.face_share import FaceShare, of_pairs, settled_gaps
from fem.contact.moved_side import MovedSide
from fem.contact.moving_contacts import MovingContacts
from fem.pair.face_shafts import HeldShafts, joined, shafts_under_face
from gears.sharing.active_set import LoadShare, share_forces

if TYPE_CHECKING:
    from fem.pair.pair_compliance import PairCompliance

__all__ = ["MovedShare", "moved_share"]


@record
class MovedShare:
    """Contacts that move, solved.

    Attributes
    ----------
    share : LoadShare
        Of the pairs.
    open : (torques, pitches, positions, pairs) array
        Gap that is left where a pair does not bear [m].
    lost : two (2, torques, pitches, positions, pairs) arrays
        Parts of both base radii by which levers of forces, and of further ones, are shorter.
    face : FaceShare or None
        Forces on cells, where there are any.
    """

    share: LoadShare
    open: Array
    lost: tuple[Array, Array]
    face: FaceShare | None = None


def moved_share(
    side: MovedSide, bodies: PairCompliance, whole: Array, stays: LoadShare, over: FaceShare | None
) -> MovedShare | None:
    """Solve with contacts that move.

    Parameters
    ----------
    side : MovedSide
    bodies : PairCompliance
    whole : (torques, 1, 1) array
        Torques over the base radius [N].
    stays, over : LoadShare, FaceShare or None
        Of contacts that stay, and of their cells: what is begun with, and whose errors are taken over.

    Returns
    -------
    MovedShare or None
        None where Newton's method does not settle: the deflection is far beyond the first order.
    """
    if over is not None:
        return _over_face(side, bodies, whole, over)
    contacts = side.in_plane()
    share = share_forces(
        contacts, whole + np.zeros_like(stays.stiffness), stays.forces, stays.transmission_error
    )
    if share is None:
        return None
    turn, lost = share.transmission_error, contacts.lever_losses(share)
    open_ = contacts.unloaded(share.forces, turn, contacts.all_bent(share.forces))
    return MovedShare(replace(share, iterations=share.iterations + stays.iterations), open_, lost)


def _over_face(side: MovedSide, bodies: PairCompliance, whole: Array, stays: FaceShare) -> MovedShare | None:
    """Solve on cells, for all torques with strips of one width together."""
    setup = side.setup
    assert setup.face is not None
    forces, remaining_gaps = np.zeros_like(stays.forces), np.zeros_like(stays.forces)
    lost = tuple(np.zeros((2, *stays.forces.shape[:-1])) for _ in range(2))
    order, shares, held = [], [], []
    for strip in np.unique(stays.strips):
        torques = np.flatnonzero(stays.strips == strip)
        rise, near = stays.rise[torques], stays.forces[torques]
        contacts = side.on_cells(bodies, rise, float(strip))
        solved = _on_shafts(side, contacts, whole[torques], near)
        if solved is None:
            return None
        share, open_, losses, brought = solved
        forces[torques] = contacts.split(share.forces)
        remaining_gaps[torques] = settled_gaps(contacts.split(open_) + rise, forces[torques])
        for lost_part, loss in zip(lost, losses, strict=True):
            lost_part[:, torques] = loss
        held += [] if brought is None else [brought]
        shares.append(of_pairs(share, setup.face.cells))
        order.append(torques)
    back = np.argsort(np.concatenate(order))
    reached = joined(held, back) if held else None
    face = replace(stays, forces=forces, remaining_gaps=remaining_gaps, shafts=reached)
    return MovedShare(_in_order(shares, back), face.open, (lost[0], lost[1]), face)


def _on_shafts(
    side: MovedSide, contacts: MovingContacts, whole: Array, near: Array
) -> tuple[LoadShare, Array, tuple[Array, Array], HeldShafts | None] | None:
    """Share of cells, gaps that are left, what levers lose, and the shafts that are held where the load brings them."""
    setup, lever_ratios = side.setup, side.lever_ratios
    assert setup.face is not None
    shafts, yielding = shafts_under_face(setup.face, setup.pair), contacts
    if shafts is not None:  # corners touch at the approach of the flanks, to which shafts do not contribute
        bent = (
            shafts.bent(near, side.flanks.lever_ratios).sum(axis=-2)[..., None, :] / lever_ratios[..., None]
        )
        contacts = replace(contacts, along=contacts.along + bent.reshape(*bent.shape[:-2], -1))
        assert isinstance(contacts.coupling, CellCoupling)
        yielding = replace(contacts, coupling=contacts.coupling.plus(shafts.compliance, lever_ratios))
    share = _solved(yielding, whole, near)
    if share is None:
        return None
    turn = share.transmission_error
    open_ = yielding.unloaded(share.forces, turn, yielding.all_bent(share.forces))
    open_ = np.where(contacts.touchable, open_, np.inf)
    brought = None
    if shafts is not None:
        at = contacts.linearised(share.forces, turn, contacts.all_bent(share.forces))
        by_tilt = np.zeros_like(share.forces) + shafts.levers(lever_ratios)
        bears, wanted = share.forces > 0.0, np.ones(turn.shape, dtype=bool)
        slopes = at.jacobian.solved(at.own, at.reach, by_tilt, bears, wanted)
        gap = side.flanks.candidates.gap
        gaps = gap - gap.min(axis=-1, keepdims=True)
        share, brought = shafts.held(share, lever_ratios, gaps, slopes, at.further_lever_ratios)
        share = replace(share, stiffness=share.stiffness - at.stiff)
    return share, open_, yielding.lever_losses(replace(share, transmission_error=turn)), brought


def _solved(contacts: MovingContacts, whole: Array, near: Array) -> LoadShare | None:
    """Forces on cells, from those of contacts that stay (torques, ..., pairs, cells), or from as much spread evenly."""
    even = np.repeat(near.mean(axis=-1, keepdims=True), near.shape[-1], axis=-1)
    for start in (near, even):
        begin = start.reshape(*near.shape[:-2], -1)
        share = share_forces(contacts, whole + np.zeros(begin.shape[:-1]), begin, None)
        if share is not None:
            return share
    return None


def _in_order(shares: list[LoadShare], order: Integers) -> LoadShare:
    """Shares of some torques each, as one of all."""
    names = ("forces", "transmission_error", "stiffness", "pair_stiffness")
    columns = {name: np.concatenate([getattr(share, name) for share in shares])[order] for name in names}
    return replace(shares[0], **columns, iterations=max(share.iterations for share in shares))
