"""Whether what is given is a pair of gears, or numbers."""

from __future__ import annotations

from numbers import Real

import numpy as np

from base import Array, Faults, shorten
from gears import GearPair

__all__ = ["check_pair", "numbers_of"]


def check_pair(faults: Faults, pair: object) -> bool:
    """Whether a pair is one; where it is not, note that."""
    return faults.instance("pair", pair, GearPair, "such as GearPair(Gear(24), Gear(31), 2e-3, 20e-3)")


def numbers_of(faults: Faults, name: str, value: object, remedy: str) -> Array:
    """One number or several as an array of their shape; where they are none, note that and return nan.

    Text that numpy would read as numbers is none.
    """
    try:
        numbers = np.asarray(value)
    except ValueError:  # sequences of different lengths
        numbers = np.array(None)
    real = numbers.dtype.kind in "iuf" or (
        numbers.dtype == object and all(isinstance(number, Real) for number in numbers.ravel().tolist())
    )
    if not real:
        faults.add(name, shorten(value), "must be a number, or a sequence of numbers", remedy)
        return np.full(1, np.nan)
    return np.asarray(numbers, dtype=float)
