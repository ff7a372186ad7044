"""Sections of the report about the run itself: error against cost, decisions, inputs."""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

from flankfilm.report.page import Fact, Part, Table, said
from flankfilm.report.text import percent, seconds
from flankfilm.scene.tables.flank_files import CURVES

if TYPE_CHECKING:
    import xarray as xr

    from flankfilm.outcome.results import Results
    from flankfilm.plan.decide import Plan
    from flankfilm.plan.decisions import Decision
    from flankfilm.stages.computed import Computed

LEAST_SECONDS = 0.005
"""Minimum time of a stage that is listed although it has no separate error [s]."""


CHOICES = {
    "fem": "finite elements",
    "ishikawa": "Ishikawa",
    "weber-banaschek": "Weber-Banaschek",
    "potential-energy": "potential energy",
    "given": "as given",
    "ehl": "solved",
    "dowson": "by formulas",
    "none": "left out",
    "on": "counted",
    "off": "left out",
}
"""What a choice of models is called, by its key in the scene."""

NUMBER = re.compile(r"(?<![\w.])\d+(?:\.\d+)?(?:e[+-]?\d+)?(?![\w.]*\d)")
"""A number in a warning."""


class Work(NamedTuple):
    """Figure that a stage's error belongs to, share of the tolerance, error, and what was done for it."""

    figure: str = ""
    allowed: float | None = None
    error: float | None = None
    note: str = ""


def costs(results: Results, works: Sequence[Work]) -> Part:
    """Error against cost for each stage that ran, in the order of computation; `works` of each of them."""
    listed = list(zip(results.runs.values(), works, strict=True))
    listed = [(run, work) for run, work in listed if work != Work() or run.seconds >= LEAST_SECONDS]
    table = Table.of(
        listed,
        {
            "stage": lambda row: row[0].title,
            "figure": lambda row: row[1].figure,
            "allowed": lambda row: _known(percent, row[1].allowed),
            "estimated error": lambda row: _known(percent, row[1].error),
            "work": lambda row: row[1].note,
            "time": lambda row: "kept from an earlier run" if row[0].cached else seconds(row[0].seconds),
        },
    )
    whole, spent = seconds(results.seconds), seconds(sum(run.seconds for run, _ in listed))
    text = said("costs", tolerance=percent(results.scene.tolerance), whole=whole, listed=spent)
    return Part("costs", "Error and cost", (text,), tables=(table.filled,))


def failures(results: Results) -> list[Part]:
    """Parts that were not computed, the reasons, and dependent parts; no section if all were computed."""
    own = [failure for failure in results.failures if not failure.because]
    if not own:
        return []
    needing = {
        failure.title: ", ".join(other.title for other in results.failures if other.because == failure.title)
        for failure in own
    }
    table = Table.of(
        own,
        {
            "part": lambda failure: failure.title,
            "why, and what to do": lambda failure: failure.why,
            "not computed because of it": lambda failure: needing[failure.title],
        },
    )
    return [Part("failures", "Not computed", (said("failures"),), tables=(table,), unfolded=True)]


def doubts(computed: Computed) -> list[str]:
    """Messages of solvers that did not converge."""
    values, runs = computed.values, computed.runs
    doubted = [name for name in runs if getattr(values.get(name), "converged", True) is False]
    return [f"{runs[name].title}: {values[name].message}" for name in doubted]


def warnings(results: Results, misses: Sequence[str] = ()) -> list[str]:
    """Figures beyond the tolerance or in doubt, and warnings of the stages, each text once."""
    heard: dict[str, list[str]] = {}
    for run in results.runs.values():
        for text in run.warnings:
            heard.setdefault(text, []).append(run.title)
    alike: dict[str, list[str]] = {}
    for text in heard:
        alike.setdefault(NUMBER.sub("#", text), []).append(text)
    lines = []
    for texts in alike.values():
        if (common := merged(texts)) is not None:
            titles = dict.fromkeys(title for text in texts for title in heard[text])
            lines.append(f"{', '.join(titles)}: {common}")
        else:
            lines += [f"{', '.join(heard[text])}: {text}" for text in texts]
    return [*misses, *lines]


def merged(texts: Sequence[str]) -> str | None:
    """Give warnings that differ in one number as one with its range; None where they differ in more.

    Examples
    --------
    >>> merged(["pressure 1.73 GPa: above 1", "pressure 1.54 GPa: above 1"])
    'pressure 1.54 to 1.73 GPa: above 1'
    """
    if len(texts) == 1:
        return texts[0]
    columns = list(zip(*(NUMBER.findall(text) for text in texts), strict=True))
    differing = [place for place, column in enumerate(columns) if len(set(column)) > 1]
    if len(differing) != 1:
        return None
    ends = sorted(columns[differing[0]], key=float)
    place = list(NUMBER.finditer(texts[0]))[differing[0]]
    return f"{texts[0][: place.start()]}{ends[0]} to {ends[-1]}{texts[0][place.end() :]}"


def _known(text: Callable[[float], str], value: float | None) -> str:
    """Text of a number; empty where there is none."""
    return "" if value is None else text(value)


def decisions(results: Results, warned: Sequence[str] = ()) -> list[Part]:
    """Decisions, division of the tolerance, and warnings; no section without any."""
    plan, decided = results.plan, results.decisions
    planned = [] if plan is None else [plan.line]
    lines = (*warned, *(d.line for d in decided), *planned)
    if not lines:
        return []
    tables = ([_decided(decided)] if decided else []) + ([_shares(plan)] if plan and len(plan.shares) else [])
    return [Part("decisions", "Decisions and warnings", tables=tuple(tables), notes=lines)]


def _decided(decided: Sequence[Decision]) -> Table:
    return Table.of(
        decided,
        {
            "decision": lambda d: d.subject,
            "choice": lambda d: CHOICES.get(d.choice, d.choice),
            "effect, at most": lambda d: _known(percent, d.effect),
            "allowed": lambda d: _known(percent, d.share),
            "estimated cost of all stages": lambda d: _known(seconds, d.seconds),
        },
    )


def _shares(plan: Plan) -> Table:
    return Table.of(
        plan.shares.items(),
        {
            "share of the tolerance": lambda share: share[0],
            "error allowed in the mean stiffness": lambda share: percent(share[1]),
            "estimated cost": lambda share: seconds(plan.costs[share[0]]),
        },
    )


def inputs_of(data: xr.Dataset) -> Part:
    """Show the scene and the versions that a file of data holds."""
    return inputs(json.loads(data.attrs["scene_json"]), data.attrs["versions_json"])


def work_of(data: xr.Dataset) -> Fact:
    """Say how long the rows of a file of data took together."""
    return Fact(f"{seconds(float(data['seconds'].sum()))} of work")


def inputs(scene: Mapping[str, Any], versions_json: str) -> Part:
    """Show a scene, and the versions as a file of data holds them; of curves from files the names alone."""
    libraries = ", ".join(f"{name} {version}" for name, version in json.loads(versions_json).items())
    code = json.dumps(_files_by_name(scene), indent=2, ensure_ascii=False)
    return Part("inputs", "Inputs", (f"Made with {libraries}.",), code=code)


def _files_by_name(table: Mapping[str, Any]) -> dict[str, Any]:
    """A table of a scene without what was read from files, which is thousands of numbers, and without empty keys."""
    read = CURVES if "file" in table else ()
    return {
        name: _files_by_name(value) if isinstance(value, Mapping) else value
        for name, value in table.items()
        if name not in read and value is not None
    }
