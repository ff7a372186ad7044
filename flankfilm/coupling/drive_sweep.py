"""Speed sweep of a drive train: what its mesh, bearings and shafts carry."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from base import Array, Cost, Stopwatch, described, quantity, record
from base.results import EXACT
from flankfilm.coupling.drive import PairDrive
from flankfilm.coupling.motion import frequencies_of

if TYPE_CHECKING:
    import dynamics

SAMPLES = 400
"""Samples of a mesh period."""

APERIODIC = 60
"""Mesh periods over which a motion that does not repeat is followed."""


UNITS = {"bearing": "N", "shaft": "N m"}
"""Of what bearings, and shafts and couplings, carry."""


@record
class DriveSweep:
    """Motion of a drive train swept up and down in speed; figures go by direction, ``"up"`` and ``"down"``."""

    headline = ("greatest_bearing_force", "greatest_shaft_torque")

    frequency: Array = quantity(
        "1", "mesh frequency over the natural one of the pair on rigid shafts", "frequency", no_error=EXACT
    )
    speed: Array = quantity("rad/s", "pinion speed", "frequency", shown="rpm", no_error=EXACT)
    labels: Mapping[str, tuple[str, ...]] = quantity("", "motion n-p-q", "frequency")
    force_factor: Mapping[str, Array] = quantity(
        "1", "greatest mesh force over the mean force", "frequency", error="sampling_error"
    )
    separated: Mapping[str, Array] = quantity(
        "1",
        "part of the time without contact of the driving flanks",
        "frequency",
        shown="%",
        no_error="not estimated: straight lines between the samples of a period",
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
        "N", "greatest modulus of the force of bearings", "frequency bearing", error="sampling_error"
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
        "greatest modulus of the torque of shafts and couplings",
        "frequency shaft",
        error="sampling_error",
    )
    sampling_error: float = quantity(
        "1", "largest change with half as many samples of a period, over the greatest of its part"
    )
    error: float = quantity("1", "relative error of one period map, the largest met")
    cost: Cost
    converged: bool = quantity("1", "whether every motion could be followed", no_error=EXACT)
    message: str = quantity("", "what the sweeps report")

    @described("N", error="sampling_error")
    def greatest_bearing_force(self) -> float | None:
        """Greatest force of a bearing in both sweeps; None without bearings."""
        return _greatest(self.bearing_force)

    @described("N m", error="sampling_error")
    def greatest_shaft_torque(self) -> float | None:
        """Greatest torque of a shaft or coupling in both sweeps; None without one that yields."""
        return _greatest(self.shaft_torque)


def _greatest(values: Mapping[str, Array]) -> float | None:
    """Greatest of both directions, of the motions that could be followed; None without any."""
    known = np.concatenate([one[np.isfinite(one)] for one in values.values()])
    return float(known.max()) if known.size else None


def drive_sweep(
    drive: PairDrive, speed: ArrayLike | None = None, *, frequency: ArrayLike | None = None
) -> DriveSweep:
    """Sweep the speed of a drive train up and down.

    Parameters
    ----------
    drive : PairDrive
    speed : array_like, shape (values,)
        Pinion speeds [rad/s].
    frequency : array_like, shape (values,)
        Instead of them: mesh frequencies over the natural one of the pair on rigid shafts.

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
    >>> drive = pair_drive(pair, cycle, 600.0, 209.44, shafts=(shaft, shaft), end_inertias=(0.02, 0.05))
    >>> swept = drive_sweep(drive, speed=[200.0])
    >>> [round(value) for value in swept.shaft_torque_mean["up"][0]]  # of both shafts, N m
    [600, 667]
    """
    import dynamics

    watch = Stopwatch()
    values, speeds = frequencies_of(drive.rigid, speed, frequency)
    scales = drive.rigid.scales
    assert scales is not None  # a pair has them
    if speeds is None:
        speeds = np.array([scales.speed(one) for one in values.tolist()])
    found = {way: dynamics.sweep(drive.oscillator, "frequency", values, way) for way in ("up", "down")}
    figures = {way: [_carried(drive, result, i) for i in range(len(values))] for way, result in found.items()}
    lost = [result.message for result in found.values() if not result.converged]
    stacked = {way: np.array([row for row, *_ in rows]) for way, rows in figures.items()}
    changes = [change for rows in figures.values() for *_, change in rows]
    return DriveSweep(
        frequency=values,
        speed=speeds,
        labels={way: result.labels for way, result in found.items()},
        force_factor={way: rows[:, 2, 0] for way, rows in stacked.items()},
        separated={way: np.array([apart for _, apart, _ in rows]) for way, rows in figures.items()},
        **_parts(drive, stacked, "bearing", "bearing_force"),
        **_parts(drive, stacked, "shaft", "shaft_torque"),
        sampling_error=max(changes),
        error=max(result.error for result in found.values()),
        cost=Cost(watch.seconds, periods=sum(result.cost.periods for result in found.values())),
        converged=not lost,
        message="; ".join(lost) or "; ".join(result.message for result in found.values() if result.message),
    )


def _parts(drive: PairDrive, stacked: Mapping[str, Array], part: str, figure: str) -> dict[str, Any]:
    """Names of all bearings, or of all shafts and couplings, and the figures of what they carry."""
    unit = UNITS[part]
    kept = [i for i, output in enumerate(drive.outputs) if output.unit == unit]
    columns = [1 + i for i in kept]  # behind the mesh force
    figures = {f"{figure}_mean": 0, f"{figure}_swing": 1, figure: 2}
    return {
        f"{part}s": tuple(drive.outputs[i].name for i in kept),
        **{name: {way: rows[:, k, columns] for way, rows in stacked.items()} for name, k in figures.items()},
    }


def _carried(drive: PairDrive, found: dynamics.SweepResult, at: int) -> tuple[Array, float, float]:
    """Mean, swing and greatest of the mesh force over the mean force and of all outputs, shape (3, 1 + parts).

    And the part of the time without contact, and the largest change with half as many samples; nan where the motion
    was lost.
    """
    import dynamics
    from dynamics.motions import mesh_force, share_below

    start = found.states[at, -1]
    if not np.all(np.isfinite(start)):
        return np.full((3, 1 + len(drive.outputs)), np.nan), np.nan, 0.0
    here = drive.oscillator.with_parameter("frequency", float(found.values[at]))
    motion = dynamics.trajectory(here, start, int(found.periods[at]) or APERIODIC, SAMPLES)
    load = drive.rigid.oscillator.mean_force
    rows = [mesh_force(here, motion) / load, *(output.of(motion.states) for output in drive.outputs)]
    curves = np.array(rows)[:, :-1]
    whole, half = (_figures(curves[:, ::step]) for step in (1, 2))
    change = float(np.max(np.abs(whole - half) / np.maximum(whole[2], 1e-300)))
    return whole, share_below(motion.x - here.half_backlash), change


def _figures(curves: Array) -> Array:
    """Mean, root mean square about it, and greatest modulus of curves."""
    return np.array([curves.mean(axis=1), curves.std(axis=1), np.abs(curves).max(axis=1)])
