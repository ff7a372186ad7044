"""The mesh cycle as a time series for ParaView."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from flankfilm import coupling
from flankfilm.processes.assistant import Assistant, Task
from flankfilm.processes.progress import Progress, silent
from flankfilm.stages.engine import Engine
from flankfilm.stages.mesh import COMPLIANCE, FIELDS, PAIR, loaded_contact

if TYPE_CHECKING:
    import fem
    from fem.cycle.result import MeshCycle
    from fem.fields.surface_frames import SurfaceFrame, Surfaces
    from fem.fields.vtk import Frames
    from gears import GearPair

STEPS = 20
"""Positions of the time series: enough for a smooth film of one base pitch."""

PART = 10
"""Positions that are written in one go: few enough to share the work evenly."""


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


@dataclass(frozen=True, eq=False)
class FieldFiles:
    """Files for ParaView that are being written.

    Attributes
    ----------
    folder : Path
        Where they are written.
    pair, cycle, rows
        As of `fem.fields.vtk.write_series`.
    parts : tuple of Task
        Each writes some of the rows.
    """

    folder: Path
    pair: GearPair
    cycle: MeshCycle
    rows: Sequence[int]
    parts: tuple[Task[Frames], ...]

    def written(self, folder: Path, helper: Assistant, progress: Progress = silent) -> list[Path]:
        """Wait for them and move them to where they belong; return the ``.pvd`` of all, and the state of ParaView.

        The state opens the series; fields over the face of a spur pair have none.
        """
        from fem.fields.paraview_state import STATE
        from fem.fields.vtk import write_series

        frames = []
        for done, part in enumerate(self.parts, start=1):
            frames.append(helper.result(part))
            progress("fields for ParaView", done, len(self.parts))
        frames = [part.moved(self.folder, folder) for part in frames]
        series = write_series(folder, self.pair, self.cycle, self.rows, frames)
        return [series, series.with_name(STATE)] if self.cycle.face is None else [series]

    def surfaces(self, helper: Assistant) -> tuple[Surfaces, dict[float, SurfaceFrame]] | None:
        """Surfaces of the teeth and their frames by position [base pitches from A], once the files are written.

        None where they were not wanted.
        """
        parts = [helper.result(part) for part in self.parts]
        if not parts or parts[0].surfaces is None:
            return None
        places = [place for part in parts for place, _ in part.steps]
        frames = [frame for part in parts for frame in part.surface_frames]
        return parts[0].surfaces, dict(zip(places, frames, strict=True))


def factorise(bodies: fem.PairCompliance) -> None:
    """Factorise both gears of a pair, before there are forces: fields find them in the process."""
    bodies.rings()


def begin_fields(folder: Path, run: Engine, helper: Assistant, surfaces: bool = False) -> FieldFiles:
    """Give the mesh cycle to be written for ParaView, in parts that two processes can share.

    Fields at the pitch point, where the scene has them, are computed beside them: the engine waits for them when they
    are asked for. Solids of gears over the face are factorised for all rows, so that one process writes them. With
    `surfaces` the teeth are kept for a page besides.
    """
    from fem.fields.vtk import write_frames

    pair, cycle, bodies = run[PAIR], loaded_contact(run), run[COMPLIANCE]
    rows = even_rows(len(cycle.position))
    plane = cycle.face is None and cycle.lines is None
    # with its arcs, what their errors are compared with would be solved before the helper can begin
    sent = cycle.without_arcs()
    if plane and FIELDS.name not in run.results():
        at_pitch_point = helper.submit(coupling.pitch_point_fields, pair, sent, bodies)
        run.promise(FIELDS, partial(helper.result, at_pitch_point))
    size = PART if plane else len(rows)
    parts = [rows[start : start + size] for start in range(0, len(rows), size)]
    tasks = tuple(
        helper.submit(write_frames, folder, pair, sent, bodies, part, None, surfaces) for part in parts
    )
    return FieldFiles(folder, pair, cycle, rows, tasks)


def write_fields(folder: Path, run: Engine, progress: Progress = silent) -> list[Path]:
    """Write the mesh cycle for ParaView; return its ``.pvd`` and state, as `FieldFiles.written` does."""
    helper = Assistant()
    return begin_fields(folder, run, helper).written(folder, helper, progress)
