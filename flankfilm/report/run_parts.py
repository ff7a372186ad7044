"""Sections of the report about the run itself: error against cost, decisions, inputs."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from flankfilm.report.page import Part, Table
from flankfilm.report.text import percent, seconds
from flankfilm.stages.engine import StageRun

if TYPE_CHECKING:
    from flankfilm.stages.decide import Plan
    from flankfilm.stages.decisions import Decision


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


def decisions(decided: Sequence[Decision], plan: Plan | None, runs: Mapping[str, StageRun]) -> Part | None:
    """What was decided, how the tolerance was split, and what was warned of."""
    warned = tuple(f"{run.title}: {text}" for run in runs.values() for text in run.warnings)
    tables = (_decided(decided),) if decided else ()
    if plan is not None and len(plan.shares):
        tables = (*tables, _shares(plan))
    lines = (*(d.line for d in decided), *((plan.line,) if plan is not None else ()), *warned)
    if not lines:
        return None
    return Part("decisions", "Decisions and warnings", tables=tables, notes=lines)


def _decided(decided: Sequence[Decision]) -> Table:
    heads = ("decision", "choice", "effect, at most", "allowed", "cost of all stages, foreseen")
    rows = tuple(
        (
            d.subject,
            d.choice,
            "" if d.effect is None else percent(d.effect),
            "" if d.share is None else percent(d.share),
            "" if d.seconds is None else seconds(d.seconds),
        )
        for d in decided
    )
    return Table(heads, rows)


def _shares(plan: Plan) -> Table:
    heads = ("share of the tolerance", "error allowed in the mean stiffness", "cost foreseen")
    rows = tuple(
        (law.name, percent(error), seconds(law.cost(error)))
        for law, error in zip(plan.shares.laws, plan.shares.errors, strict=True)
    )
    return Table(heads, rows)


def inputs(scene_text: str, versions: Mapping[str, str]) -> Part:
    """Show the scene with all defaults, and the versions."""
    libraries = ", ".join(f"{name} {version}" for name, version in versions.items())
    return Part("inputs", "Inputs", (f"Made with {libraries}.",), code=scene_text)
