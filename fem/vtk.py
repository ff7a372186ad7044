"""Time series of the loaded pair for ParaView."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from fem.compliance import Compliance, mesh_and_factor
from fem.contact import MeshCycle
from fem.fields import loaded_fields

if TYPE_CHECKING:
    from gears import GearPair

__all__ = ["write_vtk_series"]

PICTURE_REFINEMENTS = 1
"""Refinements of the mesh that is drawn: fields need no more, and files stay small."""


def write_vtk_series(
    folder: Path,
    pair: GearPair,
    cycle: MeshCycle,
    bodies: Compliance,
    positions: Sequence[int] | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> Path:
    """Write the fields of both gears as ``vtk/*.vtu`` and ``mesh_cycle.pvd``.

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
        The ``.pvd``; its time is the way from A over the base pitch.
    """
    from meshes.files import write_pvd, write_vtu

    folder = Path(folder)
    rows = range(len(cycle.position)) if positions is None else positions
    level = min(bodies.refinements, PICTURE_REFINEMENTS)
    rings, _ = mesh_and_factor(pair, bodies.plane, bodies.sizes, level)
    steps: list[tuple[float, list[Path]]] = []
    for done, row in enumerate(rows):
        files = []
        both = loaded_fields(pair, cycle, row, bodies, rings)
        for name, gear, field in zip(("pinion", "wheel"), (0, 1), both, strict=True):
            ids = {
                "tooth": field.tooth.astype(np.int32),
                "gear": np.full(len(field.tooth), gear, dtype=np.int32),
            }
            path = folder / "vtk" / f"{name}_{row:04d}.vtu"
            files.append(write_vtu(path, field.points, field.cells, field.point_data, ids))
        steps.append((float(cycle.position[row]), files))
        if progress is not None:
            progress(done + 1, len(rows))
    return write_pvd(folder / "mesh_cycle.pvd", steps)
