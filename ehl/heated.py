"""Oil that shears and warms: what temperature and stress across the film make of viscosity, density and flow."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np

from base import Array
from ehl.across import Across, lobatto
from ehl.bodies import Solid, surface_heating
from ehl.contact import LineContact
from ehl.discrete import Fluid, Grid, Groups, plain_oil

_FOLLOWED = (
    0.4  # share of a step that temperatures take: all of it goes round, by expansion and compression heat
)
_COLD = 1e-3  # mean rise below which changes are not looked at in proportion [K]
_INLET = 150.0  # gap over the central film ahead of which the oil has its undisturbed temperature
_NEWTONIAN = 1e12  # Eyring stress that no oil reaches [Pa]; with more, sums across the film lose digits
_UNLIMITED = 1e30  # [Pa]
_LEAST_STRESS = 1e3  # of the limiting stress where hardly any pressure stands [Pa]


@dataclass
class Heated:
    """State of the oil on one grid; follows the pressures and gaps that it is given.

    What the pressure moves through a node, by the oil's last state, is held while shear and temperature are sought:
    with the slope of the pressure held instead they run away at the spike and in the inlet.
    """

    contact: LineContact
    grid: Grid
    groups: Groups
    solids: tuple[Solid, Solid] | None  # None: temperatures stay those of the bulk
    bulk: Array  # (2,) [K]
    temperature: Array = field(init=False)  # (n, m) [K]
    into: Array = field(init=False)  # (2, n) [W/m2]
    sigma: Array = field(init=False)  # (n,)
    bodies: Array = field(init=False)  # (2, n, n) [K m2/W]
    across: Across = field(default_factory=lobatto)
    last: int = 0
    unsettled: float = 0.0
    before: Fluid | None = None
    moved: Array | None = None
    gap: Array = field(init=False)
    density: Array = field(init=False)
    mean_stress: Array = field(init=False)
    speed: Array = field(init=False)
    heat: Array = field(init=False)
    gradient: Array = field(init=False)

    def __post_init__(self) -> None:
        """Begin at the bulk temperatures."""
        n = self.grid.nodes.size
        self.temperature = np.tile(self.undisturbed, (n, 1))
        self.into, self.sigma = np.zeros((2, n)), np.zeros(n)
        if self.solids is not None:
            speeds, x = self.contact.surface_speeds, self.x
            depth = self.contact.radius
            both = zip(speeds, self.solids, strict=True)
            self.bodies = np.array([surface_heating(x, u, solid, depth) for u, solid in both])

    @property
    def x(self) -> Array:
        """Nodes [m]."""
        return self.grid.nodes * self.groups.length

    @property
    def undisturbed(self) -> Array:
        """Temperature of the oil between surfaces at their bulk temperatures (m,) [K]."""
        found: Array = self.bulk[0] + (self.bulk[1] - self.bulk[0]) * (self.across.zeta + 0.5)
        return found

    def start_from(self, old: Heated) -> None:
        """Take temperatures, fluxes and shear over from another grid."""
        at = self.x
        for j in range(self.across.zeta.size):
            self.temperature[:, j] = np.interp(at, old.x, old.temperature[:, j])
        self.into = np.array([np.interp(at, old.x, row) for row in old.into])
        self.sigma = np.interp(at, old.x, old.sigma)

    def at(self, P: Array, H: Array) -> Fluid:
        """Let flow, shear and heat follow pressures and gaps; give what the flux needs of them."""
        from ehl.shear_kernels import flow_across

        oil, contact, groups = self.contact.lubricant, self.contact, self.groups
        p, self.gap = groups.pressure * P, groups.gap * H
        self.last = int(np.flatnonzero(P > 0.0)[-1])
        ln_ratio, _ = oil.hot_log_viscosity(p[:, None], self.temperature)
        mean = self.temperature @ self.across.weights
        _, slope = oil.hot_log_viscosity(p, mean)
        thermal = 1.0 - oil.expansion * (mean - oil.temperature)
        ratio, ratio_slope = oil.density_ratio(p)
        self.density = oil.density * ratio * thermal
        share = oil.limiting_shear_ratio
        limit = np.full(p.size, _UNLIMITED) if share is None else np.maximum(share * p, _LEAST_STRESS)
        stress = _NEWTONIAN if oil.eyring_stress is None else oil.eyring_stress
        across = self.across
        moved = self._moved(P, H) * oil.density * contact.entrainment * groups.gap / self.density
        to = slice(0, self.last + 1)
        found = flow_across(
            np.exp(ln_ratio[to]) * oil.viscosity,
            self.gap[to],
            limit[to],
            moved[to],
            contact.entrainment,
            -contact.sliding,
            stress,
            across.zeta,
            across.weights,
            across.sum_up,
            self.sigma[to],
        )
        self.mean_stress, effective, carry, thinning, self.speed, self.heat = found
        self.gradient = np.gradient(p, self.x, edge_order=1)[to]
        if self.solids is not None:
            self._warm()
        ln_viscosity, by_viscosity, carried = ln_ratio @ across.weights, np.ones(p.size), np.ones(p.size)
        ln_viscosity[to] = np.log(effective * carry / oil.viscosity)
        by_viscosity[to], carried[to] = thinning, carry
        self.before = Fluid(
            ln_viscosity,
            slope * by_viscosity * groups.pressure,
            ratio * thermal * carried,
            ratio_slope * thermal * carried * groups.pressure,
        )
        return self.before

    def _moved(self, P: Array, H: Array) -> Array:
        """Mass flow over rho0 u a^2/R that the pressure moves through every node, by the oil's last state."""
        state = plain_oil(self.groups, P) if self.before is None else self.before
        h, ln = np.diff(self.grid.nodes), state.ln_viscosity
        half = 0.5 * np.diff(ln)
        small = np.abs(half) < 1e-4
        mean = np.where(small, 1.0, np.sinh(half) / np.where(small, 1.0, half))
        fluidity = np.exp(-0.5 * (ln[1:] + ln[:-1])) * mean
        resistance = 1.0 / (state.density * H**3)
        between = 8.0 / ((state.density[1:] + state.density[:-1]) * (0.5 * (H[1:] + H[:-1])) ** 3)
        cells = 6.0 * fluidity * np.diff(P)
        cells /= self.groups.lam * h * (resistance[1:] + between + resistance[:-1])
        found = np.empty(P.size)
        found[1:-1] = 0.5 * (cells[1:] + cells[:-1])
        found[0], found[-1] = cells[0], cells[-1]
        self.moved = found if self.moved is None else 0.5 * (self.moved + found)
        return self.moved

    def _warm(self) -> None:
        """Sweep for the temperatures, against the flow too where some runs back."""
        from ehl.shear_kernels import heat_across

        oil, across, to = self.contact.lubricant, self.across, slice(0, self.last + 1)
        flow = oil.heat_capacity * (self.density[to] * self.gap[to])[:, None] * self.speed
        expanding = oil.expansion * self.speed * self.gradient[:, None]
        first = max(1, int(np.argmax(self.gap < _INLET * np.interp(0.0, self.x, self.gap))))
        before, taken = self.temperature.copy(), self.into.copy()
        for backward in (True, False) if flow.min() < 0.0 else (False,):
            heat_across(
                self.x,
                self.gap,
                flow,
                self.heat,
                expanding,
                oil.conductivity,
                across.zeta,
                across.derive,
                across.derive_2,
                across.sum_up,
                self.bodies,
                self.bulk,
                first,
                self.last,
                self.temperature,
                self.into,
                backward,
            )
        self.temperature[self.last + 1 :] = self.temperature[self.last]
        change, warm = self.temperature - before, self.temperature - self.undisturbed
        self.unsettled = float(np.abs(change).sum() / max(np.abs(warm).sum(), warm.size * _COLD))
        self.temperature = before + _FOLLOWED * change
        self.into = taken + _FOLLOWED * (self.into - taken)

    @property
    def traction(self) -> float:
        """Mean shear stress over the load, positive where the first surface is the faster."""
        to = slice(0, self.last + 1)
        return -float(np.trapezoid(self.mean_stress, self.x[to])) / self.contact.load

    def rises(self) -> tuple[float, float]:
        """Greatest rise of the oil above the mean bulk temperature, and of a surface above its own [K]."""
        first, second = (float(np.max(self.temperature[:, j]) - self.bulk[j]) for j in (0, -1))
        return float(np.max(self.temperature) - self.bulk.mean()), max(first, second)

    def rolling(self, P: Array) -> float:
        """Integral of h p'/2 [N/m]."""
        p = P * self.groups.pressure
        return float(0.25 * np.sum((self.gap[1:] + self.gap[:-1]) * np.diff(p)))

    def stresses(self) -> Array:
        """Shear stress at both surfaces (n, 2) [Pa]; 0 behind the film."""
        found, to = np.zeros((self.x.size, 2)), slice(0, self.last + 1)
        tilt = 0.5 * self.gap[to] * self.gradient
        found[to] = np.stack([self.mean_stress - tilt, self.mean_stress + tilt], axis=1)
        return found

    def losses(self) -> dict[str, float]:
        """Where the power of one metre of face goes [W/m]."""
        oil, to, weights = self.contact.lubricant, slice(0, self.last + 1), self.across.weights
        x, gap = self.x[to], self.gap[to]
        sheared = float(np.trapezoid(gap * (self.heat @ weights), x))
        sliding = -float(np.trapezoid(self.mean_stress, x)) * self.contact.sliding
        T = self.temperature[to]
        squeezed = oil.expansion * gap * self.gradient * ((self.speed * T) @ weights)
        carried = (
            oil.heat_capacity * (self.density[to] * gap) * ((self.speed * (T - self.undisturbed)) @ weights)
        )
        compression = float(np.trapezoid(squeezed, x))
        first, second = (float(np.trapezoid(row[to], x)) for row in self.into)
        away = float(carried[-1] - carried[0])
        return {
            "dissipation": sheared,
            "sliding": sliding,
            "rolling": sheared - sliding,
            "compression": compression,
            "first_body": first,
            "second_body": second,
            "oil": away,
            "closure": (first + second + away) / (sheared + compression) - 1.0 if sheared > 0.0 else 0.0,
        }

    def softer(self, share: float) -> Heated:
        """Return the same oil on the same grid with a share of the sliding."""
        contact = replace(self.contact, sliding=share * self.contact.sliding)
        return Heated(contact, self.grid, self.groups, self.solids, self.bulk)
