"""A contact on one grid after another: starts, transfers between grids and the figures of each."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Self

import numpy as np

from base import Array
from ehl.discrete.contact import LineContact
from ehl.discrete.equations import Grid, Groups, centre_gap, film_gap
from ehl.discrete.grid import clusters
from ehl.discrete.newton import Iteration, newton
from ehl.discrete.regressions import moes_central
from ehl.solving.plan import Plan

if TYPE_CHECKING:
    from ehl.discrete.thermal_oil import ThermalOil

_SHARP = 0.2  # a maximum narrower than this share of the outlet zone is a spike
_DROP = 0.9  # the width is taken where the pressure has fallen to this share of the tip


@dataclass(frozen=True)
class Level:
    """One contact solved on one grid."""

    contact: LineContact
    plan: Plan
    grid: Grid
    solution: Iteration
    oil: ThermalOil | None = None  # where its state depends on more than the pressure

    @cached_property
    def groups(self) -> Groups:
        """Dimensionless groups and scales on this grid."""
        return Groups.on(self.contact, self.grid)

    @property
    def flow(self) -> float:
        """Mass flow over rho0 u [m]."""
        return -self.solution.flux * self.groups.gap

    def on_grid_of(self, other: Level) -> bool:
        """Whether the other's grid is laid by the same plan with as many nodes."""
        return self.plan == other.plan and self.grid.nodes.size == other.grid.nodes.size

    def bare(self) -> Self:
        """Return the level without its Newton matrix."""
        return replace(self, solution=replace(self.solution, factors=None))


@dataclass(frozen=True)
class WarmLevel(Level):
    """One contact with heat or shear thinning solved on one grid."""

    oil: ThermalOil


@dataclass(frozen=True)
class State:
    """What a film keeps so that the next one can start from it."""

    coarse: Level
    fine: Level
    flooded: State | None = None  # of a starved film: the flooded one of this contact, or of one like it

    def bare(self) -> State:
        """Return the state without Newton matrices."""
        return replace(self, coarse=self.coarse.bare(), fine=self.fine.bare())

    @property
    def plan(self) -> Plan:
        """Plan of the finer grid."""
        return self.fine.plan

    @property
    def warm(self) -> tuple[WarmLevel, WarmLevel] | None:
        """Both levels with their oils; None of an isothermal film."""
        coarse, fine = self.coarse, self.fine
        return (coarse, fine) if isinstance(coarse, WarmLevel) and isinstance(fine, WarmLevel) else None


@dataclass(frozen=True)
class Figures:
    """Headline figures of one grid [m], under the names that a film gives them."""

    central_thickness: float
    minimum_thickness: float
    minimum_position: float
    outlet: float
    separation: float


@dataclass(frozen=True)
class Tip:
    """The pressure spike of one grid."""

    position: float  # [half-widths]
    height: float  # p/p_H
    width: float  # from the tip to where the pressure has fallen by a tenth, downstream [half-widths]


def figures(level: Level) -> Figures:
    """Take the headline figures back to SI."""
    grid, solution, groups = level.grid, level.solution, level.groups
    i = int(np.clip(np.argmin(solution.H), 1, grid.nodes.size - 2))
    shift, lowest = _lowest(grid.nodes[i - 1 : i + 2] - grid.nodes[i], solution.H[i - 1 : i + 2])
    return Figures(
        central_thickness=centre_gap(grid, groups, solution.P, solution.H0) * groups.gap,
        minimum_thickness=lowest * groups.gap,
        minimum_position=float(grid.nodes[i] + shift) * groups.length,
        outlet=_outlet(grid.nodes, solution.P) * groups.length,
        separation=(solution.H0 + dry_approach(grid)) * groups.gap,
    )


def _lowest(x: Array, y: Array) -> tuple[float, float]:
    """Place and value of the smallest of the parabola through three points, the middle one at 0."""
    (left, _, right), (above, middle, beyond) = x.tolist(), y.tolist()
    before, after = (above - middle) / left, (beyond - middle) / right
    curve = (after - before) / (right - left)
    if curve <= 0.0:
        return 0.0, middle
    slope = before - curve * left
    shift = min(max(-0.5 * slope / curve, left), right)
    return shift, middle + shift * (slope + shift * curve)


