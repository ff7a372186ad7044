"""What an oscillator offers; every function that takes any oscillator asks for no more than this and its flow.

A state is a vector: displacements, then their speeds. What a flow offers is in `dynamics.flow.protocol`.
"""

from __future__ import annotations

import functools
import math
from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import replace
from typing import Any, ClassVar, ParamSpec, Self, TypeVar

import numpy as np
import numpy.typing as npt

from base import Array, InputError
from dynamics.model.excitation import Harmonics, as_series, largest
from dynamics.model.naming import natural_size, unknown, value_at, with_value
from dynamics.model.options import OPTIONS
from dynamics.model.stiffness import FourierStiffness

EPS = float(np.finfo(np.float64).eps)
P = ParamSpec("P")
R = TypeVar("R")


class Oscillator(ABC):
    """What moves: a frozen record of parameters, each with a name."""

    is_exact: ClassVar = False
    """Whether the flow is the exact one in the plane: it runs backwards, and orbits are searched for by a kernel."""
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

    def in_plane(self, states: Array) -> Array:
        """X and V, in several freedoms y and its rate, of states (k, dimension) at tau = 0; shape (k, 2)."""
        return np.column_stack(self.contact_motion(np.zeros(len(states)), states))

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
    one_sided: bool

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
    def in_contact(self, side: int) -> tuple[Self, Array]:
        """Without backlash, and the state by which its motions lie off those that never leave a flank, 1 or -1."""

    @abstractmethod
    def turning_acceleration(self, state: Array) -> float:
        """Second derivative of the contact coordinate at tau = 0 where its rate is zero."""

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


def settling_periods(
    oscillator: Oscillator, low: int = OPTIONS.least_settling, high: int = OPTIONS.most_settling
) -> int:
    """Periods in which damping alone shrinks a disturbance by `OPTIONS.settling_factor`, within [low, high]."""
    decay = oscillator.decay * oscillator.period
    return high if decay <= 0.0 else int(min(max(math.log(OPTIONS.settling_factor) / decay, low), high))


def periodic_only(function: Callable[P, R]) -> Callable[P, R]:
    """Have a function refuse, by name, an oscillator whose force is no periodic stiffness past a backlash.

    So it does with what moves by one, such as an orbit.
    """

    @functools.wraps(function)
    def checked(*args: P.args, **kwargs: P.kwargs) -> R:
        argument: Any = args[0] if args else next(iter(kwargs.values()), None)
        oscillator = argument if isinstance(argument, Oscillator) else getattr(argument, "oscillator", None)
        if isinstance(oscillator, Oscillator) and not isinstance(oscillator, PeriodicOscillator):
            name = type(oscillator).__name__
            allowed = f"must be a GearOscillator or a DriveOscillator in {function.__name__}"
            remedy = (
                "period_map, trajectory, find_orbit, continue_branch, doubled_orbit, sweep, lyapunov_exponents, "
                f"basins, basin_boundary, edge_saddles, chaos_end and boundary_crisis take a {name} too"
            )
            raise InputError.at("oscillator", name, allowed, remedy)
        return function(*args, **kwargs)

    return checked
