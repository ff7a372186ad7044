"""What settled motions of sweeps do to the teeth: maximum force, time without contact, vibration."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from base import Array
from flankfilm.coupling.vibration.part_loads import DriveOutput, output_rows

if TYPE_CHECKING:
    import dynamics
    from dynamics.flow.protocol import Flow
    from dynamics.model.protocol import PeriodicOscillator

SAMPLES = 400
"""Samples of a mesh period."""

APERIODIC = 60
"""Mesh periods over which a motion that does not repeat is followed."""


class Vibration(NamedTuple):
    """Figures of one motion; nan where it could not be followed, or of the force without a mean force.

    Attributes
    ----------
    force : float
        Maximum force over the mean force.
    separated : float
        Part of the time in which the driving flanks do not touch.
    spread : float
        Root mean square of the displacement about its mean; in several freedoms of what the backlash limits.
    separated_error : float
        What half as many samples change of that part, relative; 0 where it is 0 with both.
    change : float
        Largest relative change of force, spread and parts with half as many samples; parts over their largest.
    parts : ndarray, shape (3, parts)
        Mean, root mean square about it, and maximum modulus of what each part of a drive train carries.
    """

    force: float
    separated: float
    separated_error: float
    spread: float
    change: float
    parts: Array


class Vibrations(NamedTuple):
    """Figures of the motions of a sweep, as of `Vibration`; `parts` has the shape (values, 3, parts)."""

    force: Array
    separated: Array
    separated_error: Array
    spread: Array
    change: float
    parts: Array


def vibrations(
    oscillator: PeriodicOscillator,
    sweeps: Sequence[dynamics.SweepResult],
    *,
    load: float | None = None,
    outputs: Sequence[DriveOutput] = (),
) -> list[Vibrations]:
    """Force, time without contact and spread of all motions of sweeps, the error by sampling, and what parts carry.

    Parameters
    ----------
    oscillator : GearOscillator or DriveOscillator
    sweeps : sequence of SweepResult
        Over the same frequencies: tables of a frequency serve all of them.
    load, outputs
        As of `vibration`.

    Examples
    --------
    >>> from dynamics import FourierStiffness, GearOscillator, sweep
    >>> osc = GearOscillator(FourierStiffness(1.0, (0.18,), (0.0,)), 0.05, 0.1, 0.2, 0.5, half_backlash=0.2)
    >>> (found,) = vibrations(osc, [sweep(osc, "frequency", [0.5, 0.65])])
    >>> found.force.round(2), found.separated.round(2), found.change < 1e-3
    (array([1.94, 5.68]), array([0.  , 0.61]), True)
    """
    each: list[list[Vibration]] = []
    stiffness = stiffness_of(oscillator)
    for i, value in enumerate(sweeps[0].values.tolist()):
        here = Sampler(oscillator.with_parameter("frequency", value), stiffness, load, outputs)
        each.append([here.vibration(swept.states[i, -1], int(swept.periods[i])) for swept in sweeps])
    return [_gathered(motions) for motions in zip(*each, strict=True)]


def _gathered(motions: Sequence[Vibration]) -> Vibrations:
    """Figures of motions by figure."""
    force, separated, off, spread, change, parts = (np.array(figure) for figure in zip(*motions, strict=True))
    return Vibrations(force, separated, off, spread, float(change.max()), parts)


def vibration(
    oscillator: PeriodicOscillator,
    state: Array,
    periods: int,
    *,
    load: float | None = None,
    outputs: Sequence[DriveOutput] = (),
) -> Vibration:
    """Figures of the settled motion from a state at tau = 0; `periods` 0 where it does not repeat.

    Parameters
    ----------
    oscillator : GearOscillator or DriveOscillator
    state : ndarray, shape (dimension,)
    periods : int
    load : float, optional
        Mean force of the mesh. Left out: that of a `GearOscillator`.
    outputs : sequence of DriveOutput
        What parts carry.
    """
    return Sampler(oscillator, stiffness_of(oscillator), load, outputs).vibration(state, periods)


def stiffness_of(oscillator: PeriodicOscillator) -> Array:
    """Stiffness of the contact at the samples of one period, the end left out: at all frequencies the same."""
    return oscillator.contact_stiffness(2.0 * math.pi / SAMPLES * np.arange(SAMPLES))


@dataclass(frozen=True, eq=False)
class Sampler:
    """An oscillator made ready for the figures of its motions.

    Attributes
    ----------
    oscillator : GearOscillator or DriveOscillator
    stiffness : ndarray, shape (SAMPLES,)
        As of `stiffness_of`.
    load, outputs
        As of `vibration`.
    """

    oscillator: PeriodicOscillator
    stiffness: Array
    load: float | None
    outputs: Sequence[DriveOutput]

    @cached_property
    def flow(self) -> Flow:
        """Its flow."""
        from dynamics.flow.flows import flow_of

        return flow_of(self.oscillator)

    def vibration(self, state: Array, periods: int) -> Vibration:
        """Figures of the settled motion from a state at tau = 0; `periods` 0 where it does not repeat."""
        from dynamics.flow.samples import samples_of, share_below

        if not np.all(np.isfinite(state)):
            return Vibration(np.nan, np.nan, np.nan, np.nan, 0.0, np.full((3, len(self.outputs)), np.nan))
        length = periods or APERIODIC
        motion = samples_of(self.oscillator, self.flow, state, length, SAMPLES)
        force = np.resize(self.stiffness, length * SAMPLES + 1) * self.oscillator.deflection(motion.x)
        carried = output_rows(self.outputs, self.oscillator.dimension) @ motion.states[:-1].T
        fine, coarse = (_figures(force[::step], motion.x[::step]) for step in (1, 2))
        change = max(
            abs(there / here - 1.0) if here else 0.0 for here, there in zip(fine, coarse, strict=True)
        )
        parts, half = (_of_parts(carried[:, ::step]) for step in (1, 2))
        off = float(np.max(np.abs(parts - half) / np.maximum(parts[2], 1e-300), initial=0.0))
        mean = getattr(self.oscillator, "mean_force", 0.0) if self.load is None else self.load
        greatest = fine[0] / mean if mean else np.nan
        gap = motion.x - self.oscillator.half_backlash
        apart, seldom = share_below(gap), share_below(gap[::2])
        return Vibration(greatest, apart, _relative(seldom - apart, apart), fine[1], max(change, off), parts)


def _relative(change: float, value: float) -> float:
    """Change over the value: 0 where nothing changes, infinite where all of it does."""
    if change == 0.0:
        return 0.0
    return abs(change / value) if value else np.inf


def _figures(force: Array, x: Array) -> tuple[float, float]:
    """Maximum force, and root mean square of the displacement about its mean over whole periods."""
    return float(np.max(force)), float(np.std(x[:-1]))


def _of_parts(curves: Array) -> Array:
    """Mean, root mean square about it, and maximum modulus of curves, one row each."""
    return np.array([curves.mean(axis=1), curves.std(axis=1), np.abs(curves).max(axis=1)])
