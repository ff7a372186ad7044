"""Tip edges of a helical pair beyond the path, which lines of contact reach under load.

A line of contact leaves the path where undeformed involutes end. Beyond that, in each section, a tip edge stands before
the other flank as that of a spur pair does, at the place of the line there: tables over the distance from the path.
"""

from __future__ import annotations

import numpy as np

from base import Array, Booleans, record

__all__ = ["EdgesOfLines"]


@record
class EdgesOfLines:
    """Tip edges of a helical pair beyond the path: of the wheel before A first, then of the pinion after E.

    Attributes
    ----------
    path : (float, float)
        rho1 at which contact of the involutes starts and ends [m].
    ends : (float, float)
        rho1 up to which flanks touch beside their corners [m]: those of the path, with relief farther out.
    distance : (2, k) array
        Beyond either of these ends [m], from 0 on.
    gap : (2, k) array
        By which a turn closes the gap there, less what both flanks lack at the places that touch [m].
    touched : (2, k) array
        Curvature radii of the flank that is touched: of the pinion before A, of the wheel after E [m].
    lever : (2, k) array
        Of the force about the axis of the gear whose edge it is, over its base radius; 1 about the other axis.
    """

    path: tuple[float, float]
    ends: tuple[float, float]
    distance: Array
    gap: Array
    touched: Array
    lever: Array

    @property
    def reached(self) -> tuple[float, float]:
        """rho1 up to which there are edges [m]."""
        return self.ends[0] - float(self.distance[0, -1]), self.ends[1] + float(self.distance[1, -1])

    @property
    def beyond_path(self) -> float:
        """How far beyond the path there are edges [m]."""
        return float(self.distance.max()) + max(self.path[0] - self.ends[0], self.ends[1] - self.path[1])

    def closed_by(self, deflection: float) -> float:
        """How far beyond the flanks' ends a turn closes the gaps of flanks that lack nothing [m]."""
        pairs = zip(self.gap, self.distance, strict=True)
        return max(float(np.interp(deflection, gap, distance)) for gap, distance in pairs)

    def beyond(self, place: Array) -> Booleans:
        """Which places are beyond the ends, where edges touch; ``place`` as of ``rho``."""
        return np.asarray((place < self.ends[0]) | (place > self.ends[1]))

    def rho(self, place: Array, line_of_action: float) -> Array:
        """Curvature radii of pinion and wheel where they touch (2, ...) [m].

        Parameters
        ----------
        place : (...) array
            rho1 of the unlimited involutes [m].
        line_of_action : float
            rho1 + rho2 on the line of action [m].
        """
        (start, end), (low, high) = self.ends, self.path
        before, after = (
            np.interp(away, distance, touched)
            for away, distance, touched in zip(self._away(place), self.distance, self.touched, strict=True)
        )
        first = np.where(place < start, before, np.minimum(place, high))
        second = np.where(place > end, after, line_of_action - np.maximum(place, low))
        return np.stack([first, second])

    def gaps(self, place: Array) -> Array:
        """Gaps beyond what the flanks lack (...) [m], 0 between the ends; ``place`` as of ``rho``."""
        before, after = (
            np.where(away > 0.0, np.interp(away, distance, gap), 0.0)
            for away, distance, gap in zip(self._away(place), self.distance, self.gap, strict=True)
        )
        return np.asarray(before + after)

    def levers(self, place: Array) -> Array:
        """Levers about both axes over base radii (2, ...), 1 between the ends; ``place`` as of ``rho``."""
        before, after = (
            np.where(away > 0.0, np.interp(away, distance, lever), 1.0)
            for away, distance, lever in zip(self._away(place), self.distance, self.lever, strict=True)
        )
        return np.stack([after, before])

    def _away(self, place: Array) -> tuple[Array, Array]:
        start, end = self.ends
        return start - place, place - end
