"""Special points moved with other parameters, without their branches: Newton's method on the event itself."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from base import Array
from dynamics.branches.branch import SpecialPoint
from dynamics.branches.branch_problem import MapPoint
from dynamics.branches.continuation import problem_of
from dynamics.branches.special_orbits import Condition, special_orbit
from dynamics.model.protocol import EPS, PeriodicOscillator, periodic_only
from dynamics.model.states import scale_of
from dynamics.model.stiffness import FourierStiffness
from dynamics.orbits.shooting import motion_label

FIRST, LEAST = (
    0.25,
    1.0 / 256.0,
)  # steps of the way from one stiffness to the other: the first and the smallest
NEAR = 0.05  # of the size of the motion and the parameter: how far from where it was foretold a point may lie


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
        point cannot be evaluated, or another parameter may not change. Entries are as good as of `problem_of`.
        """
        here = self.oscillator.with_parameter(self.parameter, self.value)
        low = np.array([self.value, *(here.get(n) for n in names)])
        state, size = self.place[:-1], len(self.place)
        problem = problem_of(
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
        problem = problem_of(
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


@periodic_only
def carried_point(
    oscillator: PeriodicOscillator, parameter: str, point: SpecialPoint, stiffness: FourierStiffness
) -> SpecialPoint | None:
    r"""Follow a special point while the stiffness changes into another one.

    On the way the stiffness is :math:`(1-s) K + s K'`, each harmonic as a complex amplitude. At every step Newton's
    method finds the orbit and its condition together, from where the exact derivatives foretell the point; steps
    shrink until it lies near there, so that it is not taken for another one.

    Parameters
    ----------
    oscillator : GearOscillator or DriveOscillator
        Of the point; its value of the parameter is not used.
    parameter : str
        In which the point was found.
    point : SpecialPoint
        A saddle node or a period doubling.
    stiffness : FourierStiffness
        The other one, of any order.

    Returns
    -------
    SpecialPoint or None
        The point with the other stiffness; None where it vanishes on the way, as a saddle node does that meets
        another one, or cannot be followed.

    Examples
    --------
    >>> from dynamics import FourierStiffness, GearOscillator, carried_point, continue_branch, find_orbit
    >>> osc = GearOscillator(FourierStiffness(1.0, (0.18,), (0.0,)), 0.05, 0.1, 0.2, 0.64, half_backlash=0.2)
    >>> branch = continue_branch(find_orbit(osc, (0.35, 0.0)), "frequency", (0.62, 0.67))
    >>> (fold,) = branch.special("saddle-node")
    >>> there = FourierStiffness(1.0, (0.18, 0.05), (0.0, 1.0))
    >>> round(fold.parameter, 4), round(carried_point(osc, "frequency", fold, there).parameter, 4)
    (0.6556, 0.6577)
    """
    way = _Way(oscillator.contact_stiffness, stiffness)
    mark = replace(
        marked(oscillator, parameter, point), oscillator=oscillator.with_contact_stiffness(way.at(0.0))
    )
    done, step = 0.0, FIRST
    while done < 1.0:
        end = min(done + step, 1.0)
        next_mark = _stepped(mark, way, done, end)
        if next_mark is None:
            step = 0.5 * (end - done)
            if step < LEAST:
                return None
            continue
        mark, done, step = next_mark, end, 2.0 * step
    return _special(mark, point)


class _Way:
    """The way from one stiffness to another."""

    def __init__(self, here: FourierStiffness, there: FourierStiffness) -> None:
        order = max(here.order, there.order)
        self.mean = np.array([here.mean, there.mean])
        self.harmonics = np.zeros((2, order), dtype=complex)
        for row, stiffness in zip(self.harmonics, (here, there), strict=True):
            row[: stiffness.order] = np.array(stiffness.amplitudes) * np.exp(1j * np.array(stiffness.phases))

    def at(self, s: float) -> FourierStiffness:
        """Stiffness a part s of the way on; harmonics of no size yet in the phase that they will have."""
        harmonics = (1.0 - s) * self.harmonics[0] + s * self.harmonics[1]
        ahead = np.where(harmonics == 0.0, self.harmonics[1] - self.harmonics[0], harmonics)
        mean = float((1.0 - s) * self.mean[0] + s * self.mean[1])
        return FourierStiffness(mean, tuple(np.abs(harmonics).tolist()), tuple(np.angle(ahead).tolist()))

    def slopes(self, s: float) -> dict[str, float]:
        """Derivatives of mean, amplitudes and phases by s, by the names of the parameters."""
        now, change = self.at(s), self.harmonics[1] - self.harmonics[0]
        turned = change * np.exp(-1j * np.array(now.phases))
        slopes_by_name = {"stiffness.mean": float(self.mean[1] - self.mean[0])}
        for j, size in enumerate(now.amplitudes):
            slopes_by_name[f"stiffness.amplitudes[{j}]"] = float(turned[j].real)
            slopes_by_name[f"stiffness.phases[{j}]"] = float(turned[j].imag) / size if size else 0.0
        return {name: slope for name, slope in slopes_by_name.items() if slope}


def _stepped(mark: Mark, way: _Way, done: float, end: float) -> Mark | None:
    """The point at the end of a step; None where it is not found near where it was foretold."""
    slopes = way.slopes(done)
    foretold = np.zeros(len(mark.place))
    if slopes:
        before = mark.oscillator.stiffness_name.removesuffix("stiffness")
        names = [f"{before}{name}" for name in slopes]
        foretold = (end - done) * (mark.slopes(names) @ np.array(list(slopes.values())))
    moved = mark.moved(mark.oscillator.with_contact_stiffness(way.at(end)), foretold)
    if moved is None:
        return None
    size = np.full(len(mark.place), scale_of(mark.oscillator, mark.place[:-1]))
    size[-1] = max(abs(mark.value), 1e-300)
    off: Array = np.abs(moved.place - mark.place - foretold) / size
    return moved if float(np.max(off)) <= NEAR else None


def _special(mark: Mark, like: SpecialPoint) -> SpecialPoint | None:
    """Record of the point that a mark stands at."""
    here = mark.oscillator.with_parameter(mark.parameter, mark.value)
    low, state = np.zeros(1), mark.place[:-1]
    problem = problem_of(
        here, (mark.parameter,), mark.periods, low, np.array([mark.value]), scale_of(here, state)
    )
    place = problem.unknowns(state, mark.place[-1:])
    at, finer = problem.evaluate(place), special_orbit(problem, mark.condition, place, refinement=2, limit=4)
    if at is None or finer is None:
        return None
    return replace(
        like,
        parameter=mark.value,
        state=state.copy(),
        multipliers=at.multipliers,
        label=motion_label(mark.periods, at.counts),
        error=max(abs(finer.value / mark.value - 1.0), EPS),
    )
