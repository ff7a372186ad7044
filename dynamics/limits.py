"""What every parameter and argument may be, each stated once."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import NamedTuple

from base import Faults, Limit

__all__ = [
    "CONFIDENCE",
    "NUMBER",
    "OSCILLATOR",
    "POSITIVE",
    "RADIUS",
    "STEP",
    "STEP_TOLERANCE",
    "Whole",
    "ordered",
]

NUMBER = Limit(remedy="give a finite number")
POSITIVE = Limit(0.0, low_open=True, remedy="give a positive number")

OSCILLATOR: Mapping[str, Limit] = {
    "damping_ratio": Limit(0.0, remedy="a mesh has 0.03 to 0.1"),
    "mean_force": NUMBER,
    "error_amplitude": NUMBER,
    "frequency": Limit(0.0, low_open=True, remedy="give mesh over natural frequency"),
    "half_backlash": Limit(0.0, remedy="give half the play, without sign"),
    "error_phase": NUMBER,
}
"""Limits of an oscillator's own parameters, all of them dimensionless."""

STEP_TOLERANCE = Limit(2e-15, 0.1, remedy="1e-12 is usual")
"""Relative tolerance of the stepwise flow; below it rounding decides."""
STEP = Limit(0.0, 0.5, low_open=True, high_open=True, remedy="0.005 is usual")
"""Step of a continuation along its curve, in shares of the range."""
RADIUS = Limit(0.0, 0.1, low_open=True, high_open=True, remedy="1e-4 is usual")
"""Distance at which a motion counts as on an attractor, relative to the motions' size."""
CONFIDENCE = Limit(0.0, 1.0, low_open=True, high_open=True, remedy="0.95 is usual")


class Whole(NamedTuple):
    """Range of a whole number, for ``faults.whole(where, value, *range)``."""

    low: int
    high: int
    remedy: str


def ordered(
    faults: Faults, where: str, given: Sequence[float], remedy: str = "give (low, high)"
) -> tuple[float, float]:
    """Two finite numbers, the lower first; faults are noted."""
    low, high = (faults.number(f"{where}[{i}]", given[i], NUMBER) for i in range(2))
    if not low < high:
        faults.add(where, tuple(given), "must have the lower value first", remedy)
    return low, high
