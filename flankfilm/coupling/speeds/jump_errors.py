"""A jump with its error budget, and what the jumps of a drive train err by.

The fold of a pair on rigid shafts is carried to another stiffness by Newton's method on the fold itself
(`dynamics.carried_point`). In several freedoms a branch that begins on the motion that ends leads to the fold with a
stiffness that differs little, and jumps of the longer series are those of the similar branches of that series.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

import dynamics
from base import Array
from flankfilm.coupling.vibration.series import MEANS, MeshSeries

if TYPE_CHECKING:
    from dynamics.branches.branch import Stretch
    from dynamics.model.protocol import PeriodicOscillator
    from flankfilm.coupling.drive.pair_drive import PairDrive
    from flankfilm.coupling.speeds.truncation import Longer

STEP = 1e-3
"""Relative change of the stiffness by which slopes of a train's jump are taken."""

NEAR = 0.02
"""Part of a jump's frequency on both sides in which it is looked for with a stiffness that differs little."""

ALIKE = 0.1
"""Part of a jump's frequency within which another series has the same one."""


@dataclass(frozen=True)
class Jump:
    """End of a stable motion at a saddle node, where the motion jumps.

    Attributes
    ----------
    frequency : float
        Mesh frequency over the natural frequency.
    rising : bool
        Whether the motion ends as the speed rises.
    label : str
        The motion that ends.
    budget : mapping
        Source of error to relative error of the speed: ``"stiffness"`` of meshes, arcs and films, ``"truncation"`` of
        what the order of its series leaves out, ``"flow"``; empty for a given series. The truncation is infinite,
        that is unknown, where the longer series has no such jump.
    longer : float or None
        The same jump's frequency with the longer series; nan where it has none, None for a given series.
    """

    frequency: float
    rising: bool
    label: str
    budget: Mapping[str, float]
    longer: float | None

    @property
    def error(self) -> float:
        """Sum of the budget; infinite where it is unknown."""
        return math.fsum(self.budget.values())


def rises(stretch: Stretch, point: dynamics.SpecialPoint) -> bool:
    """Whether a stable motion ends at a point as the parameter rises."""
    return stretch.high - point.parameter < point.parameter - stretch.low


def stiffness_errors(series: MeshSeries) -> tuple[float, Array]:
    """Relative error of the mean, and errors of the amplitudes over the mean, by meshes, arcs and films.

    Zero where a model's are unknown.
    """
    assert series.cycle is not None
    mean = series.cycle.errors[MEANS[series.kind]]
    amplitudes = np.zeros(series.order) if series.harmonic_error is None else series.harmonic_error
    return mean or 0.0, amplitudes


def alike(
    ends: Sequence[tuple[Stretch, dynamics.SpecialPoint]],
    others: Sequence[tuple[Stretch, dynamics.SpecialPoint]],
) -> list[dynamics.SpecialPoint | None]:
    """For each end of a stable stretch that of another series where the same motion ends, the same way.

    Of several the one whose frequency and state are nearest.
    """
    matches: list[dynamics.SpecialPoint | None] = []
    for stretch, point in ends:
        same = [
            (_apart(point, there), there)
            for other, there in others
            if other.label == stretch.label
            and rises(other, there) is rises(stretch, point)
            and abs(there.parameter / point.parameter - 1.0) < ALIKE
        ]
        matches.append(min(same, key=lambda candidate: candidate[0], default=(0.0, None))[1])
    return matches


def _apart(fold: dynamics.SpecialPoint, other: dynamics.SpecialPoint) -> float:
    """Distance of two folds: of their frequencies, and of their states over the size of the one."""
    size = max(float(np.max(np.abs(fold.state))), 1e-300)
    return (
        abs(other.parameter / fold.parameter - 1.0) + float(np.max(np.abs(other.state - fold.state))) / size
    )


def moved_fold(
    oscillator: PeriodicOscillator, stretch: Stretch, point: dynamics.SpecialPoint
) -> dynamics.SpecialPoint | None:
    """The fold that ends a stable stretch, with an oscillator that differs little; None where it is not found.

    Parameters
    ----------
    oscillator : DriveOscillator
        With another stiffness.
    stretch : Stretch
        Of the first oscillator.
    point : SpecialPoint
        The fold at one of its ends.
    """
    here, start = point.parameter, stretch.value
    orbit = dynamics.find_orbit(
        oscillator.with_parameter("frequency", start), stretch.state, periods=stretch.periods
    )
    if not orbit.converged or orbit.periods != stretch.periods:
        return None
    bounds = min(start, (1.0 - NEAR) * here), max(start, (1.0 + NEAR) * here)
    folds = dynamics.continue_branch(orbit, "frequency", bounds).special("saddle-node")
    return min(folds, key=lambda fold: abs(fold.parameter - here), default=None)


def train_jump(
    drive: PairDrive,
    longer: Longer | None,
    stretch: Stretch,
    point: dynamics.SpecialPoint,
    carried: dynamics.SpecialPoint | None,
) -> Jump:
    """Jump of a drive train: errors of its stiffness by slopes of the fold, and the change by the longer series."""
    rising, here = rises(stretch, point), point.parameter
    if longer is None:
        return Jump(here, rising, stretch.label, {}, None)
    mean, off = stiffness_errors(drive.series)
    budget = {
        "stiffness": math.fsum(
            math.inf if fold is None else error / STEP * abs(fold.parameter / here - 1.0)
            for error, fold in _moved(drive, stretch, point, mean, off)
        ),
        "truncation": math.inf if carried is None else abs(carried.parameter / here - 1.0),
        "flow": point.error,
    }
    return Jump(here, rising, stretch.label, budget, math.nan if carried is None else carried.parameter)


def _moved(
    drive: PairDrive, stretch: Stretch, point: dynamics.SpecialPoint, mean: float, off: Array
) -> Iterator[tuple[float, dynamics.SpecialPoint | None]]:
    """Error of the mean and of each amplitude over the mean, with the fold where that is larger by a step."""
    oscillator = drive.oscillator
    own, amplitudes = oscillator.contact_stiffness, np.array(oscillator.contact_stiffness.amplitudes)
    if mean > 0.0:
        more = tuple(((1.0 + STEP) * amplitudes).tolist())
        changed = oscillator.with_contact_stiffness(
            dynamics.FourierStiffness((1.0 + STEP) * own.mean, more, own.phases)
        )
        for name in {"mesh_damping", "free_mesh_damping"} & {
            *oscillator.parameters
        }:  # their ratio is what is given
            changed = changed.with_parameter(name, math.sqrt(1.0 + STEP) * oscillator.get(name))
        yield mean, moved_fold(changed, stretch, point)
    for k in np.flatnonzero(off).tolist():
        each = amplitudes.copy()
        each[k] += STEP * own.mean
        stiffness = dynamics.FourierStiffness(own.mean, tuple(each.tolist()), own.phases)
        yield float(off[k]), moved_fold(oscillator.with_contact_stiffness(stiffness), stretch, point)
