"""Friction, losses and temperatures of the cells of the face."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

import gears
from base import Array, described, quantity, record
from base.results import EXACT, ITSELF
from fem.cycle.face_cells import FaceCells
from flankfilm.coupling.films.films import touching
from flankfilm.coupling.losses.heated_table import HeatedTable
from flankfilm.coupling.losses.losses_along_path import LossesAlongPath
from flankfilm.coupling.mesh.cells import cells_of

if TYPE_CHECKING:
    from flankfilm.coupling.mesh.mesh_curves import MeshCycle

__all__ = ["FaceLosses", "face_losses", "of_all_cells"]

_AS_FILMS = "that of the films: see the path, and table_error for what is interpolated"


@record
class FaceLosses(FaceCells):
    """Friction, losses and temperatures of all cells of the face, each a line contact under its line load.

    Heat does not flow along the face here, and oil neither; cells that bear less than the lightest film have its
    figures.
    """

    no_error = "not estimated cell by cell; the mean losses have an error"
    headline = ("greatest_cell_temperature", "table_error")

    friction_coefficient: Array = quantity(
        "1", "coefficient of friction of each cell", "position pair cell", no_error=_AS_FILMS
    )
    minimum_thickness: Array = quantity(
        "m", "minimum film with heat of each cell", "position pair cell", shown="um", no_error=_AS_FILMS
    )
    oil_temperature_rise: Array = quantity(
        "K",
        "highest oil temperature of each cell above the mean of the flanks' bulk",
        "position pair cell",
        no_error=_AS_FILMS,
    )
    contact_temperature: Array = quantity(
        "K", "maximum temperature of the flanks of each cell", "position pair cell", no_error=_AS_FILMS
    )
    sliding_loss: Array = quantity(
        "W/m", "power lost by sliding per length of face", "position pair cell", no_error=_AS_FILMS
    )
    rolling_loss: Array = quantity(
        "W/m", "power lost by rolling per length of face", "position pair cell", no_error=_AS_FILMS
    )
    films: int = quantity("1", "films solved, over places of the path and line loads", no_error=EXACT)
    table_error: float = quantity(
        "1",
        "relative error of the mean losses from the interpolation between places and loads",
        no_error=ITSELF,
    )

    @described("W/m", "cell", no_error=_AS_FILMS)
    def mean_loss(self) -> Array:
        """Mean power lost by sliding and rolling per length of face."""
        loss = self.sliding_loss + self.rolling_loss
        return np.asarray(loss.sum(axis=(0, 1)) / loss.shape[0])

    @described("K")
    def greatest_cell_temperature(self) -> float:
        """Maximum temperature of the flanks of all cells."""
        return float(np.nanmax(self.contact_temperature))


def face_losses(
    pair: gears.GearPair, cycle: MeshCycle, speed: float, table: HeatedTable, table_error: float
) -> FaceLosses:
    """Read friction, losses and temperatures of a cycle's cells off films with heat.

    Parameters
    ----------
    pair : gears.GearPair
    cycle : MeshCycle
        With cells of the face.
    speed : float
        Of the pinion [rad/s].
    table : HeatedTable
    table_error : float
        Of the mean losses.
    """
    face, rho1, bear = cells_of(cycle)
    load = face.line_load

    def each(figure: str) -> Array:
        return np.where(bear, table.at(figure, rho1, load), np.nan)

    friction = each("friction")
    slip = np.abs(pair.path_at(np.where(bear, rho1, pair.points.C).ravel()).sliding(speed)).reshape(
        load.shape
    )
    first, second = (
        each(f"{side}_rise") + at for side, at in zip(("first", "second"), table.bulk, strict=True)
    )
    return FaceLosses(
        **face.cells,
        friction_coefficient=friction,
        minimum_thickness=each("minimum_thickness"),
        oil_temperature_rise=each("oil_rise"),
        contact_temperature=np.maximum(first, second),
        sliding_loss=np.nan_to_num(friction) * load * slip,
        rolling_loss=np.nan_to_num(each("rolling")),
        films=len(table.films),
        table_error=table_error,
    )


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
