"""The oscillator with periodic stiffness and backlash, and the checks of its parameters."""

from __future__ import annotations

import dataclasses
import math
import re
from dataclasses import dataclass
from typing import Any, TypeVar

import numpy as np
import numpy.typing as npt

from base import Faults, InputError
from dynamics.limits import OSCILLATOR
from dynamics.stiffness import FourierStiffness

__all__ = ["PARAMETERS", "GearOscillator"]

FloatArray = npt.NDArray[np.float64]
PARAMETERS = ("frequency", "error_amplitude", "error_phase", "mean_force", "damping_ratio", "half_backlash")
_PLACES = {
    "mean": 0,
    "damping_ratio": 1,
    "mean_force": 2,
    "error_amplitude": 3,
    "frequency": 4,
    "error_phase": 5,
    "half_backlash": 6,
}
MAX_CELLS = 200_000  # memory of the tables: about 1 kB a cell


@dataclass(frozen=True)
class GearOscillator:
    r"""Dimensionless torsional oscillator of a gear pair with backlash.

    .. math::

        \ddot X + 2 \zeta \dot X + K(\tau) f(X) = F_m + \varepsilon \omega^2 \cos(\omega \tau + \varphi_e),
        \qquad f(X) = X - D, \; 0, \; X + D \quad \text{for } X > D, \; |X| \le D, \; X < -D.

    Parameters
    ----------
    stiffness : FourierStiffness
        :math:`K(\tau)`; mean 1 in the usual scaling.
    damping_ratio : float
        :math:`\zeta \ge 0`; the damping acts in the dead zone too.
    mean_force : float
        :math:`F_m`; positive presses the driving flanks together.
    error_amplitude : float
        :math:`\varepsilon`, amplitude of the unloaded transmission error.
    frequency : float
        :math:`\omega > 0`, mesh frequency over natural frequency.
    half_backlash : float
        :math:`D \ge 0`.
    error_phase : float
        :math:`\varphi_e` [rad], relative to :math:`\tau = 0`, like the phases of the stiffness.
    one_sided : bool
        No second flank: f(X) = 0 for all X <= D, as for a gear with much backlash or a follower on a cam.

    Raises
    ------
    InputError
        With every fault found; also if the period is so long that its table would have more than 200 000
        cells.
    """

    stiffness: FourierStiffness
    damping_ratio: float
    mean_force: float
    error_amplitude: float
    frequency: float
    half_backlash: float
    error_phase: float = 0.0
    one_sided: bool = False

    def __post_init__(self) -> None:
        """Check and convert; every fault is listed."""
        faults = Faults()
        if not isinstance(self.stiffness, FourierStiffness):
            faults.add(
                "stiffness",
                self.stiffness,
                "must be a FourierStiffness",
                "build one, or fit one with fit_fourier",
            )
        values = {
            "damping_ratio": faults.number("damping_ratio", self.damping_ratio, OSCILLATOR["damping_ratio"]),
            "mean_force": faults.number("mean_force", self.mean_force, OSCILLATOR["mean_force"]),
            "error_amplitude": faults.number(
                "error_amplitude", self.error_amplitude, OSCILLATOR["error_amplitude"]
            ),
            "frequency": faults.number(
                "frequency",
                self.frequency,
                OSCILLATOR["frequency"],
            ),
            "half_backlash": faults.number(
                "half_backlash",
                self.half_backlash,
                OSCILLATOR["half_backlash"],
            ),
            "error_phase": faults.number("error_phase", self.error_phase, OSCILLATOR["error_phase"]),
        }
        if not isinstance(self.one_sided, bool):
            faults.add(
                "one_sided", self.one_sided, "must be True or False", "True leaves the second flank out"
            )
        faults.raise_if_any()
        for name, value in values.items():
            object.__setattr__(self, name, value)
        if not self.cells <= MAX_CELLS:
            allowed = f"must give a period of at most {MAX_CELLS} cells (this has {self.cells:.3g})"
            faults.add("frequency", self.frequency, allowed, "raise the frequency, or lower the stiffness")
            faults.raise_if_any()

    @property
    def period(self) -> float:
        r"""Excitation period :math:`T = 2 \pi / \omega`."""
        return 2.0 * np.pi / self.frequency

    @property
    def cells(self) -> float:
        """Cells that the exact flow divides a period into, before rounding up."""
        return cells_per_period(self.packed())

    def get(self, parameter: str) -> float:
        """Value of a parameter named as in `with_parameter`.

        Raises
        ------
        InputError
            If there is no such parameter.
        """
        name, index = _resolve(self, parameter)
        if name in PARAMETERS:
            return float(getattr(self, name))
        if name == "mean":
            return self.stiffness.mean
        return float(getattr(self.stiffness, name)[index])

    def with_parameter(self, parameter: str, value: float) -> GearOscillator:
        """Return the oscillator with one parameter changed.

        Parameters
        ----------
        parameter : str
            ``"frequency"``, ``"error_amplitude"``, ``"error_phase"``, ``"mean_force"``, ``"damping_ratio"``,
            ``"half_backlash"``, ``"stiffness.mean"``, ``"stiffness.amplitudes[0]"``,
            ``"stiffness.phases[0]"``, ...
        value : float
            The new value.

        Raises
        ------
        InputError
            If there is no such parameter, or the value is not allowed.
        """
        name, index = _resolve(self, parameter)
        if name in PARAMETERS:
            return _replaced(self, name, value)
        if name == "mean":
            return dataclasses.replace(self, stiffness=dataclasses.replace(self.stiffness, mean=value))
        series = list(getattr(self.stiffness, name))
        series[index] = value
        return dataclasses.replace(self, stiffness=_replaced(self.stiffness, name, tuple(series)))

    def packed(self) -> FloatArray:
        """All parameters in one vector, as the kernels take them: `par` (8), amplitudes, phases."""
        k = self.stiffness
        sides = 1.0 if self.one_sided else 2.0
        own = (
            k.mean, self.damping_ratio, self.mean_force, self.error_amplitude, self.frequency, self.error_phase,
            self.half_backlash, sides,
        )  # fmt: skip
        return np.array(own + k.amplitudes + k.phases)

    @property
    def parameters(self) -> tuple[str, ...]:
        """Names of all parameters, as in `with_parameter`."""
        series = ("amplitudes", "phases")
        terms = tuple(f"stiffness.{name}[{j}]" for name in series for j in range(self.stiffness.order))
        return (*PARAMETERS, "stiffness.mean", *terms)

    def place(self, parameter: str) -> int:
        """Index of a parameter, named as in `with_parameter`, in the vector of `packed`.

        Raises
        ------
        InputError
            If there is no such parameter.
        """
        name, index = _resolve(self, parameter)
        if name in _PLACES:
            return _PLACES[name]
        return 8 + index + (self.stiffness.order if name == "phases" else 0)

    def mirrored(self) -> GearOscillator:
        """Return the oscillator of -X, which has forces and error reversed.

        Raises
        ------
        InputError
            If there is play on one side only: -X would have it on the other.
        """
        if self.one_sided:
            faults = Faults()
            faults.add("one_sided", True, "must be False", "only that has a mirror image of its kind")
            faults.raise_if_any()
        return dataclasses.replace(self, mean_force=-self.mean_force, error_amplitude=-self.error_amplitude)

    def force(self, tau: npt.ArrayLike) -> FloatArray:
        r"""Return :math:`F_m + \varepsilon \omega^2 \cos(\omega \tau + \varphi_e)`, shape of `tau`."""
        angle = self.frequency * np.asarray(tau, dtype=np.float64) + self.error_phase
        return np.asarray(self.mean_force + self.error_amplitude * self.frequency**2 * np.cos(angle))

    def deflection(self, x: npt.ArrayLike) -> FloatArray:
        """Deflection f(X) past the backlash, shape of `x`."""
        at = np.asarray(x, dtype=np.float64)
        lower = -np.inf if self.one_sided else -self.half_backlash
        return np.asarray(at - np.clip(at, lower, self.half_backlash))


