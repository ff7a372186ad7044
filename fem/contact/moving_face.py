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
    setup: MeshSetup,
    bodies: PairCompliance,
    whole: Array,
    flanks: LoadedFlanks,
    lever_ratios: Array,
    pairs: MovingPairs,
    stays: FaceShare,
) -> tuple[LoadShare, FaceShare] | None:
    """Solve with moving contacts over pairs and cells.

    Parameters
    ----------
    setup : MeshSetup
    bodies : PairCompliance
    whole : (torques, 1, 1) array
        Torques over the base radius [N].
    flanks : LoadedFlanks
        Of contacts that stay.
    lever_ratios : (positions, pairs) array
        Levers of the normals in whose forces the laws of ``pairs`` are.
    pairs : MovingPairs
    stays : FaceShare
        Of contacts that stay: what is begun with, and whose errors are taken over.

    Returns
    -------
    LoadShare and FaceShare, or None
        Of the pairs and of their cells; None where Newton's method does not settle.
    """
    assert setup.face is not None
    shares: list[LoadShare] = []
    shape, lost_shape = stays.forces.shape, (2, *stays.forces.shape[:-1])
    forces, remaining_gaps, lost = (
        np.zeros(shape),
        np.zeros(shape),
        (np.zeros(lost_shape), np.zeros(lost_shape)),
    )
    order, held = [], []
    shafts = shafts_under_face(setup.face, setup.pair)
    gaps = flanks.candidates.gap - flanks.candidates.gap.min(axis=-1, keepdims=True)
    for strip in np.unique(stays.strips):
        torques = np.flatnonzero(stays.strips == strip)
        rise = stays.rise[torques]
        still = moving_cells(setup, bodies, flanks, lever_ratios, pairs, rise, float(strip))
        cells = still
        if (
            shafts is not None
        ):  # corners touch at the approach of the flanks, to which shafts do not contribute
            bent = (
                shafts.bent(stays.forces[torques], flanks.lever_ratios).sum(axis=-2)[..., None, :]
                / lever_ratios[..., None]
            )
            still = replace(still, along=still.along + bent.reshape(*bent.shape[:-2], -1))
            cells = replace(still, coupling=still.coupling.plus(shafts.compliance, lever_ratios))
        load_share = _solved(cells, whole[torques], stays.forces[torques])
        if load_share is None:
            return None
        forces[torques] = cells.split(load_share.forces)
        open_ = np.where(
            cells.touchable, cells.unloaded(load_share.forces, load_share.transmission_error), np.inf
        )
        remaining_gaps[torques] = settled_gaps(cells.split(open_) + rise, forces[torques])
        turn = load_share.transmission_error
        if shafts is not None:
            at = still.linearised(load_share.forces, turn)
            by_tilt = np.zeros_like(load_share.forces) + shafts.levers(lever_ratios)
            slopes = still.solved(replace(at, residual=by_tilt), turn, load_share.forces > 0.0)
            load_share, brought = shafts.held(load_share, lever_ratios, gaps, slopes, at.further_lever_ratios)
            load_share = replace(load_share, stiffness=load_share.stiffness - at.stiff)
            held.append(brought)
        losses = cells.lever_losses(load_share.forces, load_share.pair_stiffness, turn)
        for lost_part, loss in zip(lost, losses, strict=True):
            lost_part[:, torques] = loss
        shares.append(of_pairs(load_share, setup.face.cells))
        order.append(torques)
    back = np.argsort(np.concatenate(order))
    share = _in_order(shares, back)
    reached = joined(held, back) if held else None
    return share, replace(stays, forces=forces, remaining_gaps=remaining_gaps, lost=lost, shafts=reached)


def _solved(cells: MovingCells, whole: Array, near: Array) -> LoadShare | None:
    """Forces on cells, from those of contacts that stay (torques, ..., pairs, cells), or from as much spread evenly."""
    even = np.repeat(near.mean(axis=-1, keepdims=True), near.shape[-1], axis=-1)
    for start in (near, even):
        begin = start.reshape(*near.shape[:-2], -1)
        nothing = np.zeros(begin.shape[:-1])
        deflection = cells.linearised(begin, nothing).residual
        approach = np.mean(deflection, axis=-1, where=begin > 0.0)
        load_share = moved_forces(cells, whole + nothing, begin, approach)
        if load_share is not None:
            return load_share
    return None


def moving_cells(
    setup: MeshSetup,
    bodies: PairCompliance,
    flanks: LoadedFlanks,
    lever_ratios: Array,
    pairs: MovingPairs,
    rise: Array,
    strip: float = 0.0,
) -> MovingCells:
    """Contacts that move on cells; cells that touch over a part of their length do as those that stay.

    Parameters
    ----------
    setup, bodies, flanks, lever_ratios, pairs
        As of ``moved_over_face``.
    rise : (torques, pitches, positions, pairs, cells) array
        By how much smallest gaps of cells fall short of their mean [m].
    strip : float
        Half-width of strips of pressure over a cell's length.
    """
    assert setup.face is not None
    face, candidates = replace(setup.face, strip=strip), flanks.candidates
    along = along_cells(face, setup.pair, candidates)
    touchable = np.repeat(candidates.touchable & np.isfinite(candidates.gap), face.cells, axis=-1)
    flat, short = (*along.shape[:-2], -1), rise.reshape(*rise.shape[:-2], -1)
    clear = (pairs.clear[..., None] + along).reshape(*pairs.clear.shape[:-1], -1) - short
    stiff = cell_coupling(face, bodies, candidates, flanks.lever_ratios, flanks.matrix)
    stays = partial_cells(CellLaws(flanks.laws, face.cells), stiff, short)
    return MovingCells(
        face.cells,
        other_pairs(
            stiff, candidates.touchable, flanks.lever_ratios / lever_ratios, flanks.matrix, pairs.bulk
        ),
        cell_roll(face, bodies, candidates, pairs.moves),
        PartialCells(CellLaws(pairs.laws, face.cells), short, stays.whole),
        None if pairs.film is None else CellLaws(pairs.film, face.cells),
        np.where(touchable, clear, 0.0),
        along.reshape(flat),
        face.least_gap(setup.pair),
        touchable,
        pairs.tilted_lever_ratios,
        pairs.moves,
        tooth_smoothing(face, bodies, candidates),
        pairs.own,
    )


def _in_order(shares: list[LoadShare], order: Integers) -> LoadShare:
    """Shares of some torques each, as one of all."""
    names = ("forces", "transmission_error", "stiffness", "pair_stiffness")
    columns = {name: np.concatenate([getattr(share, name) for share in shares])[order] for name in names}
    return replace(shares[0], **columns, iterations=max(share.iterations for share in shares))
