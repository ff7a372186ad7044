"""Damage of a load spectrum by Miner's sum, and the life at a given safety, after ISO 6336-6."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from base import Array, Faults, Limit, described, quantity, record
from base.results import EXACT
from gears.closed_form.record import STANDARD
from gears.rating.life import LifeCurve
from gears.tooth.errors import GeometryError

LIMITS = {
    "torque": Limit(
        0.0, 1e9, "N m", "give torques on the rated flank; rate reversed ones as a second spectrum"
    ),
    "speed": Limit.above(0.0, 1e5, "rad/s", "give the pinion's speed"),
    "cycles": Limit.above(0.0, 1e15, remedy="give load cycles of the pinion, in the life of the spectrum"),
}
"""What steps of a spectrum may be."""
_SAFETY = Limit.above(0.0, 100.0, remedy="1 is failure of 1 gear in 100")


@dataclass(frozen=True)
class LoadBin:
    """One step of a load spectrum.

    Parameters
    ----------
    torque : float
        Of the pinion, on the flank that is rated [N m]; 0 is a step without load.
    speed : float
        Of the pinion [rad/s].
    cycles : float
        Load cycles of the pinion.
    """

    torque: float  # N m
    speed: float  # rad/s
    cycles: float

    @property
    def time(self) -> float:
        """Time of the step [s]."""
        return 2.0 * math.pi * self.cycles / self.speed


@record
class SpectrumDamage:
    """Damage of one gear by a load spectrum, at a safety, by the linear hypothesis of Palmgren and Miner."""

    damage: float = quantity("1", "Miner's sum; 1 is failure")
    parts: Array = quantity("1", "cycles over those that the step's stress survives", "step")
    endured: Array = quantity("1", "cycles that the step's stress survives; infinite below the curve", "step")
    safety: float = quantity("1", "safety by which stresses are multiplied", no_error=EXACT)

    no_error = STANDARD
    headline = ("damage", "safety")

    @described("1")
    def life(self) -> float:
        """Passes of the whole spectrum until failure; infinite where every step lies below the curve's end."""
        return 1.0 / self.damage if self.damage > 0.0 else math.inf

    @property
    def error(self) -> None:
        """Model error, which a standard cannot know: None is unknown, never zero."""
        return


def check_spectrum(spectrum: Sequence[LoadBin]) -> None:
    """Refuse a spectrum that cannot be rated, with every fault of every step.

    Parameters
    ----------
    spectrum : sequence of LoadBin

    Raises
    ------
    GeometryError
        For an empty spectrum, one without load, reversed torques, and numbers out of range.

    Examples
    --------
    >>> check_spectrum([LoadBin(600.0, 200.0, 1e7), LoadBin(0.0, 50.0, 1e6)])
    """
    with Faults(GeometryError) as faults:
        for place, step in enumerate(spectrum):
            faults.fields(step, LIMITS, f"spectrum[{place}].")
        if not any(step.torque > 0.0 for step in spectrum):
            allowed = "must have a step with torque"
            faults.add(
                "spectrum", f"{len(spectrum)} steps", allowed, "give torque, speed and cycles of each step"
            )


def miner(
    cycles: Sequence[float], required: Sequence[float], curve: LifeCurve, safety: float = 1.0
) -> SpectrumDamage:
    """Miner's sum of the steps of a spectrum, U = Sum n_i/N_i.

    N_i is where the life curve has the factor that the step's stress requires, times the safety. A step below the end
    of the curve does no damage.

    Parameters
    ----------
    cycles : sequence of float
        n_i, load cycles of the gear in each step.
    required : sequence of float
        Life factor that each step's stress needs at a safety of 1: the step's stress times its life factor over its
        stress limit, Z_NT/S_H of `pitting_safety` or Y_NT/S_F of `bending_safety`; 0 without load.
    curve : LifeCurve
        `contact_curve` or `BENDING` of the steel.
    safety : float
        By which every stress is multiplied.

    Returns
    -------
    SpectrumDamage

    Raises
    ------
    GeometryError
        With every fault of the numbers, and where both sequences differ in length.

    References
    ----------
    ISO 6336-6:2006, Calculation of load capacity of spur and helical gears, part 6: Calculation of service life under
    variable load, clause 4; A. Palmgren (1924), M. A. Miner (1945).

    Examples
    --------
    >>> curve = LifeCurve((1e5, 5e7, 1e10), (1.6, 1.0, 0.85))
    >>> miner([2.5e7, 1e5], [1.0, 1.6], curve).damage
    1.5
    """
    counts, needed = np.asarray(cycles, dtype=np.float64), np.asarray(required, dtype=np.float64)
    with Faults(GeometryError) as faults:
        faults.number("safety", safety, _SAFETY)
        if counts.shape != needed.shape or counts.size == 0:
            faults.add(
                "required", f"{needed.size}", f"must be {counts.size}, one for each step", "give each step"
            )
        for place, n in enumerate(counts):
            faults.number(f"cycles[{place}]", float(n), LIMITS["cycles"])
        for place, factor in enumerate(needed):
            faults.number(
                f"required[{place}]", float(factor), Limit(0.0, 1e6, remedy="give stress over limit")
            )
    endured = np.array([curve.life(safety * float(factor)) for factor in needed])
    shares = np.array([n / N if N > 0.0 else math.inf for n, N in zip(counts, endured, strict=True)])
    return SpectrumDamage(float(shares.sum()), shares, endured, safety)


def spectrum_safety(damage: Callable[[float], float], low: float = 0.01, high: float = 100.0) -> float:
    """Safety at which a spectrum's damage is 1, by bisection: the smallest one above which the gear fails.

    Parameters
    ----------
    damage : callable
        Miner's sum over the safety; it rises.
    low, high : float
        Between which the safety lies; an end is returned where it does not.

    Examples
    --------
    >>> curve = LifeCurve((1e5, 5e7, 1e10), (1.6, 1.0, 0.85))
    >>> f"{spectrum_safety(lambda s: miner([5e7], [0.8], curve, s).damage):.6f}"
    '1.250000'
    """
    if damage(high) < 1.0:
        return high
    for _ in range(60):
        middle = math.sqrt(low * high)
        low, high = (low, middle) if damage(middle) > 1.0 else (middle, high)
    return low
