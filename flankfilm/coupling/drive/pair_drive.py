"""Drive train of a pair: its gears on shafts and bearings, with motor and load, and what these carry."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Literal

import numpy as np

import dynamics
import gears
from base import Array, Cost, Stopwatch, described, part, quantity, record
from base.results import EXACT, ITSELF
from flankfilm.coupling.drive.drive_limits import DAMPING_BAND, checked_arguments, held_along_axis
from flankfilm.coupling.drive.drive_reduced import (
    gear_bodies,
    mesh_excitation,
    mesh_frequencies,
    reduced_change,
    reduced_oscillator,
    reduced_outputs,
)
from flankfilm.coupling.drive.drive_side import drive_side
from flankfilm.coupling.drive.gyroscopic import gyroscopic_change
from flankfilm.coupling.drive.reduction import MOST_MODES, reduced_train
from flankfilm.coupling.drive.tilting_mesh import change_over_cycle
from flankfilm.coupling.drive.train import ShaftDamping, Train, joined, lowest_modes, shaft_damping
from flankfilm.coupling.drive.travelling_load import LoadTravel, driving_moments
from flankfilm.coupling.vibration.oscillator import PairOscillator, pair_oscillator
from flankfilm.coupling.vibration.part_loads import DriveOutput
from gears.pair.beams import ReducedShaft

if TYPE_CHECKING:
    from flankfilm.coupling.mesh.mesh_curves import MeshCycle
    from flankfilm.coupling.vibration.series import MeshSeries

SECOND_ORDER = 4.0 / 3.0
"""Error over the change by elements half as long."""

GIVEN = "not estimated: given, or of the tilt of the mesh cycle, whose tilt stiffness has an error there"

SHAPES = "not estimated: shafts are beams, whose error is not known"


@record
class PairDrive:
    """Oscillator of a pair with its shafts, bearings, motor and load."""

    headline = ("lowest_frequency", "mesh_frequency")

    oscillator: dynamics.DriveOscillator = part(
        "of the modes that move, in the units of `rigid.scales`; its displacements are amplitudes of modes"
    )
    rigid: PairOscillator = part("the pair on rigid shafts and bearings, whose scales these are")
    freedoms: tuple[str, ...] = quantity(
        "",
        "points whose displacements along the line of action show the modes; of tilt, of an end of the face",
        "freedom",
    )
    motion: Array = part("displacements of these points by those of the oscillator, (freedoms, n)")
    natural_frequencies: Array = quantity(
        "Hz",
        "of the train in contact with the mean mesh stiffness, up to the highest that is retained or swept",
        "mode",
        error="frequency_error",
    )
    retained: Array = quantity(
        "1", "1 where a mode moves freely, 0 where its static deflection alone counts", "mode", no_error=EXACT
    )
    reduction_change: Array = quantity(
        "1",
        "relative change of a natural frequency by the reduction, against the unreduced train; 0 if not retained",
        "mode",
        no_error=ITSELF,
    )
    element_error: Array = quantity(
        "1", "relative error of a natural frequency by the elements of the shafts", "mode", no_error=ITSELF
    )
    mode_shapes: Array = quantity(
        "1", "displacements of the modes, the largest of each 1", "mode freedom", no_error=SHAPES
    )
    mesh_share: Array = quantity(
        "1", "part of a mode's elastic energy that is in the mesh", "mode", no_error=SHAPES
    )
    outputs: tuple[DriveOutput, ...] = part("forces of bearings and torques of shafts")
    shafts: tuple[ReducedShaft | None, ReducedShaft | None] = part("what gear and torque feel of the shafts")
    valid_to: float | None = quantity(
        "Hz",
        "mesh frequency up to which modes that are not retained change no swing of a force by more than the tolerance; "
        "None where all are retained",
        no_error="not estimated: by the linear response",
    )
    reduction_error: float = quantity(
        "1",
        "largest change of the swing of a force by modes that are not retained, of the linear response within the "
        "speeds; over the swing there, or a tenth of its largest where that is more",
        no_error=ITSELF,
    )
    gyroscopic_change: float = quantity(
        "1",
        "largest relative change of a natural frequency by gyroscopic moments and the second plane, which are left "
        "out, at the highest speed",
        no_error=ITSELF,
    )
    tilt_stiffness: float = quantity(
        "N m/rad",
        "moment over tilt of the mesh about the place of its force, mean over the mesh cycle; 0 where it gives way",
        no_error=GIVEN,
    )
    load_centre: float = quantity(
        "m", "place of the mesh force from mid-face, mean over the mesh cycle", shown="mm", no_error=GIVEN
    )
    tilt_change: float = quantity(
        "1",
        "largest relative change of a natural frequency by tilt and place of the mesh at one position of its cycle; "
        "where these are not known, by a stiffness spread evenly over its face",
        no_error=ITSELF,
    )
    load_travel: float = quantity(
        "m",
        "travel of the mesh force along the face over the mesh cycle, whose moment drives the tilt of both gears; "
        "0 where it is not known",
        shown="mm",
        error="load_travel_error",
    )
    load_travel_error: float = quantity(
        "1",
        "estimated relative error of that travel, by cells and by harmonics left out; nan where it is unknown",
        no_error=ITSELF,
    )
    damping_band: tuple[float, float] = part(
        "damping of shafts and bearings that is likely, over the given one"
    )
    shaft_damping: ShaftDamping = part("damping of the unreduced train, which it holds")
    cost: Cost = Cost(0.0)
    converged: bool = True
    message: str = ""

    @property
    def error(self) -> float | None:
        """Relative error of the mean stiffness; None where it is unknown. Shafts are beams without one."""
        return self.rigid.error

    @described("1", "mode", no_error=ITSELF)
    def frequency_error(self) -> Array:
        """Relative error of natural frequencies: reduction, elements, and half that of the stiffness by its share."""
        stiff = 0.5 * self.mesh_share * (np.nan if self.error is None else self.error)
        return np.asarray(self.reduction_change + self.element_error + stiff)

    @property
    def lowest_frequency_error(self) -> float:
        """Relative error of the lowest natural frequency."""
        return float(self.frequency_error[0])

    @property
    def mesh_frequency_error(self) -> float:
        """Relative error of the frequency of the mode with most energy in the mesh."""
        return float(self.frequency_error[int(np.argmax(self.mesh_share))])

    def damped(self, factor: float) -> dynamics.DriveOscillator:
        """Oscillator with so many times the damping of shafts and bearings."""
        return replace(self.oscillator, damping=factor * np.asarray(self.oscillator.damping))

    @property
    def scales(self) -> dynamics.Scaling:
        """Scales of mass, stiffness and length."""
        assert self.rigid.scales is not None  # a drive has a pair
        return self.rigid.scales

    @property
    def series(self) -> MeshSeries:
        """Series of the mesh stiffness."""
        return self.rigid.series

    @property
    def mean_force(self) -> float:
        """Mean force of the mesh."""
        return self.rigid.mean_force

    @described("Hz", error="lowest_frequency_error")
    def lowest_frequency(self) -> float:
        """Lowest natural frequency of the train in contact."""
        return float(self.natural_frequencies[0])

    @described("Hz", error="mesh_frequency_error")
    def mesh_frequency(self) -> float:
        """Natural frequency of the mode that has most of its elastic energy in the mesh."""
        return float(self.natural_frequencies[int(np.argmax(self.mesh_share))])

    @described("rad/s", "mode", shown="rpm", error="frequency_error")
    def resonance_speeds(self) -> Array:
        """Pinion speeds at which the mesh frequency is a natural one."""
        return np.array([self.resonance_speed(frequency) for frequency in self.natural_frequencies.tolist()])

    def resonance_speed(self, frequency: float) -> float:
        """Pinion speed [rad/s] at which the mesh frequency is a given one [Hz]."""
        assert self.rigid.pair is not None  # a drive has one
        return 2.0 * math.pi * frequency / self.rigid.pair.pinion.teeth


def pair_drive(
    pair: gears.GearPair,
    stiffness: MeshCycle | MeshSeries,
    torque: float,
    speed: float,
    *,
    shafts: tuple[gears.Shaft | None, gears.Shaft | None],
    end_inertias: tuple[float, float] = (0.0, 0.0),
    couplings: tuple[float | None, float | None] = (None, None),
    damping_ratio: float = 0.05,
    shaft_damping_ratio: float | Sequence[float] = 0.01,
    rayleigh: tuple[float, float] | None = None,
    error_amplitude: float | Sequence[float] | Array = 0.0,
    error_phase: float | Sequence[float] | Array = 0.0,
    extra_inertia: tuple[float, float] = (0.0, 0.0),
    length_scale: float | None = None,
    one_sided: bool = False,
    reference: str = "body",
    free_damping_ratio: float | None = None,
    speeds: tuple[float, float] | None = None,
    reduction_tolerance: float = 0.05,
    damping_band: tuple[float, float] = DAMPING_BAND,
    tilt_stiffness: float = 0.0,
    load_centre: float = 0.0,
    mesh_matrix: Array | None = None,
    travel: LoadTravel | None = None,
    fourier_order: int | Literal["auto"] = "auto",
    tolerance: float = 0.005,
) -> PairDrive:
    """Drive train of a pair: bending and torsion of both shafts, with the modes that the mesh reaches.

    Displacements are turns times base radius, positive as the pinion drives, and deflections along the line of action
    towards the wheel. Shafts are beams and torsion bars of many elements (`gears.pair.beams`), gears are rigid bodies
    that tilt with them; the train is reduced to modes (`flankfilm.coupling.drive.reduction`). The back flanks press
    along the other line of action; here they press along the same. Free rotation of the train is taken out. Helical
    pairs bend their shafts across the line of action too, and pull them along the axis (`bent_shaft`); one bearing of
    each must hold against that.

    Parameters
    ----------
    pair : GearPair
    stiffness : MeshCycle or MeshSeries
        As of `pair_oscillator`; the deflection is measured against the bodies.
    torque, speed : float
        Of the pinion [N m], [rad/s].
    shafts : (Shaft or None, Shaft or None)
        Of pinion and wheel; None: rigid in rigid bearings.
    end_inertias : (float, float)
        Of motor and load, or what else is coupled at the shafts' torque positions [kg m2].
    couplings : (float or None, float or None)
        Torsional stiffness between either shaft and that inertia [N m/rad]; None: rigid.
    damping_ratio : float
        Of the mesh, as of `pair_oscillator`: c = 2 zeta sqrt(k_m m_e) with the equivalent mass of the gears alone.
    shaft_damping_ratio : float or sequence of float
        Modal ratio of shafts, bearings and couplings without the mesh: one for all modes, or several from the lowest
        on, of which the last holds for all above. Dampers of bearings come on top.
    rayleigh : (float, float), optional
        Instead of it: damping alpha M + beta K of these with alpha [1/s] and beta [s]; what turns freely is not braked.
    error_amplitude, error_phase, extra_inertia, length_scale, one_sided, reference, free_damping_ratio
        As of `pair_oscillator`.
    speeds : (float, float), optional
        Lowest and highest speed of the pinion that is looked at [rad/s]; by the natural frequency of the pair on rigid
        shafts if left out, see `RANGE`.
    reduction_tolerance : float
        Of the swing of forces within the speeds, by the modes that are not retained.
    damping_band : (float, float)
        Damping of shafts and bearings that is likely, over the given one; counts in the error of peaks.
    tilt_stiffness : float
        Tilting moment over tilt of the mesh about the place of its force, linearised about the loaded state
        [N m/rad]; a stiffness k spread evenly over a face of b has k b^2 / 12. It stays where contact is lost.
    load_centre : float
        Place of the mesh force from mid-face [m]; counts as the shafts' positions do.
    mesh_matrix : ndarray, shape (positions, 2, 2), optional
        The mesh between gears that tilt over its cycle (`tilting_mesh`), of which both are means: what its variation
        changes of the frequencies is `tilt_change`, beside that of the stiffness, which is in the series.
    travel : LoadTravel, optional
        Place of the mesh force over its cycle (`tilting_mesh`): its moment about `load_centre` under the mean force
        drives the tilt of both gears. What the place times the swing of the force adds is left out.
    fourier_order, tolerance
        As of `pair_oscillator`, by the pair on rigid shafts, within `speeds` where they are given.

    Raises
    ------
    InputError
        With every fault of the arguments.

    Examples
    --------
    >>> from gears import Bearing, Gear, GearPair, Shaft, ShaftSegment
    >>> from flankfilm.coupling import mesh_cycle
    >>> pair = GearPair(pinion=Gear(teeth=36), wheel=Gear(teeth=40), module=2e-3, face_width=40e-3).with_backlash(50e-6)
    >>> cycle = mesh_cycle(pair, 600.0, model="potential-energy")
    >>> shaft = Shaft((ShaftSegment(0.2, 0.04),), (Bearing(0.02, 4e8), Bearing(0.18, 4e8)), 0.1, 0.0)
    >>> drive = pair_drive(pair, cycle, 600.0, 209.44, shafts=(shaft, shaft), end_inertias=(0.02, 0.05),
    ...     fourier_order=1)
    >>> drive.freedoms[:4]
    ('pinion gear', 'pinion end', 'pinion deflection', 'pinion tilt')
    >>> [output.name for output in drive.outputs][:3]
    ['pinion bearing 1', 'pinion bearing 2', 'pinion shaft']
    >>> drive.valid_to > 1.5 * drive.rigid.natural_frequency * 0.999
    True
    """
    watch = Stopwatch()
    if pair.helix_angle:
        held_along_axis(shafts)
    ratios = checked_arguments(
        end_inertias, couplings, shaft_damping_ratio, rayleigh, reduction_tolerance, damping_band, tilt_stiffness,
        load_centre,
    )  # fmt: skip
    rigid = pair_oscillator(
        pair, stiffness, torque, speed, damping_ratio=damping_ratio, error_amplitude=error_amplitude,
        error_phase=error_phase, extra_inertia=extra_inertia, length_scale=length_scale, one_sided=one_sided,
        reference=reference, free_damping_ratio=free_damping_ratio, fourier_order=fourier_order, tolerance=tolerance,
        speeds=speeds,
    )  # fmt: skip
    scales = rigid.scales
    assert scales is not None  # a pair has them
    gears_of = gear_bodies(pair, rigid.inertias)

    def train_of(refined: bool, tilt: float) -> Train:
        sides = [
            drive_side(shafts[i], gears_of[i], end_inertias[i], couplings[i], 1.0 - 2.0 * i, refined)
            for i in range(2)
        ]
        return joined((sides[0], sides[1]), scales.mean_stiffness, tilt, load_centre)

    train, turning = train_of(False, tilt_stiffness), (pair.pinion.teeth, pair.wheel.teeth)
    ends = mesh_frequencies(pair, scales, speed, speeds)
    damping = shaft_damping(train, ratios, rayleigh, MOST_MODES, ends[1] ** 2)
    share = tolerance if rigid.series.share is None else rigid.series.share
    bounds = ends[0] / scales.omega_n, ends[1] / scales.omega_n
    travel = (travel or LoadTravel(())).kept(pair.face_width, share, bounds, damping_ratio)
    moments = driving_moments(train, rigid.force, travel, load_centre)
    reduction = reduced_train(train, damping, mesh_excitation(rigid, moments), ends, reduction_tolerance)
    if not math.isinf(reduction.valid_to):  # of the gears' mass: displacements of the size of the train's
        reduction = reduction._replace(shapes=reduction.shapes * math.sqrt(scales.equivalent_mass))
    oscillator = reduced_oscillator(rigid, train, damping, reduction, free_damping_ratio, moments)
    reached = max(
        int(np.sum(reduction.squares <= ends[1] ** 2)), int(np.flatnonzero(reduction.retained)[-1]) + 1
    )
    squares, modes, kept = (
        reduction.squares[:reached],
        reduction.modes[:, :reached],
        reduction.retained[:reached],
    )
    points = np.array(list(train.points.values()))
    shapes = (points @ modes).T
    greatest = np.take_along_axis(shapes, np.argmax(np.abs(shapes), axis=1)[:, None], axis=1)

    def change(other: Train) -> Array:
        other_squares = lowest_modes(other.in_contact, other.mass, reached + 1, ends[1] ** 2)[0][1:]
        return np.asarray(np.sqrt(other_squares / squares) - 1.0)

    def tilt_change() -> float:
        if mesh_matrix is not None:
            return change_over_cycle(train, squares, modes, mesh_matrix, load_centre)
        if tilt_stiffness > 0.0:
            return 0.0
        evenly = scales.mean_stiffness * pair.face_width**2 / 12.0
        return float(np.max(change(train_of(False, evenly)), initial=0.0))

    return PairDrive(
        oscillator=oscillator,
        rigid=rigid,
        freedoms=tuple(train.points),
        motion=points @ reduction.shapes,
        natural_frequencies=np.sqrt(squares) / (2.0 * math.pi),
        retained=kept.astype(np.float64),
        reduction_change=reduced_change(oscillator, squares / scales.omega_n**2, kept),
        element_error=SECOND_ORDER * np.abs(change(train_of(True, tilt_stiffness))),
        mode_shapes=shapes / greatest,
        mesh_share=train.mesh_stiffness * (modes.T @ train.direction) ** 2 / squares,
        outputs=reduced_outputs(train.outputs, reduction.shapes, scales),
        shafts=(train.sides[0].shaft, train.sides[1].shaft),
        valid_to=None if math.isinf(reduction.valid_to) else reduction.valid_to / (2.0 * math.pi),
        reduction_error=reduction.error,
        gyroscopic_change=gyroscopic_change(
            train, modes, squares, [ends[1] / teeth for teeth in turning], MOST_MODES, ends[1] ** 2
        ),
        tilt_stiffness=tilt_stiffness,
        load_centre=load_centre,
        tilt_change=tilt_change(),
        load_travel=travel.range,
        load_travel_error=math.nan if travel.range_error is None else travel.range_error,
        damping_band=(damping_band[0], damping_band[1]),
        shaft_damping=damping,
        cost=Cost(watch.seconds, unknowns=len(train.rotation)),
        message=rigid.message,
    )  # fmt: skip
