"""What two grids of a contact with heat differ by: errors of film, traction and temperatures."""

from __future__ import annotations

from functools import cached_property

import numpy as np

from ehl.discrete.equations import fluxes
from ehl.discrete.method import METHOD
from ehl.discrete.thermal_oil import ThermalOil
from ehl.films.result import film_error
from ehl.solving.heat_balance import losses, rises, traction
from ehl.solving.levels import State, WarmLevel

_CLIMB_LEFT = 0.25  # share of the climb to a spike that grids leave out


class Compared:
    """Two levels with heat: the figures of the finer and their changes."""

    def __init__(
        self,
        coarse: WarmLevel,
        fine: WarmLevel,
        tolerance: float,
        flooded: State | None = None,
        nodes: int | None = None,
    ) -> None:
        self.coarse, self.fine, self.before, self.oil = coarse, fine, coarse.oil, fine.oil
        self.flooded = flooded
        rest = METHOD.newton_done_with_heat * tolerance / 3.0  # what further steps would still change
        mu_0, mu = traction(self.before), traction(self.oil)
        self.rest, self.inlet = rest, self.fine.plan.inlet_error
        self.traction_error = rest + abs(mu_0 - mu) / max(abs(mu), 1e-4)
        # what the hottest oil does to film and traction is in these; itself it may stand at the spike
        grid = max(film_error(self.coarse, self.fine), METHOD.grid_factor * self.traction_error)
        self.error = grid + self.inlet + self._thinned_ahead() + rest
        # a grid that is asked for has no tolerance to meet, nor do coarser ones end the search for it
        self.enough = self.error <= tolerance if nodes is None else fine.grid.nodes.size == nodes

    @cached_property
    def temperature_error(self) -> float:
        """Relative error of the rises of oil and surfaces; no grid is chosen by it, found for the last alone."""
        warm_0, warm = np.array(rises(self.before)), np.array(rises(self.oil))
        change = float(np.max(np.abs(warm_0 - warm) / np.maximum(warm, 1.0)))
        return self.rest + change + self._spike_left() / max(float(warm[0]), 1.0) + self._heat_ahead()

    @cached_property
    def _wider(self) -> ThermalOil:
        """Oil of the coarser grid with heat followed from twice the gap.

        What heat ahead does falls with the gap from which it is followed: as much again as this adds is left beyond.
        """
        solution = self.coarse.solution
        with np.errstate(all="ignore"):
            return self.before.swept(solution.P, solution.H, 2.0)

    def _thinned_ahead(self) -> float:
        """Relative change of the film that heat ahead of where it is followed would make, by one Newton step."""
        if self.before.solids is None:
            return 0.0
        grid, groups, solution = self.coarse.grid, self.coarse.groups, self.coarse.solution
        P, H, factors = solution.P, solution.H, solution.factors
        assert factors is not None  # the level was solved for this comparison
        with np.errstate(all="ignore"):
            oils = self.before.swept(P, H, 1.0), self._wider
        as_it_is, warmed = (fluxes(grid, groups, P, H, grid.quick, oil.before)[0] for oil in oils)
        dP, dH0 = factors.solve(np.diff(as_it_is - warmed), 0.0, P.size)
        thinned = (dH0 - groups.compliance * (grid.potential @ dP)) / H
        middle, lowest = np.argmin(np.abs(grid.nodes)), np.argmin(H)
        return 2.0 * max(abs(float(thinned[middle])), abs(float(thinned[lowest])))

    def _heat_ahead(self) -> float:
        """Share of the rises that heat ahead of where it is followed would add.

        What oil that turns back carries off unseen is the heat by which the balance does not close.
        """
        if self.before.solids is None:
            return 0.0
        warm, wider = np.array(rises(self.before)), np.array(rises(self._wider))
        ahead = 2.0 * np.abs(wider - warm) / np.maximum(warm, 1.0)
        return float(np.max(ahead)) + abs(losses(self.oil)["closure"])

    def _spike_left(self) -> float:
        """What the oil under the spike may be hotter by than the hottest oil found [K].

        Heat of compression follows the climb of the pressure, of which grids leave a quarter out, or twice what the
        last doubling has changed.
        """
        top, climb = _climb(self.fine)
        change = climb - _climb(self.coarse)[1]
        remainder = max(_CLIMB_LEFT * climb, 2.0 * change)
        return max(0.0, top + remainder - float(self.oil.temperature.max()))

    @property
    def levels(self) -> tuple[WarmLevel, WarmLevel]:
        """Both."""
        return self.coarse, self.fine

    @property
    def state(self) -> State:
        """What a next film starts from."""
        return State(self.coarse.bare(), self.fine.bare(), self.flooded)


def _climb(level: WarmLevel) -> tuple[float, float]:
    """Maximum temperature under the spike and its rise above the coldest oil between the middle and there [K]."""
    oil = level.oil
    P, hottest = level.solution.P, oil.temperature.max(axis=1)
    tops = np.flatnonzero((P[1:-1] >= P[:-2]) & (P[1:-1] > P[2:])) + 1
    middle = int(np.searchsorted(oil.middles, 0.0))
    if tops.size == 0 or tops[-1] <= middle:
        return 0.0, 0.0
    tip = int(tops[-1])
    top = float(hottest[max(tip - 3, middle) : tip + 2].max())
    return top, top - float(hottest[middle : tip + 1].min())
