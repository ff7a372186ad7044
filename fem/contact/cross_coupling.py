"""What loads on one side of the teeth do to the other where contacts move: X + D dX/dx_1 + D' dX/dx_1'."""

from __future__ import annotations

from dataclasses import replace
from typing import Protocol

import numpy as np

from base import Array, Booleans, Integers, record
from fem.contact.cell_coupling import CellJacobian, ChangedCells
from gears.sharing.load_coupling import DenseCoupling, Jacobian

__all__ = ["CellCross", "CrossCoupling", "DenseCross"]


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
