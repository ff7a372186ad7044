"""Contacts with heat on one grid after another: starts, neighbours, refinement and what two grids differ by."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from base import Array, Cost
from base.results import WORST
from ehl.discrete.contact import LineContact
from ehl.discrete.equations import Grid, Groups
from ehl.discrete.method import METHOD
from ehl.discrete.newton import newton
from ehl.discrete.solids import Solid
from ehl.discrete.supply import OilLayer, Supply
from ehl.discrete.thermal_oil import ThermalOil
from ehl.films.solver import moes_flow, solve_checked
from ehl.films.thermal_errors import Compared
from ehl.solving.heat_balance import losses
from ehl.solving.layer_supply import LayerSupply
from ehl.solving.levels import Level, State, WarmLevel, transfer
from ehl.solving.options import Options
from ehl.solving.plan import Plan
from ehl.solving.refinement import doubled, refine

_MOST_STEPS = 60  # of Newton's on one grid
_FARTHER = 0.005  # tolerance below which heat is followed from farther ahead, as much as it is smaller,
_FARTHEST = 2.5  # up to so many times as far: beyond, oil that goes round settles with few films
_SHARES = (0.25, 0.5, 0.75, 1.0)  # of the sliding, where all of it at once fails


Pair = tuple[WarmLevel, WarmLevel]


def at_bulk(contact: LineContact, bulk: Array) -> LineContact:
    """Return the contact with the oil as it is at the mean bulk temperature, isothermal and Newtonian."""
    oil, mean = contact.lubricant, 0.5 * (bulk[0] + bulk[1])
    if (oil.viscosity_law is not None and oil.table is None) or mean == oil.temperature:
        return contact
    return replace(contact, lubricant=oil.at_temperature(mean))


def _out_of_balance(powers: dict[str, float]) -> float:
    """Heat that is lost or found over the heat that is made or that goes through the film from body to body."""
    made = powers["dissipation"] + powers["compression"]
    through = abs(powers["first_body"]) + abs(powers["second_body"])
    return abs(powers["closure"] * made) / max(abs(made), through, 1e-300)


def _carried(coarse: WarmLevel, fine: WarmLevel, solved: WarmLevel, level: Level, oil: ThermalOil) -> Level:
    """Start a finer level and its oil from a similar contact, moved along by the changes on the coarser level."""
    at, places = level.grid.nodes, coarse.grid.nodes
    P = fine.solution.P + np.interp(at, places, solved.solution.P - coarse.solution.P)
    H0 = fine.solution.H0 + solved.solution.H0 - coarse.solution.H0
    oil.start_from(fine.oil)
    oil.add(solved.oil, coarse.oil)
    last = int(np.flatnonzero(solved.solution.P > 0.0)[-1])
    P[at > places[last]] = 0.0
    return replace(level, solution=replace(level.solution, P=np.maximum(P, 0.0), H0=H0))


@dataclass(frozen=True)
class _Films:
    """Films of one call of a search, by the tolerance or up to so many nodes."""

    search: Search
    base: Level
    old: Pair | None
    nodes: int | None

    def on(self, nodes: int, near: WarmLevel | None) -> WarmLevel | None:
        """Solve from the last grid that gave in."""
        return self.search.on(near or self.base, nodes, self.old, near)

    def compared(self, coarse: WarmLevel, fine: WarmLevel) -> Compared:
        """Say what two grids differ by."""
        search = self.search
        compared = Compared(coarse, fine, search.tolerance, search.flooded, self.nodes)
        search.reason = f"error {compared.error:.2g} left on {fine.grid.nodes.size} nodes"
        return compared


class Search:
    """Solves levels with heat; counts what it does."""

    def __init__(
        self,
        contact: LineContact,
        solids: tuple[Solid, Solid] | None,
        bulk: Array,
        tolerance: float,
    ) -> None:
        self.contact, self.solids, self.bulk, self.tolerance = contact, solids, bulk, tolerance
        self.supply: Supply | None = None
        self.flooded: State | None = (
            None  # of a starved film: the flooded one of this contact, or of one like it
        )
        self.isothermal = at_bulk(contact, bulk)
        self.reach = max(METHOD.inlet_reach, (10.0 / tolerance) ** (1.0 / 3.0))
        self.heat_reach = METHOD.heat_reach * min(max(1.0, _FARTHER / tolerance), _FARTHEST)
        self.iterations, self.restarts, self.nodes, self.reason = 0, 0, 0, ""

    def from_nothing(self, nodes: int | None) -> Compared | None:
        """Start from the isothermal, Newtonian film."""
        tolerance = max(self.tolerance, 0.01)
        for n in (METHOD.first_nodes, None) if nodes is None or nodes >= METHOD.first_nodes else (nodes,):
            film = solve_checked(self.isothermal, Options(tolerance, n, supply=self.supply), None)
            self.iterations += film.run.iterations
            if film.converged:
                base = film.state.bare().fine if n == METHOD.first_nodes else film.state.bare().coarse
                return self._refine(base, None, nodes)
        self.reason = f"without heat and shear: {film.film().message}"
        return None

    def from_neighbour(self, near: State | None, nodes: int | None) -> Compared | None:
        """Start from both levels of a similar contact and their oils; None where it has none."""
        old = None if near is None else near.warm
        if old is None:
            return None
        plan, (coarse, fine) = self._plan(), old
        if fine.plan.serves(plan, self.supply):
            return self._refine(coarse, old, nodes)
        grid = plan.grid(fine.grid.nodes.size)
        P, H0 = transfer(fine, self.contact, plan, grid, along=plan.fixed)
        return self._refine(Level(fine.contact, plan, grid, replace(fine.solution, P=P, H0=H0)), None, nodes)

    def _plan(self) -> Plan:
        """Lay the grids of this contact alone, without heat."""
        if self.supply is None:
            return Plan.of(self.isothermal, "graded", None, self.reach)
        return Plan.fed(self.isothermal, "graded", self.supply, moes_flow(self.isothermal))

    def _refine(self, base: Level, old: Pair | None, nodes: int | None) -> Compared | None:
        """Double the grid until the estimate meets what is asked.

        Where no grid meets it the two that differ by the smallest amount are given back, with what they differ by.
        """
        sizes = [METHOD.most_nodes_with_heat if nodes is None else nodes]
        while sizes[0] >= 4 * METHOD.first_nodes - 3:
            # a grid that is asked for starts from coarser ones as any does
            sizes.insert(0, (sizes[0] + 1) // 2)
        # a neighbour gives starts on its own two grids
        served = old is not None and old[1].grid.nodes.size == sizes[0]
        films = _Films(self, base, old if served else None, nodes)
        compared = refine(doubled(films, ((sizes[0] + 1) // 2, *sizes)))
        return compared if compared is not None and compared.error < WORST else None

    def on(self, base: Level, n: int, old: Pair | None, near: WarmLevel | None) -> WarmLevel | None:
        """Solve on n nodes from a level and its oil, or as an old pair and the coarser grid make likely."""
        solved = self._fed(self._on(self._level(base, n), base.oil, old, near))
        if solved is None:
            self.reason = "Newton's method did not converge"
        return solved

    def _fed(self, level: WarmLevel | None) -> WarmLevel | None:
        """Move the meniscus of a layer until the film carries away what the layer brings."""
        if level is None or not isinstance(self.supply, OilLayer) or not level.plan.fixed:
            return level
        supplied = LayerSupply(
            self, level, self.supply.thickness, METHOD.layer_flow_with_heat * self.tolerance
        ).solve()
        return supplied if supplied.solution.converged else None

    @property
    def exhausted(self) -> bool:
        """Whether the call has had its Newton steps."""
        return self.iterations >= METHOD.newton_steps

    @property
    def finest(self) -> float:
        """Last Newton step of a film that is solved to its end."""
        return METHOD.newton_done_with_heat * self.tolerance

    def near(
        self, old: WarmLevel, plan: Plan, grid: Grid, start: tuple[Array, float], done: float
    ) -> WarmLevel:
        """Solve from pressures and separation on a grid, with the oil of a film on another one."""
        level = Level(self.contact, plan, grid, replace(old.solution, P=start[0], H0=start[1]))
        solved = self._newton(level, self._oil(level, 1.0, old.oil), done)
        return solved or replace(old, solution=replace(old.solution, converged=False))

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
        old: Pair | None = None,
        coarser: WarmLevel | None = None,
    ) -> WarmLevel | None:
        """Solve on a level's grid from its pressures and from another solution's temperatures."""
        self.nodes = max(self.nodes, level.grid.nodes.size)
        oil = self._oil(level, 1.0, known)
        if old is not None and coarser is not None and old[1].on_grid_of(level):
            level = _carried(*old, coarser, replace(level, grid=old[1].grid), oil)
        solved = self._newton(level, oil)
        if solved is not None:
            return solved
        self.restarts += 1
        partly: WarmLevel | None = None
        for share in _SHARES:
            oil = self._oil(level, share, None if partly is None else partly.oil)
            partly = self._newton(level if partly is None else partly, oil)
            if partly is None:
                return None
        return partly

    def _oil(self, level: Level, share: float, known: ThermalOil | None) -> ThermalOil:
        """Oil on a level's grid, with a share of the sliding."""
        contact = replace(self.contact, sliding=share * self.contact.sliding)
        groups = Groups.on(contact, level.grid)
        oil = ThermalOil(contact, level.grid, groups, self.solids, self.bulk, inlet_gap=self.heat_reach)
        if known is not None:
            oil.start_from(known)
        return oil

    def _newton(self, level: Level, oil: ThermalOil, done: float | None = None) -> WarmLevel | None:
        solution = level.solution
        try:
            with np.errstate(all="ignore"):
                solved = newton(
                    level.grid,
                    oil.groups,
                    solution.P,
                    solution.H0,
                    oil=oil,
                    done=self.finest if done is None else done,
                    max_iterations=_MOST_STEPS,
                )
        except np.linalg.LinAlgError:  # temperatures of a trial that diverged
            return None
        self.iterations += solved.iterations
        if not solved.converged or not np.isfinite(oil.temperature).all():
            return None
        if oil.solids is not None and _out_of_balance(losses(oil)) > METHOD.heat_balance:
            return None  # heat that goes round in the inlet has run away
        return WarmLevel(self.contact, level.plan, level.grid, solved, oil)

    def cost(self, seconds: float) -> Cost:
        """What it took."""
        counts = {"restarts": self.restarts}
        return Cost(seconds, unknowns=self.nodes - 1, iterations=self.iterations, counts=counts)

    def places(self) -> Array:
        """Nodes of a film that was not found [m]."""
        return np.array([-1.0, 1.0]) * self.contact.half_width
