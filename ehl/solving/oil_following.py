"""Derivatives of a film with heat by a parameter, steady or oscillating: its oil follows.

The Newton matrix leaves out most of what the oil's own state does. So the difference of the residual is taken along the
derivative found so far, with the oil following, and the matrix corrects it until it is balanced. In an oscillation
exp(i omega t) two oils follow, of the parts in phase and a quarter of a period ahead, and one sweep for their
temperatures: a film at rest with a small complex change. Oil stores heat and is compressed in time, and surfaces take
their heat along.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from base import Array
from ehl.discrete.equations import Fluid, Grid, Residual, film_gap, inlet_pressure
from ehl.discrete.solids import oscillating_heating
from ehl.discrete.squeeze import Content, at_meniscus, by_parameter
from ehl.discrete.thermal_oil import Heat, ThermalOil
from ehl.solving.levels import Level, WarmLevel, dry_approach

Complex = NDArray[np.complex128]
Solve = Callable[[Complex, complex], tuple[Complex, complex]]
"""Changes of P and H0 that make given net fluxes into the inner nodes and a missing load."""

WARM_STEP = 3e-4
"""Of a parameter's ln: the oil's own state is known to some 1e-9 of itself."""

BALANCED = 5e-4
"""Last correction of the figures' derivatives over these."""

_MOST_CORRECTIONS = 60
_CALM_AFTER = 12  # corrections after which those that go round are followed more slowly,
_CALM = 0.5  # by this share


class Swept(NamedTuple):
    """A film after a sweep of its oil."""

    residual: Residual
    content: Content
    temperature: Array
    into: Array

    heat: Heat | None

    @classmethod
    def of(cls, grid: Grid, oil: ThermalOil, P: Array, H0: float) -> Swept:
        """Let the oil follow pressures and separation by one sweep."""
        with np.errstate(all="ignore"):
            residual = Residual.of(grid, oil.groups, P, H0, oil)
        return cls.after(residual, grid, oil, P, H0)

    @classmethod
    def after(cls, residual: Residual, grid: Grid, oil: ThermalOil, P: Array, H0: float) -> Swept:
        """Keep what a sweep has left."""
        content = Content.of(grid, oil.groups, P, H0, oil.packed)
        return cls(residual, content, oil.temperature.copy(), oil.into.copy(), oil.begun_with)


class Followed(NamedTuple):
    """Derivatives; NaN where they do not settle, P and H0 apart."""

    figures: Complex  # central film, separation, and flow in the mean over the second half of the film [m]
    missing: complex  # oil that the first node's volume misses
    P: Complex
    H0: complex


