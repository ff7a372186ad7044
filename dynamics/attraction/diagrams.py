"""Whole bifurcation diagrams: every branch that searches and period doublings lead to."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from base import Array, Cost, Faults, Stopwatch, quantity, record
from dynamics.attraction.branch_tree import BranchTree, Origin
from dynamics.attraction.multi_sweeps import MultiSweep, multi_sweep
from dynamics.branches.branch import KINDS, NEIMARK_SACKER, Branch, SpecialPoint, Stretch, of_kind, stretches
from dynamics.model.arrays import AsArray
from dynamics.model.limits import SEARCHED, ordered, whole_numbers
from dynamics.model.protocol import PeriodicOscillator, periodic_only
from dynamics.model.reasons import FLOW
from dynamics.orbits.finding import find_orbits
from dynamics.orbits.shooting import find_orbit


@record
class Diagram(AsArray):
    """Branches of periodic orbits over one parameter."""

    no_error = FLOW

    headline = ("parameter", "message")

    oscillator: Any = quantity("", "what moves; its value of the parameter is not used")
    parameter: str = quantity("", "what is varied")
    bounds: tuple[float, float] = quantity("1", "range of the parameter", "bound")
    branches: tuple[Branch, ...] = quantity("", "branches in the order in which they were found")
    origins: tuple[Origin, ...] = quantity("", "how each was found")
    left_out: tuple[str, ...] = quantity("", "period doublings that were not followed, and why")
    unsure: tuple[float, ...] = quantity(
        "1",
        "parameter values of searches at which the indices of the orbits do not add up: something may be missing",
        "search",
    )
    error: float = quantity("1", "largest estimated relative error of a special point")
    cost: Cost
    converged: bool = quantity("1", "whether all branches ended for a good reason and all indices add up")
    message: str

    def special(self, kind: str) -> list[SpecialPoint]:
        """Special points of one kind on all branches, by parameter.

        Parameters
        ----------
        kind : str
            "saddle-node", "period-doubling", "grazing", or "neimark-sacker", which a `GearOscillator` never meets.

        Raises
        ------
        InputError
            If there is no such kind.
        """
        points = of_kind([p for b in self.branches for p in b.points], kind, (*KINDS, NEIMARK_SACKER))
        return sorted(points, key=lambda p: p.parameter)

    def stretches(self, stable: bool | None = None) -> list[Stretch]:
        """Stretches of all branches that keep one label, by their lower ends.

        Parameters
        ----------
        stable : bool, optional
            Only stable or only unstable ones.
        """
        selected = [s for b in self.branches for s in stretches(b) if stable is None or s.stable is stable]
        return sorted(selected, key=lambda s: (s.low, s.high))

    def table(self) -> list[tuple[int, str, float, str, float, float]]:
        """Rows branch, kind, parameter, label, X, V of every special point, branch by branch."""
        return [
            (
                i,
                p.kind,
                p.parameter,
                p.label,
                *self._plane(np.array([p.parameter]), p.state[None])[0].tolist(),
            )
            for i, branch in enumerate(self.branches)
            for p in branch.points
        ]

    def columns(self) -> Array:
        """Columns branch, parameter, X, V, stable (0 or 1) of all points: what a plot needs."""
        rows = [
            np.column_stack([np.full(len(b.values), i), b.values, self._plane(b.values, b.states), b.stable])
            for i, b in enumerate(self.branches)
        ]
        return np.concatenate(rows) if rows else np.empty((0, 5))

    def _plane(self, values: Array, states: Array) -> Array:
        """X and V at tau = 0 of states at values of the parameter."""
        rows = [
            self.oscillator.with_parameter(self.parameter, value).in_plane(state[None])
            for value, state in zip(values.tolist(), states, strict=True)
        ]
        return np.concatenate([np.empty((0, 2)), *rows])


@periodic_only
def diagram(
    oscillator: PeriodicOscillator,
    parameter: str = "frequency",
    bounds: tuple[float, float] = (0.1, 2.1),
    *,
    periods: int | Sequence[int] = (1, 2, 3),
    searches: int = 9,
    swept: int = 100,
    max_period: int = 8,
    max_branches: int = 100,
    max_step: float = 0.02,
    starts: Sequence[tuple[float, Array, int]] = (),
    progress: Callable[[int, str], None] | None = None,
) -> Diagram:
    """Build the bifurcation diagram of periodic orbits over one parameter.

    Orbits are searched for at several values of the parameter, and met by sweeps from many starts; each that lies on
    no branch known so far is followed both ways. From every period doubling the branch of twice the period is
    followed, and so on. A branch ends at a bound, where it closes, where it meets the branch of half its period, or
    where the motion grows without bound.

    In several freedoms no orbits are searched for, since no plane of starts meets them all: branches are those of the
    motions that sweeps from many starts meet, and what these lead to.

    Parameters
    ----------
    oscillator : GearOscillator or DriveOscillator
        The oscillator; its value of the parameter is not used.
    parameter : str
        As in `GearOscillator.with_parameter`.
    bounds : tuple of float
        Range of the parameter.
    periods : int or sequence of int
        Periods searched for.
    searches : int
        Values of the parameter at which orbits are searched for, at the middles of equal intervals.
    swept : int
        Values of the sweeps; 0 for none. An isolated branch between two searches that no period doubling leads to has
        a stable part beside each of its folds, but is missed if that lies between two of these values, too.
    max_period : int
        Longest period followed.
    max_branches : int
        Branches followed at most.
    max_step : float
        Largest step along a branch, as in `continue_branch`.
    starts : sequence of tuple
        Where orbits are known to lie about, as on the branches of a like oscillator: value of the parameter, X and V at
        tau = 0, and period. Those outside the bounds are left out.
    progress : callable, optional
        Called with the number of branches and what is done next.

    Returns
    -------
    Diagram
        Branches, special points, and what was left out.

    Raises
    ------
    InputError
        If an argument is out of range.

    Examples
    --------
    >>> from dynamics import FourierStiffness, GearOscillator, diagram
    >>> osc = GearOscillator(FourierStiffness(1.0, (0.18,), (0.0,)), 0.05, 0.1, 0.2, 0.6, half_backlash=0.2)
    >>> folds = diagram(osc, "frequency", (0.6, 0.68), periods=(1,), searches=1, swept=0)
    >>> folds.message
    '2 branches; 1 saddle-node, 0 period-doublings, 1 grazing'
    >>> [round(point.parameter, 6) for point in folds.special("saddle-node")]
    [0.655576]
    """
    watch = Stopwatch()
    with Faults() as faults:
        low, high = ordered(faults, "bounds", bounds)
        wanted = whole_numbers(faults, "periods", periods, SEARCHED)
        number = faults.whole("searches", searches, 1, 10_000, "9 is usual")
        longest = faults.whole("max_period", max_period, 1, 1000, "8 shows three doublings")
        steps = faults.whole("swept", swept, 0, 10**6, "100 is usual")
        most = faults.whole("max_branches", max_branches, 1, 100_000, "100 is usual")
    builder = BranchTree(oscillator, parameter, (low, high), longest, most, max_step, progress=progress)
    at = [low + (k + 0.5) / number * (high - low) for k in range(number)]
    unsure = _follow_searched(builder, oscillator, wanted, at) if oscillator.is_exact else []
    for value, state, known in starts:
        if low <= value <= high:
            orbit = find_orbit(oscillator.with_parameter(parameter, value), state, periods=known)
            if orbit.converged and not builder.holds(orbit):
                builder.follow(orbit, Origin(None, value))
    if steps:
        met = multi_sweep(
            oscillator, parameter, np.linspace(low, high, steps), seeds=2 * number, max_period=longest
        )
        _follow_met(builder, met)
    return _result(builder, tuple(unsure), watch)


def _follow_searched(
    builder: BranchTree, oscillator: Any, periods: Sequence[int], at: Sequence[float]
) -> list[float]:
    """Follow what searches find; values at which something may be missing."""
    unsure = []
    for value in at:
        orbit_set = find_orbits(oscillator.with_parameter(builder.parameter, value), periods, batches=0)
        builder.periods += orbit_set.cost.periods
        if not orbit_set.converged and any(c.expected is not None for c in orbit_set.counts):
            unsure.append(value)
        for orbit in orbit_set.orbits:
            if not builder.holds(orbit):
                builder.follow(orbit, Origin(None, value))
    return unsure


def _follow_met(builder: BranchTree, met: MultiSweep) -> None:
    """Follow the periodic motions of sweeps that lie on no branch."""
    builder.periods += met.cost.periods
    for motion in (m for here in met.motions for m in here if 0 < m.periods <= builder.longest):
        here = builder.oscillator.with_parameter(builder.parameter, motion.value)
        orbit = find_orbit(here, motion.states[-1], periods=motion.periods)
        if orbit.converged and not builder.holds(orbit):
            builder.follow(orbit, Origin(None, motion.value))


def _result(gathered: BranchTree, unsure: tuple[float, ...], watch: Stopwatch) -> Diagram:
    """Assemble the record."""
    branches = tuple(gathered.branches)
    bad = [i for i, b in enumerate(branches) if not b.converged]
    kinds = KINDS if gathered.oscillator.is_exact else (*KINDS, NEIMARK_SACKER)
    counts = {kind: sum(len(b.special(kind)) for b in branches) for kind in kinds}
    tally = ", ".join(f"{count} {kind}{'' if count == 1 else 's'}" for kind, count in counts.items())
    message = f"{len(branches)} branch{'' if len(branches) == 1 else 'es'}; {tally}"
    if bad:
        message += f"; branch {bad[0]} did not end well: {branches[bad[0]].message}"
    if unsure:
        message += f"; orbits may be missing near {gathered.parameter} = {unsure[0]:.6g}: more searches"
    iterations = sum(b.cost.iterations for b in branches)
    return Diagram(
        gathered.oscillator, gathered.parameter, gathered.bounds, branches, tuple(gathered.origins),
        tuple(gathered.left_out), unsure,
        max((b.error for b in branches), default=0.0),
        Cost(watch.seconds, 3, iterations, gathered.periods), not (bad or unsure), message,
    )  # fmt: skip
