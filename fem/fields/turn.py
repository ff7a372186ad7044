"""Vectors and stresses of the plane in frames that are turned against each other, by one angle or one for each."""

from __future__ import annotations

import numpy as np

from base import Array, record

__all__ = ["Turn"]


@record
class Turn:
    """Turn of bodies about the origin, anticlockwise.

    Attributes
    ----------
    cosine, sine : (...) arrays
        Of the angles.
    """

    cosine: Array
    sine: Array

    @classmethod
    def by(cls, angle: Array | float) -> Turn:
        """Turn by angles (...) [rad].

        Examples
        --------
        >>> turn = Turn.by(0.5 * np.pi)
        >>> turn.vectors(np.array([[1.0, 0.0]])).round(12) + 0.0
        array([[0., 1.]])
        >>> turn.stresses(np.array([[7.0, 2.0, 1.0]])).round(12)
        array([[ 2.,  7., -1.]])
        """
        return cls(np.cos(angle), np.sin(angle))

    def back(self) -> Turn:
        """Turn by the opposite angles."""
        return Turn(self.cosine, -self.sine)

    def vectors(self, values: Array) -> Array:
        """Vectors or points (..., 2) after the turn."""
        x, y = values[..., 0], values[..., 1]
        return np.stack([self.cosine * x - self.sine * y, self.sine * x + self.cosine * y], axis=-1)

    def stresses(self, values: Array) -> Array:
        """Stresses sigma_xx, sigma_yy, tau_xy (..., 3) after the turn."""
        xx, yy, xy = values[..., 0], values[..., 1], values[..., 2]
        middle, half = 0.5 * (xx + yy), 0.5 * (xx - yy)
        twice_cosine, twice_sine = self.cosine**2 - self.sine**2, 2 * self.sine * self.cosine
        along = twice_cosine * half - twice_sine * xy
        return np.stack([middle + along, middle - along, twice_sine * half + twice_cosine * xy], axis=-1)
