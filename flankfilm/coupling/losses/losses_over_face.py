"""Friction, losses and temperatures of the cells of the face."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

import gears
from base import Array, described, record
from fem.cycle.face_cells import FaceCells
from flankfilm.coupling.films.films import touching
from flankfilm.coupling.losses.cell_losses import AS_FILMS, CellLosses, losses_of_cells
from flankfilm.coupling.losses.heated_table import HeatedTable
from flankfilm.coupling.losses.losses_along_path import LossesAlongPath
from flankfilm.coupling.mesh.cells import cells_of

if TYPE_CHECKING:
    from flankfilm.coupling.mesh.mesh_curves import MeshCycle

__all__ = ["FaceLosses", "face_losses", "of_all_cells"]


@record
class FaceLosses(CellLosses, FaceCells):
    """Friction, losses and temperatures of all cells of the face, each a line contact under its line load.

    Heat does not flow along the face here, and oil neither; cells that bear less than the lightest film have its
    figures.
    """

    @described("W/m", "cell", no_error=AS_FILMS)
    def mean_loss(self) -> Array:
        """Mean power lost by sliding and rolling per length of face."""
        loss = self.sliding_loss + self.rolling_loss
        return np.asarray(loss.sum(axis=(0, 1)) / loss.shape[0])


def face_losses(
    pair: gears.GearPair, cycle: MeshCycle, speed: float, table: HeatedTable, table_error: float
) -> FaceLosses:
    """Read friction, losses and temperatures of a cycle's cells of the face; arguments as of `losses_of_cells`."""
    face = cycle.face
    assert face is not None
    return FaceLosses(**face.cells, **losses_of_cells(pair, cells_of(cycle), speed, table, table_error))


def of_all_cells(path: LossesAlongPath, over_face: FaceLosses, cycle: MeshCycle) -> LossesAlongPath:
    """Losses along the path of the most loaded cells, with the powers of all cells together.

    Parameters
    ----------
    path : LossesAlongPath
    over_face : FaceLosses
    cycle : MeshCycle
        Of both.
    """
    position, number = touching(cycle)
    width = over_face.pair.face_width / over_face.face_position.size
    sliding, rolling = (
        width * loss.sum(axis=-1)[position, number]
        for loss in (over_face.sliding_loss, over_face.rolling_loss)
    )
    return replace(path, sliding_loss=sliding, rolling_loss=rolling)
