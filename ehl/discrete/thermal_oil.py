"""Oil that shears and warms: what temperature and stress across the film make of viscosity, density and flow."""

from __future__ import annotations

from copy import copy
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from base import Array
from ehl.discrete.collocation import Collocation, lobatto
from ehl.discrete.contact import LineContact
from ehl.discrete.equations import Fluid, Grid, Groups, plain_oil
from ehl.discrete.method import METHOD
from ehl.discrete.solids import Solid, surface_heating

_COLD = 1e-3  # mean rise below which changes are not looked at in proportion [K]
_NEWTONIAN = 1e12  # Eyring stress that no oil reaches [Pa]; with more, sums across the film lose digits
_UNLIMITED = 1e30  # [Pa]
_LEAST_STRESS = 3e6  # of the limiting stress: where hardly any pressure stands no liquid yields to less [Pa]


class Sheared(NamedTuple):
    """The oil of every cell in shear."""

    gap: Array  # h [m] (n-1,)
    density: Array  # rho [kg/m3] (n-1,)
    cooling: Array  # ln(eta) over that at T0, both above the pole (n-1, m)
    fall: Array  # -d ln(eta)/dT [1/K] (n-1, m)
    viscosity: Array
    flow: Array  # (n-1, 5) and the rest (n-1, m): see ehl.kernels.shear_kernels.flow_across
    speed: Array
    across: Array
    rate: Array
    yielding: Array


class Pressed(NamedTuple):
    """What pressures and gaps make of the oil at its reference temperature, at the nodes."""

    p: Array  # [Pa]
    gap: Array  # [m]
    ratio: Array  # ln(eta/eta0)
    ratio_slope: Array
    packed: Array  # rho/rho0
    packed_slope: Array
    moved: Array  # through every cell, see ThermalOil._moved


class Heat(NamedTuple):
    """What a sweep for the temperatures begins with and changes, see ehl.kernels.heat_kernels.heat_across."""

    gap: Array
    carried: Array
    viscosity: Array
    across: Array
    rate: Array
    fall: Array
    yielding: Array
    speed: Array
    gradient: Array
    bodies: Array
    ambient: Array
    stores: Array
    added: Array
    about: Array
    temperature: Array
    into: Array
    response: Array


