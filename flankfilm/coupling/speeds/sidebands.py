r"""Motion over a revolution: pitch deviations as an excitation whose period is many meshes, and its sidebands.

Teeth that come late or early repeat after a revolution of their gear, so that excitation and motion have the orders
j/z beside the mesh's own: sidebands. The oscillator takes the revolution for its period. Where both gears have
deviations the teeth meet again after the least common multiple of the numbers of teeth, the hunting period.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np

import dynamics
import gears
from base import Array, Cost, InputError, Stopwatch, part, quantity, record
from base.results import EXACT, ITSELF
from dynamics.model.protocol import PeriodicOscillator, settling_periods
from dynamics.model.stiffness import MAX_ORDER
from fem.laws.flank_forms import Deviations
from flankfilm.coupling.drive.pair_drive import PairDrive
from flankfilm.coupling.vibration.excitation import ErrorSeries, peak_to_peak, unloaded_error
from flankfilm.coupling.vibration.oscillator import PairOscillator
from flankfilm.coupling.vibration.part_loads import output_rows, part_figures

LEAST_ORDER = 3
"""Harmonics of the mesh that the error of a revolution has at least."""

PER_PITCH = 64
"""Samples of a base pitch."""


@record
class MotionSpectrum:
    """Spectrum of the settled motion of a pair by mesh orders, with the sidebands of its revolution."""

    headline = ("speed", "meshes", "error_range")

    order: Array = quantity("1", "cycles per mesh; 1 is the mesh frequency", "line", no_error=EXACT)
    displacement: Array = quantity(
        "1", "amplitude of the displacement over the length scale", "line", error="error"
    )
    force: Array = quantity("1", "amplitude of the mesh force over the mean force", "line", error="error")
    mode_order: Array = quantity(
        "1",
        "mesh orders at which natural frequencies lie: of the pair, or of its drive train",
        "mode",
        no_error="those of the natural frequencies",
    )
    bearings: tuple[str, ...] = quantity(
        "", "bearings of a drive train, in the order of their forces", "bearing"
    )
    bearing_force: Array = quantity("N", "amplitude of the force of bearings", "line bearing", error="error")
    shafts: tuple[str, ...] = quantity(
        "", "shafts and couplings of a drive train, in the order of their torques", "shaft"
    )
    shaft_torque: Array = quantity(
        "N m", "amplitude of the torque of shafts and couplings", "line shaft", error="error"
    )
    error_order: Array = quantity("1", "cycles per mesh of the error's harmonics", "harmonic", no_error=EXACT)
    error_amplitude: Array = quantity(
        "1", "amplitude of the error's harmonics over the length scale", "harmonic", no_error=EXACT
    )
    error_range: float = quantity("1", "peak to peak of the error over the length scale", no_error=EXACT)
    error_left_out: float | None = quantity(
        "1",
        "root mean square of what the harmonics leave out of the curve of a revolution, over that of the curve; None "
        "without such a curve",
        no_error=EXACT,
    )
    frequency: float = quantity("1", "mesh frequency over the natural one", no_error=EXACT)
    speed: float | None = quantity("rad/s", "pinion speed", shown="rpm", no_error=EXACT)
    meshes: int = quantity("1", "base pitches after which the excitation repeats", no_error=EXACT)
    periods: int = quantity(
        "1", "such periods after which the motion repeats, 0 if it does not", no_error=EXACT
    )
    motion: str = quantity("", "motion n-p-q, counted over such a period")
    sidebands: float = quantity(
        "1",
        "root of the sum of squares of the force's amplitudes off the mesh's orders, over that of all",
        error="error",
    )
    spectrum: dynamics.Spectrum = part("of the oscillator over its own period")
    error: float
    cost: Cost
    converged: bool = quantity("1", "whether the motion repeats", no_error=ITSELF)
    message: str = ""


def hunting_meshes(pair: gears.GearPair, deviations: Deviations | None) -> int:
    """Base pitches after which the same deviations meet: 1 where all teeth of both gears are alike."""
    meshes = 1
    for gear, deviation in zip((pair.pinion, pair.wheel), deviations or (None, None), strict=True):
        if deviation is not None and not deviation.every_tooth_alike:
            meshes = math.lcm(meshes, gear.teeth)
    return meshes


def revolution_error(
    pair: gears.GearPair,
    deviations: Deviations,
    *,
    order: int = LEAST_ORDER,
    tip_rounding: tuple[float, float] = (0.0, 0.0),
    beyond_path: bool | None = None,
) -> ErrorSeries:
    """Error that the deviations of single teeth add to that of the mean flanks, over the hunting period.

    Parameters
    ----------
    pair : GearPair
    deviations : (GearDeviations or None, GearDeviations or None)
        Of pinion and wheel, at least one with pitch deviations or curves of single teeth.
    order : int
        Mesh orders that the series reaches.
    tip_rounding, beyond_path
        As of `unloaded_error`.

    Raises
    ------
    InputError
        Where all teeth are alike, or the period has more harmonics than an oscillator takes.

    Examples
    --------
    >>> from gears import Gear, GearDeviations, GearPair, PitchDeviations
    >>> pair = GearPair(pinion=Gear(teeth=20), wheel=Gear(teeth=30), module=2e-3, face_width=20e-3)
    >>> late = GearDeviations(pitch=PitchDeviations((4e-6,) + (0.0,) * 19))
    >>> revolution_error(pair, (late, None)).meshes
    20
    """
    meshes = hunting_meshes(pair, deviations)
    if meshes == 1:
        allowed = "must differ from tooth to tooth"
        raise InputError.at(
            "deviations", "all teeth alike", allowed, "give pitches, or take the motion of a mesh"
        )
    if meshes * order > MAX_ORDER:
        allowed = f"must repeat within {MAX_ORDER // order} meshes for {order} mesh orders (these do after {meshes})"
        remedy = "give the deviations of one gear alone, or fewer orders"
        raise InputError.at("deviations", f"{meshes} meshes", allowed, remedy)
    same: dict[str, Any] = {
        "tip_rounding": tip_rounding,
        "beyond_path": beyond_path,
        "positions": PER_PITCH,
        "order": order * meshes,
    }
    all_teeth = unloaded_error(pair, deviations=deviations, meshes=meshes, **same)
    mean = tuple(None if deviation is None else deviation.mean for deviation in deviations)
    alike = unloaded_error(pair, deviations=(mean[0], mean[1]), meshes=meshes, **same)
    added = all_teeth.amplitude * np.exp(1j * all_teeth.phase) - alike.amplitude * np.exp(1j * alike.phase)
    return replace(
        all_teeth, amplitude=np.abs(added), phase=np.angle(added), source="deviations of single teeth"
    )


def over_revolution(motion: PairOscillator | PairDrive, error: ErrorSeries) -> PeriodicOscillator:
    """Oscillator whose period is that of an error of many meshes; the stiffness and its own error repeat every mesh.

    Harmonics of the mesh above 1000 over the meshes are left out, since an oscillator has no more.

    Parameters
    ----------
    motion : PairOscillator or PairDrive
        With physical scales.
    error : ErrorSeries
        Added to the motion's own error.

    Raises
    ------
    InputError
        For an oscillator in its own units.

    Examples
    --------
    >>> from gears import Gear, GearPair
    >>> from flankfilm.coupling import error_series, given_series, pair_oscillator
    >>> pair = GearPair(pinion=Gear(teeth=20), wheel=Gear(teeth=30), module=2e-3, face_width=20e-3)
    >>> motion = pair_oscillator(pair.with_backlash(50e-6), given_series(4e8, [0.2]), 100.0, 500.0)
    >>> whole = over_revolution(motion, error_series([0.0, 1e-6, 0.0, -1e-6], meshes=20, order=1))
    >>> whole.stiffness.order, round(motion.frequency / whole.frequency, 6)
    (20, 20.0)
    """
    if motion.scales is None:
        raise InputError.at(
            "motion", "", "requires an oscillator with physical scales", "give pair and torque"
        )
    own, meshes = motion.oscillator, error.meshes
    most = MAX_ORDER // meshes
    stiffness, errors = own.contact_stiffness, own.error_series[:, :most]
    kept = min(stiffness.order, most)
    amplitudes, phases = np.zeros(meshes * kept), np.zeros(meshes * kept)
    amplitudes[meshes - 1 :: meshes] = stiffness.amplitudes[:kept]
    phases[meshes - 1 :: meshes] = stiffness.phases[:kept]
    together = np.zeros(max(meshes * max(kept, errors.shape[1]), error.order), dtype=np.complex128)
    mesh = errors[0] * np.exp(1j * errors[1])
    together[meshes - 1 : meshes * len(mesh) : meshes] += mesh
    together[: error.order] += error.amplitude / motion.scales.length * np.exp(1j * error.phase)
    series = dynamics.FourierStiffness(stiffness.mean, tuple(amplitudes.tolist()), tuple(phases.tolist()))
    changed: Any = _over_meshes(own.with_contact_stiffness(series), meshes, most)
    oscillator: PeriodicOscillator = replace(
        changed,
        frequency=own.frequency / meshes,
        error_amplitude=tuple(np.abs(together).tolist()),
        error_phase=tuple(np.angle(together).tolist()),
    )
    return oscillator


def _over_meshes(oscillator: PeriodicOscillator, meshes: int, most: int) -> PeriodicOscillator:
    """Oscillator whose periodic force, if it has one, repeats every mesh of a period of several."""
    if not isinstance(oscillator, dynamics.DriveOscillator) or oscillator.force_direction is None:
        return oscillator
    kept = oscillator.force_series[:, :most]
    spread = np.zeros((2, meshes * kept.shape[1]))
    spread[:, meshes - 1 :: meshes] = kept
    size, turn = (tuple(each.tolist()) for each in spread)
    return replace(oscillator, force_amplitude=size, force_phase=turn)


def mesh_spectrum(
    motion: PairOscillator | PairDrive, error: ErrorSeries | None = None, *, highest: float = 4.0
) -> MotionSpectrum:
    """Spectrum of the motion that a pair settles to from rest at its speed.

    Parameters
    ----------
    motion : PairOscillator or PairDrive
        At its speed.
    error : ErrorSeries, optional
        Over many meshes, added to the motion's own: of pitch deviations by `revolution_error`, or a measured curve of
        a revolution by `error_series`.
    highest : float
        Highest mesh order.

    Examples
    --------
    >>> from gears import Gear, GearDeviations, GearPair, PitchDeviations
    >>> from flankfilm.coupling import given_series, pair_oscillator
    >>> pair = GearPair(pinion=Gear(teeth=20), wheel=Gear(teeth=30), module=2e-3, face_width=20e-3)
    >>> motion = pair_oscillator(pair.with_backlash(50e-6), given_series(4e8, [0.2]), 100.0, 500.0)
    >>> late = GearDeviations(pitch=PitchDeviations((4e-6,) + (0.0,) * 19))
    >>> found = mesh_spectrum(motion, revolution_error(pair, (late, None)), highest=2.0)
    >>> found.meshes, len(found.order), found.sidebands > mesh_spectrum(motion).sidebands
    (20, 40, True)
    """
    watch = Stopwatch()
    whole = motion.oscillator if error is None else over_revolution(motion, error)
    meshes = 1 if error is None else error.meshes
    transient = math.ceil(settling_periods(motion.oscillator) / meshes) if meshes > 1 else None
    settled = dynamics.sweep(
        whole, "frequency", [whole.frequency], keep=32 if meshes == 1 else 4, max_period=16 if meshes == 1 else 2,
        transient=transient,
    )  # fmt: skip
    periods = int(settled.periods[0])
    rows = output_rows(motion.outputs, whole.dimension)
    spectrum = dynamics.motion_spectrum(
        whole, settled.states[0, -1], periods, highest=highest * meshes, outputs=rows
    )
    load = motion.mean_force
    force = spectrum.force / abs(load) if load else np.full_like(spectrum.force, np.nan)
    at = np.round(spectrum.order / meshes, 12)
    off = np.abs(at - np.round(at)) > 1e-9
    total = float(np.sum(spectrum.force**2))
    errors = whole.error_series
    repeats = periods > 0
    return MotionSpectrum(
        at,
        spectrum.displacement,
        force,
        _mode_orders(motion, whole.frequency * meshes),
        **part_figures(motion.outputs, {"": spectrum.outputs}),
        error_order=np.arange(1, errors.shape[1] + 1) / meshes,
        error_amplitude=np.abs(errors[0]),
        error_range=peak_to_peak(*errors),
        error_left_out=None if error is None else error.remainder,
        frequency=whole.frequency * meshes,
        speed=None if motion.scales is None else motion.scales.speed(whole.frequency * meshes),
        meshes=meshes,
        periods=periods,
        motion=settled.labels[0],
        sidebands=math.sqrt(float(np.sum(spectrum.force[off] ** 2)) / total) if total > 0.0 else 0.0,
        spectrum=spectrum,
        error=spectrum.error,
        cost=Cost(watch.seconds, periods=settled.cost.periods + spectrum.cost.periods),
        converged=repeats,
        message=""
        if repeats
        else "the motion does not repeat; lines are averages of stretches, and their peaks depend on those",
    )


def _mode_orders(motion: PairOscillator | PairDrive, frequency: float) -> Array:
    """Natural frequencies over the mesh frequency, which is given over the natural one of the pair."""
    if isinstance(motion, PairOscillator):
        return np.array([1.0 / frequency])
    return motion.natural_frequencies / (motion.scales.natural_frequency * frequency)
