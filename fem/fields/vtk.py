"""Fields of the loaded pair for ParaView: blocks of pyvista, and their time series over the mesh cycle."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any
from xml.sax.saxutils import quoteattr

import numpy as np

from base import replacing
from fem.cycle.result import MeshCycle
from fem.fields.contact_forces import ContactForces, contact_forces
from fem.fields.drawing import GearDrawing
from fem.fields.face_fields import face_fields
from fem.fields.face_vtk import face_blocks, face_grids
from fem.fields.face_waves import gear_prisms
from fem.fields.grids import active, rounded, single_precision, write_grid
from fem.fields.paraview_state import fillet_stress, write_paraview_state
from fem.fields.stress_fields import GearField, draw_gears, loaded_fields
from fem.pair.pair_compliance import PairCompliance

if TYPE_CHECKING:
    import pyvista

    from gears import GearPair

__all__ = ["field_blocks", "write_vtk_series"]

PICTURE_REFINEMENTS = 1
"""Refinements of the mesh that is drawn: fields need no more, and files stay small."""

COMPONENTS = {"stress_Pa": ("xx", "yy", "zz", "xy"), "principal_Pa": ("larger", "smaller")}


def field_blocks(
    pair: GearPair,
    cycle: MeshCycle,
    row: int,
    compliance: PairCompliance | None = None,
    drawings: tuple[GearDrawing, GearDrawing] | None = None,
) -> pyvista.MultiBlock:
    """Fields of both gears and the contact forces at one position, as named blocks of pyvista.

    Parameters
    ----------
    pair, cycle, row, compliance, drawings
        As of `fem.fields.stress_fields.loaded_fields`.

    Returns
    -------
    pyvista.MultiBlock
        ``pinion``, ``wheel``, and ``contacts``: points with the vectors ``force_N`` for a glyph filter, each contact
        once for each gear. Fields are in single precision. Of a cycle with cells of the face those of
        `fem.fields.face_vtk.face_blocks`.

    Examples
    --------
    >>> from fem import compliance, field_blocks, mesh_cycle
    >>> from gears import Gear, GearPair
    >>> pair = GearPair(Gear(teeth=18), Gear(teeth=20), module=2e-3, face_width=40e-3)
    >>> bodies = compliance(pair, tolerance=0.05)
    >>> blocks = field_blocks(pair, mesh_cycle(pair, 100.0, 4, bodies), 2, bodies)
    >>> blocks.keys(), float(blocks["pinion"]["von_mises_Pa"].max()) > 1e8
    (['pinion', 'wheel', 'contacts'], True)
    """
    import pyvista

    if cycle.face is not None:
        return face_blocks(pair, cycle, row, compliance)
    gear_fields = loaded_fields(pair, cycle, row, compliance, drawings)
    return pyvista.MultiBlock(_blocks(*gear_fields, contact_forces(pair, cycle, row)))


def write_vtk_series(
    folder: Path,
    pair: GearPair,
    cycle: MeshCycle,
    bodies: PairCompliance,
    positions: Sequence[int] | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> Path:
    """Write the blocks of `field_blocks` over a cycle as ``vtk/*.vtu`` and ``mesh_cycle.pvd``, and a state of ParaView.

    Teeth and flanks of a cycle with cells of the face come without a state.

    Parameters
    ----------
    folder : Path
        Gets the ``.pvd``, a folder ``vtk``, and ``paraview_state.py``, which opens the series in ParaView with the mesh
        in view and colours up to the stress of the fillets.
    pair : gears.GearPair
    cycle : MeshCycle
    bodies : PairCompliance
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
    stresses: list[float] = []
    drawn = _even(pair, cycle, bodies, stresses) if cycle.face is None else _uneven(pair, cycle, bodies)
    steps: list[tuple[float, dict[str, Path]]] = []
    for done, row in enumerate(rows):
        files = {}
        for name, grid in drawn(row).items():
            files[name] = folder / "vtk" / f"{name}_{row:04d}.vtu"
            write_grid(files[name], grid)
        steps.append((float(cycle.position[row]), files))
        if progress is not None:
            progress(done + 1, len(rows))
    if cycle.face is None:
        write_paraview_state(folder, pair, cycle, rows, stresses)
    return _write_series(folder / "mesh_cycle.pvd", steps)


def _even(
    pair: GearPair, cycle: MeshCycle, bodies: PairCompliance, stresses: list[float]
) -> Callable[[int], Mapping[str, Any]]:
    """Blocks of rows of a cycle that is even along the face; notes the stress of the fillets."""
    drawings = draw_gears(pair, bodies, min(bodies.refinements, PICTURE_REFINEMENTS))

    def at(row: int) -> Mapping[str, Any]:
        gear_fields = loaded_fields(pair, cycle, row, bodies, drawings)
        stresses.extend(fillet_stress(field) for field in gear_fields)
        return _blocks(*gear_fields, contact_forces(pair, cycle, row))

    return at


def _uneven(pair: GearPair, cycle: MeshCycle, bodies: PairCompliance) -> Callable[[int], Mapping[str, Any]]:
    """Blocks of rows of a cycle with cells of the face."""
    prisms = gear_prisms(bodies)
    return lambda row: face_grids(*face_fields(pair, cycle, row, bodies, prisms))


def _blocks(
    pinion: GearField, wheel: GearField, contacts: ContactForces
) -> dict[str, pyvista.UnstructuredGrid]:
    return {
        "pinion": _gear_grid(pinion, 0),
        "wheel": _gear_grid(wheel, 1),
        "contacts": _contact_grid(contacts),
    }


def _gear_grid(field: GearField, gear: int) -> pyvista.UnstructuredGrid:
    import pyvista

    grid = pyvista.UnstructuredGrid(
        {pyvista.CellType.QUADRATIC_TRIANGLE: field.cells}, single_precision(field.points)
    )
    for name, values in field.point_data.items():
        if name == "principal_direction":  # it follows from the stress, and would add an eighth to the file
            continue
        stored = single_precision(values, flat=name in COMPONENTS)
        grid.point_data[name] = stored if name == "displacement_m" else rounded(stored)
        for i, label in enumerate(COMPONENTS.get(name, ())):
            grid.GetPointData().GetArray(name).SetComponentName(i, label)
    for name, numbers in field.cell_data.items():
        grid.cell_data[name] = numbers.astype(np.int32)
    grid.cell_data["gear"] = np.full(len(field.cells), gear, dtype=np.int32)
    return active(grid, "von_mises_Pa", "displacement_m")


def _contact_grid(contacts: ContactForces) -> pyvista.UnstructuredGrid:
    import pyvista

    vertices = np.arange(len(contacts.points))[:, None]
    grid = pyvista.UnstructuredGrid({pyvista.CellType.VERTEX: vertices}, single_precision(contacts.points))
    for name, values in contacts.point_data.items():
        whole = np.issubdtype(values.dtype, np.integer)
        grid.point_data[name] = values.astype(np.int32) if whole else single_precision(values)
    return active(grid, "pressure_Pa", "force_N")


def _write_series(path: Path, steps: Sequence[tuple[float, Mapping[str, Path]]]) -> Path:
    """Write a ``.pvd``: for each time, the named parts that belong to it, relative to its folder."""
    lines = ['<?xml version="1.0"?>', '<VTKFile type="Collection" version="0.1" byte_order="LittleEndian">']
    lines.append("  <Collection>")
    for time, parts in steps:
        for number, (name, file) in enumerate(parts.items()):
            relative = quoteattr(os.path.relpath(file, path.parent))
            lines.append(
                f'    <DataSet timestep="{time:.9g}" group="" part="{number}" name={quoteattr(name)} file={relative}/>'
            )
    lines += ["  </Collection>", "</VTKFile>", ""]
    with replacing(path) as beside:
        beside.write_text("\n".join(lines), encoding="utf-8")
    return path
