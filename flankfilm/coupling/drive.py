"""Drive train of a pair: its gears on shafts and bearings, with motor and load, and what these carry."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

import dynamics
import gears
from base import Array, Cost, Faults, Limit, described, part, quantity, record
from flankfilm.coupling.carried import DriveOutput
from flankfilm.coupling.drive_side import Side, drive_side
from flankfilm.coupling.oscillator import PairOscillator, pair_oscillator
from gears.beams import ReducedShaft

if TYPE_CHECKING:
    from flankfilm.coupling.cycle import MeshCycle
    from flankfilm.coupling.series import MeshSeries

SIDES = ("pinion", "wheel")
SHAPES = "not estimated: shafts are beams, whose error is not known"
INERTIA = Limit(0.0, 1e9, "kg m2", "0 where nothing is coupled")
COUPLING = Limit.above(0.0, 1e15, "N m/rad", "None for a rigid coupling")
DAMPING = Limit(0.0, 1.0, "", "0.005 to 0.02 for shafts")
RAYLEIGH = (
    Limit(0.0, 1e9, "1/s", "10 to 100 damps the lowest modes"),
    Limit(0.0, 10.0, "s", "1e-6 to 1e-5 damps the highest modes"),
)


@record
class PairDrive:
    """Oscillator of a pair with its shafts, bearings, motor and load."""

    headline = ("lowest_frequency", "mesh_frequency")

    oscillator: dynamics.DriveOscillator = part("in the units of `rigid.scales`")
    rigid: PairOscillator = part("the pair on rigid shafts and bearings, whose scales these are")
    freedoms: tuple[str, ...] = quantity(
        "", "names of the oscillator's displacements, along the line of action", "freedom"
    )
    natural_frequencies: Array = quantity(
        "Hz",
        "of the train in contact with the mean mesh stiffness, free rotation left out",
        "mode",
        error="error",
    )
    mode_shapes: Array = quantity(
        "1", "displacements of the modes, the largest of each 1", "mode freedom", no_error=SHAPES
    )
    mesh_share: Array = quantity(
        "1", "part of a mode's elastic energy that is in the mesh", "mode", no_error=SHAPES
    )
    outputs: tuple[DriveOutput, ...] = part("forces of bearings and torques of shafts")
    shafts: tuple[ReducedShaft | None, ReducedShaft | None] = part("what gear and torque feel of the shafts")
    cost: Cost = Cost(0.0)
    converged: bool = True
    message: str = ""

    @property
    def error(self) -> float | None:
        """Relative error of the mean stiffness; None where it is unknown. Shafts are beams without one."""
        return self.rigid.error

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

    @described("Hz", error="error")
    def lowest_frequency(self) -> float:
        """Lowest natural frequency of the train in contact."""
        return float(self.natural_frequencies[0])

    @described("Hz", error="error")
    def mesh_frequency(self) -> float:
        """Natural frequency of the mode that has most of its elastic energy in the mesh."""
        return float(self.natural_frequencies[int(np.argmax(self.mesh_share))])

    @described("rad/s", "mode", shown="rpm", error="error")
    def resonance_speeds(self) -> Array:
        """Pinion speeds at which the mesh frequency is a natural one."""
        return np.array([self.resonance_speed(one) for one in self.natural_frequencies.tolist()])

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
) -> PairDrive:
    """Drive train of a pair: torsion of both shafts, and deflection of the gears along the line of action.

    Displacements are turns times base radius, positive as the pinion drives, and deflections along the line of action
    towards the wheel. A shaft is reduced to them by its static deflection (`gears.beams`). The back flanks press along
    the other line of action; here they press along the same. Free rotation of the train is taken out.

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
        Modal ratio of shafts, bearings and couplings without the mesh, one for all modes or one for each from the
        lowest on; dampers of bearings come on top.
    rayleigh : (float, float), optional
        Instead of it: damping alpha M + beta K of these with alpha [1/s] and beta [s]; what turns freely is not braked.
    error_amplitude, error_phase, extra_inertia, length_scale, one_sided, reference, free_damping_ratio
        As of `pair_oscillator`.

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
    >>> drive = pair_drive(pair, cycle, 600.0, 209.44, shafts=(shaft, shaft), end_inertias=(0.02, 0.05))
    >>> len(drive.freedoms), [output.name for output in drive.outputs][:3]
    (6, ['pinion bearing 1', 'pinion bearing 2', 'pinion shaft'])
    """
    with Faults() as faults:
        for side, inertia in zip(SIDES, end_inertias, strict=True):
            faults.number(f"end_inertias.{side}", inertia, INERTIA)
        for side, spring, inertia in zip(SIDES, couplings, end_inertias, strict=True):
            if spring is not None:
                faults.number(f"couplings.{side}", spring, COUPLING)
                if not inertia > 0.0:
                    allowed = "must be more than 0 kg m2 behind a coupling"
                    faults.add(f"end_inertias.{side}", inertia, allowed, "give that of motor or load")
        for i, (factor, limit) in enumerate(zip(rayleigh or (), RAYLEIGH, strict=False)):
            faults.number(f"rayleigh[{i}]", factor, limit)
        ratios = [
            faults.number(f"shaft_damping_ratio[{i}]", ratio, DAMPING)
            for i, ratio in enumerate(
                np.atleast_1d(np.asarray(shaft_damping_ratio, dtype=np.float64)).tolist()
            )
        ]
    rigid = pair_oscillator(
        pair, stiffness, torque, speed, damping_ratio=damping_ratio, error_amplitude=error_amplitude,
        error_phase=error_phase, extra_inertia=extra_inertia, length_scale=length_scale, one_sided=one_sided,
        reference=reference, free_damping_ratio=free_damping_ratio,
    )  # fmt: skip
    scales, own = rigid.scales, rigid.oscillator
    assert scales is not None  # a pair has them
    radii, masses = pair.base_radii, gear_masses(pair)
    sides = [
        drive_side(
            shafts[i], radii[i], rigid.inertias[i], masses[i], end_inertias[i], couplings[i], 1.0 - 2.0 * i
        )
        for i in range(2)
    ]
    mass, firm, damping = (
        _diagonal(*(getattr(s, name) for s in sides)) for name in ("mass", "stiffness", "damping")
    )
    if rayleigh is not None:
        held = _without_rotation(mass, _diagonal(sides[0].free[:, None], sides[1].free[:, None]))
        damping = damping + dynamics.rayleigh_damping(held, firm, *rayleigh)
    elif np.any(firm):
        damping = damping + dynamics.modal_damping(mass, firm, ratios)
    g = np.concatenate([sides[0].mesh, -sides[1].mesh])
    force = np.zeros(len(g))
    first = len(sides[0].mesh)
    force[sides[0].torque], force[first + sides[1].torque] = own.mean_force, -own.mean_force
    k, m, omega = scales.mean_stiffness, scales.equivalent_mass, scales.omega_n
    oscillator = dynamics.DriveOscillator(
        mass=mass / m, damping=damping / (m * omega), stiffness=firm / k, direction=g, mesh_stiffness=own.stiffness,
        mesh_damping=2.0 * own.damping_ratio, mean_force=force, error_amplitude=own.error_amplitude,
        frequency=own.frequency, half_backlash=own.half_backlash, error_phase=own.error_phase, one_sided=one_sided,
        free_mesh_damping=None if free_damping_ratio is None else 2.0 * own.damping_ratios[1],
    )  # fmt: skip
    names = tuple(f"{name} {what}" for name, side in zip(SIDES, sides, strict=True) for what in side.names)
    frequencies, shapes, shares = drive_modes(oscillator)
    return PairDrive(
        oscillator,
        rigid,
        names,
        frequencies * omega / (2.0 * math.pi),
        shapes,
        shares,
        _outputs(sides, scales),
        (sides[0].shaft, sides[1].shaft),
        message=rigid.message,
    )


def _outputs(sides: Sequence[Side], scales: dynamics.Scaling) -> tuple[DriveOutput, ...]:
    """What all parts carry, as factors on the oscillator's displacements and speeds."""
    found, first = [], 0
    n = sum(len(side.mesh) for side in sides)
    for which, side in zip(SIDES, sides, strict=True):
        for name, unit, push, drag in side.carried:
            rows = np.zeros((2, n))
            rows[0, first : first + len(push)] = push * scales.length
            rows[1, first : first + len(drag)] = drag * scales.length * scales.omega_n
            found.append(DriveOutput(f"{which} {name}", unit, rows[0], rows[1]))
        first += len(side.mesh)
    return tuple(found)


