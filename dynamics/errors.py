"""What is wrong with an input, all of it at once."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from numbers import Real

import base

__all__ = ["DynamicsError", "DynamicsWarning", "Fault", "Faults"]


@dataclass(frozen=True)
class Fault(base.Fault):
    """One fault of an input.

    Parameters
    ----------
    where : str
        Attribute path of the value, such as ``"stiffness.amplitudes[1]"``.
    value : str
        The value found.
    allowed : str
        What is allowed.
    remedy : str
        What to do.
    """

    where: str
    value: str
    allowed: str
    remedy: str

    def __str__(self) -> str:
        """Return the fault as one line."""
        return f"{self.where} = {self.value}: allowed {self.allowed}; {self.remedy}"


class DynamicsError(base.InputError):
    """Input that cannot be computed; lists every fault found.

    Parameters
    ----------
    faults : tuple of Fault
        All faults of the input.
    """


class DynamicsWarning(UserWarning):
    """An input that can be computed but lies outside the usual range, or a result to be read with care."""


class Faults:
    """Collector of faults; raises them together.

    Notes
    -----
    Booleans are refused as numbers: ``True`` in a list of amplitudes is a slip, not a one.
    """

    def __init__(self) -> None:
        self.found: list[Fault] = []

    def add(self, where: str, value: object, allowed: str, remedy: str) -> None:
        """Note a fault."""
        self.found.append(Fault(where, repr(value), allowed, remedy))

    def number(
        self,
        where: str,
        value: object,
        allowed: str = "a finite number",
        remedy: str = "give a finite number",
        accept: Callable[[float], bool] = lambda number: True,
    ) -> float:
        """Return the value as a float, or note a fault and return nan."""
        if isinstance(value, bool) or not isinstance(value, Real):
            self.add(where, value, allowed, remedy)
            return math.nan
        number = float(value)
        if not math.isfinite(number) or not accept(number):
            self.add(where, number, allowed, remedy)
            return math.nan
        return number

    def whole(self, where: str, value: object, low: int, high: int, remedy: str) -> int:
        """Return the value as an int within [low, high], or note a fault and return `low`."""
        number = self.number(
            where,
            value,
            f"a whole number from {low} to {high}",
            remedy,
            lambda n: n == int(n) and low <= n <= high,
        )
        return low if math.isnan(number) else int(number)

    def raise_if_any(self) -> None:
        """Raise all faults noted.

        Raises
        ------
        DynamicsError
            If there is at least one.
        """
        if self.found:
            raise DynamicsError(tuple(self.found))
