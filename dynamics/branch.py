"""Record of a branch of periodic orbits over one parameter."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from base import Cost
from dynamics.special import SpecialPoint, of_kind

__all__ = ["GOOD_ENDS", "KINDS", "MEETS", "UNBOUNDED", "Branch"]

FloatArray = npt.NDArray[np.float64]
MEETS = "meets the branch of half the period"
UNBOUNDED = "the motion grows without bound"
GOOD_ENDS = ("bound", "closed", MEETS, UNBOUNDED)
KINDS = ("saddle-node", "period-doubling", "grazing")


@dataclass(frozen=True, eq=False)
class Branch:
    """A branch of periodic orbits.

    Parameters
    ----------
    parameter : str
        What was varied.
    periods : int
        Period of the orbits, in excitation periods.
    values : ndarray, shape (m,)
        Parameter along the branch.
    states : ndarray, shape (m, 2)
        X and V at tau = 0.
    multipliers : ndarray of complex, shape (m, 2)
        Floquet multipliers.
    stable : ndarray of bool, shape (m,)
        Stability.
    labels : tuple of str
        n-p-q or Un-p-q.
    points : tuple of SpecialPoint
        Special points in their order along the branch.
    ended : tuple of str
        Why the branch ended at its first and at its last point.
    error : float
        Largest estimated relative error of a special point's parameter.
    cost : Cost
        Effort.
    converged : bool
        Whether both ends were reached for a good reason (a bound, the start again, the branch of half the period,
        motion without bound, to which resonances lead) and every special point seen was located.
    message : str
        What happened, with a remedy if not converged.
    """

    parameter: str
    periods: int
    values: FloatArray
    states: FloatArray
    multipliers: npt.NDArray[np.complex128]
    stable: npt.NDArray[np.bool_]
    labels: tuple[str, ...]
    points: tuple[SpecialPoint, ...]
    ended: tuple[str, str]
    error: float
    cost: Cost
    converged: bool
    message: str

    def special(self, kind: str) -> list[SpecialPoint]:
        """Special points of one kind, in their order along the branch.

        Parameters
        ----------
        kind : str
            "saddle-node", "period-doubling" or "grazing"; "neimark-sacker", which the exact flow never meets.

        Raises
        ------
        InputError
            If there is no such kind.
        """
        return of_kind(self.points, kind, (*KINDS, "neimark-sacker"))

    def __array__(
        self, dtype: npt.DTypeLike | None = None, copy: bool | None = None
    ) -> npt.NDArray[np.generic]:
        """Columns parameter, X, V."""
        return np.column_stack([self.values, self.states]).astype(dtype if dtype is not None else np.float64)
