"""What films over the face are: thickness and line load by cell, over the positions of a mesh cycle."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from base import Array, Cost, described, part, quantity, record
from base.results import EXACT, ITSELF
from fem.cycle.face_cells import FaceCells
from flankfilm.coupling.films.along_path import FORMULA
from flankfilm.coupling.films.film_table import FilmTable
from flankfilm.coupling.mesh.cells import cells_of

if TYPE_CHECKING:
    from flankfilm.coupling.mesh.mesh_curves import MeshCycle

__all__ = ["FaceFilms", "face_films"]

_BEARS = 0.01
"""Part of the maximum line load below which a cell's pressure along the face says nothing of its film."""


@record
class FaceFilms(FaceCells):
    """Films of all cells of the face at the positions of a mesh cycle, each that of a line contact under its line load.

    Left out is oil that flows along the face: at its ends, over about `end_zone`, where the film is thinner than here,
    and between cells, where `side_flow` says how steeply the pressure falls along the face beside how it does across.
    """

    headline = ("least_film", "greatest_film_pressure")

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
        return float(np.nanmin(self.minimum_thickness))

    @described("m", shown="mm", no_error="that of the cells: it lies in the middle of one")
    def least_film_place(self) -> float:
        """Place on the face of the minimum film, 0 at mid-face."""
        return float(self.face_position[self._least[2]])

    @described("Pa", shown="GPa", no_error="not estimated: Hertz's law of the line load")
    def greatest_film_pressure(self) -> float:
        """Largest Hertz pressure of all cells with films."""
        return float(np.nanmax(self.hertz_pressure))

    @described("m", shown="um", no_error="an estimate of where the line contact ends, itself")
    def end_zone(self) -> float:
        """Length at either end of the face over which oil leaks sideways: about the largest half-width there."""
        return float(np.nanmax(self.half_width[..., [0, -1]]))

    @described("1", no_error=ITSELF)
    def side_flow(self) -> float:
        """Largest slope of the pressure along the face over that across, ``b |dp_H/dz| / p_H``, of cells that bear."""
        step = float(self.face_position[1] - self.face_position[0])
        pressure = np.nan_to_num(self.hertz_pressure)
        bears = (self.line_load > _BEARS * self.line_load.max()) & (pressure > 0.0)
        slope = np.abs(np.gradient(pressure, step, axis=-1)) * np.nan_to_num(self.half_width)
        return float(np.max(np.divide(slope, pressure, out=np.zeros_like(slope), where=bears)))

    @property
    def _least(self) -> tuple[int, ...]:
        at = int(np.nanargmin(self.minimum_thickness))
        return tuple(int(k) for k in np.unravel_index(at, self.minimum_thickness.shape))


def face_films(cycle: MeshCycle, table: FilmTable, seconds: float) -> FaceFilms:
    """Read the films of a cycle's cells off a table.

    Parameters
    ----------
    cycle : MeshCycle
        With cells of the face, and films of the table in series.
    table : FilmTable
    seconds : float
        Cost of the films [s].
    """
    face, rho1, bear = cells_of(cycle)
    pressure = np.where(np.isfinite(rho1), face.hertz_pressure, np.nan)
    width = np.full_like(pressure, np.nan)
    width[bear] = 2.0 * face.line_load[bear] / (np.pi * pressure[bear])
    return FaceFilms(
        **face.cells,
        minimum_thickness=table.thickness("minimum_thickness", rho1, face.line_load),
        central_thickness=table.thickness("central_thickness", rho1, face.line_load),
        hertz_pressure=pressure,
        half_width=width,
        lightest_load=float(table.load[0]),
        films=table.separation.size,
        film_error=table.film_error,
        table_error=table.grid_error,
        table=table,
        cost=Cost(seconds),
    )