@dataclass
class FollowingOil:
    """A level with its matrix, and its oil after every sweep, which may still change a little."""

    level: WarmLevel

    def __post_init__(self) -> None:
        """Begin before the first sweep."""
        self._swept: list[Swept] = []
        self._oil = self._copy()

    def _copy(self) -> ThermalOil:
        return self.level.oil.on(self.level.contact, self.level.grid)

    @property
    def swelling(self) -> Array | float:
        """Change of the gap by P that has the effect of what heat of compression does to the density."""
        fluid = self._oil.before
        return 0.0 if fluid is None or fluid.swelling is None else fluid.swelling

    def after(self, sweeps: int) -> Swept:
        """Return the film at rest after as many sweeps."""
        solution = self.level.solution
        while len(self._swept) <= sweeps:
            self._swept.append(Swept.of(self.level.grid, self._oil, solution.P, solution.H0))
        return self._swept[sweeps]

    def towards(self, oil: ThermalOil, moved: Grid, solve: Solve, omega: float = 0.0) -> Followed:
        """Differentiate towards the oil of another contact on another grid, a step away; omega [rad/s]."""
        level, groups, after = self.level, self.level.groups, oil.groups
        solution, cells = level.solution, behind_middle(level.solution.P)
        per_time = 1j * omega / (groups.gap * level.contact.entrainment)
        stretched = (solution.H0 + dry_approach(level.grid)) * (after.gap - groups.gap) / WARM_STEP
        time = _Oscillation(level, oil, self._copy(), omega) if omega != 0.0 else None
        dP, dH0 = np.zeros(solution.P.size, complex), 0j
        last = np.full(3, np.nan, complex)
        stored = np.zeros(solution.P.size - 2, complex)
        for sweep in range(_MOST_CORRECTIONS):
            here = self.after(sweep)
            in_phase = solution.P + WARM_STEP * dP.real, solution.H0 + WARM_STEP * dH0.real
            if time is None:
                there, beside = Swept.of(moved, oil, *in_phase), here
            else:
                ahead = solution.P + WARM_STEP * dP.imag, solution.H0 + WARM_STEP * dH0.imag
                there, beside = time.sweep(here, in_phase, ahead, dP, stored)
            change = _Change(here, there, beside, after.gap, groups.gap)
            stored = change.stored()
            short = complex(change.of(lambda s: s.residual.short))
            more, more_H0 = solve(np.diff(change.of(lambda s: s.residual.flux)) - per_time * stored, short)
            flow = change.flow()
            centre = complex(change.of(lambda s: s.residual.centre))
            figures: Complex = np.array([centre, stretched + dH0 * after.gap, -np.mean(flow[cells])])
            done = BALANCED if sweep <= _CALM_AFTER else _CALM * BALANCED
            if np.allclose(last, figures, rtol=done, atol=0.0):
                ends = float(level.grid.nodes[0]) * groups.length, float(moved.nodes[0]) * after.length
                held = change.held(ends, level.flow)
                missing = complex(flow[0] - 1j * omega / level.contact.entrainment * held)
                return Followed(figures, missing, dP + more, dH0 + more_H0)
            share = 1.0 if sweep < _CALM_AFTER else _CALM
            last, dP, dH0 = figures, dP + share * more, dH0 + share * more_H0
        return Followed(np.full(3, np.nan, complex), complex(np.nan), dP, dH0)


def following_oil(level: Level) -> FollowingOil | None:
    """Oil of a level with heat, None of another."""
    return FollowingOil(level) if isinstance(level, WarmLevel) else None


class _Change(NamedTuple):
    """Derivatives between a film at rest and two beside it, in phase and ahead."""

    here: Swept
    there: Swept
    beside: Swept
    gap: float  # of the film in phase [m]
    gap_here: float

    def of(self, value: Callable[[Swept], Array | float]) -> Any:
        """Differentiate what a sweep leaves: complex, as its shape is."""
        here = value(self.here)
        return (value(self.there) - here + 1j * (value(self.beside) - here)) / WARM_STEP

    def flow(self) -> Complex:
        """Differentiate the flux [m], negative downstream."""
        here, there, beside = (s.residual.flux for s in self[:3])
        in_phase = there * self.gap - here * self.gap_here
        return np.asarray((in_phase + 1j * (beside - here) * self.gap_here) / WARM_STEP)

    def stored(self) -> Complex:
        """Differentiate the inner nodes' contents, less what moving nodes sweep."""
        here, there, beside = (s.content for s in self[:3])
        return by_parameter(here, there, WARM_STEP) + 1j * by_parameter(here, beside, WARM_STEP)

    def held(self, ends: tuple[float, float], layer: float) -> complex:
        """Likewise of the first node's content."""
        here, there, beside = (s.content for s in self[:3])
        ahead = at_meniscus(here, beside, (ends[0], ends[0]), layer, WARM_STEP)
        return at_meniscus(here, there, ends, layer, WARM_STEP) + 1j * ahead


@dataclass
class _Held:
    """An oil in a state that is known."""

    fluid: Fluid
    unsettled: float = 0.0

    def at(self, P: Array, H: Array) -> Fluid:
        """State, which is that of these pressures and gaps."""
        return self.fluid


