"""Compliance between cells of the face, position by position: among cells that may touch, by Cholesky's method."""

from __future__ import annotations

from abc import ABC, abstractmethod
from functools import cached_property
from typing import Self

import numpy as np

from base import Array, Booleans, Integers, record
from gears.sharing.load_coupling import Coupling

__all__ = ["CellCoupling", "CellJacobian", "ChangedCells", "solve_symmetric"]


START = 0.1
"""Part of an even share of the force with which a cell is taken in."""


class CellJacobian(ABC):
    """What couples cells of the face (``gears.sharing.load_coupling.Jacobian``), solved position by position."""

    @abstractmethod
    def block(self, at: int) -> tuple[Integers, Array]:
        """Cells that may touch and what couples them, of one of all positions (...) in their order."""

    def solved(
        self, slope: Array, reach: Array, residual: Array, active: Booleans, wanted: Booleans
    ) -> tuple[Array, Array]:
        """As of ``Jacobian``, of positions that are wanted."""
        unit, response = np.zeros((2, *residual.shape))
        size = residual.shape[-1]
        flat_unit, flat_response, stiff, closes, rest, bearing = (
            whole.reshape(-1, size) for whole in (unit, response, slope, reach, residual, active)
        )
        for at in np.flatnonzero(wanted).tolist():
            cells, block = self.block(at)
            bears = bearing[at].take(cells).nonzero()[0]
            chosen = cells[bears]
            # rows and then columns are copied much faster than both at once
            jacobian = block.take(bears, axis=0).take(bears, axis=1)
            jacobian.ravel()[:: len(bears) + 1] += stiff[at].take(chosen)
            sides = np.empty((2, len(bears)))
            sides[0], sides[1] = closes[at].take(chosen), rest[at].take(chosen)
            flat_unit[at, chosen], flat_response[at, chosen] = solve_symmetric(jacobian, sides)
        return unit, response


class CellCoupling(CellJacobian, Coupling):
    """Compliance between the cells of all pairs that may touch at each position.

    Attributes
    ----------
    cells : tuple of (m,) arrays of int
        Of the pairs that may touch at each position, among all n.
    blocks : tuple of (m, m) arrays
        Their compliance [m/N].
    unknowns : int
        n, pairs times cells.
    """

    apart = True

    def __init__(self, cells: tuple[Integers, ...], blocks: tuple[Array, ...], unknowns: int) -> None:
        self.cells, self.blocks, self.unknowns = cells, blocks, unknowns
        self.start = START / unknowns

    @cached_property
    def shortest(self) -> Array:
        """What each cell yields by its own unit force more than its neighbour does (positions, n) [m/N]."""
        differences = np.ones((len(self.blocks), self.unknowns))
        for row, cells, block in zip(differences, self.cells, self.blocks, strict=True):
            by_next = np.diagonal(block, 1)
            less = np.maximum(np.append(by_next, by_next[-1]), np.append(by_next[0], by_next))
            row[cells] = np.diagonal(block) - less
        return differences

    def applied(self, forces: Array, wanted: Booleans, known: Array) -> Array:
        """As of ``gears.sharing.load_coupling.Coupling``; 0 where cells cannot touch."""
        deflections, positions = known.copy(), len(self.blocks)
        flat, pressed = deflections.reshape(-1, self.unknowns), forces.reshape(-1, self.unknowns)
        for at in np.flatnonzero(wanted).tolist():
            cells, block = self.cells[at % positions], self.blocks[at % positions]
            flat[at, cells] = block @ pressed[at].take(cells)
        return deflections

    def block(self, at: int) -> tuple[Integers, Array]:
        """As of ``CellJacobian``."""
        position = at % len(self.blocks)
        return self.cells[position], self.blocks[position]

    def changed(self, change: Self, turn: Array, blocks: Array) -> ChangedCells:
        """As of ``gears.sharing.load_coupling.Coupling``."""
        return ChangedCells(self, change, turn, blocks)

    def plus(self, more: Array, count: int) -> CellCoupling:
        """With a further compliance that couples cells by their place on the face and side, whatever their pair.

        Parameters
        ----------
        more : (2, 2, cells, cells) array
            Displacement along the line of action of either side by forces on either [m/N].
        count : int
            Pairs on the loaded side; others follow them.
        """
        n, blocks = more.shape[-1], []
        for chosen, block in zip(self.cells, self.blocks, strict=True):
            side = (chosen[::n] // n >= count).astype(int)
            k = len(side)
            coupled = block.reshape(k, n, k, n) + np.swapaxes(more[side[:, None], side], 1, 2)
            blocks.append(coupled.reshape(k * n, k * n))
        return CellCoupling(self.cells, tuple(blocks), self.unknowns)

    def beside(self, other: CellCoupling, cross: tuple[Array, ...]) -> CellCoupling:
        """Of these cells and others after them, coupled by blocks between those that may touch (m, others) [m/N]."""
        chosen = (
            np.concatenate([first, second + self.unknowns])
            for first, second in zip(self.cells, other.cells, strict=True)
        )
        blocks = (
            np.block([[first, between], [between.T, second]])
            for first, between, second in zip(self.blocks, cross, other.blocks, strict=True)
        )
        return CellCoupling(tuple(chosen), tuple(blocks), self.unknowns + other.unknowns)

    def definite(self, slope: Array, active: Booleans, wanted: Booleans) -> bool:
        """Whether cells that bear yield to every change of their forces, with slopes of their laws (..., n) [m/N].

        Positions that are not wanted (...) are not looked at. Forces of others are one solution of many.
        """
        from scipy.linalg.lapack import dpotrf

        for at in zip(*np.nonzero(wanted), strict=True):
            cells, block = self.cells[at[-1]], self.blocks[at[-1]]
            bears = np.flatnonzero(active[at][cells])
            jacobian = block.take(bears, axis=0).take(bears, axis=1)
            jacobian.ravel()[:: len(bears) + 1] += slope[at][cells[bears]]
            if dpotrf(jacobian.T, lower=True)[1]:
                return False
        return True


@record
class ChangedCells(CellJacobian):
    """Compliance between cells that has changed by a turn; attributes as of ``Coupling.changed``."""

    coupling: CellCoupling
    change: CellCoupling
    turn: Array
    blocks: Array

    def block(self, at: int) -> tuple[Integers, Array]:
        """As of ``CellJacobian``."""
        cells, block = self.coupling.block(at)
        jacobian = block + self.turn.flat[at] * self.change.block(at)[1]
        n = self.blocks.shape[-1]
        pairs = cells[::n] // n
        k = np.arange(len(pairs))
        by_pair = jacobian.reshape(len(k), n, len(k), n)
        by_pair[k, :, k, :] += self.blocks.reshape(-1, *self.blocks.shape[-3:])[at][pairs]
        return cells, jacobian


def solve_symmetric(matrix: Array, sides: Array) -> Array:
    """Solve for rows of sides by Cholesky's method; where cells are narrow the matrix may be indefinite."""
    from scipy.linalg.lapack import dposv

    _, solution, failed = dposv(matrix.T, sides.T, lower=True)
    return np.asarray(np.linalg.solve(matrix, sides.T).T if failed else solution.T)
