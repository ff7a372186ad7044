"""Friction, losses and temperatures of all cells of a mesh cycle, on the face or on lines of contact."""

from __future__ import annotations

from typing import Any, ClassVar

import numpy as np

import gears
from base import Array, described, quantity, record
from base.results import EXACT, ITSELF
from flankfilm.coupling.losses.heated_table import HeatedTable
from flankfilm.coupling.mesh.cells import Cells

__all__ = ["AS_FILMS", "CellLosses", "losses_of_cells"]

AS_FILMS = "that of the films: see the path, and table_error for what is interpolated"


@record
class CellLosses:
    """Friction, losses and temperatures of all cells, each a line contact under its line load.

    Heat does not flow along the contact here, and oil neither; cells that bear less than the lightest film have its
    figures.
    """

    no_error = "not estimated cell by cell; the mean losses have an error"
    headline: ClassVar[tuple[str, ...]] = ("greatest_cell_temperature", "table_error")

    friction_coefficient: Array = quantity(
        "1", "coefficient of friction of each cell", "position pair cell", no_error=AS_FILMS
    )
    minimum_thickness: Array = quantity(
        "m", "minimum film with heat of each cell", "position pair cell", shown="um", no_error=AS_FILMS
    )
    oil_temperature_rise: Array = quantity(
        "K",
        "highest oil temperature of each cell above the mean of the flanks' bulk",
        "position pair cell",
        no_error=AS_FILMS,
    )
    contact_temperature: Array = quantity(
        "K", "maximum temperature of the flanks of each cell", "position pair cell", no_error=AS_FILMS
    )
    sliding_loss: Array = quantity(
        "W/m", "power lost by sliding per length of the contact", "position pair cell", no_error=AS_FILMS
    )
    rolling_loss: Array = quantity(
        "W/m", "power lost by rolling per length of the contact", "position pair cell", no_error=AS_FILMS
    )
    films: int = quantity("1", "films solved, over places of the path and line loads", no_error=EXACT)
    table_error: float = quantity(
        "1",
        "relative error of the mean losses from the interpolation between places and loads",
        no_error=ITSELF,
    )

    @described("K")
    def greatest_cell_temperature(self) -> float:
        """Maximum temperature of the flanks of all cells."""
        return float(np.nanmax(self.contact_temperature))


def losses_of_cells(
    pair: gears.GearPair, cells: Cells, speed: float, table: HeatedTable, table_error: float
) -> dict[str, Any]:
    """Read friction, losses and temperatures of cells off films with heat, as keyword arguments of a record of them.

    Parameters
    ----------
    pair : gears.GearPair
    cells : Cells
    speed : float
        Of the pinion [rad/s].
    table : HeatedTable
    table_error : float
        Of the mean losses.
    """
    rho1, load, bear = cells.rho1, cells.line_load, cells.bear

    def each(figure: str) -> Array:
        return np.where(bear, table.at(figure, rho1, load), np.nan)

    friction = each("friction")
    places = np.where(bear, rho1, pair.points.C)
    slip = np.abs(pair.path_at(places.ravel()).sliding(speed)).reshape(load.shape)
    first, second = (
        each(f"{side}_rise") + at for side, at in zip(("first", "second"), table.bulk, strict=True)
    )
    return {
        "friction_coefficient": friction,
        "minimum_thickness": each("minimum_thickness"),
        "oil_temperature_rise": each("oil_rise"),
        "contact_temperature": np.maximum(first, second),
        "sliding_loss": np.nan_to_num(friction) * load * slip * cells.part,
        "rolling_loss": np.nan_to_num(each("rolling")) * cells.part,
        "films": len(table.films),
        "table_error": table_error,
    }
