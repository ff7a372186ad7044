"""Films of all cells of a mesh cycle, on the face or on lines of contact: thickness and pressure of each."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import Any, ClassVar

import numpy as np

from base import Array, Booleans, Cost, described, part, quantity, record
from base.results import EXACT, ITSELF
from flankfilm.coupling.films.along_path import FORMULA
from flankfilm.coupling.films.film_table import FilmTable
from flankfilm.coupling.mesh.cells import Cells

__all__ = ["BEARS", "CellFilms", "films_of_cells"]

BEARS = 0.01
"""Part of the maximum line load below which a cell's pressure along the contact says nothing of its film."""


@record
class CellFilms(ABC):
    """Films of all cells at the positions of a mesh cycle, each that of a line contact under its line load."""

    headline: ClassVar[tuple[str, ...]] = ("least_film", "greatest_film_pressure")

    minimum_thickness: Array = quantity(
        "m",
        "minimum film of each cell; nan where it bears less than the lightest film that was solved",
        "position pair cell",
        shown="um",
        error="error",
    )
    central_thickness: Array = quantity(
        "m",
        "central film of each cell; nan likewise",
        "position pair cell",
        shown="um",
        error="central_error",
    )
    hertz_pressure: Array = quantity(
        "Pa",
        "Hertz pressure of each cell with films, the largest of its dry contact",
        "position pair cell",
        shown="MPa",
        no_error="not estimated: Hertz's law of the line load",
    )
    half_width: Array = quantity(
        "m",
        "half-width of the Hertz contact of each cell",
        "position pair cell",
        shown="um",
        no_error="not estimated: Hertz's law of the line load",
    )
    lightest_load: float = quantity(
        "N/m", "line load of the lightest film solved", shown="N/mm", no_error=EXACT
    )
    films: int = quantity("1", "films solved, over places of the path and line loads", no_error=EXACT)
    film_error: float | None = quantity(
        "1", "largest relative error of these; None by formula", no_error=ITSELF
    )
    table_error: float = quantity(
        "1", "relative error from the interpolation between places and loads", no_error=ITSELF
    )
    table: FilmTable = part("the films over place and load")
    cost: Cost
    converged: bool = True
    message: str = ""

    @property
    def error(self) -> float | None:
        """Relative error of a cell's film under its line load; None by formula."""
        return self.table.error

    @property
    def central_error(self) -> float | None:
        """Relative error of a cell's central film; None by formula."""
        return None if self.film_error is None else float(np.hypot(self.film_error, self.table.central_error))

    @property
    def no_error(self) -> str:
        """Why figures that say nothing of their error have none."""
        return FORMULA if self.error is None else "not estimated; the films themselves have an error"

    @described("m", shown="um", error="error")
    def least_film(self) -> float:
        """Minimum film of all cells and positions."""
        return float(self.minimum_thickness[self.least_at])

    @described("Pa", shown="GPa", no_error="not estimated: Hertz's law of the line load")
    def greatest_film_pressure(self) -> float:
        """Largest Hertz pressure of all cells with films."""
        return float(np.nanmax(np.where(self.counts, self.hertz_pressure, np.nan)))

    @property
    @abstractmethod
    def counts(self) -> Booleans:
        """Cells that count for maxima and minima (positions, pairs, cells)."""

    @property
    def least_at(self) -> tuple[int, ...]:
        """Position, pair and cell of the minimum film."""
        at = int(np.nanargmin(np.where(self.counts, self.minimum_thickness, np.nan)))
        return tuple(int(k) for k in np.unravel_index(at, self.minimum_thickness.shape))


def films_of_cells(cells: Cells, table: FilmTable, seconds: float) -> dict[str, Any]:
    """Read the films of cells off a table, as keyword arguments of a record of them.

    Parameters
    ----------
    cells : Cells
        With films of the table in series.
    table : FilmTable
    seconds : float
        Cost of the films [s].
    """
    rho1, load, bear = cells.rho1, cells.line_load, cells.bear
    pressure = np.where(np.isfinite(rho1), cells.loads.hertz_pressure, np.nan)
    width = np.full_like(pressure, np.nan)
    width[bear] = 2.0 * load[bear] / (np.pi * pressure[bear])
    return {
        "minimum_thickness": table.thickness("minimum_thickness", rho1, load),
        "central_thickness": table.thickness("central_thickness", rho1, load),
        "hertz_pressure": pressure,
        "half_width": width,
        "lightest_load": float(table.load[0]),
        "films": table.separation.size,
        "film_error": table.film_error,
        "table_error": table.grid_error,
        "table": table,
        "cost": Cost(seconds),
    }
