"""What a run gave, as the report and the command line take it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from flankfilm.scene import Scene
from flankfilm.stages.decisions import decisions
from flankfilm.stages.engine import StageRun

if TYPE_CHECKING:
    import xarray as xr

    from flankfilm.stages.decide import Plan
    from flankfilm.stages.decisions import Decision


@dataclass(frozen=True)
class Results:
    """What a run gave.

    Attributes
    ----------
    scene : Scene
        What was asked for.
    folder : Path
        Where the files are.
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
    """

    scene: Scene
    folder: Path
    values: Mapping[str, Any]
    runs: Mapping[str, StageRun]
    files: tuple[Path, ...]
    seconds: float
    dataset: xr.Dataset

    @property
    def plan(self) -> Plan | None:
        """Models and shares of the tolerance; None for a scene without teeth."""
        return self.values.get("plan")

    @property
    def decisions(self) -> tuple[Decision, ...]:
        """What the run decided by itself, and what the scene had decided."""
        return decisions(self.values)

    def _repr_html_(self) -> str:
        """Headline figures, for notebooks."""
        from flankfilm.notebook import results_html

        return results_html(self)
