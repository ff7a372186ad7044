"""What films on lines of contact are: thickness and line load by cell, over the positions of a mesh cycle."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from base import Booleans, described, record
from base.results import ITSELF
from fem.contact.line_contact import WINDOW
from fem.cycle.line_cells import CellsOfLines
from flankfilm.coupling.films.cell_films import CellFilms, films_of_cells
from flankfilm.coupling.films.film_table import FilmTable
from flankfilm.coupling.mesh.cells import cells_of

if TYPE_CHECKING:
    from flankfilm.coupling.mesh.mesh_curves import MeshCycle

__all__ = ["LineFilms", "line_films"]


@record
class LineFilms(CellFilms, CellsOfLines):
    """Films on all cells of the lines of contact of a helical pair, each that of a line contact across its line.

    Left out is oil that flows along the line: at its ends, over one or two half-widths, where the film is thinner than
    here, and between cells, where `side_flow` says how steeply the pressure falls along the line beside how it does
    across. That both flanks move along it as well carries oil by about a tenth of that. Minimum and maximum leave out
    `end_zone`, where line loads of single cells go with their length.
    """

    @described("m", shown="mm", no_error="that of the cells: it lies in the middle of one")
    def least_film_place(self) -> float:
        """Place along the face of the minimum film, 0 at mid-face."""
        return float(self.z[self.least_at])

    @property
    def counts(self) -> Booleans:
        """Cells outside the end zones, which alone count for maxima and minima."""
        return self.inside

    @described("m", shown="mm", no_error="that by which the largest line load is a mean")
    def end_zone(self) -> float:
        """Length at either end of a line whose films the minimum leaves out: half a module."""
        return WINDOW * self.pair.module

    @described("1", no_error=ITSELF)
    def side_flow(self) -> float:
        """Largest slope of the pressure along a line over that across, ``b |dp_H/ds| / p_H``, outside the end zones."""
        pressure, width = self.hertz_pressure, self.half_width
        bears = self.counts & np.isfinite(width)
        beside = bears[..., 1:] & bears[..., :-1]
        step = np.where(self.length > 0.0, self.length, np.inf)[..., None]
        mean = 0.5 * (pressure[..., 1:] + pressure[..., :-1])
        flow = np.abs(np.diff(pressure, axis=-1)) / step * 0.5 * (width[..., 1:] + width[..., :-1]) / mean
        return float(np.max(flow, where=beside, initial=0.0))


def line_films(cycle: MeshCycle, table: FilmTable, seconds: float) -> LineFilms:
    """Read the films of a cycle's lines of contact off a table; arguments as of `films_of_cells`."""
    lines = cycle.lines
    assert lines is not None
    return LineFilms(**lines.cells, **films_of_cells(cells_of(cycle), table, seconds))
