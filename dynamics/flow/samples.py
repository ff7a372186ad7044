"""A motion at equal times on a flow at hand, and the force of the mesh along it."""

from __future__ import annotations

from typing import NamedTuple, Protocol

import numpy as np

from base import Array
from dynamics.flow.protocol import Flow
from dynamics.model.protocol import Oscillator, PeriodicOscillator


class Sampled(Protocol):
    """Motion with the displacement at equal times."""

    @property
    def tau(self) -> Array:
        """Dimensionless time from 0."""

    @property
    def x(self) -> Array:
        """Displacement X."""


class Samples(NamedTuple):
    """A motion at equal times, both ends included, without an error estimate.

    Attributes
    ----------
    tau, x, v : ndarray, shape (samples,)
        Dimensionless time from 0, displacement and speed; in several freedoms y, which the backlash limits.
    states : ndarray, shape (samples, dimension)
    turns, events : ndarray
        Extrema and crossings of the backlash's limits, as of `Flow.sampled`.
    """

    tau: Array
    x: Array
    v: Array
    states: Array
    turns: Array
    events: Array


def samples_of(oscillator: Oscillator, flow: Flow, state: Array, periods: int, points: int) -> Samples:
    """Sample a motion from a state at tau = 0 on the oscillator's flow; nothing is checked.

    Raises
    ------
    InputError
        If the motion cannot be followed.
    """
    states, turns, events = flow.sampled(state, periods, points)
    tau = np.arange(periods * points + 1, dtype=np.float64) * (oscillator.period / points)
    return Samples(tau, *oscillator.contact_motion(tau, states), states, turns, events)


def mesh_force(oscillator: PeriodicOscillator, motion: Sampled) -> Array:
    """Force k(tau) f(X) of the mesh at the samples of a motion, in the unit of the mean force.

    Raises
    ------
    InputError
        If the oscillator has a force that is not piecewise linear.
    """
    return oscillator.contact_force(oscillator.frequency * motion.tau, motion.x)


def share_below(clearance: Array) -> float:
    """Part of the time in which a curve is below zero, straight between its samples."""
    low, high = np.minimum(clearance[:-1], clearance[1:]), np.maximum(clearance[:-1], clearance[1:])
    crossing = np.divide(-low, high - low, out=np.zeros_like(low), where=high > low)
    return float(np.mean(np.where(high <= 0.0, 1.0, np.where(low >= 0.0, 0.0, crossing))))
