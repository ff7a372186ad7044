"""Lines of contact on flanks with relief or deviations: in each section they touch as those of a spur pair.

Axes are parallel, so that a turn of the pinion closes the gap of a section by that section alone. Where flanks lack
h(sigma) they touch at sigma = -R h' instead of where involutes do, with a gap that is less by R' h'^2/2
(``fem.laws.relieved_flanks``). All of it depends on the place on the line of action, of which these are tables.
"""

from __future__ import annotations

import numpy as np

from base import Array, Booleans, record

__all__ = ["RelievedLines"]


@record
class RelievedLines:
    """Where flanks with relief touch in a section, at places of the line of action.

    Attributes
    ----------
    place : (k,) array
        rho1 of the unlimited involutes, growing [m].
    gap : (k,) array
        By which a turn closes the gap there, less what both flanks lack at the places that touch [m].
    touched : (2, k) array
        Curvature radii where pinion and wheel are touched [m].
    lever : (2, k) array
        Levers of the common normal in the section about both axes, over the base radii.
    curvature : (k,) array
        Of the flanks in the section over that of the involutes.
    """

    place: Array
    gap: Array
    touched: Array
    lever: Array
    curvature: Array

    def on_flanks(self, place: Array) -> Booleans:
        """Which places have contacts of flanks; ``place`` (...) is rho1 of the unlimited involutes [m]."""
        return np.asarray((place >= self.place[0]) & (place <= self.place[-1]))

    def rho(self, place: Array) -> Array:
        """Curvature radii of pinion and wheel where they touch (2, ...) [m]; ``place`` as of ``on_flanks``."""
        return np.stack([np.interp(place, self.place, touched) for touched in self.touched])

    def gaps(self, place: Array) -> Array:
        """Gaps beyond what the flanks lack (...) [m]; ``place`` as of ``on_flanks``."""
        return np.interp(place, self.place, self.gap)

    def levers(self, place: Array) -> Array:
        """Levers about both axes over base radii (2, ...); ``place`` as of ``on_flanks``."""
        return np.stack([np.interp(place, self.place, lever) for lever in self.lever])

    def curvatures(self, place: Array) -> Array:
        """Of the flanks over that of the involutes (...); 1 beyond them, ``place`` as of ``on_flanks``."""
        curvature = np.interp(place, self.place, self.curvature)
        return np.where(self.on_flanks(place), curvature, 1.0)
