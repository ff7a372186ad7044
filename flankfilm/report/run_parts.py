"""Sections of the report about the run itself: error against cost, decisions, inputs."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from flankfilm.report.page import Part, Table
from flankfilm.report.text import percent, seconds
from flankfilm.stages.engine import StageRun


@dataclass(frozen=True)
class CostRow:
    """Error and cost of one stage.

    Attributes
    ----------
    stage : str
        Its title.
    figure : str
        Which figure the error belongs to.
    allowed, error : float or None
        Share of the tolerance, and the estimate; None where there is none.
    note : str
        Unknowns, iterations, and the like.
    seconds : float
        [s]
    cached : bool
        Whether the result came from the cache.
    """

    stage: str
    figure: str
    allowed: float | None
    error: float | None
    note: str
    seconds: float
    cached: bool


def costs(rows: Sequence[CostRow], total: float, tolerance: float) -> Part:
    """Error against cost for each stage."""
    heads = ("stage", "figure", "allowed", "estimated error", "work", "time")
    cells = tuple(
        (
            row.stage,
            row.figure,
            "" if row.allowed is None else percent(row.allowed),
            "" if row.error is None else percent(row.error),
            row.note,
            "kept from an earlier run" if row.cached else seconds(row.seconds),
        )
        for row in rows
    )
    text = (
        f"The scene's tolerance is {percent(tolerance)} on the wanted figures. The run took {seconds(total)}, "
        f"of which {seconds(sum(r.seconds for r in rows))} in the stages listed."
    )
    return Part("costs", "Error and cost", (text,), tables=(Table(heads, cells),))


def decisions(notes: Sequence[str], runs: Mapping[str, StageRun]) -> Part | None:
    """What was decided and warned of."""
    warned = [f"{run.title}: {text}" for run in runs.values() for text in run.warnings]
    lines = [*notes, *warned]
    return Part("decisions", "Decisions and warnings", notes=tuple(lines)) if lines else None


def inputs(scene_text: str, versions: Mapping[str, str]) -> Part:
    """Show the scene with all defaults, and the versions."""
    told = ", ".join(f"{name} {version}" for name, version in versions.items())
    return Part("inputs", "Inputs", (f"Made with {told}.",), code=scene_text)
