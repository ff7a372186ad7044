"""Friction, losses and temperatures of the cells of lines of contact."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

import gears
from base import Array, described, record
from fem.cycle.line_cells import CellsOfLines
from flankfilm.coupling.films.most_loaded import part_of_path, parts_of_path
from flankfilm.coupling.losses.cell_losses import AS_FILMS, CellLosses, losses_of_cells
from flankfilm.coupling.losses.heated_table import HeatedTable
from flankfilm.coupling.losses.losses_along_path import LossesAlongPath
from flankfilm.coupling.mesh.cells import cells_of

if TYPE_CHECKING:
    from flankfilm.coupling.mesh.mesh_curves import MeshCycle

__all__ = ["LineLosses", "line_losses", "of_all_lines"]


@record
class LineLosses(CellLosses, CellsOfLines):
    """Friction, losses and temperatures of all cells of lines of contact, each a line contact under its line load.

    Flanks slide across the line, along their profiles; along it both move alike. Heat does not flow along the line
    here, and oil neither; cells that bear less than the lightest film have its figures, and those that bear more than
    the heaviest, at ends of lines, have that one's.
    """

    @described("W", "position", no_error=AS_FILMS)
    def power_lost(self) -> Array:
        """Power lost by sliding and rolling on all lines together, between the ends of the path."""
        loss = self.sliding_loss + self.rolling_loss
        return np.asarray((loss * self.length[..., None]).sum(axis=(1, 2)))


def line_losses(
    pair: gears.GearPair, cycle: MeshCycle, speed: float, table: HeatedTable, table_error: float
) -> LineLosses:
    """Read friction, losses and temperatures of a cycle's lines of contact; arguments as of `losses_of_cells`."""
    lines = cycle.lines
    assert lines is not None
    return LineLosses(**lines.cells, **losses_of_cells(pair, cells_of(cycle), speed, table, table_error))


def of_all_lines(path: LossesAlongPath, lines: LineLosses, cycle: MeshCycle) -> LossesAlongPath:
    """Losses along the path of the most loaded cells, with the powers of all cells of a pair of teeth at each place.

    Cells of a pair of teeth come by a place one after the other; their powers are added as if they came together, as
    they do without a helix. So the sum over places, over their number in a base pitch, is the mean power.

    Parameters
    ----------
    path : LossesAlongPath
    lines : LineLosses
    cycle : MeshCycle
        Of both.
    """
    pair, cells, positions = lines.pair, cells_of(cycle), lines.position.size
    count = parts_of_path(pair, positions)
    edges = np.linspace(pair.points.A, pair.points.E, count + 1)
    shown = part_of_path(pair, path.rho1, count)
    # a cell covers a stretch of the path, and its power is even over that
    half = 0.5 * pair.helix.base_sine * cells.length[cells.bear]
    place = cells.rho1[cells.bear]
    passed = np.clip((edges[:, None] - (place - half)) / np.maximum(2.0 * half, 1e-12 * edges[-1]), 0.0, 1.0)

    def along(loss: Array) -> Array:
        summed = np.diff(passed @ (loss * cells.length)[cells.bear]) / positions
        return np.asarray((summed * count / pair.contact_ratio)[shown])

    return replace(path, sliding_loss=along(lines.sliding_loss), rolling_loss=along(lines.rolling_loss))
