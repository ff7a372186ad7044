"""Records of a branch of periodic orbits over one parameter: its special points, and its stretches of one label."""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import groupby
from typing import Any, Protocol, TypeVar

import numpy as np
import numpy.typing as npt

from base import Array, Booleans, Cost, InputError, part, quantity, record
from dynamics.model.arrays import AsArray
from dynamics.model.reasons import FLOW

MEETS = "meets the branch of half the period"
UNBOUNDED = "the motion grows without bound"
GOOD_ENDS = ("bound", "closed", MEETS, UNBOUNDED)
KINDS = ("saddle-node", "period-doubling", "grazing")
NEIMARK_SACKER = "neimark-sacker"
"""Kind of special point that branches of several freedoms, or of damping by the motion, have besides."""


@record
class SpecialPoint:
    """A special point."""

    no_error = FLOW

    headline = ("kind", "parameter", "label")

    kind: str = quantity("", "grazing, saddle-node, period-doubling or neimark-sacker")
    parameter: float = quantity("1", "value of the parameter", error="error")
    state: Array = quantity("1", "X and V at tau = 0", "state")
    multipliers: npt.NDArray[np.complex128] | Array = quantity("1", "Floquet multipliers", "multiplier")
    label: str = quantity(
        "",
        "motion at the point; at a grazing the touch itself is not counted and a U says that the motion is unstable, "
        "at the other kinds it is marginal",
    )
    error: float = quantity("1", "estimated relative error of the parameter value")
    periods: int = quantity("1", "period of the orbit, in excitation periods", default=1)
    boundary: int = quantity("1", "at a grazing 1 for X = D, -1 for X = -D; else 0", default=0)
    tau: float = quantity("1", "time of the touch at a grazing; else nan", default=math.nan)
    acceleration: float = quantity("1", "X'' at the touch of a grazing; else nan", default=math.nan)
    stiffness: float = quantity(
        "1",
        "K at the touch of a grazing, which with the acceleration gives the square-root law of the multipliers; else "
        "nan",
        default=math.nan,
    )


class OfKind(Protocol):
    """What has a kind."""

    @property
    def kind(self) -> str:
        """Its name."""


Marked = TypeVar("Marked", bound=OfKind)


def of_kind(points: Sequence[Marked], kind: str, kinds: Sequence[str]) -> list[Marked]:
    """Points of one kind, in their order.

    Parameters
    ----------
    points : sequence
        Special points or points of codimension two.
    kind : str
        One of `kinds`.
    kinds : sequence of str
        The kinds there are.

    Raises
    ------
    InputError
        If there is no such kind.
    """
    if kind not in kinds:
        raise InputError.at("kind", kind, f"must be one of {', '.join(kinds)}", "name one of these")
    return [p for p in points if p.kind == kind]


@record
class Branch(AsArray):
    """A branch of periodic orbits."""

    no_error = FLOW

    headline = ("parameter", "periods")

    parameter: str = quantity("", "what was varied")
    periods: int = quantity("1", "period of the orbits, in excitation periods")
    values: Array = quantity("1", "parameter along the branch", "point")
    states: Array = quantity("1", "X and V at tau = 0, or displacements and speeds", "point coordinate")
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
    meetings: tuple[SpecialPoint | None, SpecialPoint | None] = quantity(
        "",
        "period doubling of the branch of half the period at which the first and the last end lies; None at an end for "
        "another reason",
        "end",
        default=(None, None),
    )
    oscillator: Any = part(
        "what moves, at a value of the parameter that does not count; None of a branch that was put together",
        default=None,
    )

    def special(self, kind: str) -> list[SpecialPoint]:
        """Special points of one kind, in their order along the branch.

        Parameters
        ----------
        kind : str
            "saddle-node", "period-doubling", "grazing" or "neimark-sacker", which the exact flow in one freedom never
            meets.

        Raises
        ------
        InputError
            If there is no such kind.
        """
        return of_kind(self.points, kind, (*KINDS, NEIMARK_SACKER))

    def columns(self) -> Array:
        """Columns parameter, then those of the state."""
        return np.column_stack([self.values, self.states])


@record
class Stretch:
    """Neighbouring orbits of a branch with one label."""

    no_error = FLOW

    headline = ("label", "low", "high")

    label: str = quantity("", "n-p-q or Un-p-q")
    stable: bool = quantity("1", "stability of all its orbits")
    periods: int = quantity("1", "period, in excitation periods")
    low: float = quantity("1", "minimum parameter value")
    high: float = quantity("1", "maximum parameter value")
    begins: SpecialPoint | None = quantity(
        "", "special point at its first orbit; None at an end of the branch"
    )
    ends: SpecialPoint | None = quantity("", "special point at its last orbit; None at an end of the branch")
    value: float = quantity("1", "parameter of an orbit in the middle of the range")
    state: Array = quantity("1", "X and V of that orbit at tau = 0", "state")

    @property
    def limits(self) -> tuple[SpecialPoint, ...]:
        """The special points at its ends."""
        return tuple(point for point in (self.begins, self.ends) if point is not None)


def stretches(branch: Branch) -> tuple[Stretch, ...]:
    """Cut a branch where its label changes.

    Parameters
    ----------
    branch : Branch
        The branch.

    Returns
    -------
    tuple of Stretch
        In their order along the branch. One that lies between two neighbouring points of the branch is left out.

    Examples
    --------
    >>> from dynamics import FourierStiffness, GearOscillator, continue_branch, find_orbit
    >>> osc = GearOscillator(FourierStiffness(1.0, (0.18,), (0.0,)), 0.05, 0.1, 0.2, 0.64, half_backlash=0.2)
    >>> branch = continue_branch(find_orbit(osc, (0.35, 0.0)), "frequency", (0.62, 0.67))
    >>> [stretch.label for stretch in stretches(branch)]
    ['1-0-0', '1-1-0', 'U1-1-0']
    """
    pieces, first = [], 0
    for label, run in groupby(branch.labels):
        count = len(list(run))
        last = first + count - 1
        begins = _between(branch, first - 1) if first > 0 else None
        ends = _between(branch, last) if last + 1 < len(branch.values) else None
        values = branch.values[first : last + 1]
        marks = [p.parameter for p in (begins, ends) if p is not None]
        low, high = min([*values.tolist(), *marks]), max([*values.tolist(), *marks])
        middle = first + int(np.argmin(np.abs(values - 0.5 * (low + high))))
        pieces.append(
            Stretch(
                label, bool(branch.stable[middle]), branch.periods, low, high, begins, ends,
                float(branch.values[middle]), branch.states[middle].copy(),
            )
        )  # fmt: skip
        first += count
    return tuple(pieces)


def _between(branch: Branch, i: int) -> SpecialPoint | None:
    """Special point between point i and the next, the nearest to the middle of their chord if there are several."""
    if not branch.points:
        return None
    width = max(float(np.ptp(branch.values)), 1e-300)
    size = max(float(np.max(np.abs(branch.states))), 1e-300)

    def place(value: float, state: Array) -> Array:
        return np.append(value / width, state / size)

    a, b = (place(float(branch.values[k]), branch.states[k]) for k in (i, i + 1))
    gaps = [float(np.linalg.norm(place(p.parameter, p.state) - 0.5 * (a + b))) for p in branch.points]
    nearest = int(np.argmin(gaps))
    return branch.points[nearest] if gaps[nearest] <= float(np.linalg.norm(b - a)) else None
