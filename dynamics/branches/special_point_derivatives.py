"""Special points followed as parameters change, without their branches: Newton's method on the event itself."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from base import Array
from dynamics.branches.branch import SpecialPoint
from dynamics.branches.branch_problem import MapPoint
from dynamics.branches.sensitivity import special_problem
from dynamics.branches.special_orbits import Condition, special_orbit
from dynamics.model.protocol import PeriodicOscillator, periodic_only
from dynamics.model.states import scale_of


@dataclass(frozen=True, eq=False)
class Mark:
    """A special point at certain parameters.

    Parameters
    ----------
    oscillator : GearOscillator or DriveOscillator
        The parameters.
    parameter : str
        In which the point lies.
    condition : Condition
        What singles it out.
    periods : int
        Of its orbit.
    place : ndarray, shape (dimension + 1,)
        State and the parameter.
    """

    oscillator: PeriodicOscillator
    parameter: str
    condition: Condition
    periods: int
    place: Array

    @property
    def value(self) -> float:
        """The parameter."""
        return float(self.place[-1])

    def slopes(self, names: Sequence[str]) -> Array:
        r"""Change of the state and the parameter with others, shape (dimension + 1, names).

        The point solves G = 0: the orbit closes and its condition holds. With the columns for the state and the
        parameter in A and those for the others in b, the change is :math:`-A^{-1} b`; nan where A is singular, the
        point cannot be evaluated, or another parameter may not change. Entries are as good as of `special_problem`.
        """
        here = self.oscillator.with_parameter(self.parameter, self.value)
        low = np.array([self.value, *(here.get(n) for n in names)])
        state, size = self.place[:-1], len(self.place)
        problem = special_problem(
            here, (self.parameter, *names), self.periods, low, low + 1.0, scale_of(here, state)
        )
        at = problem.evaluate(problem.unknowns(state, low))
        lost = np.full((size, len(names)), math.nan)
        if at is None or (self.condition.kind == "grazing" and self.condition.nearest(at) < 0):
            return lost
        rows = self.condition.rows(problem, at)
        if not np.all(np.isfinite(rows[:, :size])):
            return lost
        try:
            change = -np.linalg.solve(rows[:, :size], rows[:, size:])
        except np.linalg.LinAlgError:
            return lost
        change[:-1] *= problem.scale
        return np.asarray(change)

    def moved(self, there: PeriodicOscillator, change: Array) -> Mark | None:
        """The point at other parameters, `change` the expected change of `place`; None if it is lost.

        Newton's method on the orbit and its condition together, from that guess.
        """
        guess = self.place + change
        if not (np.all(np.isfinite(guess)) and (self.parameter != "frequency" or guess[-1] > 0.0)):
            return None
        scale = scale_of(there, self.place[:-1])
        problem = special_problem(
            there, (self.parameter,), self.periods, np.zeros(1), np.array([max(abs(guess[-1]), 1e-3)]), scale
        )
        point = special_orbit(problem, self.condition, problem.unknowns(guess[:-1], guess[-1:]))
        if point is None:
            return None
        place = np.append(point.state, point.value)
        return replace(self, oscillator=there, condition=self._refreshed(point), place=place)

    def _refreshed(self, point: MapPoint) -> Condition:
        """Condition with the phase of the extremum as it is now."""
        if self.condition.kind != "grazing":
            return self.condition
        return replace(self.condition, phase=float(point.extrema[self.condition.nearest(point), 0]))


def marked(here: PeriodicOscillator, parameter: str, point: SpecialPoint) -> Mark:
    """Mark of a special point of a branch."""
    condition = Condition.of(here.with_parameter(parameter, point.parameter), point)
    return Mark(here, parameter, condition, point.periods, np.append(point.state, point.parameter))


@periodic_only
def special_sensitivities(
    oscillator: PeriodicOscillator, parameter: str, point: SpecialPoint, names: Sequence[str] | None = None
) -> dict[str, float]:
    r"""Derivatives of a special point's parameter value with respect to the other parameters.

    The point solves G = 0: the orbit closes and its condition holds. With the columns for the state and the
    parameter in A and that for another parameter p in b, the change with p is the last component of
    :math:`-A^{-1} b`. All entries are exact; those of a drive train by parameters, and all second ones, are
    differences, good to about 1e-9.

    Parameters
    ----------
    oscillator : GearOscillator or DriveOscillator
        The oscillator; its value of the parameter is not used. A harmonic of amplitude zero may be among its series:
        the derivative is then what that harmonic would do.
    parameter : str
        The parameter in which the point was found.
    point : SpecialPoint
        A saddle node, period doubling, grazing or Neimark-Sacker point.
    names : sequence of str, optional
        Of its `parameters`. Left out: all others.

    Returns
    -------
    dict
        Name to derivative; nan where the system is singular (a point of codimension two), or where the parameter may
        not change, as one force alone of a train that nothing holds.

    Raises
    ------
    InputError
        If there is no such parameter.

    Examples
    --------
    >>> from dynamics import FourierStiffness, GearOscillator, continue_branch, find_orbit, special_sensitivities
    >>> osc = GearOscillator(FourierStiffness(1.0, (0.18,), (0.0,)), 0.05, 0.1, 0.2, 0.64, half_backlash=0.2)
    >>> branch = continue_branch(find_orbit(osc, (0.35, 0.0)), "frequency", (0.62, 0.67))
    >>> (fold,) = branch.special("saddle-node")
    >>> round(special_sensitivities(osc, "frequency", fold, ["mean_force"])["mean_force"], 4)
    1.6776
    """
    mark = marked(oscillator, parameter, point)
    wanted = [n for n in (oscillator.parameters if names is None else names) if n != parameter]
    return dict(zip(wanted, mark.slopes(wanted)[-1].tolist(), strict=True))
