"""States: their check, how large motions are, and how far apart states lie."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from base import Array, Faults
from dynamics.protocol import Oscillator

__all__ = ["apart", "checked_state", "scale_of"]


def scale_of(oscillator: Oscillator, states: npt.ArrayLike) -> float:
    """Scale of a motion: its largest X or V, or what the oscillator's least size is if that is more; never zero."""
    return max(float(np.max(np.abs(states))), oscillator.floor)


def apart(state: npt.ArrayLike, states: Array) -> float:
    """Distance of a state to the nearest of several, in the largest norm."""
    return float(np.min(np.max(np.abs(states - np.asarray(state)), axis=1)))


def checked_state(state: npt.ArrayLike, where: str = "state") -> Array:
    """Return a fresh array of X and V, or raise InputError."""
    at = np.array(state, dtype=np.float64)
    if at.shape != (2,) or not np.all(np.isfinite(at)):
        faults = Faults()
        faults.add(where, at.tolist(), "must be two finite numbers, X and V", "give the state at tau = 0")
        faults.raise_if_any()
    return at
