"""Settled motion with a mesh force that depends on the deflection as the contact itself has it, from a grid of samples.

Pairs of teeth come into contact and leave it along curved lines of angle and depth, where the force has corners.
`TabulatedContact` is smooth, and rounds them; here the force is straight between samples, and steps are equal.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple, cast

import numpy as np

from base import Array
from dynamics.model.protocol import settling_periods
from dynamics.motion.free_motion import Linear, Modes, forced_steps, free_step, linear_part, modes_of

if TYPE_CHECKING:
    from dynamics.model.drive_oscillator import DriveOscillator
    from dynamics.model.oscillator import GearOscillator

PER_OSCILLATION = 240
"""Steps of a natural period of the mesh."""

PER_SAMPLE = 2
"""Steps from one angle of the grid to the next, at least."""

LEAST_SETTLING = 10
"""Periods that a motion has at least before its maximum force is taken."""

WINDOWS, KEPT = 4, 8
"""Windows of a motion after it has settled, of so many periods each, over all of which the maximum force is taken."""


@dataclass(frozen=True, eq=False)
class GriddedContact:
    """Mesh force over the angle of the excitation and the depth, in the units of an oscillator.

    Attributes
    ----------
    forces : ndarray, shape (angles, depths)
        Force at the middle of equal parts of a period, at equally spaced depths from `lowest`, where it is 0.
    lowest, spacing : float
        First depth, below 0 where teeth touch before the deflection of the oscillator begins; and their distance.
    moved : ndarray, shape (angles,)
        Displacement whose rate the damper of the mesh does not feel.
    mirror : float
        Sum of a place in the period and of that at which the back flanks have the force of the front ones, 0 to 1.
    """

    forces: Array
    lowest: float
    spacing: float
    moved: Array
    mirror: float


class GriddedMotions(NamedTuple):
    """Maximum force of settled motions at some frequencies, nan where one grew without bound.

    Attributes
    ----------
    force : ndarray, shape (frequencies,)
    followed : bool
        Whether none grew without bound.
    unsettled : ndarray, shape (frequencies,)
        Estimated error of the force by the time for which a motion settles, relative to it (`unsettled`).
    """

    force: Array
    followed: bool
    unsettled: Array


def gridded_motions(
    oscillator: GearOscillator | DriveOscillator,
    contact: GriddedContact,
    frequencies: Iterable[float],
    steps: float = PER_OSCILLATION,
) -> GriddedMotions:
    """Settled motions with a gridded contact in place of the stiffness, each from the last state of the one before.

    Its load, damping, backlash and error stay. The linear part moves exactly, and the mesh pushes it between equal
    steps, which is of second order in the step.

    Parameters
    ----------
    oscillator : GearOscillator or DriveOscillator
    contact : GriddedContact
    frequencies : iterable of float
        In the order in which they are passed.
    steps : float
        In a natural period of the mesh.

    Examples
    --------
    >>> import numpy as np
    >>> from dynamics import FourierStiffness, GearOscillator
    >>> linear = GearOscillator(FourierStiffness(1.0), 0.05, 0.1, 0.01, 0.5, half_backlash=0.2)
    >>> spring = GriddedContact(np.tile([0.0, 1.0], (12, 1)), 0.0, 1.0, np.zeros(12), 0.0)
    >>> swing = 0.01 * 0.25 / np.hypot(0.75, 2 * 0.05 * 0.5)
    >>> found = gridded_motions(linear, spring, [0.5])
    >>> bool(abs(found.force[0] - 0.1 - swing) < 1e-6)
    True
    """
    part = linear_part(oscillator)
    m, modes = len(part.load) // 2, modes_of(part.matrix)
    state = np.zeros(2 * m)
    soft, pushed = -part.matrix[m:, :m], part.load[m:].copy()
    soft[0, 0] += part.gain * oscillator.contact_stiffness.mean
    pushed[0] += part.gain * oscillator.contact_stiffness.mean * oscillator.half_backlash
    state[:m] = np.linalg.lstsq(soft, pushed, rcond=None)[0]
    rest, forces, late = state.copy(), [], []
    for frequency in frequencies:
        moved = cast("GearOscillator", oscillator.with_parameter("frequency", float(frequency)))
        peaks = _settled(moved, part, modes, contact, state, steps)
        forces.append(float(peaks.max()))
        late.append(unsettled(peaks, math.exp(-KEPT * moved.decay * moved.period)))
        if not math.isfinite(forces[-1]):
            state[:] = rest
    return GriddedMotions(np.array(forces), bool(np.isfinite(forces).all()), np.array(late))


def unsettled(peaks: Array, decay: float) -> float:
    """Error of the largest of a motion's maximum forces in windows one after the other, relative to it.

    A periodic motion, of one period of the mesh or of several, has the same maximum in all of them. Their spread is
    what a motion that settles has changed since the first, and what chance leaves in the maximum of one that never
    repeats. Where maxima change in one direction, the motion still settles: changes go on as a geometric series, of
    the ratio of the last two, or of that by damping where they do not shrink, and what it has left is added, at most
    the maximum itself.

    Parameters
    ----------
    peaks : ndarray, shape (windows,)
        At least three.
    decay : float
        By which damping shrinks a disturbance from one window to the next, 1 without any.

    Examples
    --------
    >>> import numpy as np
    >>> unsettled(2.0 - np.array([0.5, 0.25, 0.125, 0.0625]), 0.1)  # on to 2
    0.25806451612903225
    """
    top = float(peaks.max())
    if not top > 0.0:  # nan where it was not followed
        return math.nan if math.isnan(top) else 0.0
    steps = np.diff(peaks)
    before, last = float(steps[-2]), float(steps[-1])
    left = 0.0
    if before * last > 0.0:
        ratio = last / before if abs(last) < abs(before) else decay
        left = min(abs(last) * ratio / (1.0 - ratio), top) if ratio < 1.0 else top
    return (float(np.ptp(peaks)) + left) / top


def _settled(
    oscillator: GearOscillator | DriveOscillator,
    part: Linear,
    modes: Modes | None,
    contact: GriddedContact,
    state: Array,
    fine: float,
) -> Array:
    """Maximum forces of the settled motion in windows, from a state which goes on; nan where it grew without bound."""
    from dynamics.kernels.compiling import FINE
    from dynamics.kernels.gridding import step_through

    n, rows = len(part.load), len(contact.forces)
    natural = math.sqrt(part.gain * oscillator.contact_stiffness.mean)
    per_period = oscillator.period * natural / (2.0 * math.pi) * fine
    steps = max(PER_SAMPLE * rows, math.ceil(per_period / rows) * rows)
    dt = oscillator.period / steps
    within, without = part.damped
    share = np.arange(steps + 1) / steps
    places = np.column_stack([share, (contact.mirror - share) % 1.0]) * rows + (rows - 0.5)
    error, rate = _error(oscillator, share * oscillator.period)
    change = np.roll(contact.moved, -1) - contact.moved  # from the middle of a part to the next one's
    cell = np.floor((np.arange(steps) + 0.5) / steps * rows - 0.5).astype(np.int64)
    slip = change[cell] * rows / oscillator.period
    rates = np.column_stack([rate[:-1] + slip, rate[1:] + slip])
    sides = 0.0 if oscillator.one_sided else 1.0
    push = 0.5 * dt * part.gain
    figures = np.array(
        [contact.lowest, contact.spacing, oscillator.half_backlash, sides, push, within, within - without]
    )
    raises, lowers = (np.eye(n),) * 2 if modes is None else (modes.raises, modes.lowers)
    over, columns, linear = free_step(part, modes, dt)
    loaded = forced_steps(oscillator, part.matrix, linear, share * oscillator.period)
    peaks, moved = np.zeros(WINDOWS), lowers @ state
    flag = step_through(
        np.ascontiguousarray(contact.forces),
        figures,
        places,
        error,
        rates,
        over,
        columns,
        loaded @ lowers.T,
        raises[[0, n // 2]],
        np.ascontiguousarray(lowers[:, n // 2]),
        moved,
        np.empty(n),
        settling_periods(oscillator, LEAST_SETTLING),
        peaks,
        KEPT,
    )
    state[:] = raises @ moved
    return peaks if flag == FINE else np.full(WINDOWS, math.nan)


def _error(oscillator: GearOscillator | DriveOscillator, tau: Array) -> tuple[Array, Array]:
    """Error of an oscillator and its rate at some times."""
    amplitudes, phases = oscillator.error_series
    j = oscillator.frequency * np.arange(1, len(amplitudes) + 1)
    angles = tau[:, None] * j + phases
    return np.cos(angles) @ amplitudes, -np.sin(angles) @ (j * amplitudes)
