"""What is wrong with a user's input: where, what was found, what is allowed, what to do."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass


@dataclass(frozen=True)
class Fault:
    """One fault of a scene or of a command.

    Attributes
    ----------
    where : str
        Path of the key, such as ``pair.pinion.teeth``, or the file.
    value : str
        What was found there, as text; empty where nothing was found.
    allowed : str
        What may stand there.
    remedy : str
        What the user can do about it; may be empty.
    """

    where: str
    value: str
    allowed: str
    remedy: str = ""

    def __str__(self) -> str:
        """One line: where, value, what is allowed, remedy."""
        found = f" = {self.value}" if self.value else ""
        remedy = f". {self.remedy}" if self.remedy else ""
        return f"{self.where}{found}: {self.allowed}{remedy}"


class InputError(ValueError):
    """The input cannot be used; lists every fault found.

    Attributes
    ----------
    faults : tuple of Fault
        All faults, in the order of the file.
    """

    def __init__(self, faults: Iterable[Fault]) -> None:
        self.faults = tuple(faults)
        super().__init__("\n".join(str(fault) for fault in self.faults))


def told_by_a_floor(error: ValueError) -> InputError | None:
    """Bring the error of a ground floor, which lists its faults as ours does, into ours; None for any other."""
    faults = getattr(error, "faults", None)
    if not isinstance(faults, tuple):
        return None
    return InputError(Fault(f.where, f.value, f.allowed, f.remedy) for f in faults)


class SolverError(RuntimeError):
    """A solver did not reach a result that it believes; the message holds the remedy."""


def shorten(value: object, limit: int = 60) -> str:
    """Text of a value for a message, cut to `limit` characters."""
    text = repr(value)
    return text if len(text) <= limit else text[: limit - 3] + "..."
