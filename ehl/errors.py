"""Exceptions and warnings of the line-contact solver."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass

__all__ = ["EhlInputError", "EhlWarning", "Fault"]


@dataclass(frozen=True)
class Fault:
    """One thing that is wrong with the input.

    Parameters
    ----------
    where : str
        Attribute path as the caller knows it, for example ``"lubricant.viscosity"``.
    value : str
        What was given.
    allowed : str
        What is allowed there.
    remedy : str
        What to do about it.
    """

    where: str
    value: str
    allowed: str
    remedy: str

    def __str__(self) -> str:
        """Return the fault on one line."""
        return f"{self.where} = {self.value}: must be {self.allowed}; {self.remedy}"


class EhlInputError(ValueError):
    """Input that the solver refuses, with every fault at once in ``faults``."""

    def __init__(self, faults: Iterable[Fault]) -> None:
        self.faults: tuple[Fault, ...] = tuple(faults)
        super().__init__("\n".join(str(f) for f in self.faults))

    def __reduce__(self) -> tuple[type[EhlInputError], tuple[tuple[Fault, ...]]]:
        """Rebuild from the faults, so that the error survives a process boundary."""
        return (type(self), (self.faults,))


class EhlWarning(UserWarning):
    """Input outside the range of a formula, which can be computed all the same."""


def number_fault(
    where: str, value: object, *, low: float, high: float, remedy: str, open_low: bool = True
) -> list[Fault]:
    """Return the fault of a number outside (low, high], or an empty list.

    NaN, infinities, booleans and things that are no real number are always faults.
    """
    bracket = "(" if open_low else "["
    allowed = f"a number in {bracket}{low:g}, {high:g}]"
    try:
        x = float(value)  # type: ignore[arg-type]
    except (TypeError, ValueError):
        return [Fault(where, repr(value), allowed, remedy)]
    if isinstance(value, bool) or not math.isfinite(x) or not (low < x if open_low else low <= x) or x > high:
        return [Fault(where, repr(value), allowed, remedy)]
    return []
