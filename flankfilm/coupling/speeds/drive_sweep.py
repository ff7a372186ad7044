"""Speed sweep of a drive train: what its mesh, bearings and shafts carry."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from base import Array, Cost, Stopwatch, described, quantity, record
from base.results import EXACT, ITSELF
from flankfilm.coupling.drive.pair_drive import PairDrive
from flankfilm.coupling.speeds.both_ways import LEFT, SweptForce, both_ways, frequencies_of
from flankfilm.coupling.speeds.drive_peaks import drive_peaks
from flankfilm.coupling.speeds.swept_truncation import LongerChanges, longer_changes
from flankfilm.coupling.vibration.part_loads import PARTS, greatest, part_figures


@record
class DriveSweep(SweptForce):
    """Motion of a drive train swept up and down in speed; figures go by direction, ``"up"`` and ``"down"``."""

    headline = ("greatest_bearing_force", "greatest_shaft_torque")

    frequency: Array = quantity(
        "1", "mesh frequency over the natural one of the pair on rigid shafts", "frequency", no_error=EXACT
    )
    speed: Array = quantity("rad/s", "pinion speed", "frequency", shown="rpm", no_error=EXACT)
    valid_to: float | None = quantity(
        "Hz",
        "mesh frequency up to which modes that the train does not retain change no swing of a force by more than its "
        "tolerance; None where all are retained",
        no_error="not estimated: by the linear response",
    )
    reduction_error: float = quantity(
        "1",
        "largest change of the swing of a force by these modes, of the linear response within the speeds of the train",
        no_error=ITSELF,
    )
    bearings: tuple[str, ...] = quantity("", "bearings, in the order of their forces", "bearing")
    bearing_force_mean: Mapping[str, Array] = quantity(
        "N", "mean force of bearings", "frequency bearing", error="sampling_error"
    )
    bearing_force_swing: Mapping[str, Array] = quantity(
        "N",
        "root mean square about the mean force of bearings",
        "frequency bearing",
        error="sampling_error",
    )
    bearing_force: Mapping[str, Array] = quantity(
        "N", "maximum modulus of the force of bearings", "frequency bearing", error="sampling_error"
    )
    bearing_force_peak: Array = quantity(
        "N",
        "maximum modulus of the force of bearings over the range of speed, between its values too",
        "bearing",
        error="bearing_force_peak_error",
    )
    bearing_force_peak_speed: Array = quantity(
        "rad/s",
        "pinion speed of that",
        "bearing",
        shown="rpm",
        no_error="not estimated: a peak is flat at its top",
    )
    bearing_force_peak_band: Array = quantity(
        "N",
        "the same with the minimum and the maximum damping of shafts and bearings that is likely",
        "end bearing",
        no_error=ITSELF,
    )
    bearing_force_peak_error: Array = quantity(
        "1", "relative error of the peak by search, samples and that band", "bearing", no_error=ITSELF
    )
    shafts: tuple[str, ...] = quantity("", "shafts and couplings, in the order of their torques", "shaft")
    shaft_torque_mean: Mapping[str, Array] = quantity(
        "N m", "mean torque of shafts and couplings", "frequency shaft", error="sampling_error"
    )
    shaft_torque_swing: Mapping[str, Array] = quantity(
        "N m",
        "root mean square about the mean torque of shafts and couplings",
        "frequency shaft",
        error="sampling_error",
    )
    shaft_torque: Mapping[str, Array] = quantity(
        "N m",
        "maximum modulus of the torque of shafts and couplings",
        "frequency shaft",
        error="sampling_error",
    )
    shaft_torque_peak: Array = quantity(
        "N m",
        "maximum modulus of the torque of shafts and couplings over the range of speed, between its values too",
        "shaft",
        error="shaft_torque_peak_error",
    )
    shaft_torque_peak_speed: Array = quantity(
        "rad/s",
        "pinion speed of that",
        "shaft",
        shown="rpm",
        no_error="not estimated: a peak is flat at its top",
    )
    shaft_torque_peak_band: Array = quantity(
        "N m",
        "the same with the minimum and the maximum damping of shafts and bearings that is likely",
        "end shaft",
        no_error=ITSELF,
    )
    shaft_torque_peak_error: Array = quantity(
        "1", "relative error of the peak by search, samples and that band", "shaft", no_error=ITSELF
    )
    force_peak: float = quantity(
        "1",
        "maximum mesh force over the mean force in the range of speed, between its values too",
        error="force_peak_error",
    )
    force_peak_speed: float = quantity(
        "rad/s", "pinion speed of that", shown="rpm", no_error="not estimated: a peak is flat at its top"
    )
    force_peak_band: Array = quantity(
        "1",
        "the same with the minimum and the maximum damping of shafts and bearings that is likely",
        "end",
        no_error=ITSELF,
    )
    force_peak_error: float = quantity(
        "1", "relative error of the peak by search, samples and that band", no_error=ITSELF
    )
    bearing_force_change: Mapping[str, Array] | None = quantity(
        "1", LEFT.format("the maximum force of bearings"), "checked bearing", no_error=ITSELF
    )
    bearing_force_swing_change: Mapping[str, Array] | None = quantity(
        "1",
        LEFT.format("the root mean square of their forces, over the largest,"),
        "checked bearing",
        no_error=ITSELF,
    )
    shaft_torque_change: Mapping[str, Array] | None = quantity(
        "1", LEFT.format("the maximum torque of shafts and couplings"), "checked shaft", no_error=ITSELF
    )
    shaft_torque_swing_change: Mapping[str, Array] | None = quantity(
        "1",
        LEFT.format("the root mean square of their torques, over the largest,"),
        "checked shaft",
        no_error=ITSELF,
    )
    error: float = quantity("1", "relative error of one period map, the largest met")
    cost: Cost
    converged: bool = quantity("1", "whether every motion could be followed", no_error=EXACT)
    message: str = quantity("", "what the sweeps report")

    @described("N", error="sampling_error")
    def greatest_bearing_force(self) -> float | None:
        """Maximum force of a bearing over the range of speed; None without bearings."""
        return greatest(self.bearing_force_peak)

    @described("N m", error="sampling_error")
    def greatest_shaft_torque(self) -> float | None:
        """Maximum torque of a shaft or coupling over the range of speed; None without one that yields."""
        return greatest(self.shaft_torque_peak)

    @property
    def greatest_bearing_error(self) -> float | None:
        """Relative error of the maximum force of a bearing by search, samples and the band of the damping."""
        return _at_greatest(self.bearing_force_peak, self.bearing_force_peak_error)

    @property
    def greatest_shaft_error(self) -> float | None:
        """Relative error of the maximum torque of a shaft or coupling."""
        return _at_greatest(self.shaft_torque_peak, self.shaft_torque_peak_error)

    @described("1", no_error=ITSELF)
    def truncation(self) -> float | None:
        """Largest change of what parts carry by the longer series, of motions that it has; None if unknown."""
        known = [largest for changes in self._changes if (largest := greatest(changes)) is not None]
        return max(known, default=None)

    @described("1", no_error=ITSELF)
    def carried_error(self) -> float | None:
        """Error of what parts carry by samples and the series' order; infinite where a motion is another one."""
        return self._error_with(self._changes)

    @property
    def greatest_factor_error(self) -> float | None:
        """Relative error of the mesh force by samples and the series' order, the largest; None for a given series."""
        return None if self.force_change is None else self._error_with([self.force_change])

    def _error_with(self, changes: Sequence[Mapping[str, Array]]) -> float | None:
        """Error by samples and the largest of changes that are known; None where none is."""
        known = [values[~np.isnan(values)] for change in changes for values in change.values()]
        if not any(values.size for values in known):
            return None
        return self.sampling_error + float(np.max(np.concatenate([values.ravel() for values in known])))

    @property
    def _changes(self) -> list[Mapping[str, Array]]:
        """Changes of all that parts carry, as far as they are known."""
        changes = (
            self.bearing_force_change,
            self.bearing_force_swing_change,
            self.shaft_torque_change,
            self.shaft_torque_swing_change,
        )
        return [change for change in changes if change is not None]


