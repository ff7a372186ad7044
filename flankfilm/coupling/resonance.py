"""What a sweep's settled motions do to the teeth: greatest force, time without contact, vibration."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from base import Array

if TYPE_CHECKING:
    import dynamics

SAMPLES = 400
"""Samples of a mesh period."""

APERIODIC = 60
"""Mesh periods over which a motion that does not repeat is followed."""


class Vibration(NamedTuple):
    """Figures of one motion; nan where it could not be followed, or of the force without a mean force.

    Attributes
    ----------
    force : float
        Greatest force over the mean force.
    separated : float
        Part of the time in which the driving flanks do not touch.
    spread : float
        Root mean square of the displacement about its mean.
    change : float
        Largest relative change of force and spread with half as many samples.
    """

    force: float
    separated: float
    spread: float
    change: float


_NONE = Vibration(np.nan, np.nan, np.nan, 0.0)


def vibrations(
    oscillator: dynamics.GearOscillator, found: dynamics.SweepResult
) -> tuple[Array, Array, Array, float]:
    """Force, time without contact and spread of all motions of a sweep, and the error by sampling.

    Parameters
    ----------
    oscillator : GearOscillator
    found : SweepResult
        Over the frequency.

    Examples
    --------
    >>> from dynamics import FourierStiffness, GearOscillator, sweep
    >>> osc = GearOscillator(FourierStiffness(1.0, (0.18,), (0.0,)), 0.05, 0.1, 0.2, 0.5, half_backlash=0.2)
    >>> force, separated, spread, error = vibrations(osc, sweep(osc, "frequency", [0.5, 0.65]))
    >>> force.round(2), separated.round(2), error < 1e-3
    (array([1.94, 5.68]), array([0.  , 0.61]), True)
    """
    each = [
        vibration(oscillator.with_parameter("frequency", float(value)), states[-1], int(periods))
        for value, states, periods in zip(found.values, found.states, found.periods, strict=True)
    ]
    force, separated, spread, change = (np.array(one) for one in zip(*each, strict=True))
    return force, separated, spread, float(change.max())


def vibration(oscillator: dynamics.GearOscillator, state: Array, periods: int) -> Vibration:
    """Figures of the settled motion from a state at tau = 0; `periods` 0 where it does not repeat."""
    from dynamics.motions import mesh_force, share_below, trajectory

    if not np.all(np.isfinite(state)):
        return _NONE
    motion = trajectory(oscillator, state, periods=periods or APERIODIC, points_per_period=SAMPLES)
    force = mesh_force(oscillator, motion)
    fine, coarse = (_figures(force[::step], motion.x[::step]) for step in (1, 2))
    change = max(abs(there / here - 1.0) if here else 0.0 for here, there in zip(fine, coarse, strict=True))
    mean = oscillator.mean_force
    greatest = fine[0] / mean if mean else np.nan
    return Vibration(greatest, share_below(motion.x - oscillator.half_backlash), fine[1], change)


def _figures(force: Array, x: Array) -> tuple[float, float]:
    """Greatest force, and root mean square of the displacement about its mean over whole periods."""
    return float(np.max(force)), float(np.std(x[:-1]))