class _Oscillation:
    """Two oils of an oscillation, and what it adds to their heat."""

    def __init__(self, level: WarmLevel, in_phase: ThermalOil, ahead: ThermalOil, omega: float) -> None:
        self.level, self.oils, self.omega = level, (in_phase, ahead), omega
        self.moves = (in_phase.middles - ahead.middles) / WARM_STEP  # of the cells [m]
        self.node_moves = (in_phase.x - ahead.x) / WARM_STEP
        if ahead.solids is not None:
            u, depth = level.contact.surface_speeds, level.contact.radius
            self.travelled = np.array(
                [
                    oscillating_heating(still, ahead.x, speed, solid, depth, omega) - still
                    for still, speed, solid in zip(ahead.bodies, u, ahead.solids, strict=True)
                ]
            )

    def sweep(
        self,
        here: Swept,
        in_phase: tuple[Array, float],
        ahead: tuple[Array, float],
        dP: Complex,
        stored: Complex,
    ) -> tuple[Swept, Swept]:
        """Let both oils follow pressures and separations; ``stored`` are the changes of the contents so far."""
        states = (in_phase, ahead)
        for oil, (P, H0) in zip(self.oils, states, strict=True):
            P = P.copy()
            P[0] = inlet_pressure(oil.grid, oil.groups)
            oil.press(P, film_gap(oil.grid, oil.groups, P, H0))
        if here.heat is not None:
            self._warm(here, here.heat, dP, stored)
        swept = []
        for oil, (P, H0) in zip(self.oils, states, strict=True):
            residual = Residual.of(oil.grid, oil.groups, P, H0, _Held(oil.fluid()))
            swept.append(Swept.after(residual, oil.grid, oil, P, H0))
        return swept[0], swept[1]

    def _warm(self, here: Swept, base: Heat, dP: Complex, stored: Complex) -> None:
        """Sweep once for the temperatures of both."""
        oil, ahead = self.oils
        heat = Heat(
            *(one + 1j * (two - at) for one, two, at in zip(oil.heat(), ahead.heat(), base, strict=True))
        )
        T, x = here.temperature, ahead.middles
        along, into_along = np.gradient(T, x, axis=0), np.gradient(here.into, x, axis=1)
        # at places that stay: what nodes carry along is taken off
        still_T = T + WARM_STEP * self.moves[:, None] * along
        still_into = here.into + WARM_STEP * self.moves * into_along
        lubricant = self.level.contact.lubricant
        stores: Any = 1j * self.omega * lubricant.heat_capacity * ahead.shear.density * base.gap
        lost = -1j * self.omega * lubricant.density * np.append(0.0, np.cumsum(stored))
        carried = lubricant.heat_capacity * (lost - lost[ahead.last // 2])[:, None] * along
        compressed = 1j * self.omega * lubricant.expansion * (base.gap * self._pressure(dP))[:, None] * T
        heat = heat._replace(
            bodies=heat.bodies + self.travelled,
            ambient=heat.ambient - (self.travelled @ still_into[:, :, None])[:, :, 0],
            stores=stores,
            added=stores[:, None] * still_T + WARM_STEP * (compressed - carried),
        )
        oil.sweep(heat)
        oil.temperature[:], oil.into[:] = heat.temperature.real, heat.into.real
        ahead.temperature[:], ahead.into[:] = T + heat.temperature.imag, here.into + heat.into.imag

    def _pressure(self, dP: Complex) -> Complex:
        """Change of every cell's pressure [Pa] where it is."""
        oil, ahead, P = self.oils[0].groups, self.oils[1], self.level.solution.P
        change = P * (oil.pressure - ahead.groups.pressure) / WARM_STEP + dP * ahead.groups.pressure
        change -= self.node_moves * np.gradient(P * ahead.groups.pressure, ahead.x)
        cells: Complex = 0.5 * (change[1:] + change[:-1])
        return cells


def behind_middle(P: Array) -> slice:
    """Cells of the second half of the film."""
    free = np.flatnonzero(P[1:-1] > 0.0) + 1
    return slice(int(free[free.size // 2]), int(free[-1]))
