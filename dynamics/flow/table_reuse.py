"""Tables of the exact flow for one value of a parameter after another."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from base import Array
from dynamics.flow.exact_flow import DEGREE, ExactFlow, sufficient_degree
from dynamics.model.oscillator import GearOscillator


class TableReuse:
    """Tables along a parameter, each of which stands until the next is made: what does not change is not made again.

    Forces touch the forced motion alone, backlash none of the motions that are tabulated. Numbers are those of fresh
    tables to the last bit.

    Parameters
    ----------
    oscillator : GearOscillator
        The oscillator; its own value of the parameter is not used.
    parameter : str
        One of its `parameters`.
    tolerance : float, optional
        As of `dynamics.flow.exact_flow.tables`.
    """

    def __init__(self, oscillator: GearOscillator, parameter: str, tolerance: float | None) -> None:
        from dynamics.kernels.tables import first_touched

        packed = oscillator.packed()
        change = np.zeros((1, len(packed)))
        change[0, oscillator.places(parameter)] = 1.0
        self.first = int(getattr(first_touched, "py_func", first_touched)(packed, change))
        self.tolerance = tolerance
        self._kept: dict[tuple[int, int], Any] = {}

    def at(self, oscillator: Any) -> ExactFlow:
        """Tables of the oscillator with another value of the parameter."""
        degree = DEGREE if self.tolerance is None else sufficient_degree(oscillator, self.tolerance)
        return self.made(oscillator.packed(), math.ceil(oscillator.cells), degree)

    def made(self, packed: Array, cells: int, degree: int) -> ExactFlow:
        """Tables of a packed oscillator, with so many cells per period."""
        from dynamics.kernels.tables import fill, room_of, tables_of

        known = (cells, degree) in self._kept
        if not known:
            self._kept[cells, degree] = (*tables_of(cells, degree), room_of(cells, degree))
        coef, edge, room = self._kept[cells, degree]
        fill(packed, coef, edge, room, self.first if known else 0)
        return ExactFlow(packed, coef, edge, self.made)
