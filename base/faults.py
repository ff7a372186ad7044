"""What is wrong with an input: where, what was found, what must hold, what to do; all of it at once."""

from __future__ import annotations

import decimal
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Self


@dataclass(frozen=True)
class Fault:
    """One thing that is wrong with an input.

    Attributes
    ----------
    where : str
        Path of the value as its giver knows it: ``pinion.teeth``, ``pair.pinion.bore_mm``, a file.
    value : str
        What was given, as text; empty where nothing was.
    allowed : str
        What must hold, as the rest of the sentence: ``must be at most 3``, ``is required by the film``.
    remedy : str
        What to do about it; may be empty.
    """

    where: str
    value: str
    allowed: str
    remedy: str = ""

    @classmethod
    def of(cls, where: str | Path, value: object, allowed: str, remedy: str = "") -> Fault:
        """Fault of a value as it was given: a text is shown as it is, anything else by its representation."""
        return cls(str(where), value if isinstance(value, str) else shorten(value), allowed, remedy)

    def __str__(self) -> str:
        """One line: where, value, what must hold, remedy."""
        shown = f" = {self.value}" if self.value else ""
        remedy = f". {self.remedy[:1].upper()}{self.remedy[1:]}" if self.remedy else ""
        return f"{self.where}{shown}: {self.allowed}{remedy}"


class FlankfilmError(Exception):
    """Base of everything that these packages raise for their user's sake."""


class InputError(FlankfilmError, ValueError):
    """An input that cannot be used.

    Parameters
    ----------
    faults : iterable of Fault
        All that were found; kept as the tuple ``faults``.
    """

    def __init__(self, faults: Iterable[Fault]) -> None:
        self.faults: tuple[Fault, ...] = tuple(faults)
        super().__init__(self.faults)  # what pickle hands back, so that the error survives a worker's end

    @classmethod
    def at(cls, where: str | Path, value: object, allowed: str, remedy: str = "") -> Self:
        """Error of a single fault, whose arguments are those of `Fault.of`.

        Examples
        --------
        >>> raise InputError.at("tolerance", 2.0, "must be at most 0.2", "0.005 is usual")
        Traceback (most recent call last):
        base.faults.InputError: tolerance = 2.0: must be at most 0.2. 0.005 is usual
        """
        return cls([Fault.of(where, value, allowed, remedy)])

    def __str__(self) -> str:
        """Each fault on a separate line."""
        return "\n".join(str(fault) for fault in self.faults)


class SolverError(FlankfilmError, RuntimeError):
    """A solver did not reach a result that it believes; the message holds the remedy."""


class FlankfilmWarning(UserWarning):
    """Base of the packages' warnings."""


class RangeWarning(FlankfilmWarning):
    """A model used outside the range for which it was derived or fitted, or a result to be read with care."""


class PartWarning(FlankfilmWarning):
    """A part of what was asked for could not be computed; the others are there."""


def printable(text: object) -> str:
    r"""Text for one line of a terminal: control characters, which could draw or hide things there, are spelt out.

    Examples
    --------
    >>> printable("red\x1b[31m")
    'red\\x1b[31m'
    """
    return "".join(c if c.isprintable() else c.encode("unicode_escape").decode("ascii") for c in str(text))


def rounded_down(value: float, digits: int = 6) -> str:
    """Text of an upper bound, so rounded that the number which is read keeps it.

    Examples
    --------
    >>> rounded_down(0.0334567891), rounded_down(-1.23456, digits=3)
    ('0.0334567', '-1.24')
    """
    return _rounded(value, digits, decimal.ROUND_FLOOR)


def rounded_up(value: float, digits: int = 6) -> str:
    """Text of a lower bound, or of what is to be added, so rounded that the number which is read is enough.

    Examples
    --------
    >>> rounded_up(0.0334567891), rounded_up(1.0281, digits=4)
    ('0.0334568', '1.029')
    """
    return _rounded(value, digits, decimal.ROUND_CEILING)


def _rounded(value: float, digits: int, towards: str) -> str:
    context = decimal.Context(prec=digits, rounding=towards)
    return f"{float(context.create_decimal(repr(float(value)))):.{digits}g}"


def shorten(value: object, limit: int = 60) -> str:
    """Text of a value for a message, cut to `limit` characters.

    Examples
    --------
    >>> shorten([1, 2, 3, 4, 5, 6], limit=12)
    '[1, 2, 3,...'
    """
    text = repr(value)
    return text if len(text) <= limit else text[: limit - 3] + "..."
