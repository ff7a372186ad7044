"""Oscillator of a reduced drive train in the units of its pair, and what is looked at of the pair for it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import numpy.typing as npt

import dynamics
import gears
from base import Array
from flankfilm.coupling.drive.bent_shaft import GearBody
from flankfilm.coupling.drive.reduction import MeshExcitation, Reduction
from flankfilm.coupling.drive.train import ShaftDamping, Train
from flankfilm.coupling.vibration.oscillator import PairOscillator
from flankfilm.coupling.vibration.part_loads import DriveOutput

RANGE = (0.05, 1.5)
"""Mesh frequencies that a train is reduced for unless given, over the natural one of the pair on rigid shafts."""


def gear_masses(pair: gears.GearPair) -> tuple[float, float]:
    """Masses of the gears [kg], as discs from the bore to the reference circle with the gears' moments of inertia."""
    first, second = (
        2.0 * inertia / (tooth.reference_radius**2 + tooth.bore_radius**2)
        for inertia, tooth in zip(pair.moments_of_inertia, pair.teeth_profiles, strict=True)
    )
    return first, second


def gear_bodies(pair: gears.GearPair, inertias: tuple[float, float]) -> tuple[GearBody, GearBody]:
    """Gears as rigid bodies, with moments of inertia about their axes that hold what is fixed to them [kg m2]."""
    pitch_point, lean = pair.points.C, pair.helix.base_tangent
    levers = pitch_point, pitch_point - pair.line_of_action
    first, second = (
        GearBody(
            radius, mass, inertia, 0.5 * alone + mass * width**2 / 12.0, 0.5 * pair.face_width, lean, lever
        )
        for radius, mass, inertia, alone, width, lever in zip(
            pair.base_radii, gear_masses(pair), inertias, pair.moments_of_inertia, pair.face_widths, levers, strict=True
        )
    )  # fmt: skip
    return first, second


def mesh_frequencies(
    pair: gears.GearPair, scales: dynamics.Scaling, speed: float, speeds: tuple[float, float] | None
) -> tuple[float, float]:
    """Lowest and highest mesh frequency that is looked at [rad/s]."""
    teeth = pair.pinion.teeth
    if speeds is not None:
        low, high = sorted(speeds)
        return teeth * low, teeth * high
    return RANGE[0] * scales.omega_n, max(RANGE[1] * scales.omega_n, teeth * abs(speed))


def mesh_excitation(rigid: PairOscillator, moments: Array) -> MeshExcitation:
    """What drives the train at its mesh, with mean and harmonics of the travelling load's moment [N m]."""
    own, scales = rigid.oscillator, rigid.scales
    assert scales is not None
    swing = np.abs(own.stiffness.amplitudes) / own.stiffness.mean * abs(rigid.force)
    count = max(len(swing), len(rigid.error_amplitude), 1)
    mesh = 2.0 * own.damping_ratio * scales.equivalent_mass * scales.omega_n
    force, error = (
        np.pad(np.abs(amplitudes), (0, count - len(amplitudes)))
        for amplitudes in (swing, rigid.error_amplitude)
    )
    if not (force.any() or error.any() or moments[1:].any()):
        force[0] = 1.0  # nothing drives it: any force will do
    return MeshExcitation(force, error, scales.mean_stiffness, mesh, np.abs(moments))


def reduced_oscillator(
    rigid: PairOscillator,
    train: Train,
    damping: ShaftDamping,
    reduction: Reduction,
    free_damping_ratio: float | None,
    moments: Array,
) -> dynamics.DriveOscillator:
    """The reduced train in the units of the scales; what turns freely meets neither stiffness nor damping.

    Mean and harmonics of the travelling load's moment [N m] press the pinion's flank back where the load is, as the
    mesh does.
    """
    scales, own = rigid.scales, rigid.oscillator
    assert scales is not None
    shapes, m, omega = reduction.shapes, scales.equivalent_mass, scales.omega_n
    mass, firm = (shapes.T @ (matrix @ shapes) for matrix in (train.mass, train.stiffness))
    held, along = damping.of(shapes), -shapes.T @ train.tilt
    moments = moments / (scales.mean_stiffness * scales.length)
    if not math.isinf(reduction.valid_to):
        for matrix in (firm, held):
            matrix[0, :] = matrix[:, 0] = 0.0
    return dynamics.DriveOscillator(
        mass=0.5 * (mass + mass.T) / m, damping=0.5 * (held + held.T) / (m * omega),
        stiffness=0.5 * (firm + firm.T) / scales.mean_stiffness, direction=shapes.T @ train.direction,
        mesh_stiffness=own.stiffness, mesh_damping=2.0 * own.damping_ratio,
        mean_force=own.mean_force * (shapes.T @ train.load) + moments[0].real * along,
        error_amplitude=own.error_amplitude,
        frequency=own.frequency, half_backlash=own.half_backlash, error_phase=own.error_phase,
        one_sided=own.one_sided,
        free_mesh_damping=None if free_damping_ratio is None else 2.0 * own.damping_ratios[1],
        **_pushed(moments[1:], along),
    )  # fmt: skip


def _pushed(moments: Array, direction: Array) -> dict[str, Any]:
    """Periodic force of an oscillator along a direction, if there is one."""
    if not moments.any():
        return {}
    size, turn = (tuple(each.tolist()) for each in (np.abs(moments), np.angle(moments)))
    return {"force_direction": direction, "force_amplitude": size, "force_phase": turn}


def reduced_outputs(
    outputs: Sequence[DriveOutput], shapes: Array, scales: dynamics.Scaling
) -> tuple[DriveOutput, ...]:
    """What all parts carry, as factors on the oscillator's displacements and speeds."""
    return tuple(
        replace(
            output,
            displacement=output.displacement @ shapes * scales.length,
            speed=output.speed @ shapes * scales.length * scales.omega_n,
        )
        for output in outputs
    )


def reduced_change(
    oscillator: dynamics.DriveOscillator, squares: Array, kept: npt.NDArray[np.bool_]
) -> Array:
    """Relative change of the frequencies of modes that move, against the unreduced ones."""
    own = np.sqrt(drive_squares(oscillator))
    change, there = np.zeros(len(squares)), np.sqrt(squares[kept])
    change[kept] = [float(np.min(np.abs(own / frequency - 1.0))) for frequency in there.tolist()]
    return change


def drive_squares(oscillator: dynamics.DriveOscillator) -> Array:
    """Squares of the undamped frequencies in contact with the mean mesh stiffness, the free rotation left out."""
    mass, own, g = map(np.asarray, (oscillator.mass, oscillator.stiffness, oscillator.direction))
    inverse = np.linalg.inv(np.linalg.cholesky(mass))
    whole = own + oscillator.mesh_stiffness.mean * np.outer(g, g)
    return np.asarray(np.linalg.eigvalsh(inverse @ whole @ inverse.T)[1:])
