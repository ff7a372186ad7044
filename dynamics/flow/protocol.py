"""What a flow offers: the motion of an oscillator made ready to be followed.

There are three kinds of flow: the exact one of `GearOscillator`, that of `DriveOscillator` in several freedoms, and the
stepwise one of `SmoothOscillator`; `dynamics.flow.flows.flow_of` makes the one that an oscillator has. What not every
flow offers is asked for: derivatives by parameters (`Flow.slopes`), parts of a period (`Flow.parted`).
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from base import Array, Cost, Faults, InputError, Integers, in_blocks, quantity, record
from dynamics.model.reasons import FLOW


@record
class MapResult:
    """Image of a state under n periods."""

    no_error = FLOW

    headline = ("log_determinant",)

    states: Array = quantity("1", "state after each period", "period coordinate")
    jacobian: Array = quantity("1", "derivative of the last state with respect to the first", "row column")
    log_determinant: float = quantity(
        "1", "logarithm of the determinant of the Jacobian, minus all damping on the way"
    )
    counts: Integers = quantity(
        "1", "exits from X > D and entries into X < -D during each period", "period side"
    )
    message: str = quantity("", "empty, or why the motion could not be followed; the figures are then nan")
    cost: Cost
    slope: Array = quantity(
        "1",
        "derivative of the last state by the parameters asked for",
        "row parameter",
        default_factory=lambda: np.empty((2, 0)),
    )
    events: Array = quantity(
        "1", "stepwise flow: angle, surface, side entered, X, V, X'', derivatives of X at crossings", "event column",
        default_factory=lambda: np.empty((0, 8)),
    )  # fmt: skip
    error: float | None = quantity(
        "1",
        "difference to a finer flow over the size of the motion; None where a prepared flow was followed",
        default=None,
    )

    @property
    def state(self) -> Array:
        """Last state."""
        return np.asarray(self.states[-1])

    @property
    def impacts(self) -> tuple[int, int]:
        """Exits from X > D and entries into X < -D in all."""
        return int(self.counts[:, 0].sum()), int(self.counts[:, 1].sum())

    @property
    def converged(self) -> bool:
        """Whether the motion could be followed."""
        return not self.message


class Stretches(NamedTuple):
    """Logarithms by which directions grew along stretches of a motion, as many as the flow distinguishes.

    Attributes
    ----------
    logs : ndarray, shape (stretches, directions)
        Of the length of the first direction, and of each further one across those before it.
    states : ndarray, shape (periods, dimension)
        States after every period if asked for, else the last one alone.
    damped : ndarray, shape (stretches,)
        Integral of the trace of all damping: what volumes of states shrank by, as far as damping is linear.
    message : str
        Empty, or why the motion could not be followed.
    """

    logs: Array
    states: Array
    damped: Array
    message: str


class Flow(ABC):
    """An oscillator made ready to be followed."""

    tolerance: float
    """Of a step, over the size of the motion; rounding where the flow is exact."""
    dimension: int = 2
    """Length of a state."""
    noise: float
    """Residual, over the size of the motion and the stretch of the map, below which nothing gets."""

    @abstractmethod
    def follow(self, state: Array, periods: int = 1, skip: int = 0, derivatives: bool = True) -> MapResult:
        """Follow a state at tau = 0 over `skip` periods, then over `periods` that are kept; nothing is checked."""

    @abstractmethod
    def finer(self) -> Flow:
        """The same, more accurately, for an error estimate."""

    @abstractmethod
    def sampled(self, state: Array, periods: int, points: int) -> tuple[Array, Array, Array]:
        """Samples of the state, extrema (tau, X, X'', ...) and events (tau, X, V, region entered) of a motion.

        Raises
        ------
        InputError
            If the motion cannot be followed.
        """

    @abstractmethod
    def stretches(self, state: Array, sizes: Sequence[int], keep: bool = False) -> Stretches:
        """Growth of all directions along a motion, over stretches of so many periods each."""

    def slopes(self, parameters: tuple[str, ...] = (), extrema: bool = False) -> Flow:
        """The same flow with derivatives by parameters, and with extrema among its events.

        Raises
        ------
        InputError
            If there is no such parameter; or if the flow has none of these: it names what gives them.
        """
        asked = (
            ("parameters", parameters, "take dynamics.branches.sensitivity.map_derivatives"),
            ("extrema", extrema, "take dynamics.flow.motions.turning_points"),
        )
        with Faults() as faults:
            for name, value, remedy in asked:
                if value:
                    faults.add(name, value, "must be left out with the exact flow", remedy)
        return self

    def parted(self) -> PartedFlow | None:
        """The flow over parts of a period, as shooting over many stretches takes it; None if it has no such parts."""
        return None

    def calm(self, state: Array, limit: int, longest: int) -> tuple[Array, int, str]:
        """State after `limit` periods or when the motion repeats to rounding, periods followed, message."""
        if limit == 0:
            return state, 0, ""
        image = self.follow(state, 1, limit - 1, derivatives=False)
        return image.state, limit, image.message

    def settle(self, starts: Array, homes: Array, radius: float, limit: int, labels: Integers) -> int:
        """Follow every start with the label -1 until it stays near a known attractor; `starts` become the last states.

        Parameters
        ----------
        starts : ndarray, shape (k, dimension)
            Starting states.
        homes : ndarray, shape (m, dimension + 2)
            State, attractor and its period for every point of every attractor.
        radius : float
            A motion has arrived when it is so near to a point, in the largest norm, and no farther one round later.
        limit : int
            Periods.
        labels : ndarray of int, shape (k,)
            Becomes the attractor, -2 where the motion was lost.

        Returns
        -------
        int
            Periods used.
        """
        return in_blocks(
            len(starts),
            lambda a, b: self.settle_block(starts[a:b], homes, radius, limit, labels[a:b]),
            int(np.count_nonzero(labels == -1)),
        )

    def settle_block(self, starts: Array, homes: Array, radius: float, limit: int, labels: Integers) -> int:
        """As of `settle`, on one core."""
        used = 0
        for i in np.flatnonzero(labels == -1):
            home, wait, distance, period = 0, 0, 0.0, 0
            while labels[i] == -1 and period < limit:
                image = self.follow(starts[i], min(16, limit - period), derivatives=False)
                if image.message:
                    labels[i] = -2
                for state in image.states:
                    starts[i] = state
                    period, wait = period + 1, wait - 1
                    gaps = np.max(np.abs(homes[:, :-2] - state), axis=1)
                    if wait == 0 and gaps[home] <= distance:
                        labels[i] = int(homes[home, -2])
                        break
                    if wait < 0 and len(gaps) and gaps.min() < radius:
                        home = int(gaps.argmin())
                        distance, wait = float(gaps[home]), int(homes[home, -1])
            used += period
        return used


class PartedFlow(Flow):
    """A flow that is tabulated in cells of a period, and can be followed from any cell to any other."""

    @property
    @abstractmethod
    def cells(self) -> int:
        """Cells per period."""

    @abstractmethod
    def finer(self) -> PartedFlow:
        """The same with half the cell."""

    @abstractmethod
    def part(self, first: int, number: int, state: Array, counts: Integers) -> tuple[Array, Array, float]:
        """State after some cells, its derivative by the state before, time in contact if asked for; `counts` grow.

        All nan if the motion is lost.
        """

    @abstractmethod
    def damped(self, contact: float, periods: int) -> float:
        """Integral of the trace of all damping over whole periods, by the time in contact."""

    def parted(self) -> PartedFlow:
        """The flow itself."""
        return self


def lost_motion(state: Array, reason: str) -> InputError:
    """Error of a motion that cannot be followed."""
    allowed = "must start a motion that can be followed"
    return InputError.at("state", str(np.asarray(state).tolist()), allowed, f"{reason}: check the input")


def propagated(flow: Flow, states: npt.ArrayLike, periods: int, backwards: bool = False) -> Array:
    """States after whole periods, shape (any, dimension); nan where a motion is lost.

    Parameters
    ----------
    flow : Flow
        Of `dynamics.flow.flows.flow_of`, or of `dynamics.attraction.manifolds.reversed_tables` if backwards.
    states : array_like, shape (any, dimension)
        States at tau = 0.
    periods : int
        Excitation periods.
    backwards : bool
        Whether the flow is that of the reversed oscillator.
    """
    at = np.array(states, dtype=np.float64).reshape(-1, flow.dimension)
    turn = np.repeat([1.0, -1.0 if backwards else 1.0], flow.dimension // 2)
    at *= turn
    labels = np.full(len(at), -1, dtype=np.int64)
    nowhere = np.empty((0, flow.dimension + 2))
    flow.settle(at, nowhere, 0.0, periods, labels)  # followed to the end
    at[labels == -2] = np.nan
    return np.asarray(at * turn)
