"""Derivatives of a solved contact's figures by its load, from the factorised Newton matrix.

J d(P, H0) = -d(residual): the residual is differentiated by a forward difference at fixed P and H0, on nodes
that may move; the rest is exact.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ehl.contact import LineContact
from ehl.discrete import Grid, Groups, centre_gap, film_gap, fluxes, make_grid, residual
from ehl.levels import Level, dry_approach
from ehl.plan import Plan, expected_film
from ehl.supply import OilLayer, Supply

__all__ = ["Slopes", "slopes"]

Array = NDArray[np.float64]

_STEP = 3e-7  # of ln w and of ln(distance of the meniscus), in differences of the residual


@dataclass(frozen=True)
class Slopes:
    """Derivatives by the logarithm of the load at fixed speed and supply [m]."""

    central: float
    prop: float
    ripple: float  # relative difference between the two ways of differentiating the propping


@dataclass(frozen=True)
class _Response:
    """Derivatives by one parameter [m]."""

    central: float
    prop: float
    flow: float

    def less(self, other: _Response, factor: float) -> _Response:
        return _Response(
            self.central - factor * other.central,
            self.prop - factor * other.prop,
            self.flow - factor * other.flow,
        )


def slopes(level: Level, supply: Supply | None) -> Slopes:
    """Differentiate central film and propping by ln w.

    Without a supply the nodes keep their x/b for the central film. For the propping they move as the plan has
    it for the changed load, so that they stay where they are on the pressure spike: at fixed x/b the spike runs
    over them, and the ripple this makes, 1e-4 of the propping, is several per cent of its derivative. With a
    supply the inlet moves, and all nodes with it.
    """
    contact, plan = level.contact, level.plan
    ratio = math.exp(_STEP)
    heavier = replace(contact, load=contact.load * ratio)
    growth = expected_film(heavier) / expected_film(contact)
    moving = _along(level, heavier, growth, supply)
    if supply is None or not plan.fixed:
        still = _differentiate(level, heavier, level.grid)
        return Slopes(still.central, moving.prop, abs(still.prop / moving.prop - 1.0))
    still = _along(level, heavier, 1.0, supply)
    return Slopes(moving.central, moving.prop, abs(still.prop / moving.prop - 1.0))


def _along(level: Level, heavier: LineContact, growth: float, supply: Supply | None) -> _Response:
    """Differentiate by ln w on nodes that follow a film growing by a factor, with the supply as it is.

    A meniscus fed by a layer moves until the flow is that of the layer again.
    """
    plan = level.plan
    by_load = _respond(level, heavier, plan.for_load(growth, heavier.load / level.contact.load, supply))
    if not (isinstance(supply, OilLayer) and plan.fixed):
        return by_load
    farther = plan.with_inlet(-1.0 + (plan.domain[0] + 1.0) * math.exp(_STEP))
    by_distance = _respond(level, level.contact, farther)
    return by_load.less(by_distance, by_load.flow / by_distance.flow)


def _respond(level: Level, contact: LineContact, plan: Plan) -> _Response:
    """Differentiate towards another contact on the nodes of another plan."""
    grid, ratio = level.grid, level.grid.ratio
    nodes = plan.nodes(grid.nodes.size, grid.nodes * ratio)
    return _differentiate(level, contact, make_grid(nodes, ratio, open_inlet=grid.open))


def _differentiate(level: Level, contact: LineContact, moved: Grid) -> _Response:
    """Differentiate the figures towards another contact on another grid, a step of the parameter away."""
    found, grid, groups = level.found, level.grid, level.groups
    assert found.factors is not None, "only a converged level is differentiated"
    net, short = residual(grid, groups, found.P, found.H0)
    after = Groups.on(contact, moved)
    net_after, short_after = residual(moved, after, found.P, found.H0)
    dP, dH0 = found.factors.solve((net - net_after) / _STEP, (short_after - short) / _STEP, found.P.size)
    centre = centre_gap(grid, groups, found.P, found.H0) * groups.gap
    centre_after = centre_gap(moved, after, found.P, found.H0) * after.gap
    by_pressure = groups.compliance * float(grid.centre @ dP)
    explicit = (found.H0 + dry_approach(grid)) * (after.gap - groups.gap) / _STEP
    return _Response(
        central=(centre_after - centre) / _STEP + (dH0 - by_pressure) * groups.gap,
        prop=explicit + dH0 * groups.gap,
        flow=_flow_slope(level, moved, after, dP, dH0),
    )


def _flow_slope(level: Level, moved: Grid, after: Groups, dP: Array, dH0: float) -> float:
    """Differentiate the flow [m], taken as the mean over the second half of the film."""
    found, grid, groups = level.found, level.grid, level.groups
    H = film_gap(grid, groups, found.P, found.H0)
    flux, by = fluxes(grid, groups, found.P, H, grid.quick)
    flux_after, _ = fluxes(moved, after, found.P, film_gap(moved, after, found.P, found.H0), moved.quick)
    dH = dH0 - groups.compliance * (grid.potential @ dP)
    changes = (flux_after * after.gap - flux * groups.gap) / _STEP
    for k in range(3):
        at = np.arange(flux.size) - 1 + k
        inside = at >= 0
        changes[inside] += groups.gap * (by[inside, k] * dP[at[inside]] + by[inside, 3 + k] * dH[at[inside]])
    free = np.flatnonzero(found.P[1:-1] > 0.0) + 1
    faces = changes[free[free.size // 2] : free[-1]]
    return -float(np.mean(faces))
