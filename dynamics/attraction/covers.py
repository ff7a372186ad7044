"""Where a chaotic attractor lies: the cells of the plane that its motions pass, with a margin."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from base import Array, Booleans
from dynamics.model.options import OPTIONS


@dataclass(frozen=True, eq=False)
class Cover:
    """Cells of the plane that an attractor passes, with a margin."""

    low: Array
    size: Array
    cells: Booleans

    @classmethod
    def of(cls, states: Array, side: int = OPTIONS.cover_cells, margin: int = OPTIONS.cover_margin) -> Cover:
        """Cover of states (n, 2), so many cells along each side of the attractor and around it."""
        low, high = states.min(axis=0), states.max(axis=0)
        size = np.maximum(high - low, 1e-12) / side
        marked = np.zeros((side + 2 * margin + 1,) * 2, dtype=bool)
        at = np.minimum(((states - low) / size).astype(int), side - 1) + margin
        marked[at[:, 0], at[:, 1]] = True
        grown = np.zeros_like(marked)
        for i in range(-margin, margin + 1):
            for j in range(-margin, margin + 1):
                grown |= np.roll(marked, (i, j), axis=(0, 1))
        return cls(low - margin * size, size, grown)

    def outside(self, states: Array) -> Booleans:
        """Which of the states (n, 2) lie in no cell."""
        at = np.floor((states - self.low) / self.size)
        inside = np.all((at >= 0) & (at < len(self.cells)), axis=1)
        place = np.where(inside[:, None], at, 0).astype(int)
        return np.asarray(~(inside & self.cells[place[:, 0], place[:, 1]]))
