"""A contact on one grid after another: starts, transfers between grids and the figures of each."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ehl.contact import LineContact
from ehl.discrete import Grid, Groups, centre_gap, film_gap, make_grid, residual
from ehl.grid import default_domain, film_parameter, graded_nodes, uniform_nodes
from ehl.newton import Iteration, newton
from ehl.regressions import moes_central

__all__ = ["Figures", "Level", "Plan", "Slopes", "State", "cold", "figures", "slopes", "warm"]

Array = NDArray[np.float64]

_LOAD_STEP = 3e-7  # of ln w, in differences of the residual
_REUSE = 1.5  # a start's grid serves until H_c differs by this factor


@dataclass(frozen=True)
class Plan:
    """How grids are laid: for which film, on which domain."""

    kind: str  # "graded" or "uniform"
    H_c: float  # expected h R/b^2
    domain: tuple[float, float]  # [half-widths]
    fixed: bool  # the caller gave the domain

    @classmethod
    def of(cls, contact: LineContact, kind: str, domain: tuple[float, float] | None, reach: float) -> Plan:
        """Lay the plan by Moes' film."""
        H_c = _film_parameter(contact)
        if domain is None:
            return cls(kind, H_c, default_domain(H_c, reach), fixed=False)
        return cls(kind, H_c, (float(domain[0]), float(domain[1])), fixed=True)

    def serves(self, other: Plan) -> bool:
        """Whether grids of this plan are good enough for the other."""
        if self.kind != other.kind or self.fixed != other.fixed:
            return False
        if self.fixed and self.domain != other.domain:
            return False
        reach = self.domain[0] / other.domain[0]
        return 1.0 / _REUSE < self.H_c / other.H_c < _REUSE and 1.0 / _REUSE < reach < _REUSE

    def nodes(self, n: int) -> Array:
        """Return n nodes [half-widths]."""
        if self.kind == "uniform":
            return uniform_nodes(n, self.domain)
        return graded_nodes(self.H_c, n, self.domain)

    def grid(self, n: int) -> Grid:
        """Return the grid of n nodes."""
        return make_grid(self.nodes(n), math.sqrt(max(1.0, self.H_c)), open_inlet=not self.fixed)

    def moved(self, growth: float) -> Plan:
        """Return the plan for a film parameter that has grown by a factor."""
        if self.fixed:
            return replace(self, H_c=growth * self.H_c)
        left, right = self.domain
        root = math.sqrt(growth)
        domain = (-1.0 + root * (left + 1.0), 1.0 + root * (right - 1.0))
        return replace(self, H_c=growth * self.H_c, domain=domain)


@dataclass(frozen=True)
class Level:
    """One contact solved on one grid."""

    contact: LineContact
    grid: Grid
    found: Iteration

    def bare(self) -> Level:
        """Return the level without its Newton matrix."""
        return replace(self, found=replace(self.found, factors=None))


@dataclass(frozen=True)
class State:
    """What a film keeps so that the next one can start from it."""

    plan: Plan
    coarse: Level
    fine: Level


@dataclass(frozen=True)
class Figures:
    """Headline figures of one grid [m]."""

    central: float
    minimum: float
    position: float
    outlet: float
    prop: float


@dataclass(frozen=True)
class Slopes:
    """Derivatives by the logarithm of the load at fixed speed [m]."""

    central: float
    prop: float
    ripple: float  # relative difference between the two ways of differentiating the propping


def figures(level: Level) -> Figures:
    """Take the headline figures back to SI."""
    contact, grid, found = level.contact, level.grid, level.found
    groups = Groups.on(contact, grid)
    i = int(np.clip(np.argmin(found.H), 1, grid.nodes.size - 2))
    X = grid.nodes[i - 1 : i + 2] - grid.nodes[i]
    curve, slope, lowest = np.polyfit(X, found.H[i - 1 : i + 2], 2)
    shift = float(np.clip(-0.5 * slope / curve, X[0], X[2])) if curve > 0 else 0.0
    return Figures(
        central=centre_gap(grid, groups, found.P, found.H0) * groups.gap,
        minimum=float(lowest + shift * (slope + shift * curve)) * groups.gap,
        position=float(grid.nodes[i] + shift) * groups.length,
        outlet=_outlet(grid.nodes, found.P) * groups.length,
        prop=(found.H0 + _dry(grid)) * groups.gap,
    )


def _outlet(X: Array, P: Array) -> float:
    """Return the end of the film: P goes to zero as the square of the distance, from its last two values."""
    i = int(np.flatnonzero(P > 0.0)[-1])
    last, before = math.sqrt(P[i]), math.sqrt(P[i - 1])
    if before <= last:
        return float(X[i + 1])
    return float(min(X[i] + (X[i] - X[i - 1]) * last / (before - last), X[i + 1]))


def _dry(grid: Grid) -> float:
    """Approach of the dry contact [a^2/R] on the datum of H0: surfaces at rest at the distance a."""
    return (math.log(2.0 * grid.ratio) + 0.5) / (2.0 * grid.ratio**2)


