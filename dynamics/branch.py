"""Record of a branch of periodic orbits over one parameter."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from base import Array, Booleans, Cost, part, quantity, record
from dynamics.arrays import AsArray
from dynamics.special import SpecialPoint, of_kind

__all__ = ["GOOD_ENDS", "KINDS", "MEETS", "UNBOUNDED", "Branch"]

MEETS = "meets the branch of half the period"
UNBOUNDED = "the motion grows without bound"
GOOD_ENDS = ("bound", "closed", MEETS, UNBOUNDED)
KINDS = ("saddle-node", "period-doubling", "grazing")


@record
class Branch(AsArray):
    """A branch of periodic orbits."""

    headline = ("parameter", "periods")

    parameter: str = quantity("", "what was varied")
    periods: int = quantity("1", "period of the orbits, in excitation periods")
    values: Array = quantity("1", "parameter along the branch", "point")
    states: Array = quantity("1", "X and V at tau = 0", "point coordinate")
    multipliers: npt.NDArray[np.complex128] = quantity("1", "Floquet multipliers", "point multiplier")
    stable: Booleans = quantity("1", "stability", "point")
    labels: tuple[str, ...] = quantity("", "n-p-q or Un-p-q", "point")
    points: tuple[SpecialPoint, ...] = part("special points in their order along the branch")
    ended: tuple[str, str] = quantity("", "why the branch ended at its first and at its last point", "end")
    error: float = quantity("1", "largest estimated relative error of a special point's parameter")
    cost: Cost
    converged: bool = quantity(
        "1", "whether both ends were reached for a good reason (a bound, the start again, the branch of half the "
        "period, motion without bound, to which resonances lead) and every special point seen was located"
    )  # fmt: skip
    message: str = quantity("", "what happened, with a remedy if not converged")

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

    def columns(self) -> Array:
        """Columns parameter, X, V."""
        return np.column_stack([self.values, self.states])
