"""Boundary crises: the parameter at which a chaotic attractor meets the stable manifold of a saddle."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import replace
from itertools import pairwise

import numpy as np

from base import Cost, Faults, Stopwatch, quantity, record
from dynamics.attraction.diagrams import Diagram
from dynamics.attraction.homoclinic import HomoclinicSearch
from dynamics.attraction.manifolds import is_direct_saddle
from dynamics.branches.branch import Branch
from dynamics.branches.continuation import continue_branch
from dynamics.model.limits import ordered
from dynamics.model.options import OPTIONS
from dynamics.model.reasons import FLOW
from dynamics.motion.sweeps import sweep
from dynamics.orbits.shooting import Orbit

SETTLED = 20_000  # periods after which the motion beside the saddle is named
OTHER_PHASE = 0.17  # of the points by which a tangency is confirmed, over their distance
LEAST = 9  # values looked at on a saddle's range, however narrow


@record
class Crisis:
    """A tangency of the stable and the unstable manifold of a saddle.

    Only if `before` is "aperiodic" does a chaotic attractor end; if not, motions that pass the boundary to and fro
    before they settle begin (the boundary of the basin becomes fractal).
    """

    no_error = FLOW

    headline = ("parameter", "before", "after")

    saddle: Orbit = quantity("", "the saddle at the crisis, or the one given if none was found")
    cost: Cost
    message: str
    parameter: float = quantity("1", "where it happens; nan if not found", error="error", default=math.nan)
    side: int = quantity(
        "1",
        "branch of the saddle's unstable manifold on which the attractor lies: 1 or -1 along the eigenvector of "
        "positive X, in several freedoms of a positive first displacement",
        default=0,
    )
    overshoot: tuple[float, float] = quantity(
        "1",
        "at both bounds, how far motions from that branch come past the stable manifold, over the size of the saddle; "
        "positive: they leave; negative: all turn back, the attractor is closed; -1: none comes back",
        "bound",
        default=(math.nan, math.nan),
    )
    before: str = quantity(
        "", "motion that the branch leads to beside the crisis where it is closed", default=""
    )
    after: str = quantity("", "motion that the branch leads to at the other bound", default="")
    error: float = quantity(
        "1",
        "width of the bracket, relative, at whose ends twice the points elsewhere on the manifold give the same signs",
        default=math.nan,
    )
    converged: bool = quantity(
        "1",
        "whether the overshoot passes zero within the bounds, on one branch, without a jump, and the root is closed in "
        "on",
        default=False,
    )


def boundary_crisis(
    saddle: Orbit,
    parameter: str = "frequency",
    bounds: tuple[float, float] = (0.1, 2.1),
    *,
    points: int = 2000,
    periods: int = 240,
) -> Crisis:
    r"""Find where a chaotic attractor beside a saddle opens to the other side of it.

    The attractor is the closure of one branch of the saddle's unstable manifold as long as that branch does not cross
    the stable one. A motion of the branch that comes back close to the saddle has passed, or not, according to the
    sign of :math:`u = w \cdot (x - x_s)`, with w the left eigenvector of the unstable multiplier m and
    :math:`w \cdot v = 1`. Measured r rounds later, as :math:`u/m^r`, the bend of the stable manifold no longer counts.
    The largest u of a stretch of the branch and its images vanishes at the tangency.

    Parameters
    ----------
    saddle : Orbit
        A saddle with a multiplier above 1 within the bounds.
    parameter : str
        One of the `parameters` of its oscillator.
    bounds : tuple of float
        On one side of the crisis each.
    points : int
        Points of the stretch of the unstable manifold.
    periods : int
        Periods that they are followed.

    Returns
    -------
    Crisis
        The crisis, or why there is none.

    Raises
    ------
    InputError
        If the orbit is not such a saddle, or an argument is out of range.

    Examples
    --------
    >>> from dynamics import FourierStiffness, GearOscillator, boundary_crisis, find_orbits
    >>> osc = GearOscillator(FourierStiffness(1.0, (0.5,), (0.0,)), 0.06, 0.1, 0.778, 0.4, half_backlash=0.8)
    >>> saddle = next(orbit for orbit in find_orbits(osc, (1,)).orbits if orbit.label == "U1-1-0")
    >>> crisis = boundary_crisis(saddle, "error_amplitude", (0.777, 0.783), points=20, periods=12)
    >>> round(crisis.parameter, 6), crisis.before, crisis.after
    (0.779904, 'aperiodic', '4-4-3')
    """
    watch = Stopwatch()
    faults = Faults()
    low, high = ordered(faults, "bounds", bounds)
    number = faults.whole("points", points, 10, 10**6, "2000 is usual")
    longest = faults.whole("periods", periods, 1, 10**6, "240 is usual")
    if not saddle.converged or not is_direct_saddle(saddle.multipliers):
        allowed = "must be a saddle with a multiplier above 1"
        faults.add("saddle", saddle.label, allowed, "take one of find_orbits")
    elif not low <= saddle.oscillator.get(parameter) <= high and low < high:
        faults.add("bounds", bounds, "must be a range with the saddle in it", "widen the bounds")
    faults.raise_if_any()
    branch = continue_branch(saddle, parameter, (low, high))
    value = saddle.oscillator.get(parameter)
    runs = [r for r in _runs(branch) if branch.values[r].min() <= value <= branch.values[r].max()]
    if not runs:
        faults.add("saddle", saddle.label, "must exist over a range of the bounds", "narrow the bounds")
    faults.raise_if_any()
    search = HomoclinicSearch(saddle.oscillator, branch, runs[0], number, longest)
    low, high = max(low, float(search.values[0])), min(high, float(search.values[-1]))
    ends = {side: (search.overshoot(low, side), search.overshoot(high, side)) for side in (1, -1)}
    sides = [side for side, (a, b) in ends.items() if a * b < 0.0]
    if len(sides) != 1:
        overshoots = ", ".join(f"{a:.3g} and {b:.3g}" for a, b in ends.values())
        message = f"no crisis of this saddle: overshoots at the bounds {overshoots}"
        cost = Cost(watch.seconds, 2, 0, search.periods)
        return Crisis(saddle, cost, message)
    return _closed_in(search, (low, high), ends[sides[0]], sides[0], watch)


def boundary_crises(
    diagram: Diagram,
    *,
    values: int = 200,
    points: int = 300,
    periods: int = 90,
    max_period: int = 4,
    progress: Callable[[int, int], None] | None = None,
) -> list[Crisis]:
    """Look for crises of all saddles of a diagram.

    Along every stretch on which a branch is a saddle with a multiplier above 1 the overshoot is looked at, on both
    sides; where it changes its sign the tangency is closed in on, as by `boundary_crisis`.

    Parameters
    ----------
    diagram : Diagram
        Its branches are the saddles. One that it lacks is not looked at, and two crises of one saddle closer
        together than the values are missed.
    values : int
        Values of the parameter over the diagram's range; at least nine on every stretch.
    points, periods : int
        As in `boundary_crisis`, for the search; the tangencies are closed in on with four times as many points.
    max_period : int
        Longest period of a saddle that is looked at.
    progress : callable, optional
        Called with the number of stretches done and the number of all.

    Returns
    -------
    list of Crisis
        Those that are smooth tangencies, by parameter. Where `before` is "aperiodic" a chaotic attractor ends.

    Raises
    ------
    InputError
        If an argument is out of range.

    Examples
    --------
    >>> from dynamics import FourierStiffness, GearOscillator, boundary_crises, diagram
    >>> osc = GearOscillator(FourierStiffness(1.0, (0.5,), (0.0,)), 0.06, 0.1, 0.778, 0.4, half_backlash=0.8)
    >>> whole = diagram(osc, "error_amplitude", (0.7785, 0.7815), periods=(1,), searches=1, swept=0)
    >>> [round(c.parameter, 6) for c in boundary_crises(whole, values=2, points=10, periods=12, max_period=1)]
    [0.779904]
    """
    with Faults() as faults:
        number = faults.whole("values", values, 2, 10**6, "200 is usual")
        stretch_points = faults.whole("points", points, 10, 10**6, "300 is usual")
        longest = faults.whole("periods", periods, 1, 10**6, "90 is usual")
        most = faults.whole("max_period", max_period, 1, 1000, "4 is usual")
    spacing = (diagram.bounds[1] - diagram.bounds[0]) / number
    runs = [(branch, run) for branch in diagram.branches if branch.periods <= most for run in _runs(branch)]
    crises = []
    for done, (branch, run) in enumerate(runs, start=1):
        search = HomoclinicSearch(diagram.oscillator, branch, run, stretch_points, longest)
        low, high = float(search.values[0]), float(search.values[-1])
        looked = max(LEAST, math.ceil((high - low) / spacing) + 1)
        at = np.linspace(low, high, looked)[1:-1]  # at its ends a saddle is none
        for side in (1, -1):
            seen = [search.overshoot(float(value), side) for value in at]
            for k in np.flatnonzero([a * b < 0.0 for a, b in pairwise(seen)]):
                crisis = _again(search, (float(at[k]), float(at[k + 1])), side)
                if crisis is not None and crisis.converged:
                    crises.append(crisis)
        if progress is not None:
            progress(done, len(runs))
    return sorted(crises, key=lambda c: c.parameter)


def _again(search: HomoclinicSearch, bounds: tuple[float, float], side: int) -> Crisis | None:
    """Close in with more points, if the change of sign is still there."""
    watch = Stopwatch()
    fine = replace(search, points=4 * search.points, periods=0)
    ends = (fine.overshoot(bounds[0], side), fine.overshoot(bounds[1], side))
    return _closed_in(fine, bounds, ends, side, watch) if ends[0] * ends[1] < 0.0 else None


def _closed_in(
    search: HomoclinicSearch,
    bounds: tuple[float, float],
    ends: tuple[float, float],
    side: int,
    watch: Stopwatch,
) -> Crisis:
    """Root of the overshoot, and the motions on both sides of it."""
    shut = 0 if ends[0] < 0.0 else 1
    a, b, jump, steps = search.first(bounds, side, shut)
    a, b, more = _confirmed(search, bounds, (a, b), side, shut)
    steps += more
    root = 0.5 * (a + b)
    closed, opened = (a, bounds[1]) if shut == 0 else (b, bounds[0])
    before, after = _motion(search, closed, side), _motion(search, opened, side)
    at = search.saddle(root)
    message = f"{at.label} and the {before} motion beside it meet at {search.parameter} = {root:.10g}"
    if jump > OPTIONS.tangency_jump:
        message = f"no crisis of this saddle: near {search.parameter} = {root:.10g} the overshoot jumps by {jump:.2g}"
    good = abs(b - a) <= 1e-9 * abs(root) and jump <= OPTIONS.tangency_jump
    cost = Cost(watch.seconds, 2, steps, search.periods)
    return Crisis(at, cost, message, root, side, ends, before, after, abs(b - a) / abs(root), good)


def _confirmed(
    search: HomoclinicSearch,
    bounds: tuple[float, float],
    bracket: tuple[float, float],
    side: int,
    closed: int,
) -> tuple[float, float, int]:
    """Bracket with room for rounding, at whose ends twice the points, between the others, give the same signs.

    Where they do not, a lobe was missed: the bracket then holds the tangency by these points as well. The third number
    is that of further values looked at.
    """
    fine = replace(search, points=2 * search.points, phase=OTHER_PHASE, periods=0)
    a, b = bracket
    low, high = max(bounds[0], a - (b - a)), min(bounds[1], b + (b - a))
    sign = -1.0 if closed == 0 else 1.0
    trials = 2
    if not fine.overshoot(low, side) * sign > 0.0 > fine.overshoot(high, side) * sign:
        first, last, _, trials = fine.first(bounds, side, closed)
        low, high = min(low, first), max(high, last)
        trials += 2
    search.periods += fine.periods
    return low, high, trials


def _motion(search: HomoclinicSearch, value: float, side: int) -> str:
    """Label of the motion that a branch of the unstable manifold leads to."""
    here = search.oscillator.with_parameter(search.parameter, value)
    start = search.beside(value, side)
    return sweep(here, search.parameter, [value], initial=start, transient=SETTLED).labels[0]


def _runs(branch: Branch) -> Iterator[slice]:
    """Stretches of a branch on which it is a saddle and the parameter rises or falls throughout."""
    saddle = [is_direct_saddle(m) for m in branch.multipliers]
    rising = np.sign(np.diff(branch.values))
    start = 0
    for i in range(1, len(saddle) + 1):
        ends = i == len(saddle) or not saddle[i] or not saddle[i - 1]
        turns = i < len(saddle) and i - start >= 2 and rising[i - 1] != rising[start]
        if ends or turns:
            if i - start >= 2 and saddle[start]:
                yield slice(start, i)
            start = i - 1 if turns and not ends else i
