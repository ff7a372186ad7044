"""Periodic stiffness as a Fourier series."""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from base import Array, Faults, Limit, RangeWarning
from dynamics.model.limits import NUMBER

MAX_ORDER = 1000  # the cells per period grow with the order; beyond this a series is the wrong description


@dataclass(frozen=True)
class FourierStiffness:
    r"""Periodic stiffness :math:`K(\tau) = k_0 + \sum_j k_j \cos(j \omega \tau + \varphi_j)`.

    Parameters
    ----------
    mean : float
        Mean :math:`k_0` [N/m, or 1 when dimensionless].
    amplitudes : sequence of float
        Amplitudes :math:`k_j`, j = 1, 2, ... [unit of the mean].
    phases : sequence of float
        Phases :math:`\varphi_j` [rad], as many as amplitudes. They refer to :math:`\tau = 0`, for a gear
        pair the instant at which a tooth pair enters contact at A.

    Raises
    ------
    InputError
        If a value is not finite, or the two sequences differ in length.

    Warns
    -----
    RangeWarning
        If the mean is not positive: the motion is computed, but no mesh has such a stiffness.
    """

    mean: float
    amplitudes: tuple[float, ...] = ()
    phases: tuple[float, ...] = ()

    def __post_init__(self) -> None:
        """Check and convert; every fault is listed."""
        with Faults() as faults:
            mean = faults.number("stiffness.mean", self.mean, NUMBER)
            amplitudes = numbers(faults, "stiffness.amplitudes", self.amplitudes)
            phases = numbers(faults, "stiffness.phases", self.phases)
            order = len(amplitudes)
            if len(phases) != order:
                allowed = f"must be {order} phases, one per amplitude"
                remedy = "give amplitudes and phases of equal length"
                faults.add("stiffness.phases", f"{len(phases)} phases", allowed, remedy)
            if order > MAX_ORDER:
                remedy = "leave out the highest harmonics"
                faults.add(
                    "stiffness.amplitudes", f"{order} harmonics", f"must be at most {MAX_ORDER}", remedy
                )
        if mean <= 0.0:
            warnings.warn(
                f"stiffness.mean = {mean}: a mesh has a positive mean stiffness",
                RangeWarning,
                stacklevel=3,
            )
        object.__setattr__(self, "mean", mean)
        object.__setattr__(self, "amplitudes", amplitudes)
        object.__setattr__(self, "phases", phases)

    @property
    def order(self) -> int:
        """Highest harmonic."""
        return len(self.amplitudes)

    def __call__(self, angle: npt.ArrayLike) -> Array:
        r"""Stiffness at the excitation angle :math:`\omega \tau` [rad]; same shape as the angle."""
        theta = np.asarray(angle, dtype=np.float64)
        total = np.full(theta.shape, self.mean)
        for j, (amplitude, phase) in enumerate(zip(self.amplitudes, self.phases, strict=True), start=1):
            total += amplitude * np.cos(j * theta + phase)
        return total

    def normalised(self) -> FourierStiffness:
        r"""Return the same stiffness over its mean, :math:`1 + \sum \kappa_j \cos(\cdot)`.

        Raises
        ------
        InputError
            If the mean is not positive.
        """
        with Faults() as faults:
            faults.number(
                "stiffness.mean",
                self.mean,
                Limit(0.0, low_open=True, remedy="only a positive mean can be scaled to 1"),
            )
        return FourierStiffness(1.0, tuple(k / self.mean for k in self.amplitudes), self.phases)


def numbers(faults: Faults, path: str, values: object) -> tuple[float, ...]:
    """Sequence of numbers as a tuple; what is none is noted."""
    if isinstance(values, str) or not isinstance(values, Sequence | np.ndarray) or np.ndim(values) != 1:
        faults.add(path, values, "must be a sequence of numbers", "give one number per harmonic")
        return ()
    return tuple(faults.number(f"{path}[{j}]", value, NUMBER) for j, value in enumerate(values))


def check_stiffness(faults: Faults, stiffness: object, path: str = "stiffness") -> None:
    """Note a fault of what is no `FourierStiffness`."""
    if not isinstance(stiffness, FourierStiffness):
        remedy = "build one, or fit one with fit_fourier"
        faults.add(path, stiffness, "must be a FourierStiffness", remedy)
