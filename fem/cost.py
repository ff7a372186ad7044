"""What a result cost."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

__all__ = ["Cost"]


@dataclass(frozen=True)
class Cost:
    """What a result cost.

    Attributes
    ----------
    seconds : float
        Wall time of the whole.
    unknowns : int
        Displacement components that were factorised: one sector of each gear, finest mesh.
    annulus_unknowns : int
        Those of the two whole annuli that the sectors stand for.
    iterations : int
        Newton iterations of the load sharing, all positions together; 0 for a compliance.
    parts : mapping of str to float
        Seconds by stage: mesh, assemble, factor, condense, solve, tips; contact for a mesh cycle.
    """

    seconds: float
    unknowns: int
    iterations: int = 0
    annulus_unknowns: int = 0
    parts: Mapping[str, float] = field(default_factory=dict)
