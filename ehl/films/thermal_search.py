"""Contacts with heat on one grid after another: starts, neighbours, refinement and what two grids differ by."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from base import Array, Cost
from base.results import WORST
from ehl.discrete.contact import LineContact
from ehl.discrete.equations import Groups
from ehl.discrete.newton import newton
from ehl.discrete.solids import Solid
from ehl.discrete.supply import OilLayer, Supply
from ehl.discrete.thermal_oil import INLET_GAP, ThermalOil
from ehl.films.result import GRID_FACTOR, film_error
from ehl.films.solver import REACH, solve_checked
from ehl.solving.heat_balance import losses, rises, traction
from ehl.solving.levels import Level, State, figures, transfer
from ehl.solving.meniscus import MeniscusSearch
from ehl.solving.options import Options
from ehl.solving.plan import Plan

_DONE = 0.05  # last step of the pressure over the tolerance; steps shrink by three and more each
_MOST_STEPS = 60
_LEAST = 0.6  # the minimum under a spike falls with the cells' size, not with its square: as much more of its change
_INLET_SHARE = (
    0.04  # of the film by which the central film changes where heat ahead is left out, times that gap
)
_BALANCE = 0.1  # of the heat that is lost or found, beyond which there is no solution
_FED = 0.02  # miss of a layer's flow over the tolerance
_MOST_PLACES = 20  # of a meniscus on one grid
_CLIMB_LEFT = 0.25  # share of the climb to a spike that grids leave out
_FIRST_NODES = 65
_MOST_NODES = 513
_SHARES = (0.25, 0.5, 0.75, 1.0)  # of the sliding, where all of it at once fails

Solved = tuple[Level, ThermalOil]


def at_bulk(contact: LineContact, bulk: tuple[float, float]) -> LineContact:
    """Return the contact with the oil as it is at the mean bulk temperature, isothermal and Newtonian."""
    oil, mean = contact.lubricant, 0.5 * (bulk[0] + bulk[1])
    if (oil.viscosity_law is not None and oil.table is None) or mean == oil.temperature:
        return contact
    return replace(contact, lubricant=oil.at_temperature(mean))


class Compared:
    """Two levels with heat: the figures of the finer and their changes."""

    def __init__(self, before: Solved, last: Solved, tolerance: float) -> None:
        (self.coarse, self.before), (self.fine, self.oil) = before, last
        rest = _DONE * tolerance / 3.0  # what further steps would still change
        mu_0, mu = traction(self.before), traction(self.oil)
        self.rest, self.inlet = rest, self.fine.plan.inlet_error
        self.traction_error = rest + abs(mu_0 - mu) / max(abs(mu), 1e-4)
        oil = self.oil.contact.lubricant
        cut = 0.0 if self.oil.solids is None or oil.viscosity_slope == 0.0 else _INLET_SHARE / INLET_GAP
        lowest_0, lowest = (figures(level).minimum_thickness for level in (self.coarse, self.fine))
        film = film_error(self.coarse, self.fine) + _LEAST * abs(lowest_0 / lowest - 1.0)
        # what the hottest oil does to film and traction is in these; itself it may stand at the spike
        self.error = max(film, GRID_FACTOR * self.traction_error) + self.inlet + cut + rest

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
        top, climb = _climb(self.fine, self.oil)
        change = climb - _climb(self.coarse, self.before)[1]
        remainder = max(_CLIMB_LEFT * climb, 2.0 * change)
        return max(0.0, top + remainder - float(self.oil.temperature.max()))

    @property
    def state(self) -> State:
        """What a next film starts from."""
        return State(self.coarse.bare(), self.fine.bare())


def _out_of_balance(powers: dict[str, float]) -> float:
    """Heat that is lost or found over the heat that is made or that goes through the film from body to body."""
    made = powers["dissipation"] + powers["compression"]
    through = abs(powers["first_body"]) + abs(powers["second_body"])
    return abs(powers["closure"] * made) / max(abs(made), through, 1e-300)


def _climb(level: Level, oil: ThermalOil) -> tuple[float, float]:
    """Maximum temperature under the spike and its rise above the coldest oil between the middle and there [K]."""
    P, hottest = level.solution.P, oil.temperature.max(axis=1)
    tops = np.flatnonzero((P[1:-1] >= P[:-2]) & (P[1:-1] > P[2:])) + 1
    middle = int(np.searchsorted(oil.middles, 0.0))
    if tops.size == 0 or tops[-1] <= middle:
        return 0.0, 0.0
    tip = int(tops[-1])
    top = float(hottest[max(tip - 3, middle) : tip + 2].max())
    return top, top - float(hottest[middle : tip + 1].min())


@dataclass(frozen=True)
class Neighbour:
    """Both levels of a similar contact: what is found on the coarser moves the start on the finer along."""

    coarse: Solved
    fine: Solved

    def carry(self, solved: Solved, level: Level, oil: ThermalOil) -> Level:
        """Start the finer level and its oil from the old one and from what has changed on the coarser."""
        (old, old_oil), (new, new_oil) = self.coarse, solved
        at, places = level.grid.nodes, old.grid.nodes
        P = self.fine[0].solution.P + np.interp(at, places, new.solution.P - old.solution.P)
        H0 = self.fine[0].solution.H0 + new.solution.H0 - old.solution.H0
        oil.start_from(self.fine[1])
        oil.add(new_oil, old_oil)
        last = int(np.flatnonzero(new.solution.P > 0.0)[-1])
        P[at > places[last]] = 0.0
        return replace(level, solution=replace(level.solution, P=np.maximum(P, 0.0), H0=H0))


class Search:
    """Solves levels with heat; counts what it does."""

    def __init__(
        self,
        contact: LineContact,
        solids: tuple[Solid, Solid] | None,
        bulk: tuple[float, float],
        tolerance: float,
        supply: Supply | None = None,
    ) -> None:
        self.contact, self.solids, self.bulk, self.tolerance = contact, solids, np.array(bulk), tolerance
        self.supply = supply
        self.isothermal = at_bulk(contact, bulk)
        self.reach = max(REACH, (10.0 / tolerance) ** (1.0 / 3.0))
        self.iterations, self.restarts, self.nodes, self.reason = 0, 0, 0, ""

    def from_nothing(self, nodes: int | None) -> Compared | None:
        """Start from the isothermal, Newtonian film."""
        tolerance = max(self.tolerance, 0.01)
        for n in (_FIRST_NODES, None) if nodes is None or nodes >= _FIRST_NODES else (nodes,):
            film = solve_checked(self.isothermal, Options(tolerance, n, supply=self.supply), None)
            self.iterations += film.run.iterations
            if film.converged:
                base = film.state.bare().fine if n == _FIRST_NODES else film.state.bare().coarse
                return self._refine(base, None, nodes)
        self.reason = f"without heat and shear: {film.film().message}"
        return None

    def from_neighbour(
        self, old: State, oils: tuple[ThermalOil, ThermalOil], nodes: int | None
    ) -> Compared | None:
        """Start from both levels of a similar contact and their oils."""
        plan = Plan.of(self.isothermal, "graded", None, self.reach)
        if old.plan.serves(plan):
            neighbour = Neighbour((old.coarse, oils[0]), (old.fine, oils[1]))
            return self._refine(old.coarse, neighbour, nodes)
        moved = replace(old.fine, plan=plan, grid=plan.grid(old.fine.grid.nodes.size))
        P, H0 = transfer(old.fine, self.contact, plan, moved.grid)
        return self._refine(replace(moved, solution=replace(old.fine.solution, P=P, H0=H0)), None, nodes)

    def _refine(self, base: Level, old: Neighbour | None, nodes: int | None) -> Compared | None:
        """Double the grid until the estimate meets what is asked; a grid that fails is passed over.

        Where no grid meets it the two that differ by the smallest amount are given back, with what they differ by.
        """
        sizes = [_MOST_NODES if nodes is None else nodes]
        while (
            sizes[0] >= 4 * _FIRST_NODES - 3
        ):  # a grid that is asked for starts from coarser ones as any does
            sizes.insert(0, (sizes[0] + 1) // 2)
        known = None if old is None else old.coarse[1]
        before = self._fed(self._on(self._level(base, (sizes[0] + 1) // 2), known))
        nearest: Compared | None = None
        for n in sizes:
            level, oil = (base, known) if before is None else before
            fine = self._level(level, n)
            last = self._fed(self._on(fine, oil, old if before is not None else None, before))
            if before is not None and last is not None:
                compared = Compared(before, last, self.tolerance)
                if n == nodes or (nodes is None and compared.error <= self.tolerance):
                    return compared
                self.reason = f"error {compared.error:.2g} left on {n} nodes"
                nearest = compared if nearest is None or compared.error < nearest.error else nearest
            if last is None:
                self.reason = "Newton's method did not converge"
            before, old = last or before, None
        return nearest if nearest is not None and nearest.error < WORST else None

    def _fed(self, solved: Solved | None) -> Solved | None:
        """Move the meniscus of a layer until the film carries away what the layer brings."""
        if solved is None or not isinstance(self.supply, OilLayer) or not solved[0].plan.fixed:
            return solved
        layer, level = self.supply.thickness, solved[0]
        search = MeniscusSearch.at(-1.0 - level.plan.domain[0], math.log(level.flow / layer))
        for _ in range(_MOST_PLACES):
            level, oil = solved
            if abs(search.miss) < _FED * self.tolerance:
                return solved
            if search.stuck:
                break
            plan = level.plan.with_inlet(-1.0 - search.distance)
            grid = plan.grid(level.grid.nodes.size)
            P, H0 = transfer(level, self.contact, plan, grid)
            moved = Level(self.contact, plan, grid, replace(level.solution, P=P, H0=H0))
            trial = self._newton(moved, self._oil(moved, 1.0, oil))
            if trial is None:
                self.restarts += 1
                search.failed()
            else:
                solved = trial
                search.solved(math.log(trial[0].flow / layer))
        return None

    def _level(self, base: Level, n: int) -> Level:
        """Carry pressures to a grid of n nodes, as a start."""
        same = base.grid.nodes.size == n
        grid = base.grid if same else base.plan.grid(n)
        P, H0 = transfer(base, self.contact, base.plan, grid)
        return Level(self.contact, base.plan, grid, replace(base.solution, P=P, H0=H0))

    def _on(
        self,
        level: Level,
        known: ThermalOil | None,
        old: Neighbour | None = None,
        coarser: Solved | None = None,
    ) -> Solved | None:
        """Solve on a level's grid from its pressures and from another solution's temperatures."""
        self.nodes = max(self.nodes, level.grid.nodes.size)
        oil = self._oil(level, 1.0, known)
        if old is not None and coarser is not None and old.fine[0].grid.nodes.size == level.grid.nodes.size:
            level = old.carry(coarser, replace(level, grid=old.fine[0].grid), oil)
        solved = self._newton(level, oil)
        if solved is not None:
            return solved
        self.restarts += 1
        partly: Solved | None = None
        for share in _SHARES:
            oil = self._oil(level, share, None if partly is None else partly[1])
            partly = self._newton(level if partly is None else partly[0], oil)
            if partly is None:
                return None
        return partly

    def _oil(self, level: Level, share: float, known: ThermalOil | None) -> ThermalOil:
        """Oil on a level's grid, with a share of the sliding."""
        contact = replace(self.contact, sliding=share * self.contact.sliding)
        oil = ThermalOil(contact, level.grid, Groups.on(contact, level.grid), self.solids, self.bulk)
        if known is not None:
            oil.start_from(known)
        return oil

    def _newton(self, level: Level, oil: ThermalOil) -> Solved | None:
        solution = level.solution
        try:
            with np.errstate(all="ignore"):
                solved = newton(
                    level.grid,
                    oil.groups,
                    solution.P,
                    solution.H0,
                    oil=oil,
                    done=_DONE * self.tolerance,
                    max_iterations=_MOST_STEPS,
                )
        except np.linalg.LinAlgError:  # temperatures of a trial that diverged
            return None
        self.iterations += solved.iterations
        if not solved.converged or not np.isfinite(oil.temperature).all():
            return None
        if oil.solids is not None and _out_of_balance(losses(oil)) > _BALANCE:
            return None  # heat that goes round in the inlet has run away
        return replace(level, contact=self.contact, solution=solved), oil

    def cost(self, seconds: float) -> Cost:
        """What it took."""
        counts = {"restarts": self.restarts}
        return Cost(seconds, unknowns=self.nodes - 1, iterations=self.iterations, counts=counts)

    def places(self) -> Array:
        """Nodes of a film that was not found [m]."""
        return np.array([-1.0, 1.0]) * self.contact.half_width
