"""Displacements of a gear's flanks by unit line loads at some places, from which its compliance is interpolated."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from base import Array, record
from fem.elasticity.line_load import LineLoads, flank_points, joined, line_loads
from fem.elasticity.ring import Ring

if TYPE_CHECKING:
    from gears import ToothProfile

__all__ = ["CORNER_CLEARANCE", "FlankSamples", "flank_loads", "sample_places", "sampled", "samples_of"]

CORNER_CLEARANCE = 0.01
"""Loads nearer to the tip corner than this (in modules of rho) are placed at this distance."""


@record
class FlankSamples:
    """Displacements by unit line loads at some places of a flank.

    Attributes
    ----------
    rho : (n,) array
        Curvature radii of the loads, growing [m].
    own : (n,) array
        u_r at each load [m per N/m].
    cross : (reach, n, n) array
        Displacement at the same places of the k-th tooth on the side of growing rho (rows: load).
    corner : (reach, n) array
        Displacement of that tooth's last place along the flank's tangent towards the tip.
    """

    rho: Array
    own: Array
    cross: Array
    corner: Array


def sample_places(profile: ToothProfile, count: int) -> Array:
    """Chebyshev points in the root of what rho lacks to the tip corner, stretched to include both ends of the flank.

    Whatever the mate reaches (count,) [m].
    """
    low, end = profile.flank_rho
    high = end - CORNER_CLEARANCE * profile.module
    unit = np.cos(np.pi * (np.arange(count) + 0.5) / count)
    near, far = np.sqrt(end - high), np.sqrt(end - low)
    root = near + 0.5 * (far - near) * (1 + unit / unit[0])
    return np.asarray(np.clip(end - root**2, low, high))


def flank_loads(ring: Ring, rho: Array, flank: str = "left") -> LineLoads:
    """Load a flank at growing curvature radii [m], and the last place once more along the tangent towards the tip."""
    at = flank_points(ring.mesh, rho, flank)
    return line_loads(ring, joined(at, at.part(slice(-1, None)).towards_tip()))


def sampled(ring: Ring, rho: Array, reach: int = 1, flank: str = "left") -> FlankSamples:
    """Load a flank at growing curvature radii [m] and take the displacements there and on ``reach`` teeth."""
    return samples_of(flank_loads(ring, rho, flank), reach, flank)


def samples_of(all_loads: LineLoads, reach: int = 1, flank: str = "left") -> FlankSamples:
    """As ``sampled``, by ``flank_loads``."""
    count = len(all_loads.at.rho) - 1
    loads = all_loads.part(slice(count))
    teeth = [tooth if flank == "left" else -tooth for tooth in range(1, reach + 1)]
    there = np.array([loads.on_neighbour(tooth, all_loads) for tooth in teeth])
    cross, corner = np.swapaxes(there[:, :count], 1, 2), there[:, count]
    return FlankSamples(loads.at.rho, loads.regular_at_load(), cross, corner)
