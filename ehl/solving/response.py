"""Derivatives of a solved contact's figures by its load, from the factorised Newton matrix.

J d(P, H0) = -d(residual): the residual is differentiated by a forward difference at fixed P and H0, on nodes
that may move; the rest is exact. With heat the oil follows, see :mod:`ehl.solving.oil_following`.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np

from base import Array
from ehl.discrete.contact import LineContact
from ehl.discrete.equations import Grid, Groups, Residual
from ehl.discrete.newton import newton
from ehl.discrete.supply import OilLayer, Supply
from ehl.solving.levels import Level, WarmLevel, dry_approach
from ehl.solving.oil_following import WARM_STEP, Complex, FollowingOil, behind_middle, following_oil
from ehl.solving.plan import Plan, expected_film

_STEP = 3e-7  # of a parameter's ln, in differences of the residual of isothermal films

_WARM_DONE = (
    1e-6  # last step of the pressure before a film is differentiated with its oil, and the most steps
)
_WARM_STEPS = 10


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
        return Response._make(factor * value for value in self)

    def less(self, part: float, other: Response) -> Response:
        """Return the derivatives with another parameter following along by minus a part."""
        pairs: Iterator[tuple[Any, Any]] = zip(self, other, strict=True)
        return Response._make(own - part * follows for own, follows in pairs)


def slopes(level: Level, supply: Supply | None) -> Slopes:
    """Differentiate central film and separation by ln w.

    Without a supply the nodes keep their x/b for the central film. For the separation they move as the plan has
    it for the changed load, so that they stay where they are on the pressure spike: at fixed x/b the spike runs
    over them, and the ripple this makes, 1e-4 of the separation, is several per cent of its derivative. With a
    supply the inlet moves, and all nodes with it.
    """
    contact, plan = level.contact, level.plan
    before = before_step(level)
    heavier = replace(contact, load=contact.load * math.exp(step_of(level)))
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
    return _differentiate(level, before_step(level), *farther_by_step(level), flow=True)


def by_share(level: Level, supply: Supply | None) -> Response:
    """Differentiate by ln of the part of load and modulus that asperities leave to the film, at a fixed width."""
    more = _eased(level)
    farther = by_distance(level) if isinstance(supply, OilLayer) and level.plan.fixed else None
    return _along(
        level, before_step(level), more, expected_film(more) / expected_film(level.contact), supply, farther
    )


def _eased(level: Level) -> LineContact:
    """Return the contact with a step more of load and modulus left to the film."""
    contact, grown = level.contact, math.exp(step_of(level))
    return replace(contact, load=grown * contact.load, reduced_modulus=grown * contact.reduced_modulus)


def with_matrix(level: WarmLevel) -> WarmLevel:
    """Solve a level with heat a few steps further, with its Newton matrix."""
    oil, solution = level.oil.on(level.contact, level.grid), level.solution
    with np.errstate(all="ignore"):
        solved = newton(
            level.grid,
            level.groups,
            solution.P,
            solution.H0,
            oil=oil,
            done=_WARM_DONE,
            max_iterations=_WARM_STEPS,
        )
    return replace(level, solution=solved, oil=oil)


Before = Residual | FollowingOil
"""A level before a step: its residual, or its oil that follows."""


def before_step(level: Level) -> Before:
    """Take the residual of a level, or of one with heat its oil."""
    solution = level.solution
    return following_oil(level) or Residual.of(level.grid, level.groups, solution.P, solution.H0)


def step_of(level: Level) -> float:
    """Step of a parameter's ln in differences of a level's residual."""
    return _STEP if level.oil is None else WARM_STEP


def _along(
    level: Level,
    before: Before,
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


def farther_by_step(level: Level) -> tuple[LineContact, Grid]:
    """Return the contact and the grid whose meniscus is a step of ln(distance) farther."""
    plan = level.plan
    farther = plan.with_inlet(-1.0 + (plan.domain[0] + 1.0) * math.exp(step_of(level)))
    return level.contact, moved_grid(level, farther)


def heavier_by_step(level: Level, supply: Supply | None) -> tuple[LineContact, Grid]:
    """Return the contact under a load a step larger, and the grid whose nodes follow its film."""
    contact = level.contact
    return _followed(level, replace(contact, load=contact.load * math.exp(step_of(level))), supply)


def eased_by_step(level: Level, supply: Supply | None) -> tuple[LineContact, Grid]:
    """Return the contact of a part of load and modulus a step larger, and its grid likewise."""
    return _followed(level, _eased(level), supply)


def _followed(level: Level, other: LineContact, supply: Supply | None) -> tuple[LineContact, Grid]:
    contact = level.contact
    growth, wider = expected_film(other) / expected_film(contact), other.half_width / contact.half_width
    return other, moved_grid(level, level.plan.moved_to(growth, wider, supply))


def moved_grid(level: Level, plan: Plan) -> Grid:
    """Return the level's grid with the nodes of another plan, on its scale."""
    if plan == level.plan:
        return level.grid
    ratio = level.grid.ratio
    return plan.over(plan.nodes(level.grid.nodes.size, level.grid.nodes * ratio), ratio)


def _differentiate(
    level: Level, before: Before, contact: LineContact, moved: Grid, *, flow: bool = False
) -> Response:
    """Differentiate the figures towards another contact on another grid, a step of the parameter away."""
    solution, grid, groups = level.solution, level.grid, level.groups
    assert solution.factors is not None, "only a converged level is differentiated"
    if isinstance(before, FollowingOil):
        factors, n = solution.factors, solution.P.size

        def solve(net_flux: Complex, short: complex) -> tuple[Complex, complex]:
            """Real changes, as complex ones."""
            dP, dH0 = factors.solve(-net_flux.real, short.real, n)
            return dP.astype(complex), complex(dH0)

        answer = before.towards(before.level.oil.on(contact, moved), moved, solve)
        central, separation, carried = answer.figures.real.tolist()
        return Response(central, separation, carried, answer.P.real, answer.H0.real)
    still = before
    own = explicit(level, still, contact, moved)
    dP, dH0 = solution.factors.solve(-own.net_flux, own.short, solution.P.size)
    by_pressure = groups.compliance * float(grid.centre @ dP)
    carried = _flow_slope(level, still, own.flow, dP, dH0) if flow else math.nan
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
    step = step_of(level)
    return Explicit(
        net_flux=(np.diff(changed.flux) - np.diff(before.flux)) / step,
        short=(changed.short - before.short) / step,
        flow=(changed.flux * after.gap - before.flux * groups.gap) / step,
        central=(changed.centre - before.centre) / step,
        separation=(solution.H0 + dry_approach(level.grid)) * (after.gap - groups.gap) / step,
    )


def _flow_slope(level: Level, before: Residual, explicit: Array, dP: Array, dH0: float) -> float:
    """Differentiate the flow [m], taken as the mean over the second half of the film."""
    dH = dH0 - level.groups.compliance * (level.grid.potential @ dP)
    by = level.groups.gap * before.slopes
    cells = behind_middle(level.solution.P)
    low, high = cells.start, cells.stop
    changes = explicit[low:high].copy()
    for k in range(3):
        at = slice(low - 1 + k, high - 1 + k)
        changes += by[low:high, k] * dP[at] + by[low:high, 3 + k] * dH[at]
    return -float(np.mean(changes))
