"""Motions that leave a saddle along its unstable manifold and come back, before or past its stable one."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from itertools import pairwise

import numpy as np

from base import Array, Booleans
from dynamics.attraction.manifolds import is_direct_saddle
from dynamics.branches.branch import Branch
from dynamics.branches.roots import bracketed
from dynamics.flow.flows import flow_of
from dynamics.flow.protocol import propagated
from dynamics.model.protocol import Oscillator
from dynamics.orbits.shooting import Orbit, find_orbit

FIRST, BEGUN = 1e-6, 0.05  # of the size of the saddle: where its unstable manifold starts, and is looked at
NEAR = 0.04  # of the size of the saddle: nearness at which the side of a passing motion is measured
OWN = 0.2  # of the distance between points of the saddle: farther than that nothing counts as near
ROUNDS = 2  # of the saddle that a passing motion is followed on before its side is measured
STRAIGHT = 0.3  # of its size, how far the saddle's neighbourhood is straight enough for that
LOBES = 3  # lobes narrower than the points' distance whose tops are looked for
RESOLVED = 12  # the same of lobes that neighbouring points show
PROMISE = 4.0  # of what a parabola through neighbouring points rises above them: where a top may lie
FIRST_ROUNDS = 4  # searches for an earlier tangency
LOST = -1.0


@dataclass
class HomoclinicSearch:
    """Motions of the unstable manifold of a saddle that is followed over a parameter.

    Parameters
    ----------
    oscillator : Oscillator
        The oscillator; its value of the parameter is not used.
    branch : Branch
        The saddle's.
    run : slice
        Its points on which it is a saddle and the parameter rises or falls throughout.
    points, longest : int
        Points of the stretch of the unstable manifold, and periods that they are followed.
    phase : float
        Where the first of them lies, over their distance.
    periods : int
        Periods that all motions have been followed.
    """

    oscillator: Oscillator
    branch: Branch
    run: slice
    points: int
    longest: int
    phase: float = 0.5
    periods: int = 0

    def __post_init__(self) -> None:
        """Order the saddle's points by the parameter."""
        order = np.argsort(self.branch.values[self.run])
        self.values: Array = self.branch.values[self.run][order]
        self.states: Array = self.branch.states[self.run][order]

    @property
    def parameter(self) -> str:
        """What is varied."""
        return self.branch.parameter

    def saddle(self, value: float) -> Orbit:
        """The saddle at a value, by Newton's method from between its neighbours."""
        guess = [float(np.interp(value, self.values, self.states[:, k])) for k in range(self.states.shape[1])]
        here = self.oscillator.with_parameter(self.parameter, value)
        return find_orbit(here, guess, periods=self.branch.periods)

    def holds(self, orbit: Orbit) -> bool:
        """Whether an orbit is still the saddle."""
        return (
            orbit.converged and orbit.periods == self.branch.periods and is_direct_saddle(orbit.multipliers)
        )

    def overshoot(self, value: float, side: int) -> float:
        """Largest u of returning motions, over the size of the saddle; -1 if none returns, nan without a saddle."""
        orbit = self.saddle(value)
        if not self.holds(orbit):
            return math.nan
        n, multiplier = orbit.periods, float(np.real(orbit.multipliers[0]))
        size = _size(orbit)
        along, across = _directions(orbit.jacobian, multiplier)
        table = flow_of(orbit.oscillator)
        begin = math.ceil(math.log(BEGUN / FIRST) / math.log(multiplier))

        def states(share: Array, more: int) -> Array:
            first = orbit.state + side * FIRST * size * np.outer(multiplier**share, along)
            self.periods += len(share) * (n * begin + more)
            return propagated(table, first, n * begin + more)

        def passed(at: Array) -> Array:
            return np.asarray(-side * ((at - orbit.state) @ across) / size)

        def followed(k: int, share: Array) -> Array:
            return passed(states(share, k)) / multiplier**ROUNDS

        # one point more at either end: a lobe across the stretch's ends has neighbours on both sides
        share = (np.arange(self.points + 2) - 1.0 + self.phase) / self.points
        at = states(share, 0)
        follow = ROUNDS * n
        narrow: list[tuple[float, int, float, bool]] = []  # the highest point of each period
        wide: list[tuple[float, int, float]] = []
        measured: list[tuple[Booleans, Array]] = []  # near the saddle, and raw u, period by period
        for k in range(1, self.longest + follow + 1):
            at = propagated(table, at, 1)
            with np.errstate(invalid="ignore"):
                measured.append((np.max(np.abs(at - orbit.state), axis=1) < NEAR * size, passed(at)))
                if k <= follow:
                    continue
                near, raw = measured.pop(0)
                straight = np.abs(raw) * multiplier**ROUNDS < STRAIGHT
                gone = np.where(near, np.where(straight, measured[-1][1] / multiplier**ROUNDS, raw), LOST)
            i = int(np.nanargmax(gone))
            if gone[i] > LOST:
                narrow.append((float(gone[i]), k, float(share[i]), bool(straight[i])))
            wide += _resolved(np.where(straight, gone, LOST), k, share)
        self.periods += (self.longest + follow) * len(share)
        narrow.sort(reverse=True)
        wide.sort(reverse=True)
        largest = narrow[0][0] if narrow else LOST
        for height, k, middle, straight_there in narrow[:LOBES]:
            if straight_there:
                largest = max(largest, self._top(partial(followed, k), middle))
            elif height == largest:
                return largest
        for promise, k, middle in wide[:RESOLVED]:
            if promise <= largest:
                break
            largest = max(largest, self._top(partial(followed, k), middle))
        return largest

    def _top(self, lobe: Callable[[Array], Array], middle: float) -> float:
        """Largest value of a lobe about a point of the stretch: windows that shrink around it."""
        width, largest = 2.0 / self.points, -math.inf
        for _ in range(6):
            window = middle + width * np.linspace(-1.0, 1.0, 13)
            height = lobe(window)
            i = int(np.nanargmax(height))
            middle, largest, width = float(window[i]), max(largest, float(height[i])), width / 5.0
        return largest

    def first(self, bounds: tuple[float, float], side: int, closed: int) -> tuple[float, float, float, int]:
        """The change of sign next to the closed one of the bounds, as of `root`.

        Farther in other lobes may cross and turn back again; they are looked for at distances halved.
        """
        low, high = bounds
        a, b, jump, trials = self.root(bounds, side)
        for _ in range(FIRST_ROUNDS):
            near, far = (b, low) if closed == 0 else (a, high)
            places = [near + (far - near) * 0.5**k for k in range(1, 9)]
            opened = [x for x in places if self.overshoot(x, side) > 0.0]
            trials += len(places)
            if not opened:
                break
            low, high = (low, min(opened)) if closed == 0 else (max(opened), high)
            a, b, jump, more = self.root((low, high), side)
            trials += more
        return a, b, jump, trials

    def root(self, bounds: tuple[float, float], side: int) -> tuple[float, float, float, int]:
        """Value below and above a change of sign of the overshoot, the jump between them, and the trials.

        Brent's method: the overshoot has kinks where another lobe leads. At a tangency no jump is left; it is infinite
        if the saddle is lost between them.
        """
        seen: dict[float, float] = {}

        def measure(value: float) -> float:
            if value not in seen:
                seen[value] = self.overshoot(value, side)
            return seen[value]

        if bracketed(measure, *bounds, xtol=2e-11 * max(abs(b) for b in bounds)) is None:
            return (*bounds, math.inf, len(seen))
        at = sorted(seen)
        pairs = [(a, b) for a, b in pairwise(at) if seen[a] * seen[b] <= 0.0]
        a, b = min(pairs, key=lambda pair: pair[1] - pair[0])
        return a, b, abs(seen[b] - seen[a]), len(seen)

    def beside(self, value: float, side: int, distance: float = 1e-3) -> Array | None:
        """A state beside the saddle on one branch of its unstable manifold; None without a saddle."""
        orbit = self.saddle(value)
        if not self.holds(orbit):
            return None
        along, _ = _directions(orbit.jacobian, float(np.real(orbit.multipliers[0])))
        size = float(np.max(np.abs(orbit.points)))
        return np.asarray(orbit.state + side * distance * size * along)


