"""What couples cells of contacts that move: compliance, how it changes with the roll, how teeth tilt along the face."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from base import Array, Booleans
from fem.contact.cell_coupling import CellCoupling
from fem.contact.cell_matrix import cell_matrix, coupled_by, in_blocks, kept_unless_large
from fem.influence.gear_store import GearStore
from fem.pair.face_compliance import waves_of
from fem.pair.face_setting import SLICES
from fem.pair.unequal_widths import cosines

if TYPE_CHECKING:
    from fem.contact.moving_contact import ContactMoves
    from fem.laws.contact_candidates import ContactCandidates
    from fem.pair.face_setting import FaceSetting
    from fem.pair.pair_compliance import PairCompliance

__all__ = ["cell_roll", "other_pairs", "tooth_smoothing"]

STEP = 1e-3
"""Part of the module over which compliances are differentiated by the place."""


def cell_roll(
    face: FaceSetting, bodies: PairCompliance, candidates: ContactCandidates, moves: ContactMoves
) -> CellCoupling:
    """C' between cells of pairs that may touch [1/N], kept for loads and alignments that follow."""
    held = replace(face, strip=0.0)  # which does not change with the place

    def differ(of: slice) -> Array:
        rho, roll, step = candidates.rho[:, of], moves.roll[of], STEP * bodies.pair.module
        (count, pairs), n = roll.shape[:2], face.cells
        still = np.zeros_like(roll)
        ahead, behind = (
            cell_matrix(held, bodies, rho + np.array([by, 0.0])[:, None, None], still, (0,))
            for by in (step, -step)
        )
        derivative = ((ahead - behind) / (2 * step)).reshape(count, pairs, n, pairs, n)
        cell, rolls = np.arange(n), np.diagonal(roll, axis1=-2, axis2=-1) != 0.0
        derivative[:, :, cell, :, cell] += n * roll
        derivative *= (rolls[..., :, None] & rolls[..., None, :])[:, :, None, :, None]
        return np.asarray(derivative.reshape(count, pairs * n, pairs * n))

    def cut() -> CellCoupling:
        return in_blocks(differ, candidates.touchable, face.cells)

    numbers = int(np.sum((candidates.touchable.sum(axis=-1) * face.cells) ** 2))
    key = coupled_by(bodies, held, candidates.rho, candidates.touchable, moves.roll)
    return kept_unless_large("roll", key, numbers, cut)


def other_pairs(held: CellCoupling, touchable: Booleans, more: Array) -> CellCoupling:
    """Compliance between cells that has another one of the plane.

    Parameters
    ----------
    held : CellCoupling
    touchable : (positions, pairs) boolean array
    more : (positions, pairs, pairs) array
        By which that of the plane is more [m/N].
    """
    pairs = touchable.shape[-1]
    n, blocks = held.unknowns // pairs, []
    cell = np.arange(n)
    for row, block in enumerate(held.blocks):
        at = np.flatnonzero(touchable[row])
        k = len(at)
        coupled = block.reshape(k, n, k, n).copy()
        coupled[:, cell, :, cell] += n * more[row][np.ix_(at, at)]
        blocks.append(coupled.reshape(k * n, k * n))
    return CellCoupling(held.cells, tuple(blocks), held.unknowns)


def tooth_smoothing(face: FaceSetting, bodies: PairCompliance, candidates: ContactCandidates) -> Array:
    """S of each pair (positions, pairs, cells, cells): how the tilt of both its flanks follows the load.

    Slices tilt by their own load alone.
    """
    if face.model == SLICES:
        return np.broadcast_to(
            np.eye(face.cells), (*candidates.touchable.shape, face.cells, face.cells)
        ).copy()
    pair, step = bodies.pair, STEP
    wave: Array = np.arange(1, face.cells, dtype=float) * (np.pi * pair.module / pair.face_width)
    slow, fast = np.zeros(candidates.touchable.shape), np.zeros((*candidates.touchable.shape, len(wave)))
    gears = zip((bodies.pinion, bodies.wheel), bodies.meshed, bodies.motions, candidates.rho, strict=True)
    for gear, meshed, motion, place in gears:
        rho = np.where(candidates.touchable, np.clip(place, *motion.rho_range), motion.rho_range[0])
        lever, at = gear.base_radius / rho, rho / pair.module
        waves = waves_of(meshed, GearStore())
        slope = (waves.own_at(at + step, wave) - waves.own_at(at - step, wave)) / (2 * step * pair.module)
        even = gear.own_slope(rho) * lever
        slow += even
        fast += even[..., None] + slope / gear.law.plane_modulus * lever[..., None]
    part = np.ones((*slow.shape, face.cells))
    part[..., 1:] = np.clip(fast / slow[..., None], 0.0, 1.0)
    modes = cosines(face.cells)
    return np.asarray(np.einsum("mc,...m,md->...cd", modes, part, modes, optimize=True))
