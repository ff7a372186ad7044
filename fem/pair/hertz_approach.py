"""Indentation of two flanks by the pressure between them, after Hertz: a law of each contact by itself."""

from __future__ import annotations

import numpy as np

from base import Array, record

__all__ = ["LEAST_FORCE", "HertzApproach"]

LEAST_FORCE = 1e-9
"""Force [N] below which the Hertz indentation is taken as linear, since its slope at zero is infinite."""


@record
class HertzApproach:
    """Indentation of both flanks of some pairs; see ``fem.elasticity.flamant``.

    approach = F (constant - per_log ln F), since the half-width grows as sqrt(F).

    Attributes
    ----------
    constant : (..., pairs) array
        [m/N]
    per_log : (..., pairs) array or float
        [m/N]
    """

    constant: Array
    per_log: Array | float

    def approach(self, force: Array) -> Array:
        """Indentation of both flanks together [m] under forces [N]; zero without force."""
        return np.asarray(force * (self.constant - self.per_log * np.log(np.maximum(force, LEAST_FORCE))))

    def slope(self, force: Array) -> Array:
        """Differentiate the indentation by the force [m/N]."""
        return self.value_and_slope(force)[1]

    def value_and_slope(self, force: Array) -> tuple[Array, Array]:
        """Both together."""
        secant = self.constant - self.per_log * np.log(np.maximum(force, LEAST_FORCE))
        inside = np.where(force > LEAST_FORCE, self.per_log, 0.0)
        return np.asarray(force * secant), np.asarray(secant - inside)
