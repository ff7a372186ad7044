"""What a run computed, as everything that shows it reads it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, TypeVar

from flankfilm.scene import Scene
from flankfilm.stages.engine import Stage, StageRun
from flankfilm.stages.failures import Failure

T = TypeVar("T")


@dataclass(frozen=True)
class Computed:
    """Results of the stages of one run.

    Attributes
    ----------
    scene : Scene
        What was asked for.
    values : mapping
        Stage name to result.
    failures : tuple of Failure
        Parts that could not be computed.
    runs : mapping
        Stage name to how it came about.
    """

    scene: Scene
    values: Mapping[str, Any]
    failures: tuple[Failure, ...] = ()
    runs: Mapping[str, StageRun] = field(default_factory=dict)

    def get(self, stage: Stage[T]) -> T | None:
        """Result of a stage; None where the scene did not need it, or where it failed."""
        return self.values.get(stage.name)

    def failed(self, stage: Stage[Any]) -> bool:
        """Whether a stage failed."""
        return any(failure.name == stage.name for failure in self.failures)
