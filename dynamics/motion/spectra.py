r"""Spectra of motions: which orders of the excitation displacement and force of the mesh hold.

A motion of period n has lines at multiples of 1/n of the excitation's frequency, and its discrete Fourier transform
over whole periods has no leakage. A motion that does not repeat is cut into stretches, windowed after Hann, and the
squares of their transforms are averaged.
"""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from base import Array, Cost, Faults, Limit, Stopwatch, quantity, record
from base.results import EXACT
from dynamics.flow.motions import trajectory
from dynamics.flow.samples import mesh_force
from dynamics.model.arrays import AsArray
from dynamics.model.limits import NUMBER
from dynamics.model.options import OPTIONS
from dynamics.model.protocol import PeriodicOscillator
from dynamics.model.states import checked_outputs

OVERSAMPLED = 8
"""Samples of a period of the highest order: force has corners, and aliases fall with the square of their number."""


@record
class Spectrum(AsArray):
    """Amplitudes of a settled motion by order, cycles per excitation period."""

    headline = ("periods", "rms", "force_rms")

    order: Array = quantity("1", "cycles per excitation period", "line", no_error=EXACT)
    displacement: Array = quantity(
        "1", "amplitude of X; of chaos the root of its power times 2", "line", error="error"
    )
    force: Array = quantity(
        "1", "amplitude of the mesh force k f(X), dimensionless like the mean force", "line", error="error"
    )
    outputs: Array = quantity("1", "amplitude of each output, in its own unit", "line output", error="error")
    rms: float = quantity("1", "root mean square of X about its mean", error="error")
    force_rms: float = quantity("1", "root mean square of the mesh force about its mean", error="error")
    periods: int = quantity("1", "excitation periods of the motion, 0 if it does not repeat", no_error=EXACT)
    error: float = quantity(
        "1",
        "largest change of an amplitude with half as many samples, over the largest amplitude of its kind",
    )
    cost: Cost
    converged = True  # a motion that cannot be followed raises
    message: str = ""

    def columns(self) -> Array:
        """Columns order, displacement, force."""
        return np.column_stack([self.order, self.displacement, self.force])


def motion_spectrum(
    oscillator: PeriodicOscillator,
    state: npt.ArrayLike,
    periods: int = 1,
    *,
    highest: float = 10.0,
    outputs: npt.ArrayLike | None = None,
) -> Spectrum:
    r"""Spectrum of a settled motion.

    Parameters
    ----------
    oscillator : GearOscillator or DriveOscillator
        The oscillator; in several freedoms X is y, which the backlash limits.
    state : array_like, shape (dimension,)
        State at tau = 0 of the settled motion, such as the last of `sweep` or that of an orbit.
    periods : int
        Excitation periods after which it repeats; 0 for a motion that does not.
    highest : float
        Highest order.
    outputs : array_like, shape (outputs, dimension), optional
        What else is wanted of the motion, linear in the state: factors on displacements and speeds, one row each.

    Returns
    -------
    Spectrum
        Lines at multiples of 1/periods, or of 1/64 without a period.

    Raises
    ------
    InputError
        If an argument is out of range, or the motion cannot be followed.

    Examples
    --------
    >>> from dynamics import FourierStiffness, GearOscillator, find_orbit
    >>> osc = GearOscillator(FourierStiffness(1.0), 0.05, 0.1, 0.002, 0.5, half_backlash=0.0)
    >>> spectrum = motion_spectrum(osc, find_orbit(osc, (0.1, 0.0)).state, highest=2)
    >>> spectrum.order, (1e3 * spectrum.displacement).round(6)
    (array([1., 2.]), array([0.66519, 0.     ]))
    """
    watch = Stopwatch()
    with Faults() as faults:
        n = faults.whole(
            "periods", periods, 0, 100_000, "give excitation periods, 0 where it does not repeat"
        )
        top = faults.number("highest", highest, Limit.above(0.0, 100_000.0))
        _ = faults.number("state", float(np.max(np.abs(np.asarray(state, dtype=np.float64)))), NUMBER)
    length = n or OPTIONS.spectrum_periods
    parts = 1 if n else OPTIONS.spectrum_stretches
    per_period = 2 * math.ceil(OVERSAMPLED * max(top, 4.0) / 2.0) * 2
    rows = checked_outputs(outputs, oscillator.dimension)
    motion = trajectory(oscillator, state, length * (parts + 1) // 2 if parts > 1 else length, per_period)
    x, force = motion.x[:-1], mesh_force(oscillator, motion)[:-1]
    lines = np.arange(1, math.floor(top * length + 1e-9) + 1)
    curves = [x, force, *(motion.states[:-1] @ rows.T).T]
    amplitudes = [_amplitudes(curve, length * per_period, parts)[lines] for curve in curves]
    coarse = [_amplitudes(curve[::2], length * per_period // 2, parts)[lines] for curve in curves]
    off = max(_apart(there, here) for here, there in zip(amplitudes, coarse, strict=True))
    return Spectrum(
        lines / length,
        amplitudes[0],
        amplitudes[1],
        np.array(amplitudes[2:]).reshape(len(rows), len(lines)).T,
        float(np.std(x)),
        float(np.std(force)),
        n,
        off,
        Cost(watch.seconds, periods=motion.cost.periods),
        message="" if n else f"{parts} stretches of {length} periods, squares averaged",
    )


def _amplitudes(values: Array, length: int, parts: int) -> Array:
    """Amplitudes of the lines of a motion of one length, or of stretches of it, each half over the next."""
    if parts == 1:
        return np.asarray(2.0 / length * np.abs(np.fft.rfft(values - values.mean())))
    window = 0.5 - 0.5 * np.cos(2.0 * np.pi * np.arange(length) / length)
    starts = range(0, len(values) - length + 1, length // 2)
    squares = [np.abs(np.fft.rfft(window * (values[k : k + length] - values.mean()))) ** 2 for k in starts]
    return np.asarray(2.0 * np.sqrt(np.mean(squares, axis=0) / (length * np.sum(window**2))))


def _apart(coarse: Array, fine: Array) -> float:
    largest = float(np.max(fine, initial=0.0))
    return float(np.max(np.abs(coarse - fine), initial=0.0)) / largest if largest > 0.0 else 0.0
