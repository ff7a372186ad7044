"""A point on a branch of any period map."""

from __future__ import annotations

from dataclasses import dataclass

from base import Array
from dynamics.branch_problem import PlanePoint

__all__ = ["MapPoint"]


@dataclass(frozen=True, eq=False)
class MapPoint(PlanePoint):
    """A state and its image under the map of n periods, at one value of the parameter.

    Parameters
    ----------
    u : ndarray, shape (3,)
        Unknowns: X and V over the scale, the parameter as a fraction of its range.
    values : ndarray, shape (1,)
        The parameter.
    period : float
        Excitation period, in tau.
    image : ndarray, shape (2,)
        Image of X and V over the scale.
    derivative : ndarray, shape (2, 3)
        Of the image with respect to the unknowns; its first two columns are the Jacobian.
    determinant : float
        Of the Jacobian.
    counts : tuple of int
        p and q.
    levels : ndarray, shape (s,)
        Values of X at which crossings are counted.
    extrema : ndarray, shape (k, 3)
        Phase in [0, 1) of n periods, X, X'' at every extremum of X.
    iterations : int
        Newton iterations spent.
    """

    u: Array
    values: Array
    period: float
    image: Array
    derivative: Array
    determinant: float
    counts: tuple[int, int]
    levels: Array
    extrema: Array
    iterations: int = 0

    @property
    def torus(self) -> float:
        """Product of the multipliers less 1: zero at a Neimark-Sacker point, if they are a pair."""
        return self.determinant - 1.0
