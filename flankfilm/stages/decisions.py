"""What a run decided by itself, in one form: choice, what it changes, what was allowed, what it costs, and why."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from typing import Any


@dataclass(frozen=True)
class Candidate:
    """A model that might do.

    Attributes
    ----------
    name : str
        As the scene names it.
    effect : float or None
        Relative error of the stiffness by its simplification, at most; None where it is unknown.
    seconds : float or None
        Cost that is foreseen, of it and of all stages in the shares that it leaves them [s]; None where it leaves
        them nothing.
    """

    name: str
    effect: float | None
    seconds: float | None


@dataclass(frozen=True)
class Decision:
    """One choice of a run.

    Attributes
    ----------
    subject : str
        ``"stiffness"``, ``"film"`` or ``"Fourier order"``.
    choice : str
        As the scene would name it.
    asked : bool
        Whether the scene named it itself.
    effect : float or None
        Relative change of the figure by the choice; None where it is unknown.
    share : float or None
        What it may be at most; None where nothing had to be decided.
    seconds : float or None
        Cost that is foreseen [s].
    reason : str
        Why, with its numbers.
    candidates : tuple of Candidate
        All that were weighed.
    """

    subject: str
    choice: str
    asked: bool
    reason: str
    effect: float | None = None
    share: float | None = None
    seconds: float | None = None
    candidates: tuple[Candidate, ...] = ()

    @property
    def line(self) -> str:
        """The decision in one line."""
        return f"{self.subject}: {self.reason}"

    def plain(self) -> dict[str, Any]:
        """Plain values, for files."""
        return asdict(self)


def per_cent(value: float) -> str:
    """Write a relative value in per cent with two digits."""
    return f"{float(f'{100 * value:.2g}'):g} %"


def decisions(values: Mapping[str, Any]) -> tuple[Decision, ...]:
    """Decisions among the results of stages, in the order in which they were made."""
    plan, fourier = values.get("plan"), values.get("fourier")
    series = None if fourier is None else fourier.decision
    return (*(() if plan is None else plan.decisions), *(() if series is None else (series,)))


def signed(value: float) -> str:
    """Write a relative change in per cent with its sign."""
    return f"{'-' if value < 0 else '+'}{per_cent(abs(value))}"
