r"""Slow run-up and coast-down: the motion under a frequency that changes, and its orders on the way.

The frequency is held for one excitation period and changed between periods, so that the exact flow serves. With
:math:`\theta` the angle of the excitation, a shaft that gains speed evenly in time has
:math:`\omega^2 = \omega_0^2 + (\omega_1^2 - \omega_0^2)\,\theta/\theta_1`. X is what the gears' approach has beyond the
error e, so that a step of the frequency by :math:`\delta` changes V by :math:`-\delta\,e'(\theta)`: these impulses are
the term :math:`e'\dot\omega` of the equation with a varying frequency. The displacements of a drive train are counted
without the error, and stay.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from itertools import count

import numpy as np
import numpy.typing as npt

from base import Array, Cost, Faults, Stopwatch, described, quantity, record
from base.results import EXACT, ITSELF
from dynamics.flow.flows import flow_of
from dynamics.flow.samples import share_below
from dynamics.model.arrays import AsArray
from dynamics.model.limits import POSITIVE, Whole
from dynamics.model.options import OPTIONS
from dynamics.model.protocol import EPS, PeriodicOscillator, periodic_only, settling_periods
from dynamics.model.states import checked_outputs, checked_state

SAMPLES = 64
"""Samples of a period, enough for order 8 and for the maximum force to a part in a thousand."""

BLOCK = 16
"""Periods of a block, of which orders are taken: lines lie at multiples of 1/16."""

HIGHEST = 6
"""Highest order of a block's lines."""

HELD = 4
"""Periods for which a drive train keeps a frequency: its tables cost as much as a hundred periods. A pair keeps one."""

STEADY = "rounding of the exact flow between steps of the frequency, whose error is that of the result"


@record
class RunUp(AsArray):
    """Motion under a slowly changing frequency, by blocks of 16 excitation periods."""

    headline = ("periods", "rate")

    frequency: Array = quantity("1", "mean frequency of each block", "block", no_error=EXACT)
    tau: Array = quantity("1", "time at which each block begins", "block", no_error=EXACT)
    rms: Array = quantity(
        "1", "root mean square of X about its mean in each block", "block", error="rms_error"
    )
    peak: Array = quantity("1", "maximum X of each block", "block", error="peak_error")
    force_rms: Array = quantity(
        "1",
        "root mean square of the mesh force k f(X) about its mean, dimensionless",
        "block",
        error="rms_error",
    )
    force_peak: Array = quantity("1", "maximum mesh force of each block", "block", error="peak_error")
    separated: Array = quantity(
        "1", "part of each block without contact of the driving flanks", "block", shown="%", error="error"
    )
    order: Array = quantity("1", "orders of the lines, cycles per excitation period", "line", no_error=EXACT)
    displacement_order: Array = quantity(
        "1", "amplitude of X by block and order", "block line", error="error"
    )
    force_order: Array = quantity(
        "1", "amplitude of the mesh force by block and order", "block line", error="error"
    )
    output_rms: Array = quantity(
        "1", "root mean square of each output about its mean in each block", "block output", error="error"
    )
    output_peak: Array = quantity(
        "1", "maximum modulus of each output in each block", "block output", error="error"
    )
    state: Array = quantity(
        "1", "state at the end: X and V, or displacements and speeds", "state", no_error=STEADY
    )
    periods: int = quantity("1", "excitation periods in all", no_error=EXACT)
    rate: float = quantity(
        "1",
        "largest change of the frequency in one decay time over the width of a resonance, dw/dtau / (2 zeta^2), "
        "of a drive train with its slowest decay; where it is small the motion follows",
        no_error=EXACT,
    )
    rms_error: Array = quantity(
        "1",
        "relative difference of each block's root mean square, of X, the force or the output that differs most, from a "
        "run with steps twice as long",
        "block",
    )
    peak_error: Array = quantity(
        "1",
        "the same of each block's largest X, force or output, or what may lie above its samples if that is more",
        "block",
    )
    greatest_error: float = quantity(
        "1", "the same of the largest X, force or output of the whole run that differs most", no_error=ITSELF
    )
    error: float = quantity(
        "1", "largest of the blocks' errors: where the motion jumps it may do so a block earlier or later"
    )
    cost: Cost
    converged: bool = quantity("1", "whether the motion stayed bounded")
    message: str

    @described("", no_error=EXACT)
    def direction(self) -> str:
        """Up or down."""
        return "up" if len(self.frequency) < 2 or self.frequency[-1] > self.frequency[0] else "down"

    def columns(self) -> Array:
        """Columns frequency, root mean square, peak, maximum force."""
        return np.column_stack([self.frequency, self.rms, self.peak, self.force_peak])


