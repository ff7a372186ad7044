"""What a series leaves out of a sweep: some of its motions, and where contact is first lost, with more harmonics."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from itertools import count
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

import dynamics
from base import Array, Integers
from flankfilm.coupling.speeds.truncation import Longer, longer_motion
from flankfilm.coupling.vibration.resonance import Vibrations, vibration

if TYPE_CHECKING:
    from flankfilm.coupling.drive.pair_drive import PairDrive
    from flankfilm.coupling.vibration.oscillator import PairOscillator

CHECKED = 12
"""Values of a sweep, evenly over the range, at which motions are computed with the longer series as well."""

LEAST_HARMONICS = 32
"""Lowest order of the longer series: forces follow the stiffness at every instant, and need more than displacements."""

NEAR, POINTS = 0.1, 41
"""Part of the frequency on both sides in which the longer series' loss of contact is looked for, and at how many."""


def grazing_errors(longer: Longer, grazings: Array) -> Array:
    """Relative errors of the frequencies at which contact is first lost; infinite where the longer series has none.

    Parameters
    ----------
    longer : Longer
    grazings : ndarray, shape (n,)
        Frequencies with the series itself.
    """
    errors = []
    for here in grazings.tolist():
        bounds = ((1.0 - NEAR) * here, (1.0 + NEAR) * here)
        near = dynamics.contact_grazing(longer.oscillator, "frequency", bounds, points=POINTS).columns()
        errors.append(float(np.min(np.abs(near / here - 1.0), initial=np.inf)))
    return np.array(errors)


def checked_values(count: int, forces: Sequence[Array]) -> Integers:
    """Values of a sweep that are computed once more: evenly, and where the forces of either direction are largest."""
    evenly = np.linspace(0, count - 1, min(CHECKED, count)).round().astype(np.int64)
    greatest = [int(np.nanargmax(force)) for force in forces if np.isfinite(force).any()]
    return np.unique(np.concatenate([evenly, np.array(greatest, dtype=np.int64)]))


class MotionChanges(NamedTuple):
    """What the longer series changes of swept motions, relatively.

    nan where the motion does not repeat; infinite where Newton's method finds no motion of the same label.

    Attributes
    ----------
    force, spread : ndarray, shape (n,)
        Of the maximum force and of the displacement's root mean square.
    parts : ndarray, shape (n, 3, parts)
        Of mean, root mean square and largest of what each part of a drive train carries, all over the largest.
    """

    force: Array
    spread: Array
    parts: Array


def motion_changes(
    longer: Longer,
    motion: PairOscillator | PairDrive,
    swept: dynamics.SweepResult,
    before: Vibrations,
    at: Integers,
    began: Callable[[], None] = lambda: None,
) -> MotionChanges:
    """What the longer series changes of the figures of swept motions.

    Parameters
    ----------
    longer : Longer
    motion : PairOscillator or PairDrive
        Of the sweep.
    swept : SweepResult
    before : Vibrations
        Figures of the sweep's motions.
    at : ndarray of int, shape (n,)
        Values that are looked at.
    began : callable
        Called as each of them begins.
    """
    changes = np.full((len(at), 2), np.nan)
    parts = np.full((len(at), 3, len(motion.outputs)), np.nan)
    for row, index in enumerate(at.tolist()):
        began()
        periods, frequency = int(swept.periods[index]), float(swept.values[index])
        if not periods:
            continue
        state = swept.states[index][-1]
        there = longer.oscillator.with_parameter("frequency", frequency)
        orbit = dynamics.find_orbit(there, state, periods=periods)
        if not orbit.converged or orbit.label != swept.labels[index]:
            changes[row], parts[row] = np.inf, np.inf
            continue
        after = vibration(there, orbit.state, periods, load=motion.mean_force, outputs=motion.outputs)
        for column, (figure, other) in enumerate(
            ((before.force[index], after.force), (before.spread[index], after.spread))
        ):
            changes[row, column] = abs(figure / other - 1.0) if other > 0.0 else np.nan
        parts[row] = np.abs(before.parts[index] - after.parts) / np.maximum(after.parts[2], 1e-300)
    return MotionChanges(changes[:, 0], changes[:, 1], parts)


class LongerChanges(NamedTuple):
    """What a longer series changes of a sweep up and down.

    Attributes
    ----------
    longer : Longer
        The oscillator with that series.
    at : ndarray of int, shape (n,)
        Values of the sweep that are looked at.
    by_way : mapping
        Changes there, by direction.
    """

    longer: Longer
    at: Integers
    by_way: Mapping[str, MotionChanges]

    def each(self, figure: str) -> dict[str, Array]:
        """Changes of a figure by direction."""
        return {way: getattr(change, figure) for way, change in self.by_way.items()}


def longer_changes(
    motion: PairOscillator | PairDrive,
    sweeps: Mapping[str, dynamics.SweepResult],
    shaken: Mapping[str, Vibrations],
    progress: Callable[[int, int], None] = lambda done, every: None,
) -> LongerChanges | None:
    """What a longer series changes of the motions of a sweep; None where the series was given.

    Parameters
    ----------
    motion : PairOscillator or PairDrive
    sweeps, shaken : mapping
        Sweeps over the frequency, and figures of their motions, by direction.
    progress : callable
        Called with the number of the motion that begins, and that of all.
    """
    values = next(iter(sweeps.values())).values
    longer = longer_motion(motion, (float(values.min()), float(values.max())), LEAST_HARMONICS)
    if longer is None:
        return None
    at = checked_values(len(values), [figures.force for figures in shaken.values()])
    done, total = count(1), len(sweeps) * len(at)
    changes = {
        way: motion_changes(longer, motion, result, shaken[way], at, lambda: progress(next(done), total))
        for way, result in sweeps.items()
    }
    return LongerChanges(longer, at, changes)
