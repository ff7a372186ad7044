"""Contacts that move over the face: solved over pairs and cells from contacts that stay."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from base import Array, Integers
from fem.contact.cell_contact import along_cells
from fem.contact.cell_laws import CellLaws
from fem.contact.cell_matrix import cell_coupling
from fem.contact.face_share import FaceShare, of_pairs, settled_gaps
from fem.contact.moving_cells import MovingCells
from fem.contact.moving_coupling import cell_roll, other_pairs, tooth_smoothing
from fem.contact.moving_newton import moved_forces
from fem.contact.partial_cells import PartialCells, partial_cells
from fem.pair.face_shafts import joined, shafts_under_face

if TYPE_CHECKING:
    from fem.contact.loaded_flanks import LoadedFlanks
    from fem.contact.moving_contact import MovingPairs
    from fem.laws.mesh_setup import MeshSetup
    from fem.pair.pair_compliance import PairCompliance
    from gears import LoadShare

__all__ = ["moved_over_face", "moving_cells"]


def moved_over_face(
    given: MeshSetup,
    bodies: PairCompliance,
    whole: Array,
    flanks: LoadedFlanks,
    kappa: Array,
    pairs: MovingPairs,
    stays: FaceShare,
) -> tuple[LoadShare, FaceShare] | None:
    """Solve with moving contacts over pairs and cells.

    Parameters
    ----------
    given : MeshSetup
    bodies : PairCompliance
    whole : (torques, 1, 1) array
        Torques over the base radius [N].
    flanks : LoadedFlanks
        Of contacts that stay.
    kappa : (positions, pairs) array
        Levers of the normals in whose forces the laws of ``pairs`` are.
    pairs : MovingPairs
    stays : FaceShare
        Of contacts that stay: what is begun with, and whose errors are taken over.

    Returns
    -------
    LoadShare and FaceShare, or None
        Of the pairs and of their cells; None where Newton's method does not settle.
    """
    assert given.face is not None
    shares: list[LoadShare] = []
    shape, lost_shape = stays.forces.shape, (2, *stays.forces.shape[:-1])
    forces, left, lost = np.zeros(shape), np.zeros(shape), (np.zeros(lost_shape), np.zeros(lost_shape))
    order, held = [], []
    shafts = shafts_under_face(given.face, given.pair)
    gaps = flanks.where.gap - flanks.where.gap.min(axis=-1, keepdims=True)
    for strip in np.unique(stays.strips):
        some = np.flatnonzero(stays.strips == strip)
        rise = stays.rise[some]
        still = moving_cells(given, bodies, flanks, kappa, pairs, rise, float(strip))
        cells = still
        if (
            shafts is not None
        ):  # corners touch at the approach of the flanks, to which shafts do not contribute
            bent = shafts.bent(stays.forces[some], flanks.kappa).sum(axis=-2)[..., None, :] / kappa[..., None]
            still = replace(still, along=still.along + bent.reshape(*bent.shape[:-2], -1))
            cells = replace(still, coupling=still.coupling.plus(shafts.compliance, kappa))
        found = _found(cells, whole[some], stays.forces[some])
        if found is None:
            return None
        forces[some] = cells.split(found.forces)
        open_ = np.where(cells.touchable, cells.unloaded(found.forces, found.transmission_error), np.inf)
        left[some] = settled_gaps(cells.split(open_) + rise, forces[some])
        turn = found.transmission_error
        if shafts is not None:
            at = still.linearised(found.forces, turn)
            by_tilt = np.zeros_like(found.forces) + shafts.levers(kappa)
            slopes = still.solved(replace(at, residual=by_tilt), turn, found.forces > 0.0)
            found, brought = shafts.held(found, kappa, gaps, slopes, at.arms)
            found = replace(found, stiffness=found.stiffness - at.stiff)
            held.append(brought)
        losses = cells.lever_losses(found.forces, found.pair_stiffness, turn)
        for every, one in zip(lost, losses, strict=True):
            every[:, some] = one
        shares.append(of_pairs(found, given.face.cells))
        order.append(some)
    back = np.argsort(np.concatenate(order))
    share = _in_order(shares, back)
    reached = joined(held, back) if held else None
    return share, replace(stays, forces=forces, left=left, lost=lost, shafts=reached)


def _found(cells: MovingCells, whole: Array, near: Array) -> LoadShare | None:
    """Forces on cells, from those of contacts that stay (torques, ..., pairs, cells), or from as much spread evenly."""
    even = np.repeat(near.mean(axis=-1, keepdims=True), near.shape[-1], axis=-1)
    for start in (near, even):
        begin = start.reshape(*near.shape[:-2], -1)
        nothing = np.zeros(begin.shape[:-1])
        deflection = cells.linearised(begin, nothing).residual
        approach = np.mean(deflection, axis=-1, where=begin > 0.0)
        found = moved_forces(cells, whole + nothing, begin, approach)
        if found is not None:
            return found
    return None


def moving_cells(
    given: MeshSetup,
    bodies: PairCompliance,
    flanks: LoadedFlanks,
    kappa: Array,
    pairs: MovingPairs,
    rise: Array,
    strip: float = 0.0,
) -> MovingCells:
    """Contacts that move on cells; cells that touch over a part of their length do as those that stay.

    Parameters
    ----------
    given, bodies, flanks, kappa, pairs
        As of ``moved_over_face``.
    rise : (torques, pitches, positions, pairs, cells) array
        By how much smallest gaps of cells fall short of their mean [m].
    strip : float
        Half-width of strips of pressure over a cell's length.
    """
    assert given.face is not None
    face, where = replace(given.face, strip=strip), flanks.where
    along = along_cells(face, given.pair, where)
    touchable = np.repeat(where.touchable & np.isfinite(where.gap), face.cells, axis=-1)
    flat, short = (*along.shape[:-2], -1), rise.reshape(*rise.shape[:-2], -1)
    clear = (pairs.clear[..., None] + along).reshape(*pairs.clear.shape[:-1], -1) - short
    stiff = cell_coupling(face, bodies, where, flanks.kappa, flanks.matrix)
    stays = partial_cells(CellLaws(flanks.laws, face.cells), stiff, short)
    return MovingCells(
        face.cells,
        other_pairs(stiff, where.touchable, flanks.kappa / kappa, flanks.matrix, pairs.bulk),
        cell_roll(face, bodies, where, pairs.moves),
        PartialCells(CellLaws(pairs.laws, face.cells), short, stays.whole),
        None if pairs.film is None else CellLaws(pairs.film, face.cells),
        np.where(touchable, clear, 0.0),
        along.reshape(flat),
        face.least_gap(given.pair),
        touchable,
        pairs.levers,
        pairs.moves,
        tooth_smoothing(face, bodies, where),
        pairs.own,
    )


def _in_order(shares: list[LoadShare], order: Integers) -> LoadShare:
    """Shares of some torques each, as one of all."""
    names = ("forces", "transmission_error", "stiffness", "pair_stiffness")
    every = {name: np.concatenate([getattr(one, name) for one in shares])[order] for name in names}
    return replace(shares[0], **every, iterations=max(one.iterations for one in shares))
