"""The mesh cycle as a time series for ParaView."""

from __future__ import annotations

from pathlib import Path

from flankfilm.processes.progress import Progress, silent
from flankfilm.stages.engine import Engine
from flankfilm.stages.mesh import COMPLIANCE, PAIR, loaded_contact

STEPS = 20
"""Positions of the time series: enough for a smooth film of one base pitch."""


def even_rows(positions: int, steps: int = STEPS) -> range:
    """Rows of a cycle that lie equally far apart, also from the last to the first of the next base pitch.

    Parameters
    ----------
    positions : int
        Rows of the cycle, midpoints of equal intervals of one base pitch.
    steps : int
        Rows to choose, about: as many as divide `positions`. Where no such number lies between half and twice the
        steps, rows are equally far apart but for the last and the first.

    Examples
    --------
    >>> even_rows(120), len(even_rows(50)), even_rows(9)
    (range(3, 120, 6), 25, range(0, 9))
    """
    if positions <= steps:
        return range(positions)
    counts = [n for n in range((steps + 1) // 2, 2 * steps + 1) if positions % n == 0]
    if not counts:
        return range(0, positions, round(positions / steps))
    stride = positions // min(counts, key=lambda n: abs(n - steps))
    return range(stride // 2, positions, stride)


def write_fields(folder: Path, run: Engine, progress: Progress = silent) -> list[Path]:
    """Write the mesh cycle for ParaView; return the ``.pvd`` that names all its files, and the state that opens it.

    Fields over the face of a spur pair have no state.
    """
    from fem.fields.paraview_state import STATE
    from fem.fields.vtk import write_vtk_series

    cycle = loaded_contact(run)
    rows = even_rows(len(cycle.position))
    series = write_vtk_series(
        folder,
        run[PAIR],
        cycle,
        run[COMPLIANCE],
        rows,
        lambda done, total: progress("fields for ParaView", done, total),
    )
    return [series, series.with_name(STATE)] if cycle.face is None else [series]
