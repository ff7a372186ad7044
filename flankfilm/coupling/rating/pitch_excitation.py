"""Excitation by a base pitch deviation of unloaded teeth, a sawtooth, and how many of its harmonics count."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from flankfilm.coupling.speeds.sidebands import LEAST_ORDER
from flankfilm.coupling.vibration.excitation import POSITIONS, ErrorSeries, error_series
from flankfilm.coupling.vibration.series import MOST_HARMONICS

if TYPE_CHECKING:
    import gears

ABOVE = 1.5
"""Frequency of the last harmonic over the natural one."""


def harmonics_of(frequency: float) -> int:
    """Harmonics of the sawtooth that count at a mesh over natural frequency: all up to half as much above resonance.

    Harmonic j is excited with f_pb/(pi j) and answers the most at j = 1/frequency, in proportion to the frequency. At
    slow speeds `MOST_HARMONICS` are enough: further ones change less than the error holds.

    Examples
    --------
    >>> harmonics_of(0.165), harmonics_of(1.0), harmonics_of(1e-4)
    (10, 3, 50)
    """
    return min(max(LEAST_ORDER, math.ceil(ABOVE / frequency)), MOST_HARMONICS)


def pitch_errors(pair: gears.GearPair, deviation: float, order: int) -> tuple[ErrorSeries, ErrorSeries]:
    """Unloaded error of a base pitch that is too short, with its jump at A, and too long, with its jump at E."""
    place = (np.arange(POSITIONS) + 0.5) / POSITIONS
    early = deviation * (place - 0.5)
    late = -deviation * (np.mod(place - pair.contact_ratio, 1.0) - 0.5)
    first, second = (
        error_series(curve, order=order, source="base pitch deviation") for curve in (early, late)
    )
    return first, second