@periodic_only
def run_up(
    oscillator: PeriodicOscillator,
    bounds: tuple[float, float],
    periods: int = 8000,
    *,
    state: npt.ArrayLike | None = None,
    outputs: npt.ArrayLike | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> RunUp:
    """Follow the motion while the frequency rises or falls evenly in time.

    Parameters
    ----------
    oscillator : GearOscillator or DriveOscillator
        The oscillator; its own frequency is not used. In several freedoms X is y, which the backlash limits.
    bounds : (float, float)
        Frequency at the start and at the end; the second may be the lower one: coast-down.
    periods : int
        Excitation periods, cut to whole blocks of 16; the more, the slower.
    state : array_like, shape (dimension,), optional
        State at the start. Left out: what the motion from rest settles to at the first frequency.
    outputs : array_like, shape (outputs, dimension), optional
        What else is wanted of the motion, linear in the state: factors on displacements and speeds, one row each.
    progress : callable, optional
        Called with the number of blocks done, and of those of both runs, the second with steps twice as long.

    Raises
    ------
    InputError
        If an argument is out of range, or a period has too many cells.

    Examples
    --------
    >>> from dynamics import FourierStiffness, GearOscillator, run_up
    >>> osc = GearOscillator(FourierStiffness(1.0, (0.18,), (0.0,)), 0.05, 0.1, 0.2, 0.6, half_backlash=0.2)
    >>> ramp = run_up(osc, (0.6, 0.7), periods=3200)
    >>> at = ramp.frequency[int(np.argmax(np.diff(ramp.rms)))]
    >>> ramp.direction, bool(0.65 < at < 0.67)
    ('up', True)
    """
    watch = Stopwatch()
    with Faults() as faults:
        first, last = (faults.number(f"bounds[{k}]", bounds[k], POSITIVE) for k in range(2))
        number = faults.whole("periods", periods, *Whole(BLOCK, 10**8, "some thousand are slow")) // BLOCK
    here = oscillator.with_parameter("frequency", float(first))
    _ = oscillator.with_parameter("frequency", float(min(first, last)))  # refused where it has too many cells
    if state is None:
        from dynamics.flow.motions import period_map

        at = period_map(here, here.rest_state(), 1, settling_periods(here)).state
    else:
        at = checked_state(state, size=oscillator.dimension)
    rows = checked_outputs(outputs, oscillator.dimension)
    held = 1 if oscillator.is_exact else HELD
    done = count(1)

    def block_done() -> None:
        if progress is not None:
            progress(next(done), 2 * number)

    fine = _ramp(oscillator, (first, last), number, at, held, rows, block_done)
    coarse = _ramp(oscillator, (first, last), number, at, 2 * held, rows, block_done)
    rms_error, peak_error, greatest_error = _errors(fine[0], coarse[0], fine[4])
    good = bool(np.all(np.isfinite(fine[0])))
    decay = max(oscillator.decay, 1e-300)
    change = abs(last**2 - first**2) / (4.0 * math.pi * number * BLOCK)  # dw/dtau = w dw/dtheta
    rate = change / (2.0 * decay**2)
    turns = BLOCK * (np.arange(number) + 0.5) / (BLOCK * number)
    said = (
        f"{number} blocks"
        if good
        else f"{number} blocks; the motion grows without bound: check the parameters"
    )
    if rate > OPTIONS.lag:
        said += "; faster than the motion follows: jumps come late and peaks are lower than steady ones"
    rms, peak, force_rms, force_peak, separated, *rest = np.ascontiguousarray(fine[0].T)
    return RunUp(
        np.sqrt(first**2 + (last**2 - first**2) * turns),
        fine[2],
        rms,
        peak,
        force_rms,
        force_peak,
        separated,
        np.arange(1, HIGHEST * BLOCK + 1) / BLOCK,
        fine[1][:, 0],
        fine[1][:, 1],
        np.array(rest[: len(rows)]).reshape(-1, number).T,
        np.array(rest[len(rows) :]).reshape(-1, number).T,
        fine[3],
        number * BLOCK,
        rate,
        rms_error,
        peak_error,
        greatest_error,
        float(np.max([rms_error, peak_error])),
        Cost(watch.seconds, periods=2 * number * BLOCK),
        good,
        said,
    )


def _errors(fine: Array, coarse: Array, above: Array) -> tuple[Array, Array, float]:
    """Errors of each block's root mean squares and peaks, and of the largest peaks, infinite where motions are lost.

    Parameters
    ----------
    fine, coarse : ndarray, shape (blocks, 5 + 2 outputs)
        Figures as of `_ramp`, and those of a run with longer steps.
    above : ndarray, shape (blocks, 2 + outputs)
        What may lie above the peaks, between samples.
    """
    outputs = above.shape[1] - 2
    swings = [0, 2, *range(5, 5 + outputs)]
    peaks = [1, 3, *range(5 + outputs, 5 + 2 * outputs)]
    swing, peak = fine[:, swings], fine[:, peaks]
    size = np.maximum(np.max(np.abs([swing, peak]), axis=0), 1e-300)
    least = EPS * np.max(size, axis=0, initial=0.0)
    off = np.abs(coarse - fine)
    by_rms = off[:, swings] / np.maximum(swing, 64.0 * least)
    by_peak = np.maximum(off[:, peaks], above) / size
    change = np.abs(np.max(coarse[:, peaks], axis=0) - np.max(peak, axis=0))
    missed = np.take_along_axis(above, np.argmax(peak, axis=0)[None], axis=0)[0]
    greatest = np.maximum(change, missed) / np.max(size, axis=0)
    known = [np.where(np.isfinite(part), part, np.inf).max(axis=1) for part in (by_rms, by_peak)]
    most = float(np.max(greatest))
    return known[0], known[1], most if math.isfinite(most) else math.inf


def _ramp(
    oscillator: PeriodicOscillator,
    bounds: tuple[float, float],
    number: int,
    state: Array,
    held: int,
    rows: Array,
    block_done: Callable[[], None],
) -> tuple[Array, Array, Array, Array, Array]:
    """Figures (blocks, 5 + 2 outputs), lines (blocks, 2, orders), starts of the blocks, last state, rest of peaks.

    Each frequency is held for so many periods; the last is what may lie above the largest samples. `block_done` is
    called after each block.
    """
    first, last = bounds
    turns = held * (np.arange(number * BLOCK // held) + 0.5) / (number * BLOCK)
    frequencies = np.repeat(np.sqrt(first**2 + (last**2 - first**2) * turns), held)
    at, size = np.array(state, dtype=np.float64), max(1.0, oscillator.natural_size)
    angle = np.tile(2.0 * np.pi * np.arange(SAMPLES) / SAMPLES, BLOCK)
    stiffness = oscillator.contact_stiffness(angle)
    figures = np.full((number, 5 + 2 * len(rows)), np.nan)
    lines = np.full((number, 2, HIGHEST * BLOCK), np.nan)
    above = np.full((number, 2 + len(rows)), np.nan)
    starts, tau, before, flow = np.zeros(number), 0.0, first, None
    for block in range(number):
        starts[block], parts, states = tau, [], []
        for frequency in frequencies[block * BLOCK : (block + 1) * BLOCK].tolist():
            if flow is None or frequency != before:
                at = oscillator.with_frequency_step(at, before, frequency)
                here, before = oscillator.with_parameter("frequency", frequency), frequency
                flow, times = flow_of(here), np.arange(SAMPLES) * (here.period / SAMPLES)
            samples, _, _ = flow.sampled(at, 1, SAMPLES)
            parts.append(here.contact_motion(np.asarray(times), samples[:-1])[0])
            states.append(samples[:-1])
            at = samples[-1].copy()
            tau += here.period
        if not (np.all(np.isfinite(at)) and np.max(np.abs(at)) < LOST * size):
            break
        x, carried = np.concatenate(parts), np.concatenate(states) @ rows.T
        force = stiffness * oscillator.deflection(x)
        free = share_below(x - oscillator.half_backlash)
        figures[block, :5] = np.std(x), np.max(x), np.std(force), np.max(force), free
        figures[block, 5:] = *np.std(carried, axis=0), *np.max(np.abs(carried), axis=0)
        above[block] = [_above(curve) for curve in (x, force, *np.abs(carried.T))]
        for row, values in zip(lines[block], (x, force), strict=True):
            row[:] = 2.0 / len(x) * np.abs(np.fft.rfft(values))[1 : HIGHEST * BLOCK + 1]
        block_done()
    return figures, lines, starts, at, above


def _above(curve: Array) -> float:
    """What may lie above the largest sample: the height of a parabola whose top is halfway to the next one."""
    k = min(max(int(np.argmax(curve)), 1), len(curve) - 2)
    return float(abs(2.0 * curve[k] - curve[k - 1] - curve[k + 1]) / 8.0)


LOST = 1e6
"""Size, over that of what drives it where that is more than 1, at which a motion counts as grown without bound."""
