"""Bearings on rigid shafts: radial, axial and tilting stiffness, and what they carry."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from base import Array, Faults, Limit

__all__ = ["SpatialBearing", "bearing_stiffness"]

SPRING = Limit(0.0, 1e15, "N/m", "1e8 to 1e9 for rolling bearings")
TILT_SPRING = Limit(0.0, 1e15, "N m/rad", "leave it out for bearings that tilt freely")
DAMPING_TIME = Limit(0.0, 1.0, "s", "1e-6 to 1e-5 for rolling bearings")
PLACE = Limit(-100.0, 100.0, "m", "from mid-face along the axis")


@dataclass(frozen=True)
class SpatialBearing:
    """Bearing on a rigid shaft: alike in all directions across the axis.

    Attributes
    ----------
    place : float
        From mid-face of the gear along the axis [m].
    radial, axial : float
        Stiffness [N/m].
    tilting : float
        Stiffness against turns about axes across the shaft [N m/rad].
    damping_time : float
        Damping over stiffness, in all directions [s].
    """

    place: float
    radial: float
    axial: float = 0.0
    tilting: float = 0.0
    damping_time: float = 0.0

    def check(self, faults: Faults, name: str) -> None:
        """Note every fault of the values."""
        faults.number(f"{name}.place", self.place, PLACE)
        for figure, limit in (("radial", SPRING), ("axial", SPRING), ("tilting", TILT_SPRING)):
            faults.number(f"{name}.{figure}", getattr(self, figure), limit)
        faults.number(f"{name}.damping_time", self.damping_time, DAMPING_TIME)

    @property
    def moves(self) -> Array:
        """Displacements of the shaft at the bearing by those of the gear (3, 6)."""
        moves = np.eye(3, 6)
        moves[0, 4], moves[1, 3] = self.place, -self.place
        return moves

    @property
    def springs(self) -> Array:
        """Stiffness along the three axes (3,) [N/m]."""
        return np.array([self.radial, self.radial, self.axial])

    @property
    def stiffness(self) -> Array:
        """Against displacements and turns of the gear (6, 6)."""
        matrix = self.moves.T @ (self.springs[:, None] * self.moves)
        matrix[[3, 4], [3, 4]] += self.tilting
        return np.asarray(matrix)

    @property
    def damping(self) -> Array:
        """Against their rates (6, 6)."""
        return self.damping_time * self.stiffness


def bearing_stiffness(bearings: Sequence[tuple[float, ...] | SpatialBearing]) -> Array:
    """Stiffness of bearings on a rigid shaft against displacements and turns of its gear at mid-face (6, 6).

    Nothing holds the turn about the axis.

    Parameters
    ----------
    bearings : sequence of SpatialBearing, or of tuples
        Tuples are place from mid-face along the axis [m], radial and axial [N/m], and tilting stiffness [N m/rad].

    Raises
    ------
    InputError
        With every fault.

    Examples
    --------
    >>> held = bearing_stiffness([(-0.1, 2e8, 1e8), (0.1, 2e8, 0.0)])
    >>> held[0, 0], held[2, 2], round(held[3, 3]), held[5, 5]
    (400000000.0, 100000000.0, 4000000, 0.0)
    """
    each = [given if isinstance(given, SpatialBearing) else SpatialBearing(*given) for given in bearings]
    with Faults() as faults:
        for i, bearing in enumerate(each):
            bearing.check(faults, f"bearings[{i}]")
    return np.asarray(sum((bearing.stiffness for bearing in each), np.zeros((6, 6))))
