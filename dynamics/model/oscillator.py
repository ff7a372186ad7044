"""The oscillator with periodic stiffness and backlash, and the checks of its parameters."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np
import numpy.typing as npt

from base import Array, Faults, InputError
from dynamics.model.excitation import (
    AMPLITUDE,
    PHASE,
    Harmonics,
    checked_series,
    harmonic_names,
    highest_harmonic,
    push,
)
from dynamics.model.limits import OSCILLATOR
from dynamics.model.naming import series, series_names
from dynamics.model.protocol import PeriodicOscillator, PlanarOscillator
from dynamics.model.stiffness import FourierStiffness, check_stiffness

# in the vector of `GearOscillator.packed`, as in `dynamics.kernels`; amplitude and phase are the first harmonic's
_PLACES = {
    "stiffness.mean": 0,
    "damping_ratio": 1,
    "mean_force": 2,
    AMPLITUDE: 3,
    "frequency": 4,
    PHASE: 5,
    "half_backlash": 6,
    "free_damping_ratio": 9,
}
_ORDER, _FREE = 8, _PLACES["free_damping_ratio"]
_SERIES = (
    10  # where amplitudes and phases of the stiffness begin; those of the error's further harmonics follow
)
MAX_CELLS = 200_000  # memory of the tables: about 1 kB a cell


@dataclass(frozen=True)
class GearOscillator(PeriodicOscillator, PlanarOscillator):
    r"""Dimensionless torsional oscillator of a gear pair with backlash.

    .. math::

        \ddot X + 2 \zeta(X) \dot X + K(\tau) f(X)
        = F_m + \omega^2 \sum_j j^2 \varepsilon_j \cos(j \omega \tau + \varphi_{e,j}),
        \qquad f(X) = X - D, \; 0, \; X + D \quad \text{for } X > D, \; |X| \le D, \; X < -D.

    Parameters
    ----------
    stiffness : FourierStiffness
        :math:`K(\tau)`; mean 1 in the usual scaling.
    damping_ratio : float
        :math:`\zeta \ge 0`, in contact; in the dead zone too unless `free_damping_ratio` is given.
    mean_force : float
        :math:`F_m`; positive presses the driving flanks together.
    error_amplitude : float or sequence of float
        :math:`\varepsilon_j`, amplitudes of the harmonics j = 1, 2, ... of the unloaded transmission error; a number
        is the first harmonic alone.
    frequency : float
        :math:`\omega > 0`, mesh frequency over natural frequency.
    half_backlash : float
        :math:`D \ge 0`.
    error_phase : float or sequence of float
        :math:`\varphi_{e,j}` [rad], relative to :math:`\tau = 0`, like the phases of the stiffness; one for each
        amplitude, or 0 for all of them.
    one_sided : bool
        No second flank: f(X) = 0 for all X <= D, as for a gear with much backlash or a follower on a cam.
    free_damping_ratio : float, optional
        :math:`\zeta` in the dead zone, where f is 0: at least 0. Left out: as in contact.

    Raises
    ------
    InputError
        With every fault found; also if the period is so long that its table would have more than 200 000
        cells.
    """

    is_exact: ClassVar = True
    has_steps: ClassVar = False
    stiffness_name: ClassVar = "stiffness"

    stiffness: FourierStiffness
    damping_ratio: float
    mean_force: float
    error_amplitude: Harmonics
    frequency: float
    half_backlash: float
    error_phase: Harmonics = 0.0
    one_sided: bool = False
    free_damping_ratio: float | None = None

    def __post_init__(self) -> None:
        """Check and convert; every fault is listed."""
        with Faults() as faults:
            check_stiffness(faults, self.stiffness)
            values: dict[str, Harmonics] = {
                name: faults.number(name, getattr(self, name), limit)
                for name, limit in OSCILLATOR.items()
                if name not in (AMPLITUDE, PHASE)
            }
            values[AMPLITUDE], values[PHASE] = checked_series(faults, self.error_amplitude, self.error_phase)
            if self.free_damping_ratio is not None:
                limit = OSCILLATOR["damping_ratio"]
                values["free_damping_ratio"] = faults.number(
                    "free_damping_ratio", self.free_damping_ratio, limit
                )
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

    @property
    def damping_ratios(self) -> tuple[float, float]:
        """Damping ratios in contact and in the dead zone."""
        free = self.free_damping_ratio
        return self.damping_ratio, self.damping_ratio if free is None else free

    def packed(self) -> Array:
        """All parameters in one vector, `par` of the kernels."""
        mean, *harmonics = series(self.stiffness)
        sides = 1.0 if self.one_sided else 2.0
        errors = self.error_series
        own = (
            mean, self.damping_ratio, self.mean_force, errors[0, 0], self.frequency, errors[1, 0],
            self.half_backlash, sides, self.stiffness.order, self.damping_ratios[1],
        )  # fmt: skip
        return np.array([*own, *harmonics, *errors[:, 1:].ravel()])

    @property
    def parameters(self) -> tuple[str, ...]:
        """Names of all parameters: ``frequency``, ..., ``stiffness.mean``, ``stiffness.amplitudes[0]``, ..."""
        amplitudes, phases = harmonic_names(self.error_series.shape[1])
        own = ("frequency", *amplitudes, *phases, "mean_force", "damping_ratio", "half_backlash")
        own += () if self.free_damping_ratio is None else ("free_damping_ratio",)
        return own + series_names(self.stiffness.order)

    def places(self, parameter: str) -> list[int]:
        """Indices of a parameter in the vector of `packed`: two of a damping that is the same in the dead zone.

        Raises
        ------
        InputError
            If there is no such parameter.
        """
        self._known(parameter)
        known = parameter.removesuffix("[0]")
        if known == "damping_ratio" and self.free_damping_ratio is None:
            return [_PLACES[known], _FREE]
        if known in _PLACES:
            return [_PLACES[known]]
        amplitudes, phases = harmonic_names(self.error_series.shape[1])
        further = (*series_names(self.stiffness.order)[1:], *amplitudes[1:], *phases[1:])
        return [_SERIES + further.index(parameter)]

    def rest_state(self) -> Array:
        """State at rest with the flanks pressed together by the mean force; at the centre where none hold it."""
        force, k = self.mean_force, self.stiffness.mean
        if force == 0.0 or k == 0.0 or (self.one_sided and force / k < 0.0):
            return np.zeros(2)
        if self.one_sided:
            return np.array([self.half_backlash + force / k, 0.0])
        return np.array([math.copysign(self.half_backlash, force) + force / k, 0.0])

    def balanced(self, tau: Array) -> Array:
        """States at rest where force and stiffness balance; where the stiffness is small or negative, that of its mean.

        Without a second flank nothing balances a force that opens the first: what is left there is its edge.
        """
        k = self.stiffness(self.frequency * tau)
        mean = abs(self.stiffness.mean)
        force = self.force(tau)
        pressed = force / np.maximum(k, 0.2 * mean if mean > 0.0 else 1.0)
        if self.one_sided and self.mean_force < 0.0:
            pressed = np.maximum(pressed, 0.0)
        side = -1.0 if self.mean_force < 0.0 and not self.one_sided else 1.0
        x = side * self.half_backlash + pressed
        return np.stack([x, np.zeros_like(x)], axis=1)

    def in_contact(self, side: int) -> tuple[GearOscillator, Array]:
        """Without backlash; X is less by D."""
        return replace(self, half_backlash=0.0, one_sided=False), np.array([side * self.half_backlash, 0.0])

    def turning_acceleration(self, state: Array) -> float:
        """X'' at tau = 0 where V is zero."""
        return float(self.force(0.0) - self.stiffness(0.0) * self.deflection(state[0]))

    def force(self, tau: npt.ArrayLike) -> Array:
        """Right-hand side of the equation, shape of `tau`."""
        angle = self.frequency * np.asarray(tau, dtype=np.float64)
        return np.asarray(self.mean_force + self.frequency**2 * push(self.error_series, angle))

    def deflection(self, x: npt.ArrayLike) -> Array:
        """Deflection f(X) past the backlash, shape of `x`."""
        at = np.asarray(x, dtype=np.float64)
        lower = -np.inf if self.one_sided else -self.half_backlash
        return np.asarray(at - np.clip(at, lower, self.half_backlash))


def cells_per_period(packed: Array) -> float:
    """Cells of a period, before rounding up: half a radian at most of every time scale in each."""
    values: list[float] = packed.tolist()  # plain numbers: branches ask for every point
    order = int(values[_ORDER])
    further = values[_SERIES + 2 * order :]
    highest = highest_harmonic(order, further[: len(further) // 2])
    stiffest = abs(values[0]) + sum(abs(size) for size in values[_SERIES : _SERIES + order])
    period = 2.0 * math.pi / values[4]
    drag = 2.0 * max(values[1], values[_FREE]) * period
    return 2.0 * max(period * math.sqrt(stiffest), 2.0 * math.pi * highest, drag)
