"""Studies in parts: each computed alone, on any machine that sees the folder, and merged when all are there.

Part i of n has the rows i - 1, i - 1 + n, and so on: neighbouring rows, which cost alike, fall into different parts. A
part keeps its rows in ``parts/i-of-n`` of the study's folder, so that parts know nothing of each other.
"""

from __future__ import annotations

import re
import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from base import InputError
from flankfilm.outcome.outcome import concluded
from flankfilm.studies.execution import Execution, Progress
from flankfilm.studies.files import StudyOutcome
from flankfilm.studies.kept import kept_rows
from flankfilm.studies.plan import Plan
from flankfilm.studies.run import StudyResults, refuse_unknown, run_study, work_of_plan
from flankfilm.studies.table import ROWS, Line

PARTS = "parts"
"""Folder of the parts within that of the study."""

MOST_LISTED = 20
"""Missing rows that a refusal names."""


@dataclass(frozen=True)
class Part:
    """One of several parts of a study.

    Attributes
    ----------
    number : int
        From 1.
    of : int
        Parts in all.
    """

    number: int
    of: int

    def __post_init__(self) -> None:
        """Refuse a part that there is not."""
        if not 1 <= self.number <= self.of:
            raise InputError.at("part", str(self), "must be one of 1/n to n/n", "Such as --part 3/16")

    def __str__(self) -> str:
        """Number and parts in all, as on the command line."""
        return f"{self.number}/{self.of}"

    @classmethod
    def read(cls, text: str) -> Part:
        """Part of a text such as ``3/16``.

        Examples
        --------
        >>> Part.read("3/16")
        Part(number=3, of=16)
        """
        written = re.fullmatch(r"(\d{1,7})/(\d{1,7})", text)
        if written is None:
            raise InputError.at(
                "--part", text, "must be two whole numbers with a slash", "Such as --part 3/16"
            )
        return cls(int(written[1]), int(written[2]))

    def folder(self, study: Path) -> Path:
        """Where its rows are kept."""
        return study / PARTS / f"{self.number}-of-{self.of}"

    def rows(self, plan: Plan) -> range:
        """Numbers of its rows.

        Examples
        --------
        >>> from types import SimpleNamespace
        >>> list(Part(2, 3).rows(SimpleNamespace(rows=range(8))))
        [1, 4, 7]
        """
        return range(self.number - 1, len(plan.rows), self.of)


def part_outcome(part: Part, plan: Plan, folder: Path, how: Execution, progress: Progress) -> StudyOutcome:
    """Compute the rows of a part, kept in its place within the study's folder; nothing is made of them yet."""
    place = part.folder(folder)
    rows = run_study(plan, place, how, progress, part.rows(plan))
    return StudyOutcome(rows, place, (place / ROWS,))


def merge(plan: Plan, folder: Path) -> StudyOutcome:
    """Gather the rows of all parts into ``rows.csv`` of the study's folder, and write what is made of them.

    Rows that are there already stay; parts may be of any number, and overlap.

    Parameters
    ----------
    plan : Plan
    folder : Path
        Of the study.

    Raises
    ------
    InputError
        Where rows are missing, a part is of another study or of other code, or is being computed.
    """
    start = time.perf_counter()
    with kept_rows(folder, work_of_plan(plan), resume=True) as kept:
        refuse_unknown(folder, kept.lines, plan)
        done = {line.result.index: line.result for line in kept.lines}
        for path, lines in _parts(plan, folder):
            refuse_unknown(path, lines, plan)
            for line in lines:
                if line.result.index not in done:
                    kept.add(plan.rows[line.result.index], line.result)
                    done[line.result.index] = line.result
        missing = [str(index) for index in range(len(plan.rows)) if index not in done]
        if missing:
            listed = ", ".join(missing[:MOST_LISTED]) + (", ..." if len(missing) > MOST_LISTED else "")
            rows = f"{len(missing)} of {len(plan.rows)} rows are missing: {listed}"
            remedy = "Compute their parts, with --resume where one was begun, and merge again"
            raise InputError.at(folder, "", rows, remedy)
        ordered = tuple(done[index] for index in range(len(plan.rows)))
        gathered = StudyResults(plan, ordered, 0, time.perf_counter() - start)
        return concluded(StudyOutcome(gathered), folder)


def _parts(plan: Plan, folder: Path) -> Iterator[tuple[Path, tuple[Line, ...]]]:
    """Rows of each part that was begun."""
    for path in sorted((folder / PARTS).glob("*-of-*")):
        if (path / ROWS).exists():
            with kept_rows(path, work_of_plan(plan), resume=True) as kept:
                yield path, kept.lines
