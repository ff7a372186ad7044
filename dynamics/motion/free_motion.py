"""What moves beside the mesh force: linear, and followed exactly from step to step, in coordinates of its modes."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from base import Array, Integers
from dynamics.model.drive_oscillator import DriveOscillator

if TYPE_CHECKING:
    from dynamics.model.oscillator import GearOscillator

ALIKE = 1e8
"""Condition of modes from which on they are not distinguished: it multiplies rounding."""


class Linear(NamedTuple):
    """What moves beside the mesh force: displacements, of which the first closes the mesh, and speeds.

    Attributes
    ----------
    matrix : ndarray, shape (2 m, 2 m)
        Rates by the state, with the damping of the mesh in contact.
    load : ndarray, shape (2 m,)
        Rates by the constant load.
    gain : float
        Acceleration of the first coordinate by a force of the mesh.
    damped : tuple of float
        Damping of the mesh in contact, and out of it.
    """

    matrix: Array
    load: Array
    gain: float
    damped: tuple[float, float]


def linear_part(oscillator: GearOscillator | DriveOscillator) -> Linear:
    """Everything of an oscillator but its mesh stiffness."""
    if isinstance(oscillator, DriveOscillator):
        at, load, gain = oscillator.coordinates, oscillator.load, oscillator.coordinates.gain
        stiffness, damping, damped = at.stiffness, at.damping.copy(), oscillator.dampings
    else:
        contact, free = oscillator.damping_ratios
        stiffness, damping, damped = np.zeros((1, 1)), np.zeros((1, 1)), (2.0 * contact, 2.0 * free)
        load, gain = np.array([oscillator.mean_force]), 1.0
    damping[0, 0] += gain * damped[0]
    none = np.zeros_like(stiffness)
    matrix = np.block([[none, np.eye(len(load))], [-stiffness, -damping]])
    return Linear(matrix, np.concatenate([np.zeros_like(load), load]), gain, damped)


class Modes(NamedTuple):
    """Coordinates of the modes of a linear part, in which a step of free motion has two entries in a row.

    Attributes
    ----------
    raises : ndarray, shape (n, n)
        State of these coordinates.
    lowers : ndarray, shape (n, n)
        Its inverse.
    rates : complex ndarray, shape (n,)
        Of each coordinate; above the real axis that of the first of two, below it that of the second.
    """

    raises: Array
    lowers: Array
    rates: Array

    def step(self, dt: float) -> tuple[Array, Integers]:
        """Entries of rows of a step (n, 2), and their columns."""
        grown, at = np.exp(self.rates * dt), np.arange(len(self.rates))
        beside = at + np.sign(self.rates.imag).astype(np.int64)
        return np.column_stack([grown.real, grown.imag]), np.column_stack([at, beside])


def modes_of(matrix: Array) -> Modes | None:
    """Coordinates of the modes of a matrix; None where two of them all but coincide, or none would be saved."""
    if len(matrix) <= 2:
        return None
    rates, vectors = np.linalg.eig(matrix)
    kept = rates.imag >= 0.0
    raises, each = [], []
    for rate, vector in zip(rates[kept], vectors.T[kept], strict=True):
        raises += [vector.real] if rate.imag == 0.0 else [vector.real, vector.imag]
        each += [rate] if rate.imag == 0.0 else [rate, np.conj(rate)]
    whole = np.column_stack(raises)
    return None if np.linalg.cond(whole) > ALIKE else Modes(whole, np.linalg.inv(whole), np.array(each))


def free_step(part: Linear, modes: Modes | None, dt: float) -> tuple[Array, Integers, Array]:
    """Step without mesh: entries of its rows, their columns, and with the load the step of a state and a one."""
    from scipy.linalg import expm

    n = len(part.load)
    linear = expm(np.block([[part.matrix, part.load[:, None]], [np.zeros((1, n + 1))]]) * dt)
    if modes is None:
        return np.ascontiguousarray(linear[:n, :n]), np.tile(np.arange(n), (n, 1)), linear
    return *modes.step(dt), linear


def forced_steps(
    oscillator: GearOscillator | DriveOscillator, system: Array, linear: Array, tau: Array
) -> Array:
    """What forces add to the state in each step between some times: the mean one, and those that are periodic.

    A periodic motion z under a periodic force goes from one time to the next by z = E z + what the force adds.
    """
    n = len(system)
    loaded = np.tile(linear[:n, -1], (len(tau) - 1, 1))
    if not isinstance(oscillator, DriveOscillator):
        return loaded
    amplitudes, phases = oscillator.force_series
    for direction in oscillator.moving_loads:
        pushed = np.append(np.zeros(n // 2), direction)
        for j, size in enumerate((amplitudes * np.exp(1j * phases)).tolist(), start=1):
            rate = 1j * j * oscillator.frequency
            moved = np.linalg.solve(rate * np.eye(n) - system, size * pushed)
            path = np.real(np.exp(rate * tau)[:, None] * moved)
            loaded += path[1:] - path[:-1] @ linear[:n, :n].T
    return loaded
