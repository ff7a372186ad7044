"""What fem refuses, with every fault named at once."""

from __future__ import annotations

from base import Fault, InputError

__all__ = ["Fault", "FemError"]


class FemError(InputError):
    """Input that the elasticity or the contact cannot use; ``faults`` lists all that is wrong."""

    def __init__(self, *faults: Fault) -> None:
        super().__init__(faults)

    def __reduce__(self) -> tuple[type, tuple[object, ...]]:
        """Let workers hand the error back: its faults are its arguments."""
        return type(self), self.faults
