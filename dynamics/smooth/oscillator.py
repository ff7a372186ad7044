"""The oscillator with any restoring force, and how it is handed to the kernels."""

from __future__ import annotations

import dataclasses
import math
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import numpy.typing as npt

from base import Faults, InputError
from dynamics.limits import NUMBER, OSCILLATOR, STEP_TOLERANCE
from dynamics.smooth.laws import Law
from dynamics.smooth.naming import natural_size, unknown

__all__ = ["OWN", "Engine", "SmoothOscillator"]

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]
OWN = ("damping_ratio", "mean_force", "error_amplitude", "frequency", "error_phase")
TURNING = np.array([[0.0, 1.0, 0.0, -1.0]])  # the surface V = 0


@dataclass(frozen=True)
class SmoothOscillator:
    r"""Oscillator with a smooth or piecewise smooth restoring force.

    .. math::

        \ddot X + 2 \zeta \dot X + f(\omega\tau, X, \dot X)
        = F_m + \varepsilon \omega^2 \cos(\omega \tau + \varphi_e)

    Parameters
    ----------
    law : Law
        :math:`f`, periodic in its first argument.
    damping_ratio : float
        :math:`\zeta`; negative values are allowed, a law may hold damping of its own.
    mean_force, error_amplitude : float
        :math:`F_m, \varepsilon`.
    frequency : float
        :math:`\omega > 0`.
    error_phase : float
        :math:`\varphi_e` [rad].

    Raises
    ------
    InputError
        With every fault found.
    """

    law: Law
    damping_ratio: float
    mean_force: float
    error_amplitude: float
    frequency: float
    error_phase: float = 0.0

    def __post_init__(self) -> None:
        """Check; every fault is listed."""
        faults = Faults()
        if not all(hasattr(self.law, name) for name in ("names", "values", "data", "surfaces")):
            faults.add(
                "law",
                self.law,
                "must be a law",
                "PowerContact, SmoothedBacklash, TabulatedContact, CompiledLaw",
            )
        for name in OWN:
            if name != "frequency":
                faults.number(name, getattr(self, name), NUMBER)
        faults.number("frequency", self.frequency, OSCILLATOR["frequency"])
        faults.raise_if_any()
        if not np.all(np.isfinite(self.law.values)):
            faults.add("law", self.law.values.tolist(), "must have finite parameters", "correct the law")
        faults.raise_if_any()

    @property
    def period(self) -> float:
        r"""Excitation period :math:`T = 2 \pi / \omega`."""
        return 2.0 * math.pi / self.frequency

    @property
    def parameters(self) -> tuple[str, ...]:
        """Names of all parameters: its own and those of the law."""
        return (*OWN, *self.law.names)

    @property
    def size(self) -> float:
        """Natural size of a displacement."""
        return natural_size(self.law.size, self.mean_force, self.error_amplitude)

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
        if parameter not in self.parameters:
            raise unknown(parameter, self.parameters)
        return self.parameters.index(parameter)

    def with_parameter(self, parameter: str, value: float) -> SmoothOscillator:
        """Return the oscillator with one parameter changed.

        Raises
        ------
        InputError
            If there is no such parameter, or the value is not allowed.
        """
        self.place(parameter)
        if parameter in OWN:
            change: dict[str, Any] = {parameter: float(value)}
            return dataclasses.replace(self, **change)
        return dataclasses.replace(self, law=self.law.with_value(parameter, value))

    @property
    def own(self) -> FloatArray:
        """Values of the parameters that are not the law's."""
        return np.array([getattr(self, name) for name in OWN], dtype=np.float64)


class Engine:
    """An oscillator made ready for the kernels.

    Parameters
    ----------
    oscillator : SmoothOscillator
        The oscillator.
    tolerance : float
        Of a step, relative to the size of the motion.
    parameters : tuple of str
        Parameters to differentiate by.
    turning : bool
        Whether extrema of X are met and noted, like crossings.
    """

    def __init__(
        self,
        oscillator: SmoothOscillator,
        tolerance: float,
        parameters: tuple[str, ...] = (),
        turning: bool = False,
    ) -> None:
        law = oscillator.law
        self.oscillator, self.tolerance = oscillator, checked_tolerance(tolerance)
        ways = np.array([oscillator.place(name) for name in parameters], dtype=np.int64)
        values = np.ascontiguousarray(law.values, dtype=np.float64)
        data = np.ascontiguousarray(law.data, dtype=np.float64)
        self.model = (oscillator.own, law.compiled, values, data, ways)
        levels = np.ascontiguousarray(law.surfaces, dtype=np.float64).reshape(-1, 4)
        self.levels = len(levels)
        self.surfaces = np.vstack([levels, TURNING]) if turning else levels
        self.columns = 2 + len(ways)
        self.size = 1e-2 * oscillator.size

    def vector(self, state: FloatArray, derivatives: bool) -> FloatArray:
        """State with the unit matrix as its derivative."""
        y = np.zeros(3 + 2 * self.columns if derivatives else 2)
        y[:2] = state
        if derivatives:
            y[3] = y[6] = 1.0
        return y

    @cached_property
    def first_step(self) -> float:
        """Angle of the first try."""
        return min(0.1, 0.1 * self.oscillator.frequency)

    def going(self) -> tuple[FloatArray, IntArray]:
        """What passes from call to call, at a start."""
        return np.array([-1.0, self.first_step, 0.0, 0.0]), np.zeros(len(self.surfaces), dtype=np.int64)


def checked_tolerance(tolerance: float) -> float:
    """Return the tolerance, or raise InputError."""
    faults = Faults()
    number = faults.number("tolerance", tolerance, STEP_TOLERANCE)
    if faults.found:
        raise InputError(tuple(faults.found))
    return number
