"""What couples forces that share a load: a compliance applied to them, and Newton's equations among those that bear."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import Protocol, Self

import numpy as np

from base import Array, Booleans

__all__ = ["Coupling", "DenseCoupling", "Jacobian"]


class Jacobian(Protocol):
    """Derivatives of the overlap of n contacts at positions (...) by their forces, but for their own laws."""

    def solved(
        self, slope: Array, reach: Array, residual: Array, active: Booleans, wanted: Booleans
    ) -> tuple[Array, Array]:
        """Solve J a = reach and J b = residual among the active, with slopes on the diagonal of J.

        Parameters
        ----------
        slope, reach, residual : (..., n) arrays
            [m/N], [1], [m]
        active : (..., n) boolean array
        wanted : (...) boolean array
            Positions whose solution is asked for; those solved one by one leave the others zero.

        Returns
        -------
        array, array
            a [N/m] and b [N], zero where not active.
        """


class Coupling(ABC):
    """Symmetric compliance of n forces at positions (...), positive semidefinite.

    Attributes
    ----------
    apart : bool
        Whether positions are solved one by one, so that those that are settled are not solved again.
    start : float
        Part of the whole force with which one is taken in.
    """

    apart: bool
    start: float

    @abstractmethod
    def applied(self, forces: Array, wanted: Booleans, known: Array) -> Array:
        """Deflections (..., n) [m] by forces (..., n) [N], known where they are not wanted (...)."""

    @abstractmethod
    def solved(
        self, slope: Array, reach: Array, residual: Array, active: Booleans, wanted: Booleans
    ) -> tuple[Array, Array]:
        """As of ``Jacobian``."""

    @abstractmethod
    def changed(self, change: Self, turn: Array, blocks: Array) -> Jacobian:
        """Coupling that has changed by a turn, with what couples the contacts of a pair beside it.

        Parameters
        ----------
        change : Coupling
            Derivative by the turn, of the same forces [1/N].
        turn : (...) array
            [m]
        blocks : (..., pairs, cells, cells) array
            Between the n/pairs contacts of each pair [m/N].
        """


class DenseCoupling(Coupling):
    """Compliance as a matrix of every position, all positions solved together."""

    apart, start = False, 1e-2

    def __init__(self, matrix: Array) -> None:
        self.matrix = matrix

    def applied(self, forces: Array, wanted: Booleans, known: Array) -> Array:
        """As of ``Coupling``, of all positions unless none is wanted."""
        if not wanted.any():
            return known
        return np.asarray((self.matrix @ forces[..., None])[..., 0])

    def solved(
        self, slope: Array, reach: Array, residual: Array, active: Booleans, wanted: Booleans
    ) -> tuple[Array, Array]:
        """As of ``Jacobian``, of all positions."""
        identity = np.eye(slope.shape[-1])
        jacobian = self.matrix + slope[..., None] * identity
        coupled = active[..., :, None] & active[..., None, :]
        scale = float(np.abs(jacobian).max())
        sides = np.stack([np.where(active, reach, 0.0), np.where(active, residual, 0.0)], axis=-1)
        solutions = np.linalg.solve(np.where(coupled, jacobian / scale, identity), sides / scale)
        unit, response = np.moveaxis(solutions, -1, 0)
        return unit, response

    def changed(self, change: Self, turn: Array, blocks: Array) -> DenseCoupling:
        """As of ``Coupling``."""
        pairs, cells = np.arange(blocks.shape[-3]), blocks.shape[-1]
        matrix = np.asarray(self.matrix + turn[..., None, None] * change.matrix)
        by_pair = matrix.reshape(*matrix.shape[:-2], len(pairs), cells, len(pairs), cells)
        by_pair[..., pairs, :, pairs, :] += np.moveaxis(blocks, -3, 0)
        return DenseCoupling(matrix)

    def beside(self, other: Self, cross: Array) -> DenseCoupling:
        """Of these forces and others (..., m) after them, coupled by (..., n, m) [m/N]."""
        upper = np.concatenate([self.matrix, cross], axis=-1)
        lower = np.concatenate([np.swapaxes(cross, -1, -2), other.matrix], axis=-1)
        return DenseCoupling(np.concatenate([upper, lower], axis=-2))
