"""The oscillator with any restoring force."""

from __future__ import annotations

import dataclasses
import math
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from base import Array, Faults, InputError, Integers
from dynamics.model.contact_laws import Law
from dynamics.model.excitation import Harmonics, checked_series, harmonic_names, largest
from dynamics.model.limits import NUMBER, OSCILLATOR
from dynamics.model.naming import natural_size, value_at, with_value
from dynamics.model.protocol import PlanarOscillator


@dataclass(frozen=True)
class SmoothOscillator(PlanarOscillator):
    r"""Oscillator with a smooth or piecewise smooth restoring force.

    .. math::

        \ddot X + 2 \zeta \dot X + f(\omega\tau, X, \dot X)
        = F_m + \omega^2 \sum_j j^2 \varepsilon_j \cos(j \omega \tau + \varphi_{e,j})

    Parameters
    ----------
    law : Law
        :math:`f`, periodic in its first argument.
    damping_ratio : float
        :math:`\zeta`; negative values are allowed, a law may have separate damping.
    mean_force : float
        :math:`F_m`.
    error_amplitude : float or sequence of float
        :math:`\varepsilon_j` of the harmonics j = 1, 2, ...; a number is the first harmonic alone.
    frequency : float
        :math:`\omega > 0`.
    error_phase : float or sequence of float
        :math:`\varphi_{e,j}` [rad], one for each amplitude, or 0 for all of them.

    Raises
    ------
    InputError
        With every fault found.
    """

    law: Law
    damping_ratio: float
    mean_force: float
    error_amplitude: Harmonics
    frequency: float
    error_phase: Harmonics = 0.0

    def __post_init__(self) -> None:
        """Check; every fault is listed."""
        faults = Faults()
        if not all(hasattr(self.law, name) for name in ("names", "values", "data", "surfaces")):
            laws = "PowerContact, SmoothedBacklash, TabulatedContact, CompiledLaw"
            faults.add("law", self.law, "must be a law", laws)
        for name in ("damping_ratio", "mean_force", "frequency"):
            faults.number(name, getattr(self, name), NUMBER if name == "damping_ratio" else OSCILLATOR[name])
        amplitude, phase = checked_series(faults, self.error_amplitude, self.error_phase)
        faults.raise_if_any()
        object.__setattr__(self, "error_amplitude", amplitude)
        object.__setattr__(self, "error_phase", phase)
        if not np.all(np.isfinite(self.law.values)):
            faults.add("law", self.law.values.tolist(), "must have finite parameters", "correct the law")
        faults.raise_if_any()

    @property
    def parameters(self) -> tuple[str, ...]:
        """Names of all parameters: its own and those of the law."""
        return (*self._own_names, *self.law.names)

    @property
    def _own_names(self) -> tuple[str, ...]:
        """Parameters that are not the law's, as the kernels have them."""
        amplitudes, phases = harmonic_names(self.error_series.shape[1])
        first = ("damping_ratio", "mean_force", amplitudes[0], "frequency", phases[0])
        return (*first, *amplitudes[1:], *phases[1:])

    @property
    def floor(self) -> float:
        """Natural size of a displacement."""
        return natural_size(self.law.size, self.mean_force, largest(self.error_series))

    @property
    def own(self) -> Array:
        """Values of the parameters that are not the law's."""
        return np.array([value_at(self, name) for name in self._own_names], dtype=np.float64)

    @property
    def surfaces(self) -> Array:
        """Switching surfaces of the law, shape (s, 4), as the kernels take them."""
        return np.ascontiguousarray(self.law.surfaces, dtype=np.float64).reshape(-1, 4)

    def model(self, parameters: tuple[str, ...] = ()) -> tuple[Array, Any, Array, Array, Integers]:
        """What moves, as the kernels take it: own parameters, law, its values and data, places to differentiate by.

        Raises
        ------
        InputError
            If there is no such parameter.
        """
        law = self.law
        values = np.ascontiguousarray(law.values, dtype=np.float64)
        data = np.ascontiguousarray(law.data, dtype=np.float64)
        places = np.array([self.place(name) for name in parameters], dtype=np.int64)
        return self.own, law.compiled, values, data, places

    def get(self, parameter: str) -> float:
        """Value of a parameter.

        Raises
        ------
        InputError
            If there is no such parameter.
        """
        return float(np.concatenate([self.own, self.law.values])[self.place(parameter)])

    def place(self, parameter: str) -> int:
        """Index of a parameter among all.

        Raises
        ------
        InputError
            If there is no such parameter.
        """
        self._known(parameter)
        return self.parameters.index(parameter)

    def with_parameter(self, parameter: str, value: float) -> SmoothOscillator:
        """Return the oscillator with one parameter changed.

        Raises
        ------
        InputError
            If there is no such parameter, or the value is not allowed.
        """
        self._known(parameter)
        if parameter in self.law.names:
            return dataclasses.replace(self, law=self.law.with_value(parameter, value))
        changed: SmoothOscillator = with_value(self, parameter, float(value))
        return changed

    def rest_state(self) -> Array:
        """State at rest where the mean of the force over the angle balances the mean force; zeros if there is none."""
        angles = np.linspace(0.0, 2.0 * np.pi, 64, endpoint=False)
        side = math.copysign(1.0, self.mean_force)

        def excess(x: float) -> float:
            mean = float(restoring_force(self, angles, np.full(64, side * x))[:, 0].mean())
            return side * (mean - self.mean_force)

        low, high = 0.0, self.floor
        for _ in range(60):
            if excess(high) > 0.0:
                break
            low, high = high, 2.0 * high
        else:
            return np.zeros(2)
        if excess(low) > 0.0:
            return np.zeros(2)
        for _ in range(60):
            middle = 0.5 * (low + high)
            low, high = (low, middle) if excess(middle) > 0.0 else (middle, high)
        return np.array([side * high, 0.0])


def restoring_force(
    oscillator: SmoothOscillator, angle: npt.ArrayLike, x: npt.ArrayLike, v: npt.ArrayLike = 0.0
) -> Array:
    """Restoring force of a law and its derivatives with respect to X and V, last axis 3.

    Parameters
    ----------
    oscillator : SmoothOscillator
        Whose law is meant.
    angle, x, v : array_like
        Angle omega tau [rad], X and V, broadcast against each other.

    Examples
    --------
    >>> from dynamics import FourierStiffness, PowerContact, SmoothOscillator
    >>> law = PowerContact(stiffness=FourierStiffness(1.0), half_backlash=0.2, exponent=1.0)
    >>> oscillator = SmoothOscillator(law, 0.05, 0.1, 0.2, 0.6)
    >>> restoring_force(oscillator, 0.0, [0.1, 0.5])[:, 0]
    array([0. , 0.3])
    """
    from dynamics.kernels.stepwise.propagating import probe

    if not isinstance(oscillator, SmoothOscillator):
        name, allowed = type(oscillator).__name__, "must be a SmoothOscillator in restoring_force"
        raise InputError.at("oscillator", name, allowed, "any other has its force written in its equation")

    theta, place, speed = np.broadcast_arrays(angle, x, v)
    model = oscillator.model()
    out = np.empty((theta.size, 3 + len(model[2])))
    points = np.column_stack([np.asarray(a, dtype=np.float64).ravel() for a in (theta, place, speed)])
    probe(model, oscillator.surfaces, points, out)
    return out[:, :3].reshape(*theta.shape, 3)
