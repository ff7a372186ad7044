"""Films with heat and shear at loaded contacts along the path, each from its neighbour."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TypeVar

import numpy as np

import ehl
import gears
from base import Array, Integers, SolverError
from flankfilm.coupling.films.films import Held, Supply, contacts_of, supply_of
from flankfilm.coupling.films.line_contacts import with_sliding
from flankfilm.coupling.mesh.mesh_curves import MeshCycle

T = TypeVar("T")

LOOSER = 5.0
"""Times the tolerance that a single film may err by where it has no better solution; its own error says so."""

LOOSEST = 0.2
"""What a film may be asked for at most."""

SHORTEST = 1.0 / 16.0
"""Smallest part of the way from another film that one step goes."""


@dataclass(frozen=True)
class HeatedOil:
    """What films with heat are computed from, beside the contact.

    Attributes
    ----------
    solids : (ehl.Solid, ehl.Solid)
        Pinion and wheel.
    roughness : ehl.Roughness or None
        Of both flanks together.
    boundary_friction : float
        Coefficient of friction of what asperities carry.
    tolerance : float
        Of the films, relative.
    supply : ehl.Meniscus, ehl.OilLayer, PlacedMeniscus or None
        What is held at the inlets; None for flooded contacts.
    """

    solids: tuple[ehl.Solid, ehl.Solid]
    roughness: ehl.Roughness | None
    boundary_friction: float
    tolerance: float
    supply: Held = None

    @property
    def looser(self) -> float:
        """Tolerance where a film has no better solution."""
        return min(LOOSER * self.tolerance, max(LOOSEST, self.tolerance))

    def supply_of(self, contact: ehl.LineContact) -> Supply:
        """Supply of one contact."""
        return supply_of(self.supply, contact)


@dataclass(frozen=True)
class HeatedFilms:
    """Films with heat in the order of the path, with what asperities carry beside them.

    Attributes
    ----------
    rho1 : ndarray, shape (n,)
        Curvature radius of the pinion's flank [m].
    contacts : tuple of ehl.LineContact
        With the whole load.
    films : tuple of ehl.ThermalFilm
        Of the part of the load that asperities leave.
    mixed : tuple of ehl.MixedThermalFilm
        Of rough flanks; empty for smooth ones.
    oil : HeatedOil
    """

    rho1: Array
    contacts: tuple[ehl.LineContact, ...]
    films: tuple[ehl.ThermalFilm, ...]
    mixed: tuple[ehl.MixedThermalFilm, ...]
    oil: HeatedOil

    @property
    def solids(self) -> tuple[ehl.Solid, ehl.Solid]:
        """Pinion and wheel."""
        return self.oil.solids

    @property
    def rough(self) -> bool:
        """Whether asperities carry a share."""
        return bool(self.mixed)

    @property
    def asperity_share(self) -> Array:
        """Share of the load on asperities (n,)."""
        if not self.mixed:
            return np.zeros(len(self.films))
        return np.array([film.asperity_share for film in self.mixed])

    @property
    def asperity_share_error(self) -> Array:
        """Relative error of that share (n,)."""
        if not self.mixed:
            return np.zeros(len(self.films))
        return np.array([film.asperity_share_error for film in self.mixed])

    @property
    def friction(self) -> Array:
        """Coefficient of friction, of film and asperities by their shares (n,)."""
        film = np.abs([film.traction_coefficient for film in self.films])
        share = self.asperity_share
        return np.asarray((1.0 - share) * film + share * self.oil.boundary_friction)

    @property
    def friction_error(self) -> Array:
        """Relative error of the coefficient of friction: of the film's, and of the asperities' share (n,)."""
        film = np.abs([film.traction_coefficient for film in self.films])
        share, errors = self.asperity_share, np.array([film.traction_error for film in self.films])
        apart = np.abs(self.oil.boundary_friction - film) * share * self.asperity_share_error
        whole = self.friction
        known = whole > 0.0
        moved = np.divide(apart, whole, out=np.zeros_like(whole), where=known)
        part = np.divide((1.0 - share) * film, whole, out=np.ones_like(whole), where=known)
        return np.asarray(errors * part + moved)

    @property
    def rolling(self) -> Array:
        """Power lost by the oil's flow under its pressure (n,) [W/m]."""
        return np.array([film.losses.rolling for film in self.films if film.losses is not None])

    @property
    def first_part(self) -> Array:
        """Part of the heat into both bodies that the first takes (n,)."""
        taken = [
            (film.losses.first_body, film.losses.second_body)
            for film in self.films
            if film.losses is not None
        ]
        first, second = np.array(taken).T
        whole = first + second
        return np.where(whole > 0.0, first / np.where(whole > 0.0, whole, 1.0), 0.5)

    @property
    def minimum_thickness(self) -> Array:
        """Minimum film (n,) [m]."""
        return np.array([film.minimum_thickness for film in self.films])

    @property
    def film_ratio(self) -> Array | None:
        """Minimum film over the standard deviation of heights (n,); None of smooth flanks."""
        rough = self.oil.roughness
        return None if rough is None else np.asarray(self.minimum_thickness / rough.deviation)

    def rubbing(self, friction: float) -> HeatedFilms:
        """Give the same films with another friction of the asperities, which no film feels."""
        return replace(self, oil=replace(self.oil, boundary_friction=friction))

    def thinned_to(self, most: int) -> HeatedFilms:
        """Give so many of them at most, the first and the last as well."""
        kept = thinned(len(self.films), most)
        return replace(
            self,
            rho1=self.rho1[kept],
            contacts=_taken(self.contacts, kept),
            films=_taken(self.films, kept),
            mixed=_taken(self.mixed, kept) if self.mixed else (),
        )


