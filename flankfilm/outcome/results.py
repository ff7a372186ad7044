"""What a run gave, as the report and the command line take it."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

from base import Cost, record
from flankfilm.figures.views import register
from flankfilm.plan.decisions import decisions
from flankfilm.scene import Scene
from flankfilm.stages.computed import Computed
from flankfilm.stages.engine import Stage, StageRun
from flankfilm.stages.failures import Failure

if TYPE_CHECKING:
    import xarray as xr

    from flankfilm.plan.decide import Plan
    from flankfilm.plan.decisions import Decision


T = TypeVar("T")


@record
class Results:
    """What a run gave.

    Attributes
    ----------
    scene : Scene
        What was asked for.
    folder : Path or None
        Where the files are; None where none were written.
    values : mapping
        Stage name to result.
    runs : mapping
        Stage name to how it came about.
    files : tuple of Path
        What was written.
    seconds : float
        Cost of the whole run [s].
    dataset : xarray.Dataset
        What ``results.nc`` holds; the functions of `flankfilm.figures` draw from it.
    others : tuple of str
        Files in the folder that this run did not write.
    failures : tuple of Failure
        Parts that could not be computed, each with the reason; empty where all could.
    """

    headline = ("title", "stages", "failed", "written")

    scene: Scene
    folder: Path | None
    values: Mapping[str, Any]
    runs: Mapping[str, StageRun]
    files: tuple[Path, ...]
    seconds: float
    dataset: xr.Dataset
    others: tuple[str, ...] = ()
    failures: tuple[Failure, ...] = ()

    def get(self, stage: Stage[T]) -> T | None:
        """Result of a stage, such as `flankfilm.stages.mesh.DRY_CYCLE`; None where the scene did not need it.

        Raises
        ------
        InputError, SolverError
            Where the stage, or one that it needs, failed.
        """
        for failure in self.failures:
            if failure.name == stage.name:
                raise failure.error
        return self.values.get(stage.name)

    @property
    def computed(self) -> Computed:
        """Results of the stages, as everything that shows them reads them."""
        return Computed(self.scene, self.values, self.failures, self.runs)

    @property
    def title(self) -> str:
        """Title of the scene."""
        return self.scene.title or "untitled"

    @property
    def stages(self) -> int:
        """Number of stages that ran."""
        return len(self.runs)

    @property
    def failed(self) -> int | None:
        """Number of stages that could not be computed; None where all could."""
        return len(self.failures) or None

    @property
    def written(self) -> str:
        """Number of files and where they are."""
        return f"{len(self.files)} files in {self.folder}" if self.folder else "no files"

    @property
    def cost(self) -> Cost:
        """Cost of the whole run."""
        return Cost(self.seconds, parts={name: run.seconds for name, run in self.runs.items()})

    @property
    def plan(self) -> Plan | None:
        """Models and shares of the tolerance; None for a scene without teeth."""
        return self.values.get("plan")

    @property
    def decisions(self) -> tuple[Decision, ...]:
        """What the run decided by itself, and what the scene had decided."""
        return decisions(self.values)


register()
