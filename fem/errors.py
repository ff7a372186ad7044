"""What fem refuses, with every fault named at once, and what it warns of."""

from __future__ import annotations

from dataclasses import dataclass

__all__ = ["Fault", "FemError", "FemWarning"]


@dataclass(frozen=True)
class Fault:
    """One fault: where it is, what was found, what is allowed and what helps."""

    where: str
    value: str
    allowed: str
    remedy: str

    def __str__(self) -> str:
        """One line: where, value, what is allowed, remedy."""
        return f"{self.where} = {self.value}: allowed {self.allowed}; {self.remedy}"


class FemError(ValueError):
    """Input that the elasticity or the contact cannot use.

    Attributes
    ----------
    faults : tuple of Fault
    """

    def __init__(self, *faults: Fault) -> None:
        self.faults = faults
        super().__init__("\n".join(str(fault) for fault in faults))


class FemWarning(UserWarning):
    """A result that can be computed, but outside the range where it is trusted."""
