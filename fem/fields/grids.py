"""Grids of VTK: those of fields in the plane and over the face, precision of what they hold, and their files."""

from __future__ import annotations

import errno
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from base import Integers, replacing
from fem.fields.contact_forces import ContactForces
from fem.fields.face_fields import FaceField, ToothField
from fem.fields.flank_patches import FlankField
from fem.fields.helix_fields import HelixFields
from fem.fields.helix_flanks import LineField
from fem.fields.stress_fields import GearField, of_axis

if TYPE_CHECKING:
    import pyvista

__all__ = ["face_grids", "helix_grids", "plane_grids", "rounded", "write_grid"]

DROPPED = 12
"""Bits of the mantissa that fields but the displacement lose: 12 significant ones stay (2.5e-4 of the value), which is
finer than the fields are exact, and an archive of them is smaller."""

OF_POINTS = "displacement_m", "stress_Pa", "von_mises_Pa", "principal_Pa", "energy_density_J_per_m3"
"""Fields of a gear; the principal direction follows from the stress, and would add an eighth to the file."""

OF_CELLS = "tooth", "region", "indicative"

COMPONENTS = {"stress_Pa": ("xx", "yy", "zz", "xy"), "principal_Pa": ("larger", "smaller")}


def plane_grids(
    pinion: GearField, wheel: GearField, contacts: ContactForces
) -> dict[str, pyvista.UnstructuredGrid]:
    """Grids of both gears and of the contacts by the names of their blocks."""
    return {
        "pinion": _gear_grid(pinion, 0),
        "wheel": _gear_grid(wheel, 1),
        "contacts": _contact_grid(contacts),
    }


def _grid(kind: str, cells: Integers, points: NDArray[Any]) -> pyvista.UnstructuredGrid:
    """Cells of one kind, whose points have numbers of half the usual length."""
    import pyvista

    grid = pyvista.UnstructuredGrid({pyvista.CellType[kind]: cells}, points)
    grid.GetCells().ConvertTo32BitStorage()
    return grid


def _gear_grid(field: GearField, gear: int) -> pyvista.UnstructuredGrid:
    grid = _grid("QUADRATIC_TRIANGLE", field.cells, single_precision(field.points))
    for name in OF_POINTS:
        stored = single_precision(getattr(field, name), flat=name in COMPONENTS)
        grid.point_data[name] = stored if name == "displacement_m" else rounded(stored)
        for i, label in enumerate(COMPONENTS.get(name, ())):
            grid.GetPointData().GetArray(name).SetComponentName(i, label)
    for name in OF_CELLS:
        grid.cell_data[name] = getattr(field, name).astype(np.int16)
    grid.cell_data["gear"] = np.full(len(field.cells), gear, dtype=np.int8)
    return active(grid, "von_mises_Pa", "displacement_m")


def _contact_grid(contacts: ContactForces) -> pyvista.UnstructuredGrid:
    vertices = np.arange(len(contacts.points))[:, None]
    grid = _grid("VERTEX", vertices, single_precision(contacts.points))
    for name, values in contacts.point_data.items():
        whole = np.issubdtype(values.dtype, np.integer)
        grid.point_data[name] = values.astype(np.int32) if whole else single_precision(values)
    return active(grid, "pressure_Pa", "force_N")


def face_grids(pinion: FaceField, wheel: FaceField) -> dict[str, pyvista.UnstructuredGrid]:
    """Grids of both gears by the names of their blocks."""
    gears = {"pinion": pinion, "wheel": wheel}
    teeth = {name: _teeth(field.teeth, gear) for gear, (name, field) in enumerate(gears.items())}
    return teeth | {
        f"{name}_flanks": _flanks(field.flanks, i) for i, (name, field) in enumerate(gears.items())
    }


def helix_grids(fields: HelixFields) -> dict[str, pyvista.UnstructuredGrid]:
    """Grids of both gears and of the lines of contact by the names of their blocks."""
    return face_grids(fields.pinion, fields.wheel) | {"lines": _lines(fields.lines)}


def _lines(field: LineField) -> pyvista.UnstructuredGrid:
    grid = _grid("LINE", field.cells, field.points)
    for name, values in of_axis(field, "cell").items():
        whole = np.issubdtype(values.dtype, np.integer)
        # forces keep all their digits, so that they add up to the torque's
        stored = values if name == "force_N" else single_precision(values)
        grid.cell_data[name] = values.astype(np.int16) if whole else stored
    grid.GetCellData().SetActiveScalars("line_load_N_per_m")
    grid.GetCellData().SetActiveVectors("force_N")
    return grid


def _teeth(field: ToothField, gear: int) -> pyvista.UnstructuredGrid:
    grid = _grid("WEDGE", field.cells, single_precision(field.points))
    grid.point_data["displacement_m"] = rounded(single_precision(field.displacement_m))
    grid.cell_data["tooth"] = field.tooth.astype(np.int16)
    grid.cell_data["gear"] = np.full(len(field.cells), gear, dtype=np.int8)
    grid.GetPointData().SetActiveVectors("displacement_m")
    return grid


def _flanks(field: FlankField, gear: int) -> pyvista.UnstructuredGrid:
    grid = _grid("QUAD", field.cells, field.points)
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


def active(grid: pyvista.UnstructuredGrid, scalars: str, vectors: str) -> pyvista.UnstructuredGrid:
    """Name the fields that a viewer shows first."""
    grid.GetCellData().SetActiveScalars(None)
    grid.GetPointData().SetActiveScalars(scalars)
    grid.GetPointData().SetActiveVectors(vectors)
    return grid


def single_precision(values: NDArray[Any], flat: bool = False) -> NDArray[np.float32]:
    """Single precision; vectors of the plane get a third component unless ``flat``."""
    if values.ndim == 2 and values.shape[1] == 2 and not flat:
        values = np.column_stack([values, np.zeros(len(values))])
    return np.ascontiguousarray(values, dtype=np.float32)


def rounded(values: NDArray[np.float32]) -> NDArray[np.float32]:
    """Mantissas rounded, in the array itself."""
    bits = values.view(np.uint32)
    near = (bits + (1 << (DROPPED - 1))) & ~np.uint32((1 << DROPPED) - 1)
    np.copyto(bits, near, where=np.isfinite(values))
    return values


def write_grid(path: Path, grid: pyvista.UnstructuredGrid) -> None:
    """Write a ``.vtu`` with its arrays as bytes behind the text; ``grid.save`` spells them in a third more.

    They are not packed: zlib's fastest would make files of half the size in ten times the time, half that of a series;
    LZ4 would make them a fifth smaller, and meshio does not read it.
    """
    from vtkmodules.vtkCommonMisc import vtkErrorCode
    from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridWriter

    writer = vtkXMLUnstructuredGridWriter()
    writer.SetInputData(grid)
    writer.SetDataModeToAppended()
    writer.EncodeAppendedDataOff()
    writer.SetHeaderTypeToUInt32()
    writer.SetCompressorTypeToNone()
    with replacing(path) as beside:
        writer.SetFileName(str(beside))
        shown = writer.GetGlobalWarningDisplay()
        writer.GlobalWarningDisplayOff()  # what goes wrong is raised
        try:
            done = writer.Write()
        finally:
            writer.SetGlobalWarningDisplay(shown)
        if not done:
            fault = vtkErrorCode.GetStringFromErrorCode(writer.GetErrorCode())
            raise OSError(errno.ENOSPC, fault, str(path))
