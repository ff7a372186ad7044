"""Bulk temperatures at which a mesh's losses are taken away, sought round by round."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

__all__ = ["BulkTrial"]


@dataclass(frozen=True)
class BulkTrial:
    """Bulk temperatures that were tried, and those that their losses ask for.

    Attributes
    ----------
    bulk : (float, float)
        Of pinion and wheel [K].
    asked : (float, float)
        At which the losses are taken away [K].
    before : BulkTrial or None
        The trial before.
    """

    bulk: tuple[float, float]
    asked: tuple[float, float]
    before: BulkTrial | None

    @property
    def change(self) -> float:
        """Larger difference of what is asked for from what was tried [K]."""
        return float(np.max(np.abs(np.subtract(self.asked, self.bulk))))

    @property
    def following(self) -> tuple[float, float]:
        """Temperatures to try next [K]: their mean by a secant, what they differ by as it is asked for."""
        if not self.change:
            return self.bulk
        at, wanted = self._means
        slope = 0.0
        if self.before is not None and at != (last := self.before._means)[0]:
            slope = float(np.clip((wanted - last[1]) / (at - last[0]), -3.0, 0.5))
        mean = at + (wanted - at) / (1.0 - slope)
        apart = 0.5 * (self.asked[0] - self.asked[1])
        return mean + apart, mean - apart

    @property
    def _means(self) -> tuple[float, float]:
        """Mean of pinion and wheel, as tried and as asked for [K]."""
        return 0.5 * sum(self.bulk), 0.5 * sum(self.asked)
