"""Time series of the loaded pair for ParaView."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from fem.bodies import Compliance
from fem.contact import MeshCycle
from fem.contact_forces import ContactForces, contact_forces
from fem.fields import GearField, draw_gears, loaded_fields
from fem.vtk_file import VERTEX, Grid, write_grid, write_series

if TYPE_CHECKING:
    from gears import GearPair

__all__ = ["write_vtk_series"]

PICTURE_REFINEMENTS = 1
"""Refinements of the mesh that is drawn: fields need no more, and files stay small."""

COMPONENTS = {"stress_Pa": ("xx", "yy", "zz", "xy"), "principal_Pa": ("larger", "smaller")}


def write_vtk_series(
    folder: Path,
    pair: GearPair,
    cycle: MeshCycle,
    bodies: Compliance,
    positions: Sequence[int] | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> Path:
    """Write the fields of both gears and the contact forces as ``vtk/*.vtu`` and ``mesh_cycle.pvd``.

    The parts of the series are ``pinion``, ``wheel`` and ``contacts``: points with the vectors ``force_N`` for
    a glyph filter, each contact once for each gear.

    Parameters
    ----------
    folder : Path
        Gets the ``.pvd`` and a folder ``vtk``.
    pair : gears.GearPair
    cycle : MeshCycle
    bodies : Compliance
        The one that the cycle was computed with.
    positions : sequence of int, optional
        Rows of the cycle; all of them unless given.
    progress : callable, optional
        Called with the steps done and all steps.

    Returns
    -------
    Path
        The ``.pvd``; its time is the position in base pitches from A.
    """
    folder = Path(folder)
    rows = range(len(cycle.position)) if positions is None else positions
    drawings = draw_gears(pair, bodies, min(bodies.refinements, PICTURE_REFINEMENTS))
    steps: list[tuple[float, dict[str, Path]]] = []
    for done, row in enumerate(rows):
        pinion, wheel = loaded_fields(pair, cycle, row, bodies, drawings)
        grids = {
            "pinion": _gear_grid(pinion, 0),
            "wheel": _gear_grid(wheel, 1),
            "contacts": _contact_grid(contact_forces(pair, cycle, row)),
        }
        files = {
            name: write_grid(folder / "vtk" / f"{name}_{row:04d}.vtu", grid) for name, grid in grids.items()
        }
        steps.append((float(cycle.position[row]), files))
        if progress is not None:
            progress(done + 1, len(rows))
    return write_series(folder / "mesh_cycle.pvd", steps)


def _gear_grid(field: GearField, gear: int) -> Grid:
    # the principal direction follows from the stress, and would add an eighth to the file
    point_data = {name: values for name, values in field.point_data.items() if name != "principal_direction"}
    cell_data = {**field.cell_data, "gear": np.full(len(field.cells), gear)}
    return Grid(
        field.points,
        field.cells,
        point_data=point_data,
        cell_data=cell_data,
        components=COMPONENTS,
        rounded=point_data.keys() - {"displacement_m"},
        scalars="von_mises_Pa",
        vectors="displacement_m",
    )


def _contact_grid(contacts: ContactForces) -> Grid:
    vertices = np.arange(len(contacts.points))[:, None]
    return Grid(
        contacts.points, vertices, VERTEX, contacts.point_data, scalars="pressure_Pa", vectors="force_N"
    )
