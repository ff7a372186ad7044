"""Derivatives of a solved contact's figures by its load, from the factorised Newton matrix.

J d(P, H0) = -d(residual): the residual is differentiated by a forward difference at fixed P and H0, on nodes
that may move; the rest is exact.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from base import Array
from ehl.discrete.contact import LineContact
from ehl.discrete.equations import Grid, Groups, Residual
from ehl.discrete.supply import OilLayer, Supply
from ehl.solving.levels import Level, dry_approach
from ehl.solving.plan import Plan, expected_film

STEP = 3e-7
"""Of ln w and of ln(distance of the meniscus), in differences of the residual."""


@dataclass(frozen=True)
class Slopes:
    """Derivatives by the logarithm of the load at fixed speed and supply [m]."""

    central: float
    separation: float
    ripple: (
        float  # relative difference between two derivatives of the separation, on fixed and on moving nodes
    )


class Response(NamedTuple):
    """Derivatives by one parameter: figures [m], pressures at the nodes and rigid separation."""

    central: float
    separation: float
    flow: float  # NaN where it was not asked for
    P: Array
    H0: float

    def scaled(self, factor: float) -> Response:
        """Return the derivatives by another parameter, of which this one is a function of this slope."""
        return Response(
            factor * self.central,
            factor * self.separation,
            factor * self.flow,
            factor * self.P,
            factor * self.H0,
        )

    def less(self, part: float, other: Response) -> Response:
        """Return the derivatives with another parameter following along by minus a part."""
        return Response(
            self.central - part * other.central,
            self.separation - part * other.separation,
            self.flow - part * other.flow,
            self.P - part * other.P,
            self.H0 - part * other.H0,
        )


def slopes(level: Level, supply: Supply | None) -> Slopes:
    """Differentiate central film and separation by ln w.

    Without a supply the nodes keep their x/b for the central film. For the separation they move as the plan has
    it for the changed load, so that they stay where they are on the pressure spike: at fixed x/b the spike runs
    over them, and the ripple this makes, 1e-4 of the separation, is several per cent of its derivative. With a
    supply the inlet moves, and all nodes with it.
    """
    contact, plan = level.contact, level.plan
    before = _residual(level)
    heavier = replace(contact, load=contact.load * math.exp(STEP))
    growth = expected_film(heavier) / expected_film(contact)
    if supply is None or not plan.fixed:
        moving = _along(level, before, heavier, growth, supply)
        still = _differentiate(level, before, heavier, level.grid)
        return Slopes(still.central, moving.separation, abs(still.separation / moving.separation - 1.0))
    farther = by_distance(level) if isinstance(supply, OilLayer) else None
    moving, still = (_along(level, before, heavier, g, supply, farther) for g in (growth, 1.0))
    return Slopes(moving.central, moving.separation, abs(still.separation / moving.separation - 1.0))


def by_distance(level: Level) -> Response:
    """Differentiate by ln of the distance between the meniscus and the dry contact, at a fixed load."""
    plan = level.plan
    farther = plan.with_inlet(-1.0 + (plan.domain[0] + 1.0) * math.exp(STEP))
    return _differentiate(level, _residual(level), level.contact, moved_grid(level, farther), flow=True)


def by_share(level: Level, supply: Supply | None) -> Response:
    """Differentiate by ln of the part of load and modulus that asperities leave to the film, at a fixed width."""
    contact = level.contact
    grown = math.exp(STEP)
    more = replace(contact, load=grown * contact.load, reduced_modulus=grown * contact.reduced_modulus)
    farther = by_distance(level) if isinstance(supply, OilLayer) and level.plan.fixed else None
    return _along(
        level, _residual(level), more, expected_film(more) / expected_film(contact), supply, farther
    )


def _residual(level: Level) -> Residual:
    return Residual.of(level.grid, level.groups, level.solution.P, level.solution.H0)


def _along(
    level: Level,
    before: Residual,
    other: LineContact,
    growth: float,
    supply: Supply | None,
    farther: Response | None = None,
) -> Response:
    """Differentiate towards another contact on nodes that follow a film growing by a factor, with the supply as it is.

    A meniscus fed by a layer moves until the flow is that of the layer again; ``farther`` is what its distance does.
    """
    moved = moved_grid(
        level, level.plan.moved_to(growth, other.half_width / level.contact.half_width, supply)
    )
    direct = _differentiate(level, before, other, moved, flow=farther is not None)
    return direct if farther is None else direct.less(direct.flow / farther.flow, farther)


def heavier_by_step(level: Level, supply: Supply | None) -> tuple[LineContact, Grid]:
    """Return the contact under a load a step larger, and the grid whose nodes follow its film."""
    contact = level.contact
    heavier = replace(contact, load=contact.load * math.exp(STEP))
    growth = expected_film(heavier) / expected_film(contact)
    wider = heavier.half_width / contact.half_width
    return heavier, moved_grid(level, level.plan.moved_to(growth, wider, supply))


def moved_grid(level: Level, plan: Plan) -> Grid:
    """Return the level's grid with the nodes of another plan, on its scale."""
    if plan == level.plan:
        return level.grid
    ratio = level.grid.ratio
    return plan.over(plan.nodes(level.grid.nodes.size, level.grid.nodes * ratio), ratio)