def cells_per_period(packed: FloatArray) -> float:
    """Cells of a period, before rounding up: half a radian at most of every time scale in each."""
    order = (len(packed) - 8) // 2
    stiffest = abs(packed[0]) + float(np.sum(np.abs(packed[8 : 8 + order])))
    period = 2.0 * math.pi / float(packed[4])
    drag = 2.0 * float(packed[1]) * period
    return 2.0 * max(period * math.sqrt(stiffest), 2.0 * math.pi * max(order, 1), drag)


Record = TypeVar("Record", GearOscillator, FourierStiffness)


def _replaced(record: Record, name: str, value: float | tuple[float, ...]) -> Record:
    """Copy of a frozen record with one field changed, checked again."""
    changed: dict[str, Any] = {name: value}
    return dataclasses.replace(record, **changed)


def _resolve(oscillator: GearOscillator, parameter: str) -> tuple[str, int]:
    """Attribute and index that a parameter name stands for."""
    order = oscillator.stiffness.order
    if parameter in PARAMETERS:
        return parameter, -1
    if parameter == "stiffness.mean":
        return "mean", -1
    match = re.fullmatch(r"stiffness\.(amplitudes|phases)\[(\d+)\]", str(parameter))
    if match and int(match[2]) < order:
        return match[1], int(match[2])
    faults = Faults()
    series = f", stiffness.amplitudes[0..{order - 1}], stiffness.phases[0..{order - 1}]" if order else ""
    faults.add(
        "parameter",
        parameter,
        f"must be one of {', '.join((*PARAMETERS, 'stiffness.mean'))}{series}",
        "name one of these",
    )
    raise InputError(tuple(faults.found))
