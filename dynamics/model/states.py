"""States and rectangles of them: their checks, how large motions are, and how far apart states lie."""

from __future__ import annotations

from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from base import Array, Booleans, Faults, InputError
from dynamics.model.limits import ordered
from dynamics.model.protocol import Oscillator

Region: TypeAlias = tuple[tuple[float, float], tuple[float, float]]
"""((x0, x1), (v0, v1))"""


def scale_of(oscillator: Oscillator, states: npt.ArrayLike) -> float:
    """Scale of a motion: its largest X or V, or what the oscillator's smallest size is if that is more; never zero."""
    return max(float(np.max(np.abs(states))), oscillator.floor)


def apart(state: npt.ArrayLike, states: Array) -> float:
    """Distance of a state to the nearest of several, in the largest norm."""
    return float(np.min(np.max(np.abs(states - np.asarray(state)), axis=1)))


def checked_state(state: npt.ArrayLike, path: str = "state", size: int = 2) -> Array:
    """Return a fresh array of X and V, or of so many displacements and speeds, or raise InputError."""
    at = np.array(state, dtype=np.float64)
    if at.shape != (size,) or not np.all(np.isfinite(at)):
        allowed = "must be two finite numbers, X and V"
        if size != 2:
            allowed = f"must be {size} finite numbers, {size // 2} displacements and their speeds"
        raise InputError.at(path, at.tolist(), allowed, "give the state at tau = 0")
    return at


def start_state(oscillator: Oscillator, state: npt.ArrayLike | None, path: str = "state") -> Array:
    """The state that a motion starts at: that given, checked; at rest under the mean force without one."""
    return oscillator.rest_state() if state is None else checked_state(state, path, oscillator.dimension)


def checked_outputs(outputs: npt.ArrayLike | None, size: int) -> Array:
    """Outputs as rows of factors on a state.

    Raises
    ------
    InputError
        If they are not finite, or not as long as a state.
    """
    rows = np.zeros((0, size)) if outputs is None else np.array(outputs, dtype=np.float64)
    if rows.ndim != 2 or rows.shape[1] != size or not np.all(np.isfinite(rows)):
        allowed = f"must be finite numbers of shape (outputs, {size})"
        raise InputError.at("outputs", f"shape {rows.shape}", allowed, "one factor for each entry of a state")
    return rows


def checked_region(faults: Faults, region: Region) -> Region:
    """The rectangle as numbers; notes what is none, or out of order."""
    x, v = (
        ordered(faults, f"region[{k}]", side, "give ((x0, x1), (v0, v1))") for k, side in enumerate(region)
    )
    return x, v


def within(region: Region, states: Array) -> Booleans:
    """Which of some states lie in the rectangle; those that are nan do not."""
    low, high = np.array(region).T
    with np.errstate(invalid="ignore"):
        return np.asarray(np.all((states >= low) & (states <= high), axis=1))
