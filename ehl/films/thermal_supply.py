"""Films with heat by how their oil is supplied, each from a similar film where there is such a film."""

from __future__ import annotations

from dataclasses import replace

from ehl.discrete.supply import Meniscus, Supply
from ehl.films.solver import SURELY, moes_flow
from ehl.films.thermal_errors import Compared
from ehl.films.thermal_search import Search, at_bulk
from ehl.solving.levels import State

_CLIMB = (3e7, 5e7, 1e8, 2e8, 5e8)  # Eyring stresses on the way to an oil that yields without thinning [Pa]


def supplied(
    search: Search, supply: Supply | None, start: State | None, nodes: int | None
) -> Compared | None:
    """Solve with a supply: a layer may be thicker than what the contact takes, which the flooded film shows.

    A layer of less than seven tenths of the flow that the start's flooded film makes likely starves the contact for
    certain: the flooded film is then left out.
    """
    held = start if start is not None and start.plan.fixed else None
    full = start if held is None else held.flooded
    if supply is None:
        return _flooded(search, full, nodes)
    if isinstance(supply, Meniscus):
        return _held(search, supply, held, full, nodes)
    if held is not None and full is not None and supply.thickness < SURELY * _expected(search, full):
        starved = _held(search, supply, held, full, nodes)
        if starved is not None:
            return starved
    flooded = _flooded(search, full, nodes)
    if flooded is None or supply.thickness >= flooded.fine.flow * (1.0 - flooded.error):
        return flooded
    return _held(search, supply, held, flooded.state, nodes)


def _held(
    search: Search, supply: Supply, near: State | None, flooded: State | None, nodes: int | None
) -> Compared | None:
    """Solve a starved film from a similar one, from nothing where that fails."""
    search.supply, search.flooded = supply, flooded
    compared = search.from_neighbour(near, nodes)
    return search.from_nothing(nodes) if compared is None else compared


def _flooded(search: Search, near: State | None, nodes: int | None) -> Compared | None:
    """Solve a flooded film from a similar one, from nothing where that fails, then with an oil that thins as well."""
    search.supply = search.flooded = None
    compared = search.from_neighbour(near, nodes)
    if compared is None:
        compared = search.from_nothing(nodes)
    oil = search.contact.lubricant
    yields = oil.eyring_stress is None and oil.limiting_shear_ratio is not None
    return _yielding(search, nodes) if compared is None and yields else compared


def _expected(search: Search, full: State) -> float:
    """Flow of the flooded film [m]: that of a similar contact, changed as Moes' formula has it."""
    near = full.fine
    cold = near.contact if near.oil is None else at_bulk(near.contact, near.oil.bulk)
    return near.flow * moes_flow(search.isothermal) / moes_flow(cold)


def _yielding(search: Search, nodes: int | None) -> Compared | None:
    """Start an oil that yields at a limiting stress alone from oils that thin as well, at ever larger stresses."""
    contact = search.contact
    near: Compared | None = None
    for stress in (*_CLIMB, None):
        oil = replace(contact.lubricant, eyring_stress=stress)
        thins = Search(replace(contact, lubricant=oil), search.solids, search.bulk, search.tolerance)
        near = thins.from_nothing(nodes) if near is None else thins.from_neighbour(near.state, nodes)
        search.iterations += thins.iterations
        if near is None:
            return None
    return near
