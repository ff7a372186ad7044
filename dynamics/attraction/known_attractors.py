"""Known attractors, and which of them starts reach."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from base import Array, Integers
from dynamics.flow.protocol import Flow


class KnownAttractors:
    """Periodic attractors that starts are followed to.

    Parameters
    ----------
    flow : Flow
        Of the oscillator.
    points : sequence of ndarray, shape (n, dimension), or None
        States of each attractor after every excitation period; None for one that is not periodic.
    nearness : float
        Distance that counts as arrived, over the size of the largest of them.
    """

    def __init__(self, flow: Flow, points: Sequence[Array | None], nearness: float) -> None:
        rows = [
            np.column_stack([p, np.full(len(p), i), np.full(len(p), len(p))])
            for i, p in enumerate(points)
            if p is not None
        ]
        self.flow, self.number = flow, len(points)
        self.rows = np.vstack(rows) if rows else np.zeros((0, flow.dimension + 2))
        self.size = float(np.max(np.abs(self.rows[:, :-2]), initial=0.0))
        self.radius = nearness * self.size
        self.periods = 0

    def settle(self, starts: Array, limit: int, labels: Integers | None = None) -> Integers:
        """Index of the attractor that each start reaches within some periods; negative for none.

        The starts are replaced by their last states. Those with a label other than -1 already are left alone.
        """
        indices = np.full(len(starts), -1, dtype=np.int64) if labels is None else labels
        self.periods += self.flow.settle(starts, self.rows, self.radius, limit, indices)
        return indices
