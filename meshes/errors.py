"""What meshes refuses, with every fault named at once."""

from __future__ import annotations

from dataclasses import dataclass

__all__ = ["Fault", "MeshError"]


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


class MeshError(ValueError):
    """The outline or the sizes cannot give a valid mesh.

    Attributes
    ----------
    faults : tuple of Fault
    """

    def __init__(self, *faults: Fault) -> None:
        self.faults = faults
        super().__init__("\n".join(str(fault) for fault in faults))
