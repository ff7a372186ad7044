"""What an oscillator and its flow offer; every function that takes any oscillator asks for no more.

There are three kinds of flow: the exact one of `GearOscillator`, that of `DriveOscillator` in several freedoms, and the
stepwise one of `SmoothOscillator`; `dynamics.flow.flows.flow_of` makes the one that an oscillator has. What not every
flow offers is asked for: derivatives by parameters (`Flow.slopes`), parts of a period (`Flow.parted`). A state is a
vector: displacements, then their speeds.
"""

from __future__ import annotations

import functools
import math
from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any, ClassVar, NamedTuple, ParamSpec, Self, TypeVar

import numpy as np
import numpy.typing as npt

from base import Array, Cost, Faults, InputError, Integers, quantity, record
from dynamics.model.excitation import Harmonics, as_series, largest
from dynamics.model.naming import natural_size, unknown, value_at, with_value
from dynamics.model.stiffness import FourierStiffness

EPS = float(np.finfo(np.float64).eps)
P = ParamSpec("P")
R = TypeVar("R")


@record
class MapResult:
    """Image of a state under n periods."""

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
    beside: ClassVar = "take dynamics.branches.sensitivity.map_derivatives"
    """What gives derivatives by parameters where the flow itself has none."""

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
            ("parameters", parameters, self.beside),
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


class Oscillator(ABC):
    """What moves: a frozen record of parameters, each with a name."""

    is_exact: ClassVar = False
    """Whether the flow is the exact one in the plane, which many functions need."""
    has_steps: ClassVar = True
    """Whether the flow takes steps, of a tolerance."""

    error_amplitude: Harmonics
    error_phase: Harmonics
    frequency: float

    @property
    @abstractmethod
    def parameters(self) -> tuple[str, ...]:
        """Names of all parameters, as `get` and `with_parameter` take them."""

    @property
    @abstractmethod
    def floor(self) -> float:
        """Smallest size that a motion is measured by."""

    @abstractmethod
    def rest_state(self) -> Array:
        """State at rest under the mean force."""

    @abstractmethod
    def start_plane(self) -> tuple[Array, Array]:
        """Directions, shape (2, dimension), of the starts of basins, and the state that their plane passes."""

    @property
    def period(self) -> float:
        r"""Excitation period :math:`T = 2 \pi / \omega`."""
        return 2.0 * math.pi / self.frequency

    @property
    @abstractmethod
    def dimension(self) -> int:
        """Length of a state."""

    @property
    @abstractmethod
    def decay(self) -> float:
        """Rate at which damping shrinks a disturbance."""

    @property
    def directions(self) -> int:
        """Independent directions of a disturbance."""
        return self.dimension

    @property
    def natural_size(self) -> float:
        """Size of the displacements that go in."""
        return natural_size(self.floor, self.driven_size)

    @property
    @abstractmethod
    def driven_size(self) -> float:
        """Size of the displacements that the forces and the error make, without the backlash."""

    @abstractmethod
    def contact_motion(self, tau: Array, states: Array) -> tuple[Array, Array]:
        """Displacement that the backlash limits, and its rate, of states (k, dimension) at times (k,)."""

    def contact_force(self, angle: Array, x: Array) -> Array:
        """Force of the contact at angles of the excitation.

        Raises
        ------
        InputError
            If it is no periodic stiffness times the deflection past a backlash.
        """
        allowed = "must be a GearOscillator or a DriveOscillator in mesh_force"
        remedy = "restoring_force gives the force of a SmoothOscillator"
        raise InputError.at("oscillator", type(self).__name__, allowed, remedy)

    def with_frequency_step(self, state: Array, before: float, after: float) -> Array:
        """State at tau = 0 just after the frequency has changed there: what is counted without the error stays."""
        return state

    @property
    def error_series(self) -> Array:
        """Amplitudes and phases [rad] of the harmonics of the unloaded transmission error, shape (2, harmonics)."""
        return as_series(self.error_amplitude, self.error_phase)

    def get(self, parameter: str) -> float:
        """Value of a parameter.

        Raises
        ------
        InputError
            If there is no such parameter.
        """
        self._known(parameter)
        return value_at(self, parameter)

    def with_parameter(self, parameter: str, value: float) -> Self:
        """Return the oscillator with one parameter changed.

        Raises
        ------
        InputError
            If there is no such parameter, or the value is not allowed.
        """
        self._known(parameter)
        changed: Self = with_value(self, parameter, value)
        return changed

    def _known(self, parameter: str) -> None:
        if parameter not in self.parameters:
            raise unknown(parameter, self.parameters)


