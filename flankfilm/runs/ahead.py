"""What a helper does while a scene is computed: each part of it as soon as the stages that it needs are there."""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from base import InputError, SolverError
from flankfilm.processes.assistant import Assistant, Task
from flankfilm.products import geometry
from flankfilm.stages.computed import Computed
from flankfilm.stages.engine import Engine, Stage
from flankfilm.stages.mesh import COMPLIANCE, MESH, along_the_face
from flankfilm.stages.vtk import FieldFiles, begin_fields, factorise

if TYPE_CHECKING:
    from flankfilm.runs.report import Shown

__all__ = ["Ahead"]


@dataclass(eq=False)
class Ahead:
    """Work of a helper beside the stages; the only thing here that changes.

    Attributes
    ----------
    engine : Engine
        That calls `ended`.
    helper : Assistant
    folder : Path
        Where fields are written.
    fields : FieldFiles or None
        Files for ParaView, where they are begun.
    of_pair : Task or None
        Draws what shows the geometry, where that is begun.
    """

    engine: Engine
    helper: Assistant
    folder: Path
    fields: FieldFiles | None = None
    of_pair: Task[Shown] | None = None

    def ended(self, stage: Stage[Any]) -> None:
        """Begin what the result of a stage was wanting for."""
        if stage is COMPLIANCE and not along_the_face(self.engine.scene):
            self.helper.submit(factorise, self.engine[COMPLIANCE])
        elif stage is MESH:
            with suppress(InputError, SolverError):  # what fields need as well, and so the engine keeps
                self.fields = begin_fields(self.folder, self.engine, self.helper, self._report)
        elif stage in (needed := self._of_geometry) and self._report:
            known = self.engine.results()
            if all(one.name in known for one in needed):
                self._draw_pair({one.name: known[one.name] for one in needed})

    @property
    def _report(self) -> bool:
        return "report" in self.engine.scene.wants

    @property
    def _of_geometry(self) -> tuple[Stage[Any], ...]:
        """Stages that the sections of the geometry show."""
        return tuple(geometry.PRODUCT.goals(self.engine.scene, {geometry.PRODUCT.name}))

    def _draw_pair(self, values: Mapping[str, Any]) -> None:
        from flankfilm.runs.report import draw_pair

        self.of_pair = self.helper.submit(draw_pair, Computed(self.engine.scene, values))
