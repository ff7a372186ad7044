"""The oscillator that a pair's mesh stiffness drives, and its scales."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Literal

import numpy as np

import dynamics
import gears
from base import Array, Cost, Faults, InputError, Limit, described, part, quantity, record
from base.results import EXACT
from flankfilm.coupling.mesh.mesh_curves import MeshCycle
from flankfilm.coupling.mesh.references import MEANINGS
from flankfilm.coupling.vibration.excitation import peak_to_peak
from flankfilm.coupling.vibration.part_loads import DriveOutput
from flankfilm.coupling.vibration.series import MOST_HARMONICS, MeshSeries, mesh_series

MEAN_FORCE = 0.1
"""Dimensionless mean force that the length scale is chosen for, unless that is given."""


@record
class PairOscillator:
    """Oscillator of a pair, and its scales where there are physical ones.

    All physical figures are None or zero for an oscillator in its own units.
    """

    headline = ("natural_frequency", "mean_force", "half_backlash", "frequency")

    oscillator: dynamics.GearOscillator = part("at the pair's speed")
    scales: dynamics.Scaling | None = part(
        "of mass, stiffness and length; None for an oscillator in its own units"
    )
    series: MeshSeries = part("of the mesh stiffness")
    pair: gears.GearPair | None = part("the gears; None for an oscillator in its own units", default=None)
    force: float = quantity(
        "N",
        "force of the mesh along the transverse line of action: of spur pairs the normal force",
        no_error=EXACT,
        default=0.0,
    )
    error_amplitude: Array = quantity(
        "m",
        "amplitudes of the harmonics of the unloaded transmission error",
        "harmonic",
        shown="um",
        no_error=EXACT,
        default_factory=lambda: np.zeros(1),
    )
    error_phase: Array = quantity(
        "rad",
        "phases of these harmonics; tau = 0 when a pair is at A",
        "harmonic",
        shown="deg",
        no_error=EXACT,
        default_factory=lambda: np.zeros(1),
    )
    backlash: float = quantity(
        "m", "whole backlash along the transverse line of action", shown="um", no_error=EXACT, default=0.0
    )
    inertias: tuple[float, float] = quantity(
        "kg m2", "moments of inertia of pinion and wheel", "gear", no_error=EXACT, default=(0.0, 0.0)
    )
    cost: Cost = Cost(0.0)
    converged: bool = True
    message: str = ""

    @property
    def error(self) -> float | None:
        """Relative error of the mean stiffness; None where it is unknown."""
        return self.series.mean_error

    @property
    def no_error(self) -> str:
        """Why figures that say nothing of their error have none."""
        return "unknown: it follows from the mean stiffness, whose error is not known"

    @described("")
    def reference(self) -> str | None:
        """What the deflection of the stiffness is measured against; None for a given series."""
        return self.series.reference

    @property
    def rigid(self) -> PairOscillator:
        """The pair on rigid shafts: itself."""
        return self

    @property
    def outputs(self) -> tuple[DriveOutput, ...]:
        """Forces of bearings and torques of shafts: none on rigid ones."""
        return ()

    @described("m", shown="um", no_error=EXACT)
    def error_range(self) -> float:
        """Peak to peak of the unloaded transmission error."""
        return peak_to_peak(self.error_amplitude, self.error_phase)

    @described("1")
    def mean_force(self) -> float:
        """Mean force F_m."""
        return self.oscillator.mean_force

    @described("1")
    def half_backlash(self) -> float:
        """Half the backlash D."""
        return self.oscillator.half_backlash

    @described("1")
    def frequency(self) -> float:
        """Mesh frequency omega over the natural one."""
        return self.oscillator.frequency

    @property
    def frequency_error(self) -> float | None:
        """Relative error of the natural frequency, half that of the mean stiffness; None where that is unknown."""
        mean = self.series.mean_error
        return None if mean is None else 0.5 * mean

    @described("Hz", error="frequency_error")
    def natural_frequency(self) -> float | None:
        """Natural frequency; None for an oscillator in its own units."""
        return None if self.scales is None else self.scales.natural_frequency

    @described("m", shown="um", error="error")
    def length_scale(self) -> float | None:
        """Length of displacement 1; None for an oscillator in its own units."""
        return None if self.scales is None else self.scales.length

    @described("m/s", error="error")
    def speed_scale(self) -> float | None:
        """Velocity dX/dtau of 1; None for an oscillator in its own units."""
        return None if self.scales is None else self.scales.length * self.scales.omega_n

    @described("N/m", error="error")
    def mean_stiffness(self) -> float | None:
        """Mean stiffness that frequencies refer to; None for an oscillator in its own units."""
        return None if self.scales is None else self.scales.mean_stiffness

    @described("kg", no_error=EXACT)
    def equivalent_mass(self) -> float | None:
        """Equivalent mass along the transverse line of action; None for an oscillator in its own units."""
        return None if self.scales is None else self.scales.equivalent_mass


def pair_oscillator(
    pair: gears.GearPair,
    stiffness: MeshCycle | MeshSeries,
    torque: float,
    speed: float,
    *,
    damping_ratio: float = 0.05,
    free_damping_ratio: float | None = None,
    error_amplitude: float | Sequence[float] | Array = 0.0,
    error_phase: float | Sequence[float] | Array = 0.0,
    extra_inertia: tuple[float, float] = (0.0, 0.0),
    length_scale: float | None = None,
    one_sided: bool = False,
    reference: str = "body",
    fourier_order: int | Literal["auto"] = "auto",
    tolerance: float = 0.005,
    speeds: tuple[float, float] | None = None,
) -> PairOscillator:
    """Oscillator of a pair along the transverse line of action, driven by its mesh stiffness.

    Its coordinate is the rotation of rigid inertias, so that the deflection of finite elements is measured against the
    bodies, whatever it was measured against before, unless another reference is asked for. Closed forms,
    independent pairs and given series have no rotation that all pairs share, and are used unchanged; the message says
    which it was.

    A helical pair turns alone, on shafts that neither bend nor move along their axes: deflection, force T/r_b1 and
    backlash j_bn/cos(beta_b) are along the transverse line of action, masses follow from the base radii of the
    transverse section. Axial forces do no work on such gears.

    On the far side of the backlash the flanks that the load does not press bear with the same k(t). Theirs is its
    mirror image, k(c - t) with c of `fem.laws.mesh_setup.MeshSetup.mirror`: of the same mean and harmonics, in other
    phases. Those of a helix are of the other hand, with the same k where faces are symmetric about their middle.

    Parameters
    ----------
    pair : gears.GearPair
    stiffness : MeshCycle or MeshSeries
        Of a mesh cycle the series of the secant is taken, see `fourier_order`. A series of a mesh cycle with another
        reference is fitted anew, to the same order.
    torque, speed : float
        Of the pinion [N m], [rad/s]. Where the wheel drives, with a negative torque, X counts in the direction of that
        load, and the stiffness is that of the back flanks.
    damping_ratio : float
        Dimensionless.
    free_damping_ratio : float, optional
        In the backlash, where no teeth press. Left out: as in contact.
    error_amplitude, error_phase : float or sequence of float
        Of the unloaded transmission error [m], [rad], of its first harmonic or of each; the deflection is in the
        stiffness already. `error_series` takes them from a curve.
    extra_inertia : (float, float)
        What turns with pinion and wheel, on their bores [kg m2].
    length_scale : float, optional
        b_c [m]; such that the dimensionless mean force is 0.1 unless given.
    one_sided : bool
        Whether the back flanks cannot touch.
    reference : {"body", "bore", "teeth"}
        What the deflection is measured against, as of `fem.mesh_cycle`; the inertia on the bores counts for "body".
    fourier_order : int or "auto"
        Harmonics of the stiffness of a mesh cycle; "auto": as few as the tolerance allows, by the rule of scenes
        (`mesh_series`). A series that is given has its own.
    tolerance : float
        What these harmonics may leave out, relative: of the stiffness, and of the motion within `speeds`.
    speeds : (float, float), optional
        Lowest and highest speed of the pinion that is looked at [rad/s]: harmonics that resonate between them are
        taken. Left out: the stiffness alone decides.

    Raises
    ------
    InputError
        With every fault of the arguments.

    Examples
    --------
    >>> from gears import Gear, GearPair
    >>> from flankfilm.coupling import mesh_cycle
    >>> pair = GearPair(pinion=Gear(teeth=36), wheel=Gear(teeth=40), module=2e-3, face_width=40e-3)
    >>> cycle = mesh_cycle(pair, 600.0, model="potential-energy")
    >>> motion = pair_oscillator(pair.with_backlash(50e-6), cycle, torque=600.0, speed=209.44)
    >>> round(motion.mean_force, 3), 6e3 < motion.natural_frequency < 8e3
    (0.1, True)
    """
    order = _checked_series(fourier_order, tolerance, speeds)
    measured = _measured(stiffness, reference, extra_inertia)
    if isinstance(measured, MeshSeries):
        series = measured
    else:
        bounds = None
        if speeds is not None:
            mean = measured.mean("secant")
            of_one = pair_scales(pair, torque, mean, extra_inertia, length_scale).speed(1.0)
            bounds = min(speeds) / of_one, max(speeds) / of_one
        series = mesh_series(measured, "secant", order, tolerance, bounds, damping_ratio)
    said = "" if series.reference is None else f"stiffness measured against {MEANINGS[series.reference]}"
    if pair.backlash < -1e-12 * pair.module:
        allowed = "must be at least 0 for the motion, in which back flanks touch alternately"
        remedy = "give more backlash; the mesh cycle of pressed teeth needs no motion"
        raise InputError.at("pair.backlash", f"{1e6 * pair.backlash:.4g} um", allowed, remedy)
    force, backlash = abs(pair.base_tangent_force(torque)), pair.base_tangent_backlash
    amplitudes, phases = (
        np.asarray(harmonics, dtype=np.float64) for harmonics in (error_amplitude, error_phase)
    )
    if phases.ndim == 0 and phases == 0.0:  # serves any number of amplitudes
        phases = np.zeros(amplitudes.shape)
    scales = pair_scales(pair, torque, series.mean, extra_inertia, length_scale)
    oscillator = scales.oscillator(
        stiffness=series.stiffness,
        damping_ratio=damping_ratio,
        force=force,
        error_amplitude=error_amplitude,
        half_backlash=0.5 * max(backlash, 0.0),
        speed=speed,
        error_phase=_as_given(phases + (0.0 if torque > 0.0 else math.pi)),
    )
    return PairOscillator(
        replace(oscillator, one_sided=one_sided, free_damping_ratio=free_damping_ratio),
        scales,
        series,
        pair,
        force,
        np.atleast_1d(amplitudes),
        np.atleast_1d(phases),
        backlash,
        pair_inertias(pair, extra_inertia),
        message=said,
    )


def _as_given(values: Array) -> float | tuple[float, ...]:
    """One number as a number, several as a tuple."""
    return tuple(values.tolist()) if values.ndim else float(values)


def _measured(
    stiffness: MeshCycle | MeshSeries, reference: str, bore_inertia: tuple[float, float]
) -> MeshCycle | MeshSeries:
    """Stiffness whose deflection is measured against a reference, where it can be."""
    cycle = stiffness if isinstance(stiffness, MeshCycle) else stiffness.cycle
    if cycle is None or cycle.contact is None:
        return stiffness
    measured = cycle.against(reference, bore_inertia)
    if isinstance(stiffness, MeshCycle):
        return measured
    assert measured.contact is not None
    before, after = (
        (contact.reference, contact.bore_inertia) for contact in (cycle.contact, measured.contact)
    )
    return stiffness if before == after else mesh_series(measured, stiffness.kind, stiffness.order)


def _checked_series(
    fourier_order: object, tolerance: object, speeds: tuple[float, float] | None
) -> int | None:
    """Order of a series, None where it is to be found; with every fault of what decides on it."""
    order = None
    with Faults() as faults:
        if fourier_order != "auto":
            order = faults.whole("fourier_order", fourier_order, 1, MOST_HARMONICS, 'or "auto", the default')
        faults.number("tolerance", tolerance, Limit.above(0.0, 0.2, remedy="0.005 is 0.5 %"))
        if speeds is not None:
            for i, speed in enumerate(speeds):
                faults.number(
                    f"speeds[{i}]", speed, Limit.above(0.0, 1e6, "rad/s", "give the pinion's speeds")
                )
    return order


def pair_inertias(pair: gears.GearPair, extra: tuple[float, float] = (0.0, 0.0)) -> tuple[float, float]:
    """Moments of inertia of pinion and wheel with what turns with them [kg m2]."""
    first, second = pair.moments_of_inertia
    return first + extra[0], second + extra[1]


def pair_scales(
    pair: gears.GearPair,
    torque: float,
    mean_stiffness: float,
    extra_inertia: tuple[float, float] = (0.0, 0.0),
    length_scale: float | None = None,
) -> dynamics.Scaling:
    """Scales of a pair's oscillator for a mean stiffness [N/m]; arguments as of `pair_oscillator`.

    Examples
    --------
    >>> from gears import Gear, GearPair
    >>> pair = GearPair(pinion=Gear(teeth=36), wheel=Gear(teeth=40), module=2e-3, face_width=40e-3)
    >>> 6e3 < pair_scales(pair, 600.0, 8e8).natural_frequency < 8e3
    True
    """
    return dynamics.Scaling.from_inertias(
        inertias=pair_inertias(pair, extra_inertia),
        base_radii=pair.base_radii,
        mean_stiffness=mean_stiffness,
        cycles_per_revolution=pair.pinion.teeth,
        length=length_scale,
        force=abs(pair.base_tangent_force(torque)) if length_scale is None else None,
        mean_force=MEAN_FORCE if length_scale is None else None,
    )
