"""Bulk temperatures at which a mesh's losses are taken away, sought round by round."""

from __future__ import annotations

import numpy as np

__all__ = ["BulkBalance"]


class BulkBalance:
    """Bulk temperatures that are sought: the mean of both by secants, what they differ by as it comes."""

    def __init__(self) -> None:
        self.last: tuple[float, float] | None = None

    def next(self, tried: tuple[float, float], asked: tuple[float, float]) -> tuple[float, float]:
        """Temperatures to try next, after given ones have asked for others."""
        at, wanted = 0.5 * sum(tried), 0.5 * sum(asked)
        slope = 0.0
        if self.last is not None and at != self.last[0]:
            slope = float(np.clip((wanted - self.last[1]) / (at - self.last[0]), -3.0, 0.5))
        self.last = at, wanted
        mean = at + (wanted - at) / (1.0 - slope)
        apart = 0.5 * (asked[0] - asked[1])
        return mean + apart, mean - apart
