"""The mesh cycle as a time series for ParaView."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from flankfilm.progress import Progress, silent
from flankfilm.stages.catalogue import COMPLIANCE, PAIR, loaded_contact
from flankfilm.stages.engine import Engine

STEPS = 20
"""Positions of the time series: enough for a smooth film of one base pitch."""


def write_fields(folder: Path, run: Engine, progress: Progress = silent) -> list[Path]:
    """Write the mesh cycle for ParaView; return the ``.pvd`` that names all its files, and the state that opens it.

    Fields over the face have no state.
    """
    from fem.paraview_state import STATE
    from fem.vtk import write_vtk_series

    cycle = loaded_contact(run)
    n = len(cycle.position)
    rows = sorted({int(i) for i in np.linspace(0, n - 1, min(n, STEPS)).round()})
    series = write_vtk_series(
        folder,
        run[PAIR],
        cycle,
        run[COMPLIANCE],
        rows,
        lambda done, total: progress("fields for ParaView", done, total),
    )
    return [series, series.with_name(STATE)] if cycle.face is None else [series]