def slopes(level: Level, plan: Plan) -> Slopes:
    """Differentiate the figures by ln w with the Newton matrix, J d(P, H0) = -d(residual).

    The nodes keep their x/b for the central film. For the propping they move as the plan has it for the
    changed load, so that they stay where they are on the pressure spike: at fixed x/b the spike runs over
    them, and the ripple this makes, 1e-4 of the propping, is several per cent of its derivative.
    """
    contact, grid, found = level.contact, level.grid, level.found
    heavier = replace(contact, load=contact.load * math.exp(_LOAD_STEP))
    nodes = plan.moved(_film_parameter(heavier) / _film_parameter(contact)).nodes(grid.nodes.size)
    groups = Groups.on(contact, grid)
    central, H0_still = _response(level, heavier, grid)
    _, H0 = _response(level, heavier, make_grid(nodes, grid.ratio, open_inlet=grid.open))
    prop = found.H0 + _dry(grid) + H0
    return Slopes(
        central=(centre_gap(grid, groups, found.P, found.H0) + central) * groups.gap,
        prop=prop * groups.gap,
        ripple=abs((H0_still - H0) / prop),
    )


def _response(level: Level, heavier: LineContact, moved: Grid) -> tuple[float, float]:
    """Differentiate the gap at X = 0 and H0 by ln w, from the residual of a heavier load on its grid.

    The residual is differentiated by a forward difference at fixed P and H0. Its step is small because the
    part of H0 that matters is small beside H0 in thin films.
    """
    found = level.found
    assert found.factors is not None, "only a converged level is differentiated"
    residuals, centres = [], []
    for contact, grid in ((level.contact, level.grid), (heavier, moved)):
        groups = Groups.on(contact, grid)
        residuals.append(residual(grid, groups, found.P, found.H0))
        centres.append(centre_gap(grid, groups, found.P, found.H0))
    (net, short), (net_heavier, short_heavier) = residuals
    dP, dH0 = found.factors.solve(
        (net - net_heavier) / _LOAD_STEP, (short_heavier - short) / _LOAD_STEP, found.P.size
    )
    compliance = Groups.on(level.contact, level.grid).compliance
    by_pressure = compliance * float(level.grid.centre @ dP)
    return (centres[1] - centres[0]) / _LOAD_STEP + dH0 - by_pressure, dH0


def _film_parameter(contact: LineContact) -> float:
    """Return the expected h R/b^2."""
    return film_parameter(moes_central(contact), contact.half_width, contact.radius)


def _cold_start(contact: LineContact, grid: Grid, H_c: float) -> tuple[Array, float]:
    """Half an ellipse of pressure and a separation that leaves a film H_c at the centre."""
    groups = Groups.on(contact, grid)
    P = np.sqrt(np.maximum(0.0, 1.0 - grid.nodes**2))
    P[0] = P[-1] = 0.0
    P *= 0.5 * math.pi / float(grid.weights @ P)
    H0 = H_c / grid.ratio**2 - centre_gap(grid, groups, P, 0.0)
    lowest = float(film_gap(grid, groups, P, H0).min())
    return P, H0 - 1.2 * min(lowest, 0.0)


def _transfer(old: Level, contact: LineContact, grid: Grid) -> tuple[Array, float]:
    """Carry a solution to another grid or contact: pressure over x/b as it is, gap scaled by Moes' film."""
    if old.grid is grid:
        P = old.found.P
    else:
        P = np.interp(
            grid.nodes * grid.ratio, old.grid.nodes * old.grid.ratio, old.found.P, left=0.0, right=0.0
        )
        P *= grid.ratio / old.grid.ratio
        P[0] = P[-1] = 0.0
    groups = Groups.on(contact, grid)
    groups_old = Groups.on(old.contact, old.grid)
    centre = centre_gap(old.grid, groups_old, old.found.P, old.found.H0)
    centre *= groups_old.gap / groups.gap * moes_central(contact) / moes_central(old.contact)
    H0 = centre - centre_gap(grid, groups, P, 0.0)
    lowest = float(film_gap(grid, groups, P, H0).min())
    return P, H0 - 1.2 * min(lowest, 0.0)


def cold(contact: LineContact, grid: Grid, H_c: float) -> Level:
    """Solve from an ellipse of pressure: first-order wedge until nearly converged, then third order.

    A start with a thicker film than expected (``H_c``) is slower and safer: Newton comes down on the film
    from above without closing the gap.
    """
    groups = Groups.on(contact, grid)
    P, H0 = _cold_start(contact, grid, H_c)
    first = newton(grid, groups, P, H0, upwind=True, loose=True)
    return Level(contact, grid, newton(grid, groups, first.P, first.H0, spent=first.iterations))


def warm(old: Level, contact: LineContact, grid: Grid) -> Level:
    """Solve from a solution of another grid or of a neighbouring contact."""
    groups = Groups.on(contact, grid)
    return Level(contact, grid, newton(grid, groups, *_transfer(old, contact, grid)))
