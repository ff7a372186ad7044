"""What films over the face are: thickness and line load by cell, over the positions of a mesh cycle."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from base import Booleans, described, record
from base.results import ITSELF
from fem.cycle.face_cells import FaceCells
from flankfilm.coupling.films.cell_films import BEARS, CellFilms, films_of_cells
from flankfilm.coupling.films.film_table import FilmTable
from flankfilm.coupling.mesh.cells import cells_of

if TYPE_CHECKING:
    from flankfilm.coupling.mesh.mesh_curves import MeshCycle

__all__ = ["FaceFilms", "face_films"]


@record
class FaceFilms(CellFilms, FaceCells):
    """Films of all cells of the face at the positions of a mesh cycle, each that of a line contact under its line load.

    Left out is oil that flows along the face: at its ends, over about `end_zone`, where the film is thinner than here,
    and between cells, where `side_flow` says how steeply the pressure falls along the face beside how it does across.
    """

    @property
    def counts(self) -> Booleans:
        """All cells."""
        return np.ones(self.line_load.shape, dtype=bool)

    @described("m", shown="mm", no_error="that of the cells: it lies in the middle of one")
    def least_film_place(self) -> float:
        """Place on the face of the minimum film, 0 at mid-face."""
        return float(self.face_position[self.least_at[2]])

    @described("m", shown="um", no_error="an estimate of where the line contact ends, itself")
    def end_zone(self) -> float:
        """Length at either end of the face over which oil leaks sideways: about the largest half-width there."""
        return float(np.nanmax(self.half_width[..., [0, -1]]))

    @described("1", no_error=ITSELF)
    def side_flow(self) -> float:
        """Largest slope of the pressure along the face over that across, ``b |dp_H/dz| / p_H``, of cells that bear."""
        step = float(self.face_position[1] - self.face_position[0])
        pressure = np.nan_to_num(self.hertz_pressure)
        bears = (self.line_load > BEARS * self.line_load.max()) & (pressure > 0.0)
        slope = np.abs(np.gradient(pressure, step, axis=-1)) * np.nan_to_num(self.half_width)
        return float(np.max(np.divide(slope, pressure, out=np.zeros_like(slope), where=bears)))


def face_films(cycle: MeshCycle, table: FilmTable, seconds: float) -> FaceFilms:
    """Read the films of a cycle's cells of the face off a table; arguments as of `films_of_cells`."""
    face = cycle.face
    assert face is not None
    return FaceFilms(**face.cells, **films_of_cells(cells_of(cycle), table, seconds))
