"""Drive train of a pair: its gears on shafts and bearings, with motor and load, and what these carry."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

import dynamics
import gears
from base import Array, Cost, Faults, Limit, part, quantity, record
from flankfilm.coupling.oscillator import PairOscillator, pair_oscillator
from gears.beams import ReducedShaft, reduced

if TYPE_CHECKING:
    from flankfilm.coupling.cycle import MeshCycle
    from flankfilm.coupling.series import MeshSeries

SIDES = ("pinion", "wheel")
INERTIA = Limit(0.0, 1e9, "kg m2", "0 where nothing is coupled")
DAMPING = Limit(0.0, 1.0, "", "0.005 to 0.02 for shafts")


@dataclass(frozen=True, eq=False)
class DriveOutput:
    """What a part of the train carries: linear in the state.

    Attributes
    ----------
    name : str
        Such as "pinion bearing 1" or "wheel shaft".
    unit : str
        N or N m.
    displacement, speed : ndarray, shape (n,)
        Factors on the oscillator's displacements and speeds.
    """

    name: str
    unit: str
    displacement: Array
    speed: Array

    def of(self, states: Array) -> Array:
        """Values at states (k, 2 n) of the oscillator."""
        n = len(self.displacement)
        return np.asarray(states[:, :n] @ self.displacement + states[:, n:] @ self.speed)


@record
class PairDrive:
    """Oscillator of a pair with its shafts, bearings, motor and load."""

    headline = ("natural_frequencies", "freedoms")

    oscillator: dynamics.DriveOscillator = part("in the units of `rigid.scales`")
    rigid: PairOscillator = part("the pair on rigid shafts and bearings, whose scales these are")
    freedoms: tuple[str, ...] = quantity(
        "", "names of the oscillator's displacements, along the line of action"
    )
    natural_frequencies: Array = quantity(
        "Hz",
        "of the train in contact with the mean mesh stiffness, free rotation left out",
        "mode",
        error="error",
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


class _Side(NamedTuple):
    """Half of the train, in turns times base radius and the gear's deflection along the line of action."""

    names: tuple[str, ...]
    mass: Array
    stiffness: Array
    damping: Array
    mesh: Array
    torque: int
    shaft: ReducedShaft | None
    outputs: tuple[tuple[str, str, Array, Array], ...]


def pair_drive(
    pair: gears.GearPair,
    stiffness: MeshCycle | MeshSeries,
    torque: float,
    speed: float,
    *,
    shafts: tuple[gears.Shaft | None, gears.Shaft | None],
    end_inertias: tuple[float, float] = (0.0, 0.0),
    damping_ratio: float = 0.05,
    shaft_damping_ratio: float | Sequence[float] = 0.01,
    error_amplitude: float | Sequence[float] | Array = 0.0,
    error_phase: float | Sequence[float] | Array = 0.0,
    length_scale: float | None = None,
    one_sided: bool = False,
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
    damping_ratio : float
        Of the mesh, as of `pair_oscillator`: c = 2 zeta sqrt(k_m m_e) with the equivalent mass of the gears alone.
    shaft_damping_ratio : float or sequence of float
        Modal ratio of shafts and bearings without the mesh, one for all modes or one for each from the lowest on;
        dampers of bearings come on top.
    error_amplitude, error_phase, length_scale, one_sided
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
        ratios = [
            faults.number(f"shaft_damping_ratio[{i}]", ratio, DAMPING)
            for i, ratio in enumerate(
                np.atleast_1d(np.asarray(shaft_damping_ratio, dtype=np.float64)).tolist()
            )
        ]
    rigid = pair_oscillator(
        pair, stiffness, torque, speed, damping_ratio=damping_ratio, error_amplitude=error_amplitude,
        error_phase=error_phase, length_scale=length_scale, one_sided=one_sided,
    )  # fmt: skip
    scales, own = rigid.scales, rigid.oscillator
    assert scales is not None  # a pair has them
    radii, masses = pair.base_radii, gear_masses(pair)
    sides = [
        _side(SIDES[i], shafts[i], radii[i], pair.moments_of_inertia[i], masses[i], end_inertias[i])
        for i in range(2)
    ]
    mass, firm, damping = (
        _diagonal(*(getattr(s, name) for s in sides)) for name in ("mass", "stiffness", "damping")
    )
    if np.any(firm):
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
    )  # fmt: skip
    names = tuple(f"{name} {what}" for name, side in zip(SIDES, sides, strict=True) for what in side.names)
    return PairDrive(
        oscillator,
        rigid,
        names,
        natural_frequencies(oscillator) * omega / (2.0 * math.pi),
        _outputs(sides, scales),
        (sides[0].shaft, sides[1].shaft),
        message=rigid.message,
    )


