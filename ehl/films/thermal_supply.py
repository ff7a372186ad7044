"""Films with heat, flooded or starved, each from a similar film where there is such a film."""

from __future__ import annotations

from dataclasses import dataclass, replace

from ehl.discrete.supply import Supply
from ehl.films.solver import moes_flow
from ehl.films.thermal_errors import Compared
from ehl.films.thermal_search import Search, at_bulk
from ehl.solving.levels import State

_CLIMB = (3e7, 5e7, 1e8, 2e8, 5e8)  # Eyring stresses on the way to an oil that yields without thinning [Pa]


@dataclass(frozen=True)
class ThermalFilms:
    """Films of one contact with heat, on grids by the tolerance or of so many nodes."""

    search: Search
    supply: Supply | None
    nodes: int | None

    def flooded(self, near: State | None) -> Compared | None:
        """Film that takes what oil it wants; where it fails with an oil that yields, then with one that thins too."""
        compared = self._solved(None, near, None)
        oil = self.search.contact.lubricant
        yields = oil.eyring_stress is None and oil.limiting_shear_ratio is not None
        return self._yielding() if compared is None and yields else compared

    def starved(self, near: State | None, full: State | None, _flow: float | None) -> Compared | None:
        """Film that the supply holds; the flow by Moes' formula lays its grids."""
        return self._solved(self.supply, near, full)

    def expected(self, full: State) -> float:
        """Flow of the flooded film [m], by that of a similar contact."""
        near = full.fine
        cold = near.contact if near.oil is None else at_bulk(near.contact, near.oil.bulk)
        return near.flow * moes_flow(self.search.isothermal) / moes_flow(cold)

    def _solved(self, supply: Supply | None, near: State | None, full: State | None) -> Compared | None:
        """Solve from a similar film, from nothing where that fails."""
        self.search.supply, self.search.flooded = supply, full
        compared = self.search.from_neighbour(near, self.nodes)
        return self.search.from_nothing(self.nodes) if compared is None else compared

    def _yielding(self) -> Compared | None:
        """Start an oil that yields at a limiting stress alone from oils that thin as well, at ever larger stresses."""
        search, contact = self.search, self.search.contact
        near: Compared | None = None
        for stress in (*_CLIMB, None):
            oil = replace(contact.lubricant, eyring_stress=stress)
            thins = Search(replace(contact, lubricant=oil), search.solids, search.bulk, search.tolerance)
            near = (
                thins.from_nothing(self.nodes)
                if near is None
                else thins.from_neighbour(near.state, self.nodes)
            )
            search.iterations += thins.iterations
            if near is None:
                return None
        return near
