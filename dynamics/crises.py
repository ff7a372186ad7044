"""Boundary crises: the parameter at which a chaotic attractor meets the stable manifold of a saddle."""

from __future__ import annotations

import math
import time
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from dynamics.continuation import Branch, continue_branch
from dynamics.cost import Cost
from dynamics.errors import Faults
from dynamics.flow import tables
from dynamics.manifolds import carried
from dynamics.shooting import Orbit, find_orbit

__all__ = ["Crisis", "boundary_crisis"]

FloatArray = npt.NDArray[np.float64]
FIRST, BEGUN = 1e-6, 0.05  # of the size of the saddle: where its unstable manifold starts, and is looked at
NEAR = 0.08  # of the size of the saddle: nearness at which a passing motion's side is told
ROUNDS = 2  # of the saddle that a passing motion is followed on before its side is measured
LOST = -1.0


@dataclass(frozen=True, eq=False)
class Crisis:
    """A tangency of the stable and the unstable manifold of a saddle.

    Parameters
    ----------
    parameter : float
        Where it happens; nan if not found.
    saddle : Orbit
        The saddle there.
    side : int
        Branch of its unstable manifold on which the attractor lies: 1 or -1 along the eigenvector of positive X.
    overshoot : tuple of float
        At both bounds: how far motions from that branch come past the stable manifold, over the size of the saddle.
        Positive: they leave; negative: all turn back, the attractor is closed.
    error : float
        Width of the bracket, relative.
    cost : Cost
        Effort.
    converged : bool
        Whether the overshoot changes its sign within the bounds, on one branch, and the root is closed in on.
    message : str
        What was found.
    """

    parameter: float
    saddle: Orbit
    side: int
    overshoot: tuple[float, float]
    error: float
    cost: Cost
    converged: bool
    message: str


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
        As in `GearOscillator.with_parameter`.
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
    DynamicsError
        If the orbit is not such a saddle, or an argument is out of range.
    """
    began = time.perf_counter()
    faults = Faults()
    low, high = (faults.number(f"bounds[{i}]", bounds[i]) for i in range(2))
    number = faults.whole("points", points, 10, 10**6, "2000 is usual")
    longest = faults.whole("periods", periods, 1, 10**6, "240 is usual")
    leading = np.asarray(saddle.multipliers)
    if not saddle.converged or np.iscomplexobj(leading) or not leading[0] > 1.0 > abs(leading[1]):
        faults.add("saddle", saddle.label, "a saddle with a multiplier above 1", "take one of find_orbits")
    elif not low <= saddle.oscillator.get(parameter) <= high or not low < high:
        faults.add("bounds", bounds, "a range with the saddle in it", "widen the bounds")
    faults.raise_if_any()
    search = _Passing(continue_branch(saddle, parameter, (low, high)), saddle, number, longest)
    ends = {side: tuple(search.overshoot(value, side) for value in (low, high)) for side in (1, -1)}
    sides = [side for side, (a, b) in ends.items() if a * b < 0.0]
    if len(sides) != 1:
        told = ", ".join(f"{a:.3g} and {b:.3g}" for a, b in ends.values())
        message = f"no crisis of this saddle: overshoots at the bounds {told}"
        cost = Cost(time.perf_counter() - began, 2, 0, search.periods)
        return Crisis(math.nan, saddle, 0, (math.nan, math.nan), math.nan, cost, False, message)
    side = sides[0]
    (a, b), at_a = (low, high), ends[side][0]
    steps = 0
    while b - a > 1e-10 * abs(b) and steps < 60:  # halving: the overshoot has kinks where another lobe leads
        middle = 0.5 * (a + b)
        if search.overshoot(middle, side) * at_a > 0.0:
            a = middle
        else:
            b = middle
        steps += 1
    root = 0.5 * (a + b)
    at = search.saddle(root)
    message = f"{at.label} and the attractor beside it meet at {parameter} = {root:.10g}"
    cost = Cost(time.perf_counter() - began, 2, steps, search.periods)
    return Crisis(
        root, at, side, (ends[side][0], ends[side][1]), (b - a) / abs(root), cost, b - a <= 1e-9 * abs(root), message
    )  # fmt: skip


class _Passing:
    """Motions of a saddle's unstable manifold that come back to it."""

    def __init__(self, branch: Branch, saddle: Orbit, points: int, periods: int) -> None:
        self.branch, self.start, self.points, self.longest = branch, saddle, points, periods
        self.periods = 0

    def saddle(self, value: float) -> Orbit:
        """The saddle at a value, by Newton's method from the branch."""
        i = int(np.argmin(np.abs(self.branch.values - value)))
        here = self.start.oscillator.with_parameter(self.branch.parameter, value)
        return find_orbit(here, self.branch.states[i], periods=self.start.periods)

    def overshoot(self, value: float, side: int) -> float:
        """Largest u of returning motions, over the size of the saddle; -1 if none returns."""
        orbit = self.saddle(value)
        n, multiplier = orbit.periods, float(np.real(orbit.multipliers[0]))
        if not orbit.converged or np.iscomplexobj(orbit.multipliers) or not multiplier > 1.0:
            return LOST
        size = float(np.max(np.abs(orbit.state)))
        along = np.linalg.svd(orbit.jacobian - multiplier * np.eye(2))[2][1]
        along = along if along[0] >= 0.0 else -along
        across = np.linalg.svd(orbit.jacobian.T - multiplier * np.eye(2))[2][1]
        across = across / (across @ along)
        table = tables(orbit.oscillator)
        begin = math.ceil(math.log(BEGUN / FIRST) / math.log(multiplier))

        def states(share: FloatArray, more: int) -> FloatArray:
            first = orbit.state + side * FIRST * size * np.outer(multiplier**share, along)
            self.periods += len(share) * (n * begin + more)
            return carried(table, first, n * begin + more)

        def passed(at: FloatArray) -> FloatArray:
            return np.asarray(-side * ((at - orbit.state) @ across) / size)

        share = (np.arange(self.points) + 0.5) / self.points
        at, best = states(share, 0), (LOST, 0, 0.0)
        for k in range(1, self.longest + 1):
            at = carried(table, at, 1)
            with np.errstate(invalid="ignore"):
                near = np.max(np.abs(at - orbit.state), axis=1) < NEAR * size
                gone = np.where(near, passed(at), LOST)
            i = int(np.argmax(gone))
            if gone[i] > best[0]:
                best = (float(gone[i]), k, float(share[i]))
        self.periods += self.longest * self.points
        if best[0] == LOST or abs(best[0]) * multiplier**ROUNDS > 1.0:
            return best[0]
        width, middle, largest = 2.0 / self.points, best[2], best[0]
        for _ in range(6):  # zoom in on the top of the lobe
            window = middle + width * np.linspace(-1.0, 1.0, 21)
            lobe = passed(states(window, best[1] + ROUNDS * n)) / multiplier**ROUNDS
            i = int(np.nanargmax(lobe))
            middle, largest, width = float(window[i]), float(lobe[i]), width / 8.0
        return largest