@dataclass
class ThermalOil:
    """State of the oil in the cells of one grid; follows the pressures and gaps that it is given.

    What the pressure moves through a cell, by the oil's last state, is held while shear and temperature are sought:
    with the slope of the pressure held instead they run away at the spike and in the inlet.
    """

    contact: LineContact
    grid: Grid
    groups: Groups
    solids: tuple[Solid, Solid] | None  # None: temperatures stay those of the bulk
    bulk: Array  # (2,) [K]
    temperature: Array = field(init=False)  # (n-1, m) [K]
    into: Array = field(init=False)  # (2, n-1) [W/m2]
    sigma: Array = field(init=False)  # (n-1,)
    bodies: Array = field(init=False)  # (2, n-1, n-1) [K m2/W]
    across: Collocation = field(default_factory=lobatto)
    x: Array = field(init=False)  # nodes [m] (n,)
    middles: Array = field(init=False)  # of the cells [m] (n-1,)
    lengths: Array = field(init=False)  # of the cells [m] (n-1,)
    left: Array = field(init=False)  # share of the left cell at the nodes between two (n-2,)
    inlet_gap: float = METHOD.heat_reach
    first: int = 0  # cell where heat begins to be followed
    last: int = 0  # and where it ends
    unsettled: float = 0.0
    before: Fluid | None = None
    begun: Array | None = None  # (n-1, 5): of another grid or contact, see ehl.kernels.film_kernels.reynolds
    shear: Sheared = field(init=False)
    gradient: Array = field(init=False)  # p' [Pa/m] (n-1,)
    response: Array | None = None  # (n-1, 2) of the mean temperature, see heat_kernels.heat_across
    carried: Array = field(init=False)  # (n, m): c rho u h through every node [W/(m K)]
    mass: Array = field(init=False)  # (n-1,): what flows through every cell [kg/(m s)]
    packed: Array = field(init=False)  # (n,): rho/rho0
    under: Pressed = field(init=False)
    begun_with: Heat | None = None  # as the last sweep has found it

    def __post_init__(self) -> None:
        """Begin at the bulk temperatures."""
        cells = self.grid.nodes.size - 1
        self.x = self.grid.nodes * self.groups.length
        self.middles, self.lengths = 0.5 * (self.x[1:] + self.x[:-1]), np.diff(self.x)
        self.left = self.lengths[1:] / (self.lengths[1:] + self.lengths[:-1])
        self.temperature = np.tile(self.undisturbed, (cells, 1))
        self.into, self.sigma = np.zeros((2, cells)), np.zeros(cells)
        self.mass = np.zeros(cells)
        if self.solids is not None:
            surfaces = zip(self.contact.surface_speeds, self.solids, strict=True)
            depth = self.contact.radius
            self.bodies = np.array([surface_heating(self.x, u, solid, depth) for u, solid in surfaces])

    @property
    def undisturbed(self) -> Array:
        """Temperature of the oil between surfaces at their bulk temperatures (m,) [K]."""
        temperature: Array = self.bulk[0] + (self.bulk[1] - self.bulk[0]) * (self.across.zeta + 0.5)
        return temperature

    def start_from(self, old: ThermalOil) -> None:
        """Take temperatures, fluxes and shear over from another grid."""
        at, places = self.middles, old.middles
        for j in range(self.across.zeta.size):
            self.temperature[:, j] = np.interp(at, places, old.temperature[:, j])
        self.into = np.array([np.interp(at, places, row) for row in old.into])
        self.sigma = np.interp(at, places, old.sigma)
        if old.before is not None:
            self.begun = np.array([np.interp(at, places, column) for column in old.before.shear.T]).T

    def add(self, new: ThermalOil, old: ThermalOil) -> None:
        """Add what has changed between two oils on one other grid."""
        at, places = self.middles, old.middles
        for j in range(self.across.zeta.size):
            change = new.temperature[:, j] - old.temperature[:, j]
            self.temperature[:, j] += np.interp(at, places, change)
        for mine, change in zip(self.into, new.into - old.into, strict=True):
            mine += np.interp(at, places, change)

    def on(self, contact: LineContact, grid: Grid) -> ThermalOil:
        """Return the oil of a contact nearby, on a grid whose nodes have moved a little: cell by cell as it is here."""
        groups = Groups.on(contact, grid)
        other = ThermalOil(contact, grid, groups, self.solids, self.bulk, inlet_gap=self.inlet_gap)
        other.temperature, other.into, other.sigma = (
            values.copy() for values in (self.temperature, self.into, self.sigma)
        )
        other.before = self.before
        return other

    def swept(self, P: Array, H: Array, wider_by: float) -> ThermalOil:
        """Return the oil with heat followed from a wider gap, swept once under the same pressures and gaps."""
        wider = copy(self)
        wider.inlet_gap = wider_by * self.inlet_gap
        wider.temperature, wider.into, wider.sigma = (
            values.copy() for values in (self.temperature, self.into, self.sigma)
        )
        wider.at(P, H)
        return wider

    def at(self, P: Array, H: Array) -> Fluid:
        """Let flow, shear and heat follow pressures and gaps; give what the flux needs of them."""
        self.press(P, H)
        if self.solids is not None:
            self._warm()
        return self.fluid()

    def press(self, P: Array, H: Array) -> None:
        """Let flow and shear follow pressures and gaps, temperatures unchanged."""
        oil = self.contact.lubricant
        p = self.groups.pressure * P
        self.last = int(np.flatnonzero(P > 0.0)[-1])
        self.under = Pressed(
            p, self.groups.gap * H, *oil.log_viscosity(p), *oil.density_ratio(p), self._moved(P, H)
        )
        if self.solids is not None:
            self.shear = self._sheared()

    def fluid(self) -> Fluid:
        """What the flux needs of the oil at its temperatures."""
        oil, under, scale = self.contact.lubricant, self.under, self.groups.pressure
        shear = self.shear = self._sheared()
        _, effective, carry, steep, thinning = shear.flow.T
        cells = self.across.weights @ shear.cooling.T
        columns = np.empty((steep.size, 5))
        columns[:, 0] = np.log(effective * carry / oil.viscosity)
        columns[:, 1] = cells * thinning / steep
        columns[:, 2], columns[:, 3] = under.moved, steep
        columns[:, 4] = 1.0 + thinning - 2.0 * steep
        thermal = 1.0 - oil.expansion * (
            self.at_nodes(self.temperature @ self.across.weights) - oil.temperature
        )
        factor = thermal * self.at_nodes(carry)
        self.packed = under.packed * thermal
        self.before = Fluid(
            under.ratio,
            under.ratio_slope * scale,
            under.packed * factor,
            under.packed_slope * factor * scale,
            columns,
            self._swelling(thermal, under.gap / self.groups.gap),
        )
        return self.before

    def _swelling(self, thermal: Array, H: Array) -> Array | None:
        """Change of the gap that acts as the density does when heat of compression expands the oil, by P (n, n)."""
        from ehl.kernels.heat_kernels import compression_response

        if self.response is None:
            return None
        by_pressure: Array = compression_response(self.grid.nodes, self.response)
        factor = -self.contact.lubricant.expansion * self.groups.pressure * H / thermal
        return factor[:, None] * by_pressure

    def at_nodes(self, values: Array) -> Array:
        """Take values of cells (n-1, ...) to the nodes, linearly."""
        left = self.left if values.ndim == 1 else self.left[:, None]
        nodal = np.empty((values.shape[0] + 1, *values.shape[1:]))
        nodal[0], nodal[-1] = values[0], values[-1]
        nodal[1:-1] = values[1:] + left * (values[:-1] - values[1:])
        return nodal

    def _moved(self, P: Array, H: Array) -> Array:
        """Mass flow over rho0 u a^2/R that the pressure moves upstream through every cell.

        The last flow followed the tangent of the oil's thinning to the new pressures, never through zero.
        """
        from ehl.kernels.film_kernels import pressure_flow

        grid, state = self.grid, self.before
        if state is None:
            state = plain_oil(self.groups, P)
            if self.begun is not None:
                state = state._replace(shear=self.begun)
        flow: Array = pressure_flow(
            grid.nodes, P, H, grid.quick, state.ln_viscosity, state.density, state.shear, self.groups.lam
        )
        if self.before is None:
            return flow
        held, steep = state.shear[:, 2], state.shear[:, 3]
        with np.errstate(divide="ignore", invalid="ignore"):
            ratio = flow / held
            more = held * (1.0 + steep * (ratio - 1.0))
            less = held / (1.0 + steep * (1.0 / ratio - 1.0))
        moved: Array = np.where(ratio > 1.0, more, np.where(ratio > 0.0, less, flow))
        return moved

    def _sheared(self) -> Sheared:
        """Shear the oil of every cell at its temperatures and with what the pressure moves there."""
        from ehl.kernels.shear_kernels import flow_across

        p, gap, ratio, _, packed, _, moved = self.under
        oil, contact, across = self.contact.lubricant, self.contact, self.across
        middle, pressed = 0.5 * (gap[1:] + gap[:-1]), 0.5 * (p[1:] + p[:-1])
        between = 0.5 * (ratio[1:] + ratio[:-1])
        ln_ratio, cooling, fall = oil.warmed(between[:, None], self.temperature, pressed[:, None])
        thermal = 1.0 - oil.expansion * (self.temperature @ across.weights - oil.temperature)
        density = 0.5 * oil.density * (packed[1:] + packed[:-1]) * thermal
        share = oil.limiting_shear_ratio
        limit = (
            np.full(middle.size, _UNLIMITED) if share is None else np.maximum(share * pressed, _LEAST_STRESS)
        )
        viscosity = np.exp(ln_ratio) * oil.viscosity
        profiles = flow_across(
            viscosity,
            middle,
            limit,
            moved * oil.density * contact.entrainment * self.groups.gap / density,
            contact.entrainment,
            -contact.sliding,
            _NEWTONIAN if oil.eyring_stress is None else oil.eyring_stress,
            across.zeta,
            across.weights,
            across.sum_up,
            self.sigma,
        )
        return Sheared(middle, density, cooling, fall, viscosity, *profiles)

    def heat(self) -> Heat:
        """What a sweep for the temperatures begins with."""
        oil, shear = self.contact.lubricant, self.shear
        through = (shear.density * shear.gap)[:, None] * shear.speed
        self.mass = through @ self.across.weights
        carried = oil.heat_capacity * self.at_nodes(
            through + (self.mass[self.last // 2] - self.mass)[:, None]
        )
        self.carried, self.gradient = carried, np.diff(self.under.p) / self.lengths
        near = shear.gap < self.inlet_gap * np.interp(0.0, self.middles, shear.gap)
        self.first = max(1, int(np.argmax(near)))
        return Heat(
            shear.gap,
            carried,
            shear.viscosity,
            shear.across,
            shear.rate,
            shear.fall,
            shear.yielding,
            shear.speed,
            self.gradient,
            self.bodies,
            np.repeat(self.bulk[:, None], shear.gap.size, axis=1),
            np.zeros(shear.gap.size),
            np.zeros_like(self.temperature),
            self.temperature.copy(),
            self.temperature,
            self.into,
            np.zeros((shear.gap.size, 2)),
        )

    def sweep(self, heat: Heat) -> None:
        """Sweep for the temperatures, against the flow too where some runs back."""
        from ehl.kernels.heat_kernels import heat_across

        oil, across = self.contact.lubricant, self.across
        back = np.flatnonzero(self.carried.min(axis=1) < 0.0)
        sweeps = [(self.last, False)]
        if back.size > 0:  # some runs back
            sweeps.insert(0, (min(int(back[-1]), self.last), True))
        rules = across.zeta, across.weights, across.derive, across.stiffness, across.sum_up
        for to, backward in sweeps:
            heat_across(self.x, *heat, oil.expansion, oil.conductivity, *rules, self.first, to, backward)
        heat.temperature[self.last + 1 :] = heat.temperature[self.last]

    def _warm(self) -> None:
        """Sweep, and note by how much the temperatures still change."""
        heat = self.heat()
        self.begun_with = heat._replace(temperature=heat.about, into=self.into.copy())
        self.sweep(heat)
        self.response = heat.response
        change, warm = self.temperature - heat.about, self.temperature - self.undisturbed
        self.unsettled = float(np.abs(change).sum() / max(np.abs(warm).sum(), warm.size * _COLD))
