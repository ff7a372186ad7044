"""Fields of the loaded pair for ParaView: blocks of pyvista, and their time series over the mesh cycle."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING
from xml.sax.saxutils import quoteattr

from base import record, replacing
from fem.cycle.result import MeshCycle
from fem.fields.contact_forces import contact_forces
from fem.fields.drawing import GearDrawing
from fem.fields.face_fields import face_fields
from fem.fields.face_waves import GearPrisms, gear_prisms
from fem.fields.grids import face_grids, helix_grids, plane_grids, write_grid
from fem.fields.helix_fields import helix_fields
from fem.fields.helix_solids import TwistedGear, twisted_gears
from fem.fields.loaded_gears import frames
from fem.fields.paraview_state import fillet_stress, write_lines_state, write_paraview_state
from fem.fields.stress_fields import draw_gears, loaded_fields
from fem.fields.surface_frames import SurfaceFrame, Surfaces
from fem.pair.compliance import compliance as _compliance
from fem.pair.pair_compliance import PairCompliance

if TYPE_CHECKING:
    import pyvista

    from gears import GearPair

__all__ = ["Frames", "field_blocks", "write_frames", "write_series", "write_vtk_series"]

PICTURE_REFINEMENTS = 1
"""Refinements of the mesh that is drawn: fields need no more, and files stay small."""

Frame = tuple[dict[str, "pyvista.UnstructuredGrid"], tuple[float, ...]]
"""Blocks of a position, and stresses of fillets or pressures [Pa] that the colours of a series follow."""


@record
class Frames:
    """Files of some positions of a series.

    Attributes
    ----------
    steps : tuple
        Of each position its place in base pitches from A, and its files by the names of their blocks.
    colours : tuple of float
        Stresses of fillets or pressures that the colours of the series follow [Pa].
    surfaces : Surfaces or None
        Of the teeth, where they were wanted.
    surface_frames : tuple of SurfaceFrame
        Of each position, where they were wanted.
    """

    steps: tuple[tuple[float, dict[str, Path]], ...]
    colours: tuple[float, ...]
    surfaces: Surfaces | None = None
    surface_frames: tuple[SurfaceFrame, ...] = ()

    def moved(self, source: Path, target: Path) -> Frames:
        """The same after the files have been moved from one folder to another one of the same disk."""
        if source == target:
            return self
        steps = tuple(
            (place, {name: _moved(file, target / file.relative_to(source)) for name, file in files.items()})
            for place, files in self.steps
        )
        return replace(self, steps=steps)


def _moved(file: Path, target: Path) -> Path:
    """Replace a file by another one."""
    target.parent.mkdir(parents=True, exist_ok=True)
    try:
        return file.replace(target)
    except OSError as fault:
        raise OSError(fault.errno, fault.strerror, str(target)) from fault


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
        once for each gear. Fields are in single precision. Of a cycle with cells of the face ``pinion`` and ``wheel``
        are wedges of the teeth in mesh with their displacement, in single precision; ``pinion_flanks`` and
        ``wheel_flanks`` quadrangles whose ``pressure_Pa`` times their area adds up to the forces, in double precision.
        Of a helical pair the teeth are twisted, and ``lines`` are the lines of contact, a segment a cell, once for each
        gear, with vectors ``force_N``.

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

    if cycle.lines is not None:
        grids, _ = _helix_frame(pair, cycle, row, compliance)
    elif cycle.face is None:
        grids, _ = _plane_frame(pair, cycle, row, compliance, drawings)
    else:
        grids, _ = _face_frame(pair, cycle, row, compliance)
    return pyvista.MultiBlock(grids)


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
        in view and colours up to the stress of the fillets, of a helical pair up to its Hertz pressure.
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
    return write_series(
        folder, pair, cycle, rows, [write_frames(folder, pair, cycle, bodies, rows, progress)]
    )


def write_frames(
    folder: Path,
    pair: GearPair,
    cycle: MeshCycle,
    bodies: PairCompliance,
    rows: Sequence[int],
    progress: Callable[[int, int], None] | None = None,
    surfaces: bool = False,
) -> Frames:
    """Write the files of some positions of a series; arguments as of `write_vtk_series`.

    Positions do not depend on each other, so that several processes can share a series. With `surfaces` what is
    written is kept as surfaces too, light enough for a page.
    """
    frame: Callable[..., Frame]
    if cycle.lines is not None:
        frame = partial(_helix_frame, solids=twisted_gears(bodies, cycle.lines.slope))
    elif cycle.face is None:
        drawings = draw_gears(pair, bodies, min(bodies.refinements, PICTURE_REFINEMENTS))
        frame = partial(_plane_frame, drawings=drawings)
    else:
        frame = partial(_face_frame, prisms=gear_prisms(bodies))
    colours: list[float] = []
    steps: list[tuple[float, dict[str, Path]]] = []
    teeth: Surfaces | None = None
    kept: list[SurfaceFrame] = []
    for done, row in enumerate(rows):
        files = {}
        grids, largest = frame(pair, cycle, row, bodies)
        colours.extend(largest)
        for name, grid in grids.items():
            files[name] = folder / "vtk" / f"{name}_{row:04d}.vtu"
            write_grid(files[name], grid)
        steps.append((float(cycle.position[row]), files))
        if surfaces:
            teeth = teeth or Surfaces.of(grids, frames(pair, pair.points.C)[1][1], pair.face_width)
            kept.append(teeth.frame(grids))
        if progress is not None:
            progress(done + 1, len(rows))
    return Frames(tuple(steps), tuple(colours), teeth, tuple(kept))


def write_series(
    folder: Path, pair: GearPair, cycle: MeshCycle, rows: Sequence[int], parts: Sequence[Frames]
) -> Path:
    """Write ``mesh_cycle.pvd`` over the files of all `rows`, and the state of ParaView; return the ``.pvd``."""
    colours = [value for part in parts for value in part.colours]
    if colours:
        state = write_lines_state if cycle.lines is not None else write_paraview_state
        state(folder, pair, cycle, rows, colours)
    return _write_series(folder / "mesh_cycle.pvd", [step for part in parts for step in part.steps])


def _plane_frame(
    pair: GearPair,
    cycle: MeshCycle,
    row: int,
    bodies: PairCompliance | None,
    drawings: tuple[GearDrawing, GearDrawing] | None = None,
) -> Frame:
    """Blocks of a cycle that is even along the face, and the stress of both gears' fillets."""
    pinion, wheel = loaded_fields(pair, cycle, row, bodies, drawings)
    grids = plane_grids(pinion, wheel, contact_forces(pair, cycle, row))
    return grids, (fillet_stress(pinion), fillet_stress(wheel))


def _face_frame(
    pair: GearPair,
    cycle: MeshCycle,
    row: int,
    bodies: PairCompliance | None,
    prisms: tuple[GearPrisms, GearPrisms] | None = None,
) -> Frame:
    """Blocks of a cycle with cells of the face, which have no stress."""
    ready = bodies or _compliance(pair, plane=cycle.plane)
    return face_grids(*face_fields(pair, cycle, row, ready, prisms)), ()


def _helix_frame(
    pair: GearPair,
    cycle: MeshCycle,
    row: int,
    bodies: PairCompliance | None,
    solids: tuple[TwistedGear, TwistedGear] | None = None,
) -> Frame:
    """Blocks of a cycle of a helical pair, and the maximum Hertz pressure."""
    ready = bodies or _compliance(pair, plane=cycle.plane)
    fields = helix_fields(pair, cycle, row, ready, solids)
    return helix_grids(fields), (float(fields.lines.hertz_pressure_Pa.max()),)


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