def _outputs(sides: Sequence[_Side], scales: dynamics.Scaling) -> tuple[DriveOutput, ...]:
    """What all parts carry, as factors on the oscillator's displacements and speeds."""
    found, first = [], 0
    n = sum(len(side.mesh) for side in sides)
    for which, side in zip(SIDES, sides, strict=True):
        for name, unit, push, drag in side.outputs:
            rows = np.zeros((2, n))
            rows[0, first : first + len(push)] = push * scales.length
            rows[1, first : first + len(drag)] = drag * scales.length * scales.omega_n
            found.append(DriveOutput(f"{which} {name}", unit, rows[0], rows[1]))
        first += len(side.mesh)
    return tuple(found)


def natural_frequencies(oscillator: dynamics.DriveOscillator) -> Array:
    """Undamped natural frequencies in contact with the mean mesh stiffness, from the lowest, free rotation left out."""
    at = oscillator.coordinates
    whole = at.stiffness.copy()
    whole[0, 0] += at.gain * oscillator.mesh_stiffness.mean
    return np.sqrt(np.sort(np.linalg.eigvals(whole).real))


def gear_masses(pair: gears.GearPair) -> tuple[float, float]:
    """Masses of the gears [kg], as discs from the bore to the reference circle with the gears' moments of inertia."""
    first, second = (
        2.0 * inertia / (tooth.reference_radius**2 + tooth.bore_radius**2)
        for inertia, tooth in zip(pair.moments_of_inertia, pair.teeth_profiles, strict=True)
    )
    return first, second


def _side(
    side: str, shaft: gears.Shaft | None, radius: float, inertia: float, mass: float, end: float
) -> _Side:
    """Half of the train; what bearings and shafts carry is positive as the driving flanks press."""
    if shaft is None:
        whole = np.array([[(inertia + end) / radius**2]])
        none = np.zeros((1, 1))
        return _Side(("gear",), whole, none, none, np.ones(1), 0, None, ())
    felt = reduced(shaft)
    rigid = math.isinf(felt.torsion_stiffness)
    turns = 1 if rigid else 2
    n = turns + 1
    m, k, c = (np.zeros((n, n)) for _ in range(3))
    m[:turns, :turns] = felt.inertia[:turns, :turns] / radius**2
    m[0, 0] += inertia / radius**2
    m[turns - 1, turns - 1] += end / radius**2
    m[-1, -1], k[-1, -1] = mass + felt.bending_mass, felt.bending_stiffness
    c[-1, -1] = felt.bending_damping
    outputs, way = [], 1.0 if side == SIDES[0] else -1.0
    for i, (bearing, share) in enumerate(zip(shaft.bearings, felt.bearing_shares.tolist(), strict=True)):
        push, drag = np.zeros(n), np.zeros(n)
        push[-1], drag[-1] = -way * bearing.stiffness * share, -way * bearing.damping * share
        outputs.append((f"bearing {i + 1}", "N", push, drag))
    if not rigid:
        twist = felt.torsion_stiffness / radius**2
        k[:2, :2] = twist * np.array([[1.0, -1.0], [-1.0, 1.0]])
        carried = way * felt.torsion_stiffness / radius * np.array([-1.0, 1.0, 0.0])
        outputs.append(("shaft", "N m", carried, np.zeros(n)))
    names = ("gear", "deflection") if rigid else ("gear", "end", "deflection")
    mesh = np.zeros(n)
    mesh[0] = mesh[-1] = 1.0
    return _Side(names, m, k, c, mesh, turns - 1, felt, tuple(outputs))


def _diagonal(first: Array, second: Array) -> Array:
    """Both matrices, one after the other on the diagonal."""
    n, m = len(first), len(second)
    return np.block([[first, np.zeros((n, m))], [np.zeros((m, n)), second]])
