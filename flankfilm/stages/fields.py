"""Stress and displacement of the loaded gears: one position for the report, all for ParaView."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from flankfilm.mesh_stiffness import MeshStiffness

if TYPE_CHECKING:
    from pathlib import Path

    from fem import MeshCycle
    from fem.fields import GearField
    from flankfilm.progress import Progress
    from flankfilm.stages.engine import Engine

STEPS = 20
"""Positions of the time series: enough for a smooth film of one base pitch."""


@dataclass(frozen=True)
class FieldsStage:
    """Fields at the position nearest to the pitch point.

    Attributes
    ----------
    pinion, wheel : GearField
        In the common frame.
    position : int
        Row of the cycle.
    """

    pinion: GearField
    wheel: GearField
    position: int


def fields(engine: Engine) -> FieldsStage:
    """Fields with a pair at the pitch point."""
    from fem.fields import loaded_fields

    cycle = loaded_contact(engine)
    distance = np.abs(np.where(np.isfinite(cycle.rho1), cycle.rho1, np.inf) - engine["pair"].points.C)
    position = int(np.argmin(distance.min(axis=1)))
    pinion, wheel = loaded_fields(engine["pair"], cycle, position, compliance=engine["compliance"])
    return FieldsStage(pinion, wheel, position)


def loaded_contact(engine: Engine) -> MeshCycle:
    """Give the loaded contact that the fields belong to: with the film where there is one."""
    mesh: MeshStiffness = engine["mesh"]
    assert mesh.contact is not None
    return mesh.contact


def write_vtk(folder: Path, engine: Engine, progress: Progress) -> list[Path]:
    """Write the mesh cycle for ParaView; return the ``.pvd`` that names all its files."""
    from fem.vtk import write_vtk_series

    cycle = loaded_contact(engine)
    n = len(cycle.position)
    rows = sorted({int(i) for i in np.linspace(0, n - 1, min(n, STEPS)).round()})
    return [
        write_vtk_series(
            folder,
            engine["pair"],
            cycle,
            engine["compliance"],
            rows,
            lambda done, total: progress("fields for ParaView", done, total),
        )
    ]
