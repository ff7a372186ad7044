"""What the package raises and warns with: every fault of an input at once, each with its remedy."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass


@dataclass(frozen=True)
class Fault:
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


class GearsError(ValueError):
    """Base of the package's exceptions.

    Parameters
    ----------
    faults : iterable of Fault
        All faults that were found; kept as the tuple ``faults``.
    """

    def __init__(self, faults: Iterable[Fault]) -> None:
        self.faults: tuple[Fault, ...] = tuple(faults)
        super().__init__(self.faults)

    def __str__(self) -> str:
        """Each fault on a line of its own."""
        return "\n".join(str(fault) for fault in self.faults)


class GeometryError(GearsError):
    """Gears that cannot exist or cannot run together, or values that no gear has."""


class LoadSharingError(GearsError):
    """A load-sharing problem that is ill posed or whose iteration found no solution."""


class GeometryWarning(UserWarning):
    """A geometry that can be computed but that practice avoids."""


class ModelRangeWarning(UserWarning):
    """A closed form used outside the range for which it was fitted or derived."""
