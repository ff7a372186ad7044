"""What the package raises and warns with: every fault of an input at once, each with its remedy."""

from __future__ import annotations

from dataclasses import dataclass

import base


@dataclass(frozen=True)
class Fault(base.Fault):
    """One thing that is wrong with an input.

    Parameters
    ----------
    where : str
        Attribute path as the caller knows it, e.g. ``pinion.teeth``.
    value : str
        What was given, or what follows from it.
    allowed : str
        What would be accepted.
    remedy : str
        What to change.
    """

    where: str
    value: str
    allowed: str
    remedy: str

    def __str__(self) -> str:
        """One line: where, value, what is allowed, remedy."""
        return f"{self.where} = {self.value}: allowed {self.allowed}; {self.remedy}"


class GearsError(base.InputError):
    """Base of the package's exceptions.

    Parameters
    ----------
    faults : iterable of Fault
        All faults that were found; kept as the tuple ``faults``.
    """


class GeometryError(GearsError):
    """Gears that cannot exist or cannot run together, or values that no gear has."""


class LoadSharingError(GearsError):
    """A load-sharing problem that is ill posed or whose iteration found no solution."""


class GeometryWarning(UserWarning):
    """A geometry that can be computed but that practice avoids."""


class ModelRangeWarning(UserWarning):
    """A closed form used outside the range for which it was fitted or derived."""