def _resolved(height: Array, period: int, share: Array) -> list[tuple[float, int, float]]:
    """Lobes that neighbouring points show: how high their tops may be, the period, and the highest point's place."""
    before, here, after = height[:-2], height[1:-1], height[2:]
    with np.errstate(invalid="ignore", divide="ignore"):
        tops = (before > LOST) & (after > LOST) & (here >= before) & (here >= after)
        rise = (after - before) ** 2 / (8.0 * (2.0 * here - before - after))
    rise = np.where(np.isfinite(rise), rise, 0.0)
    return [
        (float(here[i] + PROMISE * rise[i]), period, float(share[i + 1]))
        for i in np.flatnonzero(tops).tolist()
    ]


def _size(orbit: Orbit) -> float:
    """Largest of X and V at all its points, less where they lie close together; the same from whichever period.

    Beside a saddle of many periods lie other pieces of the attractor, which are past the line of its stable manifold
    and not past the manifold: what counts as near must leave them out.
    """
    points = orbit.points
    gaps = np.max(np.abs(points[:, None] - points[None]), axis=2)
    gaps[np.diag_indices(len(points))] = np.inf
    return min(float(np.max(np.abs(points))), OWN * float(np.min(gaps)) / NEAR)


def _directions(jacobian: Array, multiplier: float) -> tuple[Array, Array]:
    """Right eigenvector of a multiplier, towards positive X, and the left one with product 1.

    In several freedoms X is the first displacement.
    """
    shifted = jacobian - multiplier * np.eye(len(jacobian))
    along = np.linalg.svd(shifted)[2][-1]
    along = along if along[0] >= 0.0 else -along
    across = np.linalg.svd(shifted.T)[2][-1]
    return np.asarray(along), np.asarray(across / (across @ along))
