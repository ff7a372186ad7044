"""Search for the meniscus that lets pass what an oil layer brings: a root in the logarithm of its distance."""

from __future__ import annotations

import math
import sys
from dataclasses import dataclass

from ehl.discrete.method import METHOD

_FARTHEST = 1.5  # most that ln(distance) changes at once
_NEAREST = 1e-6  # a change too small to help a start that fails
_FLATTEST = 1e-3  # slope of ln(flow) over ln(distance) below which it says nothing
_USUAL_SLOPE = 0.5
_ROUNDED = 4.0 * sys.float_info.epsilon  # of the place of the meniscus, which is about one half-width


@dataclass
class MeniscusSearch:
    """Secant of ln(flow over layer) by ln(distance), kept between places whose flow is known to miss on either side.

    A flow that is known roughly serves the secant and bounds nothing: it may miss on the other side. A place that could
    not be solved says nothing about the root: the next one is tried half as far from the last solution, and steps grow
    again once one succeeds.
    """

    ln_distance: float  # ln of the distance of the last solution from the dry contact [half-widths]
    miss: float  # ln(flow/layer) there
    low: float = -math.inf  # nearer than the root
    high: float = math.inf  # farther
    rough: bool = False  # whether the flow of the last solution is known roughly
    enough: float = METHOD.layer_flow  # miss that ends the search
    slope: float = _USUAL_SLOPE
    reach: float = _FARTHEST
    target: float = math.nan  # place to be tried

    @classmethod
    def at(
        cls, distance: float, miss: float, slope: float = _USUAL_SLOPE, enough: float = METHOD.layer_flow
    ) -> MeniscusSearch:
        """Begin at a solution, a distance [half-widths] ahead of the dry contact."""
        search = cls(math.log(distance), miss, slope=slope, enough=enough)
        search._aim()
        return search

    @property
    def distance(self) -> float:
        """Distance to be tried [half-widths]."""
        return math.exp(self.target)

    @property
    def step(self) -> float:
        """Change of ln(distance) from the last solution to the place to be tried."""
        return self.target - self.ln_distance

    @property
    def done(self) -> bool:
        """Whether the flow is that of the layer, to within what the rounding of the place makes of it."""
        return abs(self.miss) < max(self.enough, abs(self.slope) * _ROUNDED * math.exp(-self.ln_distance))

    @property
    def stuck(self) -> bool:
        """Whether no place is left to be tried."""
        return self.reach < _NEAREST or self.target == self.ln_distance

    def failed(self) -> None:
        """Go half as far."""
        self.reach = 0.5 * abs(self.target - self.ln_distance)
        self._aim()

    def solved(self, miss: float, *, rough: bool = False) -> None:
        """Take the solution at the target."""
        self.slope = (miss - self.miss) / (self.target - self.ln_distance)
        self.ln_distance, self.miss, self.rough = self.target, miss, rough
        self.reach = min(2.0 * self.reach, _FARTHEST)
        self._aim()

    def corrected(self, miss: float) -> None:
        """Take a better solution at the place of the last."""
        self.miss, self.rough = miss, False
        self._aim()

    def _aim(self) -> None:
        if not self.rough and self.miss < 0.0:
            self.low = self.ln_distance
        elif not self.rough:
            self.high = self.ln_distance
        step = -self.miss / max(self.slope, _FLATTEST)
        if not self.low < self.ln_distance + step < self.high:
            step = 0.5 * ((self.high if self.miss < 0.0 else self.low) - self.ln_distance)
        self.target = self.ln_distance + max(-self.reach, min(self.reach, step))