def sliding_contacts(
    pair: gears.GearPair,
    cycle: MeshCycle,
    speed: float,
    lubricant: ehl.Lubricant,
    line_load: Array | None = None,
) -> tuple[Array, tuple[ehl.LineContact, ...]]:
    """Line contacts of a cycle with their sliding speeds, with their places on the path [m]; see `contacts_of`."""
    rho1, contacts = contacts_of(pair, cycle, speed, lubricant, line_load)
    return rho1, with_sliding(pair, rho1, contacts, speed)


def heated_films(
    rho1: Array,
    contacts: Sequence[ehl.LineContact],
    oil: HeatedOil,
    bulk: tuple[float, float],
    before: HeatedFilms | None = None,
) -> HeatedFilms:
    """Solve the films of contacts in the order of the path.

    Parameters
    ----------
    rho1 : ndarray, shape (n,)
        Their places [m].
    contacts : sequence of ehl.LineContact
        With their sliding speeds.
    oil : HeatedOil
    bulk : (float, float)
        Temperatures of pinion and wheel [K].
    before : HeatedFilms, optional
        Films at the same places to start from; each starts from its neighbour without.

    Raises
    ------
    SolverError
        Where a film has no solution.
    """
    films: list[ehl.ThermalFilm] = []
    mixed: list[ehl.MixedThermalFilm] = []
    for i, contact in enumerate(contacts):
        if oil.roughness is not None:
            near_rough = before.mixed[i] if before is not None else mixed[-1] if mixed else None
            mixed.append(_rough(contact, oil, oil.roughness, bulk, near_rough, float(rho1[i])))
            films.append(mixed[-1].film)
            continue
        near = before.films[i] if before is not None else films[-1] if films else None
        films.append(_film(contact, oil, bulk, near, float(rho1[i])))
    return HeatedFilms(rho1, tuple(contacts), tuple(films), tuple(mixed), oil)


def _rough(
    contact: ehl.LineContact,
    oil: HeatedOil,
    roughness: ehl.Roughness,
    bulk: tuple[float, float],
    near: ehl.MixedThermalFilm | None,
    rho1: float,
) -> ehl.MixedThermalFilm:
    """Share the load with asperities, from the neighbour; where that fails from nothing, and less sharply."""
    supply = oil.supply_of(contact)
    for start in (None,) if near is None else (near, None):
        for tolerance in (oil.tolerance, oil.looser):
            film = ehl.solve_mixed_thermal(
                contact, roughness, oil.solids, bulk, tolerance, supply, oil.boundary_friction, start
            )
            if film.converged:
                return film
    raise _none_at(rho1, film.message)


def _film(
    contact: ehl.LineContact,
    oil: HeatedOil,
    bulk: tuple[float, float],
    near: ehl.ThermalFilm | None,
    rho1: float,
) -> ehl.ThermalFilm:
    """Solve a film from its neighbour; where that fails less sharply, from nothing, or by way of what lies between."""

    def solved(contact: ehl.LineContact, tolerance: float, start: ehl.ThermalFilm | None) -> ehl.ThermalFilm:
        supply = oil.supply_of(contact)
        return ehl.solve_thermal(contact, oil.solids, bulk, tolerance, start=start, supply=supply)

    starts = (None,) if near is None else (near, None)
    for start in starts:
        for tolerance in (oil.tolerance, oil.looser):
            film = solved(contact, tolerance, start)
            if film.converged:
                return film
    if near is not None:
        film = _by_way(contact, oil, bulk, near)
    if not film.converged:
        raise _none_at(rho1, film.message)
    return film


def _by_way(
    contact: ehl.LineContact, oil: HeatedOil, bulk: tuple[float, float], near: ehl.ThermalFilm
) -> ehl.ThermalFilm:
    """Solve a film by steps from another, in contact and bulk temperatures; each as far as goes, down to a part."""
    assert near.oils is not None
    here, at = near, near.oils[0].bulk
    behind, step = 0.0, 0.5
    while True:
        part = min(step / (1.0 - behind), 1.0)
        ahead = contact if part == 1.0 else _between(here.contact, contact, part)
        mixed = at + part * (np.array(bulk) - at)
        warm = (float(mixed[0]), float(mixed[1]))
        film = ehl.solve_thermal(ahead, oil.solids, warm, oil.looser, start=here, supply=oil.supply_of(ahead))
        if film.converged and part == 1.0:
            return film
        if film.converged:
            here, at, behind = film, mixed, behind + step
        elif step > SHORTEST:
            step *= 0.5
        else:
            return film


def _between(first: ehl.LineContact, other: ehl.LineContact, part: float) -> ehl.LineContact:
    """Contact so far from the first to the second, with the oil of the second."""

    def mixed(figure: str) -> float:
        return float((1.0 - part) * getattr(first, figure) + part * getattr(other, figure))

    return replace(
        other,
        load=float(first.load ** (1.0 - part) * other.load**part),
        entrainment=mixed("entrainment"),
        radius=mixed("radius"),
        sliding=mixed("sliding"),
    )


def _none_at(rho1: float, why: str) -> SolverError:
    return SolverError(f"no film with heat at rho1 = {1e3 * rho1:.3f} mm: {why}")


def thinned(count: int, most: int) -> Integers:
    """Numbers of so many of some at most, evenly, the first and the last as well."""
    return np.unique(np.linspace(0, count - 1, min(count, most)).round().astype(int))


def _taken(values: tuple[T, ...], kept: Integers) -> tuple[T, ...]:
    return tuple(values[k] for k in kept.tolist())
