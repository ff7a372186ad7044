"""What two grids of a contact with heat differ by: errors of film, traction and temperatures."""

from __future__ import annotations

from functools import cached_property

import numpy as np

from ehl.discrete.method import METHOD
from ehl.films.result import film_error
from ehl.solving.heat_balance import losses, rises, traction
from ehl.solving.levels import State, WarmLevel, figures

_LEAST = 0.6  # the minimum under a spike falls with the cells' size, not with its square: as much more of its change
_INLET_SHARE = (
    0.04  # of the film by which the central film changes where heat ahead is left out, times that gap
)
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
        oil = self.oil.contact.lubricant
        cut = (
            0.0 if self.oil.solids is None or oil.viscosity_slope == 0.0 else _INLET_SHARE / METHOD.heat_reach
        )
        lowest_0, lowest = (figures(level).minimum_thickness for level in (self.coarse, self.fine))
        film = film_error(self.coarse, self.fine) + _LEAST * abs(lowest_0 / lowest - 1.0)
        # what the hottest oil does to film and traction is in these; itself it may stand at the spike
        self.error = max(film, METHOD.grid_factor * self.traction_error) + self.inlet + cut + rest
        # a grid that is asked for has no tolerance to meet, nor do coarser ones end the search for it
        self.enough = self.error <= tolerance if nodes is None else fine.grid.nodes.size == nodes

    @cached_property
    def temperature_error(self) -> float:
        """Relative error of the rises of oil and surfaces; no grid is chosen by it, found for the last alone."""
        warm_0, warm = np.array(rises(self.before)), np.array(rises(self.oil))
        change = float(np.max(np.abs(warm_0 - warm) / np.maximum(warm, 1.0)))
        return self.rest + change + self._spike_left() / max(float(warm[0]), 1.0) + self._heat_ahead()

    def _heat_ahead(self) -> float:
        """Share of the rises that heat ahead of where it is followed would add.

        It falls with the gap from which heat is followed, so that as much again as twice the gap adds is left beyond.
        What oil that turns back carries off unseen is the heat by which the balance does not close.
        """
        if self.before.solids is None:
            return 0.0
        solution = self.coarse.solution
        with np.errstate(all="ignore"):
            wider = np.array(rises(self.before.farther(solution.P, solution.H)))
        warm = np.array(rises(self.before))
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
