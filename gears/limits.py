"""Limits of single input values: finite, of the right kind, within bounds."""

from __future__ import annotations

import math
from dataclasses import dataclass
from numbers import Integral, Real

from gears.errors import Fault


@dataclass(frozen=True)
class Limit:
    """Closed or half-open interval that a value must lie in.

    Parameters
    ----------
    low, high : float
        Bounds.
    unit : str
        Unit for the message.
    remedy : str
        What to do when a value is outside.
    low_open : bool
        True where the lower bound itself is refused.
    """

    low: float
    high: float
    unit: str
    remedy: str
    low_open: bool = False

    def __str__(self) -> str:
        """Interval in words."""
        below = "more than" if self.low_open else "at least"
        unit = f" {self.unit}" if self.unit else ""
        return f"a finite number, {below} {self.low:g} and at most {self.high:g}{unit}"

    def holds(self, value: float) -> bool:
        """Whether the interval contains `value`."""
        above = value > self.low if self.low_open else value >= self.low
        return above and value <= self.high

    def faults(self, where: str, value: object) -> tuple[Fault, ...]:
        """Faults of one value: not a number, not finite, or outside.

        Parameters
        ----------
        where : str
            Attribute path of the value.
        value : object
            The value as given.

        Returns
        -------
        tuple of Fault
            Empty when the value is in order.
        """
        if isinstance(value, bool) or not isinstance(value, Real):
            return (Fault(where, repr(value), str(self), "give a number"),)
        number = float(value)
        if not math.isfinite(number) or not self.holds(number):
            return (Fault(where, f"{number!r}", str(self), self.remedy),)
        return ()


def whole_number_faults(where: str, value: object, low: int, high: int, remedy: str) -> tuple[Fault, ...]:
    """Faults of a value that must be a whole number from `low` to `high`."""
    allowed = f"a whole number from {low} to {high}"
    if isinstance(value, bool) or not isinstance(value, Integral):
        return (Fault(where, repr(value), allowed, "give an integer"),)
    if not low <= int(value) <= high:
        return (Fault(where, str(int(value)), allowed, remedy),)
    return ()
