"""What couples contacts that move: compliance, how it changes with the roll, how teeth tilt along the face.

Loads on one side of the teeth do to the other X + D dX/dx_1 + D' dX/dx_1'.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Protocol

import numpy as np

from base import Array, Booleans, Integers, record
from fem.contact.cell_coupling import CellCoupling, CellJacobian, ChangedCells
from fem.contact.cell_matrix import cell_matrix, coupled_by, in_blocks, kept_unless_large
from fem.influence.gear_store import GearStore
from fem.pair.face_compliance import waves_of
from fem.pair.face_setting import SLICES
from fem.pair.unequal_widths import cosines
from gears.sharing.load_coupling import DenseCoupling, Jacobian

if TYPE_CHECKING:
    from fem.contact.moving_contact import ContactMoves
    from fem.laws.contact_candidates import ContactCandidates
    from fem.pair.face_setting import FaceSetting
    from fem.pair.pair_compliance import PairCompliance

__all__ = ["CellCross", "CrossCoupling", "DenseCross", "cell_roll", "other_pairs", "tooth_smoothing"]

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


class CrossCoupling(Protocol):
    """Compliance between n contacts of the loaded side and m of the other, and its derivatives by their places."""

    def applied(self, front: Array, back: Array, wanted: Booleans, known: Array) -> Array:
        """All three applied to the forces of the other side (3, ..., n + m); known where not wanted."""

    def beside(self, here: Jacobian, there: Jacobian, turn: Array, behind: Array) -> Jacobian:
        """Couple the contacts of both sides, where the pinion has turned by D (...) and the others by D' (...) [m]."""


@record
class DenseCross:
    """Matrices (3, positions, n, m), all positions together."""

    matrices: Array

    def applied(self, front: Array, back: Array, wanted: Booleans, known: Array) -> Array:
        """As of ``CrossCoupling``, of all positions unless none is wanted."""
        if not wanted.any():
            return known
        leading = (3, *(1,) * (front.ndim - 2), *self.matrices.shape[1:])
        cross = self.matrices.reshape(leading)
        seen = (cross @ back[..., None])[..., 0], (np.swapaxes(cross, -1, -2) @ front[..., None])[..., 0]
        return np.concatenate(seen, axis=-1)

    def beside(self, here: Jacobian, there: Jacobian, turn: Array, behind: Array) -> Jacobian:
        """As of ``CrossCoupling``."""
        assert isinstance(here, DenseCoupling)
        assert isinstance(there, DenseCoupling)
        still, by_turn, by_behind = self.matrices
        cross = still + turn[..., None, None] * by_turn + behind[..., None, None] * by_behind
        return here.beside(there, np.asarray(cross))


@record
class CellCross:
    """Between cells that may touch, position by position.

    Attributes
    ----------
    cells : two tuples of (m,) arrays of int
        Of the loaded side and of the other.
    blocks : three tuples of arrays
        X [m/N] and its derivatives [1/N] of each position.
    """

    cells: tuple[tuple[Integers, ...], tuple[Integers, ...]]
    blocks: tuple[tuple[Array, ...], ...]

    def applied(self, front: Array, back: Array, wanted: Booleans, known: Array) -> Array:
        """As of ``CrossCoupling``."""
        count, more, seen = front.shape[-1], back.shape[-1], known.copy()
        flat, loads = seen.reshape(3, -1, count + more), (front.reshape(-1, count), back.reshape(-1, more))
        for at in np.flatnonzero(wanted).tolist():
            position = at % len(self.cells[0])
            rows, columns = (cells[position] for cells in self.cells)
            for row, blocks in zip(flat, self.blocks, strict=True):
                row[at, rows] = blocks[position] @ loads[1][at, columns]
                row[at, count + columns] = blocks[position].T @ loads[0][at, rows]
        return seen

    def plus(self, more: Array) -> CellCross:
        """With a further compliance by places on the face, whatever the pairs.

        Parameters
        ----------
        more : (cells, cells) array
            Displacement along the line of action of one side by forces on the other [m/N].
        """
        sizes = ((len(block) // len(more), block.shape[1] // len(more)) for block in self.blocks[0])
        blocks = tuple(
            block + np.tile(more, pairs) for block, pairs in zip(self.blocks[0], sizes, strict=True)
        )
        return replace(self, blocks=(blocks, *self.blocks[1:]))

    def beside(self, here: Jacobian, there: Jacobian, turn: Array, behind: Array) -> Jacobian:
        """As of ``CrossCoupling``."""
        assert isinstance(here, ChangedCells)
        assert isinstance(there, ChangedCells)
        return _BothSides(self, here, there, turn, behind)


@record
class _BothSides(CellJacobian):
    """Cells on both sides; attributes as of ``CrossCoupling.beside``."""

    cross: CellCross
    here: ChangedCells
    there: ChangedCells
    turn: Array
    behind: Array

    def block(self, at: int) -> tuple[Integers, Array]:
        """As of ``CellJacobian``."""
        (rows, first), (columns, second) = self.here.block(at), self.there.block(at)
        still, by_turn, by_behind = (blocks[at % len(blocks)] for blocks in self.cross.blocks)
        between = still + self.turn.flat[at] * by_turn + self.behind.flat[at] * by_behind
        cells = np.concatenate([rows, columns + self.here.coupling.unknowns])
        return cells, np.block([[first, between], [between.T, second]])
