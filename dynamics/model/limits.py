"""What every parameter and argument may be, each stated once."""

from __future__ import annotations

from collections.abc import Mapping, Sequence, Set
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from base import Array, Faults, Limit
from dynamics.model.options import OPTIONS

NUMBER = Limit(remedy="give a finite number")
POSITIVE = Limit(0.0, low_open=True, remedy="give a positive number")

OSCILLATOR: Mapping[str, Limit] = {
    "damping_ratio": Limit(0.0, remedy="a mesh has 0.03 to 0.1"),
    "mean_force": NUMBER,
    "error_amplitude": NUMBER,
    "frequency": Limit(0.0, low_open=True, remedy="give mesh over natural frequency"),
    "half_backlash": Limit(0.0, remedy="give half the backlash, without sign"),
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


PERIODS = Whole(1, 10**9, "give a positive number of periods")
ORBIT_PERIODS = Whole(1, 100_000, "give the number of excitation periods")
SEARCHED = Whole(1, 1000, "give excitation periods")
"""Periods of orbits that are searched for."""
AVERAGED = Whole(OPTIONS.batches, 10**9, "10 000 gives two digits in chaos")
TRANSIENT = Whole(0, 10**9, "give 0 or more")
PATIENT = Whole(1, 10**7, "give more")
"""Periods that a start is followed for."""
POINTS = Whole(1, 10**6, "200 draws a smooth curve")
KEPT = Whole(2, 10**7, "keep at least twice max_period")
LONGEST_PERIOD = Whole(1, 10_000, "16 is usual")
NEWTON_STEPS = Whole(1, 100_000, "60 is ample")
MAX_POINTS = Whole(1, 10**7, "5000 is usual")
STARTS = Whole(1, 100_000, "give the number of values")
REFINEMENT = Whole(1, 1000, "2 is enough for an error estimate")
TAYLOR_DEGREE = Whole(6, 60, "13 leaves rounding alone")


def ordered(
    faults: Faults, path: str, bounds: Sequence[float], remedy: str = "give (low, high)"
) -> tuple[float, float]:
    """Two finite numbers, the lower first; faults are noted."""
    low, high = (faults.number(f"{path}[{i}]", bounds[i], NUMBER) for i in range(2))
    if not low < high:
        faults.add(path, tuple(bounds), "must have the lower value first", remedy)
    return low, high


def whole_numbers(faults: Faults, path: str, values: int | Sequence[int], limit: Whole) -> list[int]:
    """Different whole numbers in order, of a sequence or one alone; faults are noted."""
    several = values if isinstance(values, Sequence | np.ndarray | Set) else [values]
    return sorted({faults.whole(path, number, *limit) for number in several})


def checked_grid(faults: Faults, path: str, grid: npt.ArrayLike) -> Array:
    """Finite numbers in one dimension, at least one; faults are noted."""
    values = np.atleast_1d(np.asarray(grid, dtype=np.float64))
    if values.ndim != 1 or len(values) == 0 or not np.all(np.isfinite(values)):
        allowed = "must be finite numbers in one dimension"
        faults.add(path, f"shape {values.shape}", allowed, "give at least one value")
    return values


def checked_axis(faults: Faults, path: str, axis: tuple[float, float, int]) -> Array:
    """Equally spaced values from (first, last, number); faults are noted."""
    if len(axis) != 3:
        faults.add(path, axis, "must be (first, last, number)", "give three numbers")
        return np.zeros(1)
    low, high = (faults.number(f"{path}[{i}]", axis[i], NUMBER) for i in range(2))
    count = faults.whole(f"{path}[2]", axis[2], *STARTS)
    return np.linspace(low, high, count) if np.isfinite(low + high) else np.zeros(1)
