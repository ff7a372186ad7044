"""Rectangles of the plane of X and V."""

from __future__ import annotations

from typing import TypeAlias

import numpy as np

from base import Array, Booleans, Faults
from dynamics.limits import ordered

__all__ = ["Region", "checked_region", "within"]

Region: TypeAlias = tuple[tuple[float, float], tuple[float, float]]
"""((x0, x1), (v0, v1))"""


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
