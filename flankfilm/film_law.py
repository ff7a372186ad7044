r"""What a film props two flanks apart by, as a function of the force, around a solved film.

Near a solved film at the force :math:`F_0` the prop follows

.. math:: s(F) = s_0 \, (F/F_0)^{-n}, \qquad n = F_0 / (k \, s_0),

which meets value and slope :math:`ds/dF = -1/k` there, stays positive and falls with the force: the form that
every film formula has. Iterated with new films it needs two or three rounds, where a straight line
can turn negative at small forces.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


_LEAST_RATIO = 0.01


@dataclass(frozen=True, eq=False)
class FilmLaw:
    """Props of all pairs at all positions of a mesh cycle, as load sharing takes them.

    Attributes
    ----------
    force : ndarray, shape (positions, pairs)
        Force at which the film was solved [N]; any positive number where `prop` is zero.
    prop : ndarray, shape (positions, pairs)
        Prop there [m]; zero for pairs without film.
    exponent : ndarray, shape (positions, pairs)
        n, at least zero [-].
    """

    force: Array
    prop: Array
    exponent: Array

    def __call__(self, rho1: Array, forces: Array) -> tuple[Array, Array]:
        """Prop [m] and its slope [m/N]; the law is tied to its places already."""
        return self.approach(forces), self.slope(forces)

    def approach(self, force: Array) -> Array:
        """Prop of each pair at the given forces [N], shape (positions, pairs) [m].

        A force below a hundredth of the solved one is taken as that hundredth: the power law would
        grow without bound where the pair lets go.
        """
        return np.asarray(self.prop * self._ratio(force) ** -self.exponent)

    def slope(self, force: Array) -> Array:
        """Derivative of the prop by the force, shape (positions, pairs) [m/N]."""
        ratio = self._ratio(force)
        falling = -self.exponent * self.prop * ratio**-self.exponent / (ratio * self.force)
        return np.where(ratio > _LEAST_RATIO, falling, 0.0)

    def stiffness(self) -> Array:
        """Film stiffness at the solved forces, infinite without film, shape (positions, pairs) [N/m]."""
        yielding = self.exponent * self.prop
        return np.divide(self.force, yielding, out=np.full_like(yielding, np.inf), where=yielding > 0)

    def _ratio(self, force: Array) -> Array:
        return np.maximum(force / self.force, _LEAST_RATIO)