class PeriodicOscillator(Oscillator):
    """What moves by a periodic stiffness times the deflection past a backlash."""

    stiffness_name: ClassVar[str]
    """Field of the stiffness."""
    half_backlash: float

    @property
    def contact_stiffness(self) -> FourierStiffness:
        """Periodic stiffness in contact."""
        stiffness: FourierStiffness = getattr(self, self.stiffness_name)
        return stiffness

    def with_contact_stiffness(self, stiffness: FourierStiffness) -> Self:
        """The same with another periodic stiffness in contact."""
        same: Any = self  # a dataclass, as all oscillators are
        changed: Self = replace(same, **{self.stiffness_name: stiffness})
        return changed

    @abstractmethod
    def balanced(self, tau: Array) -> Array:
        """States at rest at some times, shape (k, dimension), near which a slow motion stays."""

    @abstractmethod
    def deflection(self, x: npt.ArrayLike) -> Array:
        """Deflection f(X) past the backlash, shape of `x`."""

    def contact_force(self, angle: Array, x: Array) -> Array:
        """Force k f(X) at angles of the excitation."""
        return np.asarray(self.contact_stiffness(angle) * self.deflection(x))


class PlanarOscillator(Oscillator):
    """What moves in one freedom: a state is X and V."""

    dimension = 2
    damping_ratio: float
    mean_force: float

    @property
    def decay(self) -> float:
        """The damping ratio, that in contact."""
        return self.damping_ratio

    @property
    def driven_size(self) -> float:
        """The mean force, over a stiffness of 1, or the error."""
        return natural_size(self.mean_force, largest(self.error_series))

    def contact_motion(self, tau: Array, states: Array) -> tuple[Array, Array]:
        """X and V."""
        return states[:, 0], states[:, 1]

    def with_frequency_step(self, state: Array, before: float, after: float) -> Array:
        """State at tau = 0 just after the frequency has changed there: V is counted from the error's rate."""
        amplitudes, phases = self.error_series
        j = np.arange(1, len(amplitudes) + 1)
        slope = float(-np.sum(j * amplitudes * np.sin(phases)))
        return np.array([state[0], state[1] - (after - before) * slope])

    def start_plane(self) -> tuple[Array, Array]:
        """The plane of X and V."""
        return np.eye(2), np.zeros(2)


def lost_motion(state: Array, reason: str) -> InputError:
    """Error of a motion that cannot be followed."""
    allowed = "must start a motion that can be followed"
    return InputError.at("state", str(np.asarray(state).tolist()), allowed, f"{reason}: check the input")


def settling_periods(oscillator: Oscillator, low: int = 200, high: int = 5000) -> int:
    """Periods in which damping alone shrinks a disturbance by 1e-6, within [low, high]."""
    decay = oscillator.decay * oscillator.period
    return high if decay <= 0.0 else int(min(max(math.log(1e6) / decay, low), high))


def exact_only(function: Callable[P, R]) -> Callable[P, R]:
    """Have a function refuse, by name, an oscillator that is no `GearOscillator`, or what moves by another one."""
    return _refusing(function, lambda oscillator: oscillator.is_exact, "a GearOscillator")


def periodic_only(function: Callable[P, R]) -> Callable[P, R]:
    """Have a function refuse, by name, an oscillator whose force is no periodic stiffness past a backlash."""
    allowed = "a GearOscillator or a DriveOscillator"
    return _refusing(function, lambda oscillator: isinstance(oscillator, PeriodicOscillator), allowed)


def _refusing(function: Callable[P, R], takes: Callable[[Oscillator], bool], allowed: str) -> Callable[P, R]:
    """Have a function refuse, by name, an oscillator that it does not take, or what moves by one."""

    @functools.wraps(function)
    def checked(*args: P.args, **kwargs: P.kwargs) -> R:
        argument: Any = args[0] if args else next(iter(kwargs.values()), None)
        oscillator = argument if isinstance(argument, Oscillator) else getattr(argument, "oscillator", None)
        if isinstance(oscillator, Oscillator) and not takes(oscillator):
            name = type(oscillator).__name__
            raise InputError.at(
                "oscillator", name, f"must be {allowed} in {function.__name__}",
                "period_map, trajectory, find_orbit, continue_branch, doubled_orbit, sweep, lyapunov_exponents and "
                f"basins take a {name} too",
            )  # fmt: skip
        return function(*args, **kwargs)

    return checked
