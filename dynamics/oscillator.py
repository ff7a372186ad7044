"""The oscillator with periodic stiffness and backlash, and the checks of its parameters."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
import numpy.typing as npt

from base import Array, Faults, InputError
from dynamics.limits import OSCILLATOR
from dynamics.naming import series, series_names
from dynamics.protocol import Oscillator
from dynamics.stiffness import FourierStiffness, check_stiffness

PARAMETERS = ("frequency", "error_amplitude", "error_phase", "mean_force", "damping_ratio", "half_backlash")
# of these and the mean stiffness, in the vector of `GearOscillator.packed`
_PLACES = {
    "stiffness.mean": 0,
    "damping_ratio": 1,
    "mean_force": 2,
    "error_amplitude": 3,
    "frequency": 4,
    "error_phase": 5,
    "half_backlash": 6,
}
MAX_CELLS = 200_000  # memory of the tables: about 1 kB a cell


@dataclass(frozen=True)
class GearOscillator(Oscillator):
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

    is_exact: ClassVar = True

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
        with Faults() as faults:
            check_stiffness(faults, self.stiffness)
            values = {
                name: faults.number(name, getattr(self, name), limit) for name, limit in OSCILLATOR.items()
            }
            faults.choice("one_sided", self.one_sided, (True, False), "True leaves the second flank out")
        for name, value in values.items():
            object.__setattr__(self, name, value)
        if not self.cells <= MAX_CELLS:
            allowed = f"must give a period of at most {MAX_CELLS} cells (this has {self.cells:.3g})"
            remedy = "raise the frequency, or lower the stiffness"
            raise InputError.at("frequency", self.frequency, allowed, remedy)

    @property
    def cells(self) -> float:
        """Cells that the exact flow divides a period into, before rounding up."""
        return cells_per_period(self.packed())

    @property
    def floor(self) -> float:
        """Half the backlash."""
        return max(self.half_backlash, 1e-300)

    def packed(self) -> Array:
        """All parameters in one vector, as the kernels take them: `par` (8), amplitudes, phases."""
        mean, *harmonics = series(self.stiffness)
        sides = 1.0 if self.one_sided else 2.0
        own = (
            mean, self.damping_ratio, self.mean_force, self.error_amplitude, self.frequency, self.error_phase,
            self.half_backlash, sides,
        )  # fmt: skip
        return np.array([*own, *harmonics])

    @property
    def parameters(self) -> tuple[str, ...]:
        """Names of all parameters: ``frequency``, ..., ``stiffness.mean``, ``stiffness.amplitudes[0]``, ..."""
        return PARAMETERS + series_names(self.stiffness.order)

    def place(self, parameter: str) -> int:
        """Index of a parameter in the vector of `packed`.

        Raises
        ------
        InputError
            If there is no such parameter.
        """
        self._known(parameter)
        if parameter in _PLACES:
            return _PLACES[parameter]
        return 7 + self.parameters.index(parameter) - len(PARAMETERS)

    def rest_state(self) -> Array:
        """State at rest with the flanks pressed together by the mean force, at the centre without one."""
        force, k = self.mean_force, self.stiffness.mean
        if force == 0.0 or k == 0.0:
            return np.zeros(2)
        return np.array([math.copysign(self.half_backlash, force) + force / k, 0.0])

    def force(self, tau: npt.ArrayLike) -> Array:
        r"""Return :math:`F_m + \varepsilon \omega^2 \cos(\omega \tau + \varphi_e)`, shape of `tau`."""
        angle = self.frequency * np.asarray(tau, dtype=np.float64) + self.error_phase
        return np.asarray(self.mean_force + self.error_amplitude * self.frequency**2 * np.cos(angle))

    def deflection(self, x: npt.ArrayLike) -> Array:
        """Deflection f(X) past the backlash, shape of `x`."""
        at = np.asarray(x, dtype=np.float64)
        lower = -np.inf if self.one_sided else -self.half_backlash
        return np.asarray(at - np.clip(at, lower, self.half_backlash))


def cells_per_period(packed: Array) -> float:
    """Cells of a period, before rounding up: half a radian at most of every time scale in each."""
    order = (len(packed) - 8) // 2
    stiffest = abs(packed[0]) + float(np.sum(np.abs(packed[8 : 8 + order])))
    period = 2.0 * math.pi / float(packed[4])
    drag = 2.0 * float(packed[1]) * period
    return 2.0 * max(period * math.sqrt(stiffest), 2.0 * math.pi * max(order, 1), drag)