def _differentiate(
    level: Level, before: Residual, contact: LineContact, moved: Grid, *, flow: bool = False
) -> Response:
    """Differentiate the figures towards another contact on another grid, a step of the parameter away."""
    solution, grid, groups = level.solution, level.grid, level.groups
    assert solution.factors is not None, "only a converged level is differentiated"
    own = explicit(level, before, contact, moved)
    dP, dH0 = solution.factors.solve(-own.net_flux, own.short, solution.P.size)
    by_pressure = groups.compliance * float(grid.centre @ dP)
    carried = _flow_slope(level, before, own.flow, dP, dH0) if flow else math.nan
    return Response(
        central=own.central + (dH0 - by_pressure) * groups.gap,
        separation=own.separation + dH0 * groups.gap,
        flow=carried,
        P=dP,
        H0=dH0,
    )


class Explicit(NamedTuple):
    """Derivatives by a parameter at fixed P and H0, on nodes that may move."""

    net_flux: Array  # into each inner node (n-2,)
    short: float  # load that is missing
    flow: Array  # through each cell (n-1,) [m], negative downstream
    central: float  # [m]
    separation: float  # [m]


def explicit(level: Level, before: Residual, contact: LineContact, moved: Grid) -> Explicit:
    """Differentiate the residual and the figures towards another contact on another grid, a step away."""
    solution, groups = level.solution, level.groups
    after = Groups.on(contact, moved)
    changed = Residual.of(moved, after, solution.P, solution.H0)
    return Explicit(
        net_flux=(np.diff(changed.flux) - np.diff(before.flux)) / STEP,
        short=(changed.short - before.short) / STEP,
        flow=(changed.flux * after.gap - before.flux * groups.gap) / STEP,
        central=(changed.centre - before.centre) / STEP,
        separation=(solution.H0 + dry_approach(level.grid)) * (after.gap - groups.gap) / STEP,
    )


def _flow_slope(level: Level, before: Residual, explicit: Array, dP: Array, dH0: float) -> float:
    """Differentiate the flow [m], taken as the mean over the second half of the film."""
    dH = dH0 - level.groups.compliance * (level.grid.potential @ dP)
    by = level.groups.gap * before.slopes
    free = np.flatnonzero(level.solution.P[1:-1] > 0.0) + 1
    low, high = int(free[free.size // 2]), int(free[-1])
    changes = explicit[low:high].copy()
    for k in range(3):
        at = slice(low - 1 + k, high - 1 + k)
        changes += by[low:high, k] * dP[at] + by[low:high, 3 + k] * dH[at]
    return -float(np.mean(changes))
