"""What the oil between the nodes' cells weighs, and how it changes in time: the squeeze term on moving nodes.

d(rho h)/dt is taken over the volume between the middles of the cells beside a node. Where nodes move, oil passes the
middles by their velocity too, and what leaves one volume so enters the next: nothing is lost.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from base import Array, Integers
from ehl.discrete.equations import Grid, Groups, film_gap, inlet_pressure


class Content(NamedTuple):
    """Oil of each node's volume, where it ends, and what stands there."""

    oil: Array  # rho/rho0 times area (n,) [m2]
    middles: Array  # x of the middle of each cell (n-1,) [m]
    film: Array  # rho h/rho0 there (n-1,) [m]

    @classmethod
    def of(cls, grid: Grid, groups: Groups, P: Array, H0: float, density: Array | None = None) -> Content:
        """Compute all of full gaps; the first node's pressure is that of the inlet."""
        P = P.copy()
        P[0] = inlet_pressure(grid, groups)
        return cls.under(grid, groups, P, film_gap(grid, groups, P, H0), density)

    @classmethod
    def under(cls, grid: Grid, groups: Groups, P: Array, H: Array, density: Array | None = None) -> Content:
        """Compute all of full gaps under pressures; with heat the density rho/rho0 is given."""
        if density is None:
            density = groups.lubricant.density_ratio(groups.pressure * P)[0]
        film = density * H * groups.gap
        middles = 0.5 * groups.length * (grid.nodes[1:] + grid.nodes[:-1])
        return cls(film * grid.weights * groups.length, middles, 0.5 * (film[1:] + film[:-1]))


def by_parameter(before: Content, after: Content, step: float) -> Array:
    """Derivative of each inner node's content by a parameter at fixed P and H0, less what moving nodes sweep."""
    swept = before.film * (after.middles - before.middles) / step
    change: Array = (after.oil - before.oil)[1:-1] / step - np.diff(swept)
    return change


def at_meniscus(
    before: Content, after: Content, places: tuple[float, float], layer: float, step: float
) -> float:
    """Likewise of the first node's content, less what the meniscus sweeps from one place to another [m2].

    Ahead of it the gap holds what the layer brings, a thickness [m].
    """
    swept = before.film[0] * (after.middles[0] - before.middles[0]) - layer * (places[1] - places[0])
    return float(after.oil[0] - before.oil[0] - swept) / step


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

    def rows(self, influence: Array, free: Integers) -> Array:
        """Derivatives of the free nodes' contents by the free pressures and H0 (k, k + 1)."""
        out = np.empty((free.size, free.size + 1))
        out[:, :-1] = self.by_gap[free, None] * influence[np.ix_(free, free)]
        out[np.arange(free.size), np.arange(free.size)] += self.by_pressure[free]
        out[:, -1] = self.by_gap[free]
        return out


@dataclass(frozen=True)
class Squeeze:
    """What the contents' change in one step of time adds to the net flux into each node's volume.

    A formula backwards in time makes the change of a content (rate C - past)/(gap u) and that of the middles' places
    their velocity, so that a film that stays as it is stays whole however the nodes move.
    """

    grid: Grid
    groups: Groups
    rate: float  # of the content now [1/s]
    past: Array  # what former contents leave of the change, likewise (n,) [m2/s]
    velocity: Array  # of the middles over u (n-1,)
    speed: float  # u [m/s]

    def swept(self, P: Array, H: Array) -> tuple[Array, Array]:
        """Flux that moving middles sweep, and its derivatives by P and H of the nodes on either side (n-1, 6)."""
        density, slope = self.groups.lubricant.density_ratio(self.groups.pressure * P)
        film, half = density * H, 0.5 * self.velocity
        by_pressure = slope * self.groups.pressure * H
        slopes = np.zeros((half.size, 6))
        slopes[:, 1], slopes[:, 2] = half * by_pressure[:-1], half * by_pressure[1:]
        slopes[:, 4], slopes[:, 5] = half * density[:-1], half * density[1:]
        return half * (film[:-1] + film[1:]), slopes

    def stored(self, P: Array, H: Array) -> Array:
        """Change of each content, as a net flux (n,)."""
        content = Content.under(self.grid, self.groups, P, H).oil
        change: Array = (self.rate * content - self.past) / (self.groups.gap * self.speed)
        return change

    def rows(self, P: Array, H: Array, influence: Array, free: Integers) -> Array:
        """Derivatives of the free nodes' changes by the free pressures and H0 (k, k + 1)."""
        by = Storage.of(self.grid, self.groups, P, H).rows(influence, free)
        return self.rate * self.groups.length / self.speed * by
