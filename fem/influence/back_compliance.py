"""What loads on one side of the teeth do to the other side: front flanks loaded, back flanks seen, and the reverse.

u on the flanks of the other hand along their inward normals, per unit line load; in the loaded sector itself the sum
of the half-plane and the regular part (``fem.elasticity.line_load``). X_k(a, b) belongs to a load at rho = a on the
left flank of tooth 0 and the right flank of tooth k at rho = b, counted anticlockwise. Mirrored gears are the same
gears, and Maxwell and Betti let load and point change places: X_k(a, b) = X_k(b, a), and a load on the right flank
moves the left one of tooth -k by the same. Samples that are not symmetric show an error of the elements.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from base import Array, Integers, record
from fem.elasticity.line_load import FlankPoints, LineLoads, flank_points, line_loads
from fem.influence.flank_variable import FlankVariable
from fem.influence.gear_compliance import cross_degree
from fem.influence.series import CrossSeries, FlankFit, left_out, of_teeth

if TYPE_CHECKING:
    from fem.elasticity.plane_elasticity import PlaneElasticity
    from fem.elasticity.ring import Ring

__all__ = ["BackCompliance", "back_by_mirror", "back_compliance", "teeth_around"]

MIRRORED: Array = np.array([[1.0], [-1.0]])
"""Radial and tangential components in a mirror through the gear's axis."""


@record
class BackCompliance:
    """Displacement of the flanks on the other side of a gear's teeth per unit line load.

    Attributes
    ----------
    series : mapping of int to CrossSeries
        X_k over both curvature radii [m per N/m].
    error : float
        Largest asymmetry of the samples and what the series leave out [m per N/m].
    """

    series: Mapping[int, CrossSeries]
    error: float

    def scaled(self, module: float, law: PlaneElasticity) -> BackCompliance:
        """Give a gear in modules and E* its size [m] and modulus."""
        modulus = law.plane_modulus
        series = {tooth: each.scaled(module, modulus) for tooth, each in self.series.items()}
        return BackCompliance(series, self.error / modulus)

    def off(self) -> BackCompliance:
        """Series that are off by their remainder."""
        change = left_out(self.series, self.error)
        series = {tooth: of_tooth.plus(change[tooth].coefficients) for tooth, of_tooth in self.series.items()}
        return replace(self, series=series)

    def across(self, tooth: Integers, load: Array, point: Array) -> Array:
        """Displacement into the right flank of a tooth by a load on the left flank of tooth 0 [m per N/m].

        Parameters
        ----------
        tooth : array of int
            Counted anticlockwise from the loaded one; 0 where it is too far away to feel the load.
        load, point : arrays
            Curvature radii [m].
        """
        return of_teeth(self.series, tooth, load, point)


def back_compliance(ring: Ring, rho: Array, reach: int) -> BackCompliance:
    """Load left flanks at growing curvature radii (n,) [m] and see the right ones of ``reach`` teeth on either side."""
    loads = line_loads(ring, flank_points(ring.mesh, rho, "left"))
    seen = flank_points(ring.mesh, rho, "right")
    return _fitted(rho, {tooth: _seen(loads, tooth, seen) for tooth in teeth_around(ring.mesh.teeth, reach)})


def back_by_mirror(loads: LineLoads, reach: int) -> BackCompliance:
    """As ``back_compliance``, by loads on left flanks that are solved already.

    Loads on right flanks are those on left ones in a mirror, but for the elements' errors: nothing is solved for
    other teeth.
    """
    ring, rho = loads.ring, loads.at.rho
    right, left = np.split(loads.cut_force.reshape(-1, 2, len(rho)), 2)
    mirrored = (np.concatenate([left, right]) * MIRRORED).reshape(loads.cut_force.shape)
    seen = flank_points(ring.mesh, rho, "right")
    return _fitted(
        rho,
        {
            tooth: mirrored.T @ ring.interfaces(loads.cut_force, tooth) if tooth else _seen(loads, 0, seen)
            for tooth in teeth_around(ring.mesh.teeth, reach)
        },
    )


def teeth_around(teeth: int, reach: int) -> range:
    """Teeth within reach of the loaded one, counted anticlockwise from it, of a gear that has so many."""
    most = min(reach, (teeth - 1) // 2)
    return range(-most, most + 1)


def _seen(loads: LineLoads, tooth: int, points: FlankPoints) -> Array:
    moved = loads.on_tooth(tooth, points)
    return moved if tooth else moved + loads.singular(points)


def _fitted(rho: Array, seen: Mapping[int, Array]) -> BackCompliance:
    """Fit what loads do at the same places of the other flanks (points, loads), tooth by tooth."""
    place = FlankVariable((float(rho[0]), float(rho[-1])))
    fit = FlankFit(place, place.unit(rho, hold=False), cross_degree(len(rho)))
    series, error = {}, 0.0
    for tooth, moved in seen.items():
        even = 0.5 * (moved + moved.T)
        series[tooth] = fit.cross(even)
        error = max(error, float(np.max(np.abs(moved - even))), float(fit.error(series[tooth], even)))
    return BackCompliance(series, error)
