"""Exceptions and warnings of the line-contact solver."""

from __future__ import annotations

import math
from dataclasses import dataclass

import base

__all__ = ["EhlInputError", "EhlWarning", "Fault"]


@dataclass(frozen=True)
class Fault(base.Fault):
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


class EhlInputError(base.InputError):
    """Input that the solver refuses, with every fault at once in ``faults``."""


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