def _outlet(X: Array, P: Array) -> float:
    """Return the end of the film: P goes to zero as the square of the distance, from its last two values."""
    i = int(np.flatnonzero(P > 0.0)[-1])
    last, before = math.sqrt(P[i]), math.sqrt(P[i - 1])
    if before <= last:
        return float(X[i + 1])
    return float(min(X[i] + (X[i] - X[i - 1]) * last / (before - last), X[i + 1]))


def dry_approach(grid: Grid) -> float:
    """Approach of the dry contact [a^2/R] on the datum of H0: surfaces at rest at the distance a."""
    return (math.log(2.0 * grid.ratio) + 0.5) / (2.0 * grid.ratio**2)


def spike_of(level: Level) -> Tip | None:
    """Find the pressure spike: the last maximum before the outlet, if it is narrow."""
    P = level.solution.P / level.grid.ratio
    tops = np.flatnonzero((P[1:-1] >= P[:-2]) & (P[1:-1] > P[2:])) + 1
    if tops.size == 0:
        return None
    k = int(tops[-1])
    X, height = level.grid.nodes * level.grid.ratio, float(P[k])
    below = k + int(np.argmax(P[k:] < _DROP * height))
    share = (P[below - 1] - _DROP * height) / (P[below - 1] - P[below])
    width = float(X[below - 1] + share * (X[below] - X[below - 1]) - X[k])
    if width > _SHARP * clusters(level.plan.H_c)[1]:
        return None
    return Tip(float(X[k]), height, width)


def _cold_start(contact: LineContact, grid: Grid, H_c: float) -> tuple[Array, float]:
    """Half an ellipse of pressure and a separation that leaves a film H_c at the centre."""
    groups = Groups.on(contact, grid)
    P = np.sqrt(np.maximum(0.0, 1.0 - grid.nodes**2))
    P[0] = P[-1] = 0.0
    P *= 0.5 * math.pi / float(grid.weights @ P)
    return P, open_gap(grid, groups, P, H_c / grid.ratio**2)


def open_gap(grid: Grid, groups: Groups, P: Array, centre: float) -> float:
    """Rigid separation that leaves a gap at the centre, more of it where the gap would close elsewhere."""
    H0 = centre - centre_gap(grid, groups, P, 0.0)
    lowest = float(film_gap(grid, groups, P, H0).min())
    return H0 - 1.2 * min(lowest, 0.0)


def transfer(
    old: Level, contact: LineContact, plan: Plan, grid: Grid, *, along: bool = False
) -> tuple[Array, float]:
    """Carry a solution to another grid or contact: pressure over x/b as it is, gap scaled by the expected film.

    A spike that moves with the inlet zone is carried along, so that it meets the nodes laid for it. With ``along`` the
    pressures go with as many nodes: an inlet that moves leaves no jump behind.
    """
    if along or old.grid is grid:
        P = old.solution.P
    else:
        X = old.grid.nodes * old.grid.ratio
        P = np.interp(grid.nodes * grid.ratio, X, old.solution.P, left=0.0, right=0.0)
        P *= grid.ratio / old.grid.ratio
        P[0] = P[-1] = 0.0
    groups, groups_old = Groups.on(contact, grid), old.groups
    centre = centre_gap(old.grid, groups_old, old.solution.P, old.solution.H0)
    growth = moes_central(contact) / moes_central(old.contact)
    if plan.fixed and old.plan.fixed and plan.domain != old.plan.domain:
        growth *= (plan.H_c / old.plan.H_c) / (growth * groups_old.gap / groups.gap)
    return P, open_gap(grid, groups, P, centre * (groups_old.gap / groups.gap * growth))


def cold(contact: LineContact, plan: Plan, grid: Grid, H_c: float) -> Level:
    """Solve from an ellipse of pressure: first-order wedge until nearly converged, then third order.

    A start with a thicker film than expected (``H_c``) is slower and safer: Newton comes down on the film
    from above without closing the gap.
    """
    groups = Groups.on(contact, grid)
    P, H0 = _cold_start(contact, grid, H_c)
    first = newton(grid, groups, P, H0, upwind=True, loose=True)
    return Level(contact, plan, grid, newton(grid, groups, first.P, first.H0, spent=first.iterations))


def warm(old: Level, contact: LineContact, plan: Plan, grid: Grid) -> Level:
    """Solve from a solution of another grid or of a neighbouring contact."""
    groups = Groups.on(contact, grid)
    return Level(contact, plan, grid, newton(grid, groups, *transfer(old, contact, plan, grid)))
