"""Parts of a scene that could not be computed, and why."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any, TypeAlias

from base import InputError, SolverError

PartError: TypeAlias = InputError | SolverError
"""What a part may raise without ending the others."""


@dataclass(frozen=True, eq=False)
class Failure:
    """One part that was not computed.

    Attributes
    ----------
    name, title : str
        Of the stage.
    error : InputError or SolverError
        What was raised, with the remedy.
    because : str
        Title of the part that this one needs and that failed; empty where it failed itself.
    """

    name: str
    title: str
    error: PartError
    because: str = ""

    @property
    def why(self) -> str:
        """Reason and remedy in one line."""
        return f"it needs {self.because}" if self.because else " ".join(str(self.error).split())

    @property
    def line(self) -> str:
        """What was not computed, why, and what to do."""
        return f"not computed: {self.title}: {self.why}"

    def plain(self) -> dict[str, Any]:
        """Plain values, for files."""
        return {"part": self.name, "title": self.title, "why": self.why, "because": self.because}


def failure_of(name: str, title: str, error: PartError, known: Mapping[str, Failure]) -> Failure:
    """Failure of a part: its own, or that of a part which it needs, where that is `known` to have raised the error."""
    raised = (error, error.__cause__)
    first = next(
        (failure for failure in known.values() if not failure.because and failure.error in raised), None
    )
    return Failure(name, title, error, "" if first is None else first.title)


def lines(failures: Iterable[Failure]) -> list[str]:
    """A line for each part that failed by itself, each followed by the parts that need it."""
    known = list(failures)
    texts = []
    for first in (failure for failure in known if not failure.because):
        texts.append(first.line)
        if needed := [failure.title for failure in known if failure.because == first.title]:
            texts.append(f"not computed because of it: {', '.join(needed)}")
    return texts
