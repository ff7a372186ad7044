"""Stretches of a branch that keep one label: where a motion exists, and what begins and ends it."""

from __future__ import annotations

from itertools import groupby

import numpy as np

from base import Array, quantity, record
from dynamics.branch import Branch
from dynamics.special import SpecialPoint

__all__ = ["Stretch", "stretches"]


@record
class Stretch:
    """Neighbouring orbits of a branch with one label."""

    headline = ("label", "low", "high")

    label: str = quantity("", "n-p-q or Un-p-q")
    stable: bool = quantity("1", "stability of all its orbits")
    periods: int = quantity("1", "period, in excitation periods")
    low: float = quantity("1", "least parameter value")
    high: float = quantity("1", "greatest parameter value")
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
    found, first = [], 0
    for label, run in groupby(branch.labels):
        count = len(list(run))
        last = first + count - 1
        begins = _between(branch, first - 1) if first > 0 else None
        ends = _between(branch, last) if last + 1 < len(branch.values) else None
        values = branch.values[first : last + 1]
        marks = [p.parameter for p in (begins, ends) if p is not None]
        low, high = min([*values.tolist(), *marks]), max([*values.tolist(), *marks])
        middle = first + int(np.argmin(np.abs(values - 0.5 * (low + high))))
        found.append(
            Stretch(
                label, bool(branch.stable[middle]), branch.periods, low, high, begins, ends,
                float(branch.values[middle]), branch.states[middle].copy(),
            )
        )  # fmt: skip
        first += count
    return tuple(found)


def _between(branch: Branch, i: int) -> SpecialPoint | None:
    """Special point between point i and the next, the nearest to the middle of their chord if there are several."""
    if not branch.points:
        return None
    width = max(float(np.ptp(branch.values)), 1e-300)
    size = max(float(np.max(np.abs(branch.states))), 1e-300)

    def place(value: float, state: Array) -> Array:
        return np.array([value / width, state[0] / size, state[1] / size])

    a, b = (place(float(branch.values[k]), branch.states[k]) for k in (i, i + 1))
    gaps = [float(np.linalg.norm(place(p.parameter, p.state) - 0.5 * (a + b))) for p in branch.points]
    nearest = int(np.argmin(gaps))
    return branch.points[nearest] if gaps[nearest] <= float(np.linalg.norm(b - a)) else None
