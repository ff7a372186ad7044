"""What couples forces that share a load: a compliance applied to them, and Newton's equations among those that bear."""

from __future__ import annotations

from abc import ABC, abstractmethod

import numpy as np

from base import Array, Booleans

__all__ = ["Coupling", "DenseCoupling"]


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

    @property
    @abstractmethod
    def shape(self) -> tuple[int, ...]:
        """(..., n, n)."""

    @property
    @abstractmethod
    def finite(self) -> bool:
        """Whether all numbers are finite."""

    @property
    @abstractmethod
    def diagonal(self) -> Array:
        """Deflection of each by its own unit force (..., n) [m/N]."""

    @abstractmethod
    def applied(self, forces: Array, wanted: Booleans, known: Array) -> Array:
        """Deflections (..., n) [m] by forces (..., n) [N], known where they are not wanted (...)."""

    @abstractmethod
    def solved(
        self, slope: Array, residual: Array, active: Booleans, wanted: Booleans
    ) -> tuple[Array, Array, float]:
        """Solve J a = s 1 and J b = residual among the active, with J the compliance and a diagonal of slopes.

        Parameters
        ----------
        slope, residual : (..., n) arrays
            [m/N], [m]
        active : (..., n) boolean array
        wanted : (...) boolean array
            Positions whose solution is asked for; zero elsewhere where positions are `apart`.

        Returns
        -------
        array, array, float
            a and b, zero where not active, and the scale s [m/N].
        """


class DenseCoupling(Coupling):
    """Compliance as a matrix of every position, all positions solved together."""

    apart, start = False, 1e-2

    def __init__(self, matrix: Array) -> None:
        self.matrix = matrix

    @property
    def shape(self) -> tuple[int, ...]:
        """(..., n, n)."""
        return self.matrix.shape

    @property
    def finite(self) -> bool:
        """Whether all numbers are finite."""
        return bool(np.all(np.isfinite(self.matrix)))

    @property
    def diagonal(self) -> Array:
        """Deflection of each by its own unit force (..., n) [m/N]."""
        return np.diagonal(self.matrix, axis1=-2, axis2=-1)

    def applied(self, forces: Array, wanted: Booleans, known: Array) -> Array:
        """As of ``Coupling``, of all positions unless none is wanted."""
        if not wanted.any():
            return known
        return np.asarray((self.matrix @ forces[..., None])[..., 0])

    def solved(
        self, slope: Array, residual: Array, active: Booleans, wanted: Booleans
    ) -> tuple[Array, Array, float]:
        """As of ``Coupling``, of all positions."""
        jacobian = self.matrix + slope[..., None] * np.eye(slope.shape[-1])
        coupled = active[..., :, None] & active[..., None, :]
        matrix = np.where(coupled, jacobian, np.eye(slope.shape[-1]))
        scale = float(np.abs(jacobian).max())
        sides = np.stack((np.where(active, 1.0, 0.0), np.where(active, residual / scale, 0.0)), axis=-1)
        solutions = np.linalg.solve(np.where(coupled, matrix / scale, matrix), sides)
        return solutions[..., 0], solutions[..., 1], scale