def _at_greatest(values: Array, errors: Array) -> float | None:
    """Error of the maximum value; None without any."""
    return float(errors[int(np.nanargmax(values))]) if np.isfinite(values).any() else None


def drive_sweep(
    drive: PairDrive,
    speed: ArrayLike | None = None,
    *,
    frequency: ArrayLike | None = None,
    progress: Callable[[str, int, int], None] = lambda what, done, every: None,
) -> DriveSweep:
    """Sweep the speed of a drive train up and down.

    Parameters
    ----------
    drive : PairDrive
    speed : array_like, shape (values,)
        Pinion speeds [rad/s].
    frequency : array_like, shape (values,)
        Instead of them: mesh frequencies over the natural one of the pair on rigid shafts.
    progress : callable
        Called with what is counted (speeds, peaks, motions with more harmonics), how many are done, and of how many.

    Raises
    ------
    InputError
        If both are given, or neither.

    Examples
    --------
    >>> from gears import Bearing, Gear, GearPair, Shaft, ShaftSegment
    >>> from flankfilm.coupling import mesh_cycle, pair_drive
    >>> pair = GearPair(pinion=Gear(teeth=36), wheel=Gear(teeth=40), module=2e-3, face_width=40e-3).with_backlash(50e-6)
    >>> cycle = mesh_cycle(pair, 600.0, model="potential-energy")
    >>> shaft = Shaft((ShaftSegment(0.2, 0.04),), (Bearing(0.02, 4e8), Bearing(0.18, 4e8)), 0.1, 0.0)
    >>> drive = pair_drive(pair, cycle, 600.0, 209.44, shafts=(shaft, shaft), end_inertias=(0.02, 0.05),
    ...     fourier_order=1)
    >>> swept = drive_sweep(drive, speed=[200.0])
    >>> [round(value) for value in swept.shaft_torque_mean["up"][0]]  # of both shafts, N m
    [600, 667]
    """
    watch = Stopwatch()
    values, speeds = frequencies_of(drive.rigid, speed, frequency)
    if speeds is None:
        speeds = np.array([drive.scales.speed(nu) for nu in values.tolist()])
    swept = both_ways(drive, values, partial(progress, "speeds"))
    parts = {way: np.moveaxis(response.parts, 1, 0) for way, response in swept.shaken.items()}
    peaks = drive_peaks(drive, swept.sweeps, swept.shaken, partial(progress, "peaks"))
    at_peaks = {
        "_peak": peaks.height, "_peak_speed": peaks.frequency * drive.scales.speed(1.0), "_peak_band": peaks.band,
        "_peak_error": peaks.error,
    }  # fmt: skip
    changes = longer_changes(
        drive, swept.sweeps, swept.shaken, partial(progress, "motions with more harmonics")
    )
    lost = [f"{way}: {result.message}" for way, result in swept.sweeps.items() if not result.converged]
    said = [f"{way}: {result.message}" for way, result in swept.sweeps.items() if result.message]
    return DriveSweep(
        **swept.figures(changes),
        speed=speeds,
        valid_to=drive.valid_to,
        reduction_error=drive.reduction_error,
        **part_figures(
            drive.outputs,
            {end: {way: carried[k] for way, carried in parts.items()} for k, end in enumerate(ENDINGS)}
            | {end: figures[..., 1:] for end, figures in at_peaks.items()},
        ),
        force_peak=float(peaks.height[0]),
        force_peak_speed=float(at_peaks["_peak_speed"][0]),
        force_peak_band=peaks.band[:, 0],
        force_peak_error=float(peaks.error[0]),
        **_part_changes(drive, changes),
        error=swept.error,
        cost=Cost(watch.seconds, periods=swept.periods),
        converged=not lost,
        message="; ".join([*_beyond(drive, float(values.max())), *(lost or said)]),
    )


def _beyond(drive: PairDrive, highest: float) -> list[str]:
    """That a mesh frequency is beyond those for which the modes of the train suffice; nothing where it is not."""
    reached = highest * drive.scales.natural_frequency
    if drive.valid_to is None or reached <= drive.valid_to * (1.0 + 1e-9):
        return []
    remedy = "give pair_drive the speeds"
    return [f"the mesh reaches {reached:.0f} Hz, forces are valid to {drive.valid_to:.0f} Hz: {remedy}"]


ENDINGS = ("_mean", "_swing", "")
"""Endings of the figures' names, in the order of `Vibration.parts`."""


def _part_changes(drive: PairDrive, changes: LongerChanges | None) -> dict[str, Any]:
    """What the longer series changes of what parts carry; None of each for a given series."""
    if changes is None:
        return dict.fromkeys(f"{figure}{end}_change" for figure, _ in PARTS.values() for end in ENDINGS[1:])
    by_end = {
        f"{end}_change": {way: parts[:, k] for way, parts in changes.each("parts").items()}
        for k, end in enumerate(ENDINGS)
        if end != "_mean"
    }
    figures = part_figures(drive.outputs, by_end)
    return {name: value for name, value in figures.items() if name.endswith("_change")}
