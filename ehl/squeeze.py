"""What the oil between the nodes' cells weighs, and how it changes in time: the squeeze term on moving nodes.

d(rho h)/dt is taken over the volume between the middles of the cells beside a node. Where nodes move, oil passes the
middles by their velocity too, and what leaves one volume so enters the next: nothing is lost.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from base import Array
from ehl.discrete import Grid, Groups, film_gap, inlet_pressure


class Content(NamedTuple):
    """Oil of each node's volume, where it ends, and what stands there."""

    oil: Array  # rho/rho0 times area (n,) [m2]
    middles: Array  # x of the middle of each cell (n-1,) [m]
    film: Array  # rho h/rho0 there (n-1,) [m]

    @classmethod
    def of(cls, grid: Grid, groups: Groups, P: Array, H0: float) -> Content:
        """Compute all of full gaps; the first node's pressure is that of the inlet."""
        P = P.copy()
        P[0] = inlet_pressure(grid, groups)
        return cls.under(grid, groups, P, film_gap(grid, groups, P, H0))

    @classmethod
    def under(cls, grid: Grid, groups: Groups, P: Array, H: Array) -> Content:
        """Compute all of full gaps under pressures."""
        film = groups.lubricant.density_ratio(groups.pressure * P)[0] * H * groups.gap
        middles = 0.5 * groups.length * (grid.nodes[1:] + grid.nodes[:-1])
        return cls(film * grid.weights * groups.length, middles, 0.5 * (film[1:] + film[:-1]))


def by_parameter(before: Content, after: Content, step: float) -> Array:
    """Derivative of each inner node's content by a parameter at fixed P and H0, less what moving nodes sweep."""
    swept = before.film * (after.middles - before.middles) / step
    change: Array = (after.oil - before.oil)[1:-1] / step - np.diff(swept)
    return change


@dataclass(frozen=True)
class Storage:
    """Derivatives of the contents [a gap] by P and H of their nodes."""

    by_pressure: Array
    by_gap: Array

    @classmethod
    def of(cls, grid: Grid, groups: Groups, P: Array, H: Array) -> Storage:
        """Differentiate."""
        density, slope = groups.lubricant.density_ratio(groups.pressure * P)
        return cls(grid.weights * slope * groups.pressure * H, grid.weights * density)
