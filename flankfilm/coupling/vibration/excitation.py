r"""Harmonics of an unloaded transmission error from its curve: measured, of relief and deviations, or computed.

A curve e over one period becomes :math:`e_0 + \sum_j e_j \cos(j \theta + \varphi_j)` by the discrete Fourier transform
of equally spaced samples. The mean drives nothing. In the motion harmonic j has the force :math:`j^2 \omega^2 e_j`;
about a mesh of mean stiffness in contact it answers with :math:`e_j (j \omega)^2 H(j \omega)`,
:math:`H(r) = [(1-r^2)^2 + (2 \zeta r)^2]^{-1/2}`, which is :math:`e_j / (2 \zeta)` at its resonance and :math:`e_j` far
above. The order is the lowest that leaves out less than a share of the curve, or of the static deflection where that is
larger, and of the motion where a range of frequencies is given.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

import fem
import gears
from base import Array, Cost, Faults, Stopwatch, described, quantity, record
from base.results import EXACT, ITSELF
from dynamics.model.stiffness import MAX_ORDER
from fem.laws.flank_forms import Deviations
from fem.laws.mesh_setup import MeshSetup

SAMPLES = 4096
"""Samples of a curve that is given at unequal positions, and of a sum of harmonics whose range is looked for."""

MOST_SAMPLES = 1_000_000

POSITIONS = 2048
"""Samples of a base pitch of an unloaded curve, which has kinks where pairs take over from each other."""

_FREQUENCIES = 2000


@record
class ErrorSeries:
    """Harmonics of an unloaded transmission error along the transverse line of action; tau = 0 with a pair at A."""

    headline = ("order", "range", "remainder")

    source: str = quantity("", "curve that the series is of")
    meshes: int = quantity("1", "base pitches of a period", no_error=EXACT)
    amplitude: Array = quantity(
        "m",
        "amplitude of cos(j theta + phase), theta 2 pi over a period",
        "harmonic",
        shown="um",
        error="error",
    )
    phase: Array = quantity(
        "rad", "phase; tau = 0 when a pair is at A", "harmonic", no_error="not estimated; see remainder"
    )
    position: Array = quantity("1", "base pitches from A", "sample", no_error=EXACT)
    curve: Array = quantity("m", "the curve at equal steps", "sample", shown="um", no_error=EXACT)
    all_amplitudes: Array = quantity(
        "m", "amplitudes of all harmonics that the samples show", "sampled", shown="um", error="error"
    )
    range: float = quantity("m", "peak to peak of the curve as given", shown="um", no_error=EXACT)
    remainder: float = quantity(
        "1", "root mean square of curve less series, over that of the curve about its mean", no_error=ITSELF
    )
    motion_left: float | None = quantity(
        "1",
        "largest answer of the motion to what the series leaves out, over the curve's root mean square; None without a "
        "range of frequencies",
        no_error=ITSELF,
    )
    share: float | None = quantity(
        "1", "what the order may leave out; None for one that was named", no_error=EXACT
    )
    error: float = quantity(
        "1", "change of the amplitudes with half as many samples, over the largest amplitude"
    )
    cost: Cost
    converged: bool = quantity(
        "1", "whether an order that was to be found leaves out no more than the share", no_error=ITSELF
    )
    message: str = ""

    @described("1", no_error=EXACT)
    def order(self) -> int:
        """Highest harmonic of the series."""
        return len(self.amplitude)


def error_series(
    error: ArrayLike,
    position: ArrayLike | None = None,
    *,
    order: int | None = None,
    share: float = 0.005,
    deflection: float = 0.0,
    meshes: int = 1,
    bounds: tuple[float, float] | None = None,
    damping_ratio: float = 0.05,
    source: str = "given curve",
) -> ErrorSeries:
    r"""Harmonics of an unloaded transmission error.

    Parameters
    ----------
    error : array_like, shape (n,)
        The curve over one period along the line of action [m], positive where the wheel lags: at the midpoints of
        equal intervals, as mesh cycles have it, unless positions are given.
    position : array_like, shape (n,), optional
        Base pitches from A, rising, within one period; between them the curve is straight, and it goes on
        periodically.
    order : int, optional
        Highest harmonic of the period; as few as leave out no more than `share` unless given.
    share : float
        What the series may leave out, relative to the root mean square of the curve or to the deflection.
    deflection : float
        Of the mesh under its load [m]: where the error is small beside it, few harmonics do.
    meshes : int
        Base pitches of the period: 1, or the teeth of a gear for its revolution.
    bounds : (float, float), optional
        Range of the mesh frequency over the natural one, for what a series leaves out of the motion.
    damping_ratio : float
        Likewise.
    source : str
        What the curve is.

    Raises
    ------
    InputError
        For a curve that is none.

    Examples
    --------
    >>> theta = 2.0 * np.pi * (np.arange(40) + 0.5) / 40
    >>> found = error_series(5e-6 * np.cos(theta + 0.3) + 2e-6 * np.cos(2.0 * theta))
    >>> found.order, (1e6 * found.amplitude).round(6), found.phase.round(6) + 0.0
    (2, array([5., 2.]), array([0.3, 0. ]))
    """
    watch = Stopwatch()
    curve = np.asarray(error, dtype=np.float64)
    with Faults() as faults:
        pitches = faults.whole("meshes", meshes, 1, 10**6, "give base pitches")
        _check(faults, curve, position, pitches)
        if order is not None:
            order = faults.whole("order", order, 1, MAX_ORDER, "leave out the highest harmonics")
    values, first = _equally_spaced(curve, position, pitches)
    harmonics = _harmonics(values, first)
    coarse = _harmonics(values[::2], first) if values.size % 2 == 0 else _harmonics(values, first)
    amplitudes = np.abs(harmonics)
    whole = math.sqrt(float(np.mean((values - values.mean()) ** 2)))
    largest = float(amplitudes.max(initial=0.0))
    half = min(len(coarse), len(harmonics)) // 2
    off = float(np.max(np.abs(coarse[:half] - harmonics[:half]), initial=0.0))
    curve_left = np.sqrt(_tails(0.5 * amplitudes**2)) / (whole or 1.0)
    motion = None if bounds is None else _answers(amplitudes, bounds, pitches, damping_ratio) / (whole or 1.0)
    worst = curve_left if motion is None else np.maximum(curve_left, motion)
    worst = worst * (whole / max(whole, deflection) if whole else 1.0)
    most = min(MAX_ORDER, len(amplitudes))
    enough = np.flatnonzero(worst[1 : most + 1] <= share)
    chosen = (
        min(order, len(amplitudes)) if order is not None else (int(enough[0]) + 1 if enough.size else most)
    )
    remainder = float(curve_left[chosen])
    short = order is None and not enough.size
    more = "; more are not taken: give a smoother curve or a larger share" if short else ""
    return ErrorSeries(
        source,
        pitches,
        amplitudes[:chosen],
        np.angle(harmonics[:chosen]),
        pitches * (first + np.arange(values.size) / values.size),
        values,
        amplitudes,
        float(np.ptp(curve)),
        remainder,
        None if motion is None else float(motion[chosen]),
        share if order is None else None,
        off / largest if largest > 0.0 else 0.0,
        Cost(watch.seconds, unknowns=2 * chosen),
        not short,
        f"{chosen} harmonics of {pitches} base pitches leave out {remainder:.2g} of the curve{more}",
    )


def unloaded_error(
    pair: gears.GearPair,
    *,
    deviations: Deviations | None = None,
    tip_rounding: tuple[float, float] = (0.0, 0.0),
    beyond_path: bool | None = None,
    back: bool = False,
    alignment: gears.Alignment | None = None,
    meshes: int = 1,
    positions: int = POSITIONS,
    order: int | None = None,
    share: float = 0.005,
    deflection: float = 0.0,
    bounds: tuple[float, float] | None = None,
    damping_ratio: float = 0.05,
) -> ErrorSeries:
    """Harmonics of the transmission error of rigid gears without load: of reliefs, deviations and pitches.

    Parameters
    ----------
    pair : GearPair
        With its reliefs.
    deviations : (GearDeviations or None, GearDeviations or None), optional
        Of pinion and wheel.
    tip_rounding : (float, float)
        Radii of the tip edges [m].
    beyond_path : bool, optional
        Whether tip edges may touch outside A..E. None: of spur pairs alone.
    back : bool
        Whether the wheel drives, so that the flanks are the back ones.
    alignment : gears.Alignment, optional
        Of the axes: of helical pairs it decides, with leads, where on the lines of contact teeth touch first.
    meshes, order, share, deflection, bounds, damping_ratio
        As of `error_series`; the revolution begins with the teeth 0 of both gears in mesh.
    positions : int
        Samples of a base pitch.

    Examples
    --------
    >>> from gears import Gear, GearPair, TipRelief
    >>> relieved = Gear(teeth=36, tip_relief=TipRelief(amount=20e-6, length=3e-3))
    >>> pair = GearPair(relieved, Gear(teeth=40, tip_relief=TipRelief(20e-6, 3e-3)), module=2e-3, face_width=40e-3)
    >>> found = unloaded_error(pair)
    >>> found.converged, 0.0 < found.range < 20e-6
    (True, True)
    """
    bearing, aligned = pair, alignment
    if back and pair.helix_angle != 0.0:  # back flanks are front flanks of the other hand
        bearing = replace(pair, helix_angle=-pair.helix_angle)
        aligned = None if alignment is None else alignment.opposite(pair.working_pressure_angle)
    curve = fem.unloaded_transmission_error(
        bearing, positions, beyond_path, deviations, meshes, tip_rounding=tip_rounding, alignment=aligned
    )
    places = (np.arange(curve.size) + 0.5) / positions
    if back:  # their path is the mirror of that of the flanks in front
        mirrored = MeshSetup(pair).mirror - places
        curve, places = -curve[::-1], mirrored[::-1]
    return error_series(
        curve,
        places if back else None,
        order=order,
        share=share,
        deflection=deflection,
        meshes=meshes,
        bounds=bounds,
        damping_ratio=damping_ratio,
        source="unloaded, by the geometry",
    )


def peak_to_peak(amplitude: Array, phase: Array) -> float:
    """Range of a sum of harmonics; of a single one twice its amplitude."""
    if len(amplitude) == 1:
        return 2.0 * abs(float(amplitude[0]))
    count = max(SAMPLES, 16 * len(amplitude))
    spectrum = np.zeros(count // 2 + 1, dtype=np.complex128)
    spectrum[1 : len(amplitude) + 1] = 0.5 * count * amplitude * np.exp(1j * phase)
    return float(np.ptp(np.fft.irfft(spectrum, count)))


def _check(faults: Faults, curve: Array, position: ArrayLike | None, meshes: int) -> None:
    """Note what is no curve over a period."""
    if curve.ndim != 1 or not 3 <= curve.size <= MOST_SAMPLES or not np.all(np.isfinite(curve)):
        allowed = f"must be 3 to {MOST_SAMPLES} finite numbers in one dimension"
        faults.add("error", f"shape {curve.shape}", allowed, "give the curve over one period")
    if position is None:
        return
    at = np.asarray(position, dtype=np.float64)
    if at.shape != curve.shape:
        faults.add("position", f"shape {at.shape}", f"must be of the shape {curve.shape}", "give pairs")
    elif not np.all(np.diff(at) > 0.0):
        faults.add("position", "", "must rise from point to point", "sort the points; leave out doubles")
    elif at[-1] - at[0] > meshes * (1.0 + 1e-9):
        allowed = f"must cover {meshes} base pitches at most"
        faults.add("position", f"{at[-1] - at[0]:g}", allowed, "give one period, or meshes")


def _equally_spaced(curve: Array, position: ArrayLike | None, meshes: int) -> tuple[Array, float]:
    """Samples at equal steps over the period, and the phase of the first in periods."""
    if position is None:
        return curve, 0.5 / curve.size
    at = np.asarray(position, dtype=np.float64) / meshes
    count = max(SAMPLES, 2 ** math.ceil(math.log2(4 * curve.size)))
    places = np.arange(count) / count
    if at[-1] - at[0] > 1.0 - 1e-9:  # the end stands for the start again
        at, curve = at[:-1], curve[:-1]
    return np.interp(places, at, curve, period=1.0), 0.0


def _harmonics(values: Array, first: float) -> Array:
    """Complex amplitudes of the harmonics 1, 2, ... below the highest that samples show; `first` is the first place."""
    count = values.size
    harmonics = 2.0 / count * np.fft.rfft(values)[1 : (count + 1) // 2]
    j = np.arange(1, len(harmonics) + 1)
    return np.asarray(harmonics * np.exp(-2j * np.pi * j * first))


def _tails(squares: Array) -> Array:
    """Sums of what lies beyond each order, from order 0 on, along the first axis."""
    sums = np.cumsum(squares[::-1], axis=0)[::-1]
    return np.concatenate([sums, np.zeros_like(squares[:1])])


def _answers(amplitudes: Array, bounds: tuple[float, float], meshes: int, damping_ratio: float) -> Array:
    """Largest answer of the motion to what lies beyond each order, root mean square."""
    kept = amplitudes[: 4 * MAX_ORDER]
    low, high = bounds
    order = np.arange(1, kept.size + 1) / meshes
    worst = np.zeros(kept.size + 1)
    for at in np.unique(
        np.concatenate([np.geomspace(low, high, _FREQUENCIES), np.clip(1.0 / order, low, high)])
    ):
        ratio = order * at
        answer = kept**2 * ratio**4 / ((1.0 - ratio**2) ** 2 + (2.0 * damping_ratio * ratio) ** 2)
        worst = np.maximum(worst, _tails(0.5 * answer))
    return np.asarray(np.sqrt(np.concatenate([worst, np.zeros(amplitudes.size - kept.size)])))
