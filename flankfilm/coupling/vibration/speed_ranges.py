"""Ranges of speed in which a stable motion does something, and the maximum forces of stable motions."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING

import numpy as np

import dynamics
import gears
from base import Array
from flankfilm.coupling.vibration.oscillator import PairOscillator

if TYPE_CHECKING:
    from dynamics.branches.branch import Stretch
    from dynamics.model.protocol import PeriodicOscillator

Ranges = tuple[tuple[float, float], ...]


def separated_ranges(stable: Iterable[Stretch]) -> Ranges:
    """Ranges of frequency in which some stable motion loses contact."""
    return _union([s for s in stable if _counts(s.label)[0] > 0])


def back_contact_ranges(stable: Iterable[Stretch]) -> Ranges:
    """Ranges of frequency in which some stable motion touches the back flank."""
    return _union([s for s in stable if _counts(s.label)[1] > 0])


def force_factors(
    oscillator: PeriodicOscillator, diagram: dynamics.Diagram, load: float, longest: int = 2
) -> Array:
    """Frequency, maximum force over the mean force and period along stable branches of short period, by frequency.

    `load` is the mean force of the mesh.

    Returns
    -------
    ndarray, shape (points, 3)
        Empty without a mean force.
    """
    from dynamics.flow.motions import force_range

    rows = []
    for branch in diagram.branches:
        for value, state, stable in zip(branch.values, branch.states, branch.stable, strict=True):
            if stable and branch.periods <= longest and load != 0.0:
                here = oscillator.with_parameter("frequency", float(value))
                greatest = force_range(here, state, branch.periods, load=load).greatest
                rows.append((float(value), greatest, branch.periods))
    return np.array(sorted(rows)).reshape(-1, 3)


def standard_factors(motion: PairOscillator, frequency: Array) -> Array:
    """K_v after ISO 6336-1, method B; the pitch deviation is the peak-to-peak value of the unloaded error."""
    scales, pair = motion.scales, motion.pair
    if scales is None or pair is None:
        return np.full(len(frequency), np.nan)
    reliefs = [gear.tip_relief.amount for gear in (pair.pinion, pair.wheel) if gear.tip_relief is not None]
    factor = gears.closed_form.iso6336_dynamic(
        pair,
        motion.force / pair.helix.base_cosine,  # normal force
        scales.equivalent_mass,
        scales.speed(1.0) * frequency,
        pitch_deviation=motion.error_range,
        relief=max(reliefs, default=0.0),
    )
    return np.asarray(factor.K_v)


def changes(
    diagrams: tuple[dynamics.Diagram, dynamics.Diagram], forces: tuple[Array, Array]
) -> Mapping[str, float]:
    """Relative changes of ranges and of the maximum force from one series to another, motions of period 1 alone.

    Parameters
    ----------
    diagrams : (Diagram, Diagram)
        With the one and with the other series.
    forces : (ndarray, ndarray)
        Their `force_factors`.

    Returns
    -------
    mapping
        ``"separated"`` and ``"back_contact"``, the largest of all limits, infinite where the ranges are not equally
        many; ``"greatest_force"``.
    """
    stable = [[s for s in diagram.stretches(stable=True) if s.periods == 1] for diagram in diagrams]
    greatest = [factors[factors[:, 2] == 1, 1] for factors in forces]
    return {
        "separated": _apart(*map(separated_ranges, stable)),
        "back_contact": _apart(*map(back_contact_ranges, stable)),
        "greatest_force": abs(float(greatest[0].max() / greatest[1].max()) - 1.0)
        if all(map(len, greatest))
        else math.inf,
    }


def _apart(ranges: Ranges, other: Ranges) -> float:
    """Largest relative difference of the limits of ranges."""
    if len(ranges) != len(other):
        return math.inf
    return float(np.max(np.abs(np.array(ranges) / np.array(other) - 1.0), initial=0.0))


def _counts(label: str) -> tuple[int, int]:
    """Losses of contact and contacts of the back flank in a label."""
    _, p, q = label.removeprefix("U").split("-")
    return int(p), int(q)


def _union(parts: list[Stretch]) -> Ranges:
    """Ranges covered by stretches, joined where they touch or overlap."""
    joined: list[tuple[float, float]] = []
    for low, high in sorted((s.low, s.high) for s in parts):
        if joined and low <= joined[-1][1] * (1.0 + 1e-9):
            joined[-1] = (joined[-1][0], max(high, joined[-1][1]))
        else:
            joined.append((low, high))
    return tuple(joined)
