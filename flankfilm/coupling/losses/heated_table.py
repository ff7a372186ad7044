"""Films with heat over the face: solved at places of the path under some line loads, and carried to all cells."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

import ehl
import gears
from base import Array
from flankfilm.coupling.films.film_field import FilmField
from flankfilm.coupling.films.line_contacts import line_contacts, with_sliding
from flankfilm.coupling.losses.heated_films import HeatedFilms, HeatedOil, heated_films
from flankfilm.coupling.losses.mean_losses import Borne, Carried
from flankfilm.coupling.mesh.cells import cells_of

if TYPE_CHECKING:
    from flankfilm.coupling.mesh.mesh_curves import MeshCycle

__all__ = ["HeatedTable", "heated_table"]

GRID = (17, 7)
"""Places of the path, and line loads at each, of films with heat."""

CLOSER = 1.5
"""Power by which places part with their distance from C."""

FEW = (9, 5)
"""The same of those that first values are found from."""

LIGHTEST = 0.03
"""Smallest of the loads over the largest; cells that bear less have the friction of this one."""

HEAVIEST = 1.02
"""Largest of the loads over that of the cells: friction tilts the forces and moves them a little."""

FIGURES = ("friction", "rolling", "first_part", "minimum_thickness", "oil_rise", "first_rise", "second_rise")


@dataclass(frozen=True, eq=False)
class HeatedTable(FilmField):
    """Films with heat over place and falling line loads: between loads cubic in their logarithm, between places linear.

    Attributes
    ----------
    rows : tuple of HeatedFilms
        At each place, films under all loads.
    bulk : (float, float)
        Temperatures of pinion and wheel [K].
    ratios : Carried, optional
        By which friction and rolling are other than those of the films, along the path.
    """

    figures = FIGURES
    degree_along = 1

    rows: tuple[HeatedFilms, ...]
    bulk: tuple[float, float]
    ratios: Carried | None = None

    @property
    def films(self) -> tuple[ehl.ThermalFilm, ...]:
        """All films."""
        return tuple(film for row in self.rows for film in row.films)

    def rubbing(self, friction: float) -> HeatedTable:
        """Give the same films with another friction of the asperities, which no film feels."""
        return replace(self, rows=tuple(row.rubbing(friction) for row in self.rows))

    def every_second(self, along: int) -> HeatedTable:
        """Table by every second place (0), or load (1)."""
        if along == 0:
            return replace(self, rho1=self.rho1[::2], rows=self.rows[::2])
        kept = (len(self.load) + 1) // 2
        return replace(self, load=self.load[::2], rows=tuple(row.thinned_to(kept) for row in self.rows))

    def at(self, figure: str, rho1: Array, load: Array, slope: int = 0) -> Array:
        """Figure of the films at places [m] under line loads [N/m], or its slope by these; beyond of the nearest."""
        return self.within(figure, rho1, load, slope) / load**slope

    def borne(self, cycle: MeshCycle, face_width: float) -> Borne:
        """What the cells of a cycle bear, with friction and rolling."""
        cells = cells_of(cycle)
        width = (cells.length * cells.part)[cells.bear]
        rho1, load = cells.rho1[cells.bear], cells.line_load[cells.bear]
        friction, rolling, first = (
            self.at(name, rho1, load) for name in ("friction", "rolling", "first_part")
        )
        if self.ratios is not None:
            by = self.ratios.at(rho1)
            friction, rolling = friction * by.friction, rolling * by.rolling
        return Borne(rho1, width * load, width, friction, rolling, first)

    def grid(self, figure: str) -> Array:
        """Figure of all films (places, loads)."""
        if figure in ("friction", "rolling", "first_part", "minimum_thickness"):
            return np.array([getattr(row, figure) for row in self.rows])
        return np.array([[_rise(film, figure, self.bulk) for film in row.films] for row in self.rows])


def _places(pair: gears.GearPair, places: int) -> Array:
    """Places of the path, an odd number, closer near C: there friction turns round within a little sliding."""
    half = np.linspace(0.0, 1.0, places // 2 + 1) ** CLOSER
    points = pair.points
    before, after = points.C - (points.C - points.A) * half[::-1], points.C + (points.E - points.C) * half
    return np.concatenate([before, after[1:]])


def _rise(film: ehl.ThermalFilm, figure: str, bulk: tuple[float, float]) -> float:
    """Maximum rise of the oil, or of either surface above its bulk [K]."""
    if figure == "oil_rise":
        return film.oil_temperature_rise
    assert film.temperature is not None
    side = 0 if figure == "first_rise" else 1
    return float(film.temperature[:, -side].max() - bulk[side])


def heated_table(
    pair: gears.GearPair,
    cycle: MeshCycle,
    speed: float,
    lubricant: ehl.Lubricant,
    oil: HeatedOil,
    bulk: tuple[float, float],
    grid: tuple[int, int],
    before: HeatedTable | None = None,
) -> HeatedTable:
    """Solve films with heat at places of the path under the line loads of a cycle's cells.

    Parameters
    ----------
    pair : gears.GearPair
    cycle : MeshCycle
        With cells of the face.
    speed : float
        Of the pinion [rad/s].
    lubricant : ehl.Lubricant
    oil : HeatedOil
    bulk : (float, float)
        Temperatures of pinion and wheel [K].
    grid : (int, int)
        Places, one more than a multiple of four, and loads, odd.
    before : HeatedTable, optional
        Films to start from, where it has as many.

    Raises
    ------
    SolverError
        Where a film has no solution.
    """
    places, loads = grid
    greatest = HEAVIEST * cells_of(cycle).greatest
    load = np.geomspace(greatest, LIGHTEST * greatest, loads)
    rho1 = _places(pair, places)
    rows: list[HeatedFilms] = []
    for k, place in enumerate(rho1):
        at = np.full(loads, place)
        contacts = with_sliding(pair, at, line_contacts(pair, at, load, speed, lubricant), speed)
        same = before is not None and len(before.rows) == places and len(before.load) == loads
        near = before.rows[k] if same and before is not None else rows[-1] if rows else None
        rows.append(heated_films(at, contacts, oil, bulk, near))
    return HeatedTable(rho1, load, tuple(rows), bulk)