def drive_modes(oscillator: dynamics.DriveOscillator) -> tuple[Array, Array, Array]:
    """Undamped modes in contact with the mean mesh stiffness, from the lowest, the free rotation left out.

    Returns
    -------
    frequencies : ndarray, shape (modes,)
    shapes : ndarray, shape (modes, n)
        The largest entry of each is 1.
    shares : ndarray, shape (modes,)
        Part of the elastic energy that is in the mesh.
    """
    mass, own, g = map(np.asarray, (oscillator.mass, oscillator.stiffness, oscillator.direction))
    mean = oscillator.mesh_stiffness.mean
    whole = own + mean * np.outer(g, g)
    inverse = np.linalg.inv(np.linalg.cholesky(mass))
    squares, vectors = np.linalg.eigh(inverse @ whole @ inverse.T)
    shapes = (inverse.T @ vectors[:, 1:]).T  # one rotation of the whole train is free
    shapes /= np.take_along_axis(shapes, np.argmax(np.abs(shapes), axis=1)[:, None], axis=1)
    energies = np.einsum("ij,jk,ik->i", shapes, whole, shapes)
    return np.sqrt(squares[1:]), shapes, mean * (shapes @ g) ** 2 / energies


def _without_rotation(mass: Array, rotations: Array) -> Array:
    """Mass matrix of what is left of a motion when the free rotations, in columns, are taken out."""
    pushed = mass @ rotations
    return np.asarray(mass - pushed @ np.linalg.solve(rotations.T @ pushed, pushed.T))


def gear_masses(pair: gears.GearPair) -> tuple[float, float]:
    """Masses of the gears [kg], as discs from the bore to the reference circle with the gears' moments of inertia."""
    first, second = (
        2.0 * inertia / (tooth.reference_radius**2 + tooth.bore_radius**2)
        for inertia, tooth in zip(pair.moments_of_inertia, pair.teeth_profiles, strict=True)
    )
    return first, second


def _diagonal(first: Array, second: Array) -> Array:
    """Both matrices, one after the other on the diagonal."""
    right, below = (
        np.zeros((len(first), second.shape[1])),
        np.zeros((len(second), first.shape[1])),
    )
    return np.block([[first, right], [below, second]])
