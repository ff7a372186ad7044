"""Teeth and flanks of a loaded face as blocks of pyvista."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fem.cycle.result import MeshCycle
from fem.fields.face_fields import FaceField, ToothField, face_fields
from fem.fields.flank_patches import FlankField
from fem.fields.grids import rounded, single_precision
from fem.fields.stress_fields import of_axis
from fem.pair.compliance import compliance as _compliance

if TYPE_CHECKING:
    import pyvista

    from fem.pair.pair_compliance import PairCompliance
    from gears import GearPair

__all__ = ["face_blocks", "face_grids"]


def face_blocks(
    pair: GearPair, cycle: MeshCycle, row: int, compliance: PairCompliance | None = None
) -> pyvista.MultiBlock:
    """Teeth and flanks of both gears at one position, as named blocks of pyvista.

    Parameters
    ----------
    pair, cycle, row
        As of `fem.fields.face_fields.face_fields`.
    compliance : PairCompliance, optional
        The one that the cycle was computed with.

    Returns
    -------
    pyvista.MultiBlock
        ``pinion`` and ``wheel``: wedges of the teeth in mesh with their displacement, in single precision;
        ``pinion_flanks`` and ``wheel_flanks``: quadrangles whose ``pressure_Pa`` times their area adds up to the
        forces, in double precision.
    """
    import pyvista

    bodies = compliance or _compliance(pair, plane=cycle.plane)
    return pyvista.MultiBlock(face_grids(*face_fields(pair, cycle, row, bodies)))


def face_grids(pinion: FaceField, wheel: FaceField) -> dict[str, pyvista.UnstructuredGrid]:
    """Grids of both gears by the names of their blocks."""
    gears = {"pinion": pinion, "wheel": wheel}
    teeth = {name: _teeth(field.teeth, gear) for gear, (name, field) in enumerate(gears.items())}
    return teeth | {
        f"{name}_flanks": _flanks(field.flanks, i) for i, (name, field) in enumerate(gears.items())
    }


def _teeth(field: ToothField, gear: int) -> pyvista.UnstructuredGrid:
    import pyvista

    grid = pyvista.UnstructuredGrid({pyvista.CellType.WEDGE: field.cells}, single_precision(field.points))
    grid.point_data["displacement_m"] = rounded(single_precision(field.displacement_m))
    grid.cell_data["tooth"] = field.tooth.astype(np.int16)
    grid.cell_data["gear"] = np.full(len(field.cells), gear, dtype=np.int8)
    grid.GetPointData().SetActiveVectors("displacement_m")
    return grid


def _flanks(field: FlankField, gear: int) -> pyvista.UnstructuredGrid:
    import pyvista

    grid = pyvista.UnstructuredGrid({pyvista.CellType.QUAD: field.cells}, field.points)
    grid.point_data["displacement_m"] = rounded(single_precision(field.displacement_m))
    for name, values in of_axis(field, "cell").items():
        whole = np.issubdtype(values.dtype, np.integer)
        # pressures keep all their digits, so that they add up to the force
        stored = values if name == "pressure_Pa" else single_precision(values)
        grid.cell_data[name] = values.astype(np.int16) if whole else stored
    grid.cell_data["gear"] = np.full(len(field.cells), gear, dtype=np.int8)
    grid.GetCellData().SetActiveScalars("pressure_Pa")
    grid.GetPointData().SetActiveVectors("displacement_m")
    return grid
