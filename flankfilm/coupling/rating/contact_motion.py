"""Motions of a pair or its drive train with the laws of the loaded contact as the force of the mesh."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from base import Array
from dynamics.motion.gridded_motion import PER_OSCILLATION, GriddedContact, gridded_motions
from flankfilm.coupling.rating.contact_laws import DEPTHS, ContactLaws, gridded

if TYPE_CHECKING:
    from flankfilm.coupling.drive.pair_drive import PairDrive
    from flankfilm.coupling.vibration.oscillator import PairOscillator

EVEN, UNEQUAL = ("even",), ("early", "late")
"""Laws of equal base pitches, and of the pinion's that is too short, and too long."""


class Followed(NamedTuple):
    """Maximum forces of settled motions over the mean one, the error of the largest, and whether all were followed.

    Forces of motions that grew without bound are nan, and so is the larger of them and others.
    """

    factor: Array
    error: float
    followed: bool


def followed(
    motion: PairOscillator | PairDrive, laws: ContactLaws, chosen: Sequence[str], values: Array
) -> Followed:
    """Follow settled motions at some frequencies, of several in sweeps up and down; of all that are made the larger.

    The error is what half as many steps in time, forces, positions and depths change, each alone, of the law with the
    larger maximum, and what its motion has left to settle (`dynamics.motion.gridded_motion.unsettled`). Motions that
    never repeat have the maximum over the periods that are looked at, and the spread of its parts as an error.

    Parameters
    ----------
    motion : PairOscillator or PairDrive
    laws : ContactLaws
    chosen : sequence of {"even", "early", "late"}
        Laws that are followed.
    values : ndarray
        Rising mesh frequencies over the natural one.
    """
    runs = [_forces(motion, gridded(laws, which, motion), values) for which in chosen]
    each = [forces for forces, _ in runs]
    peaks = [_peak(forces) for forces in each]
    worse = int(np.argmax(peaks))
    coarse = (
        _peak(_forces(motion, contact, values, steps)[0])
        for contact, steps in _coarser(motion, laws, chosen[worse])
    )
    forces, late = runs[worse]
    error = sum(abs(peak / peaks[worse] - 1.0) for peak in coarse)
    error += float(late[np.argmax(np.nan_to_num(forces, nan=-np.inf))])
    return Followed(np.maximum.reduce(each), error, bool(np.isfinite(each).all()))


def _coarser(
    motion: PairOscillator | PairDrive, laws: ContactLaws, which: str
) -> Iterator[tuple[GriddedContact, float]]:
    """Grids and steps of a natural period, one of them half as fine."""
    yield gridded(laws, which, motion), 0.5 * PER_OSCILLATION
    yield gridded(laws.fewer_forces(), which, motion), PER_OSCILLATION
    yield gridded(laws.fewer_positions(), which, motion), PER_OSCILLATION
    yield gridded(laws, which, motion, DEPTHS // 2), PER_OSCILLATION


def _forces(
    motion: PairOscillator | PairDrive, contact: GriddedContact, values: Array, steps: float = PER_OSCILLATION
) -> tuple[Array, Array]:
    """Maximum forces over the mean one at frequencies, and their errors by settling.

    Of several frequencies those of sweeps up and down, the larger.
    """
    oscillator, frequencies = motion.oscillator, values.tolist()
    up = gridded_motions(oscillator, contact, frequencies, steps)
    force, late = up.force, up.unsettled
    if len(frequencies) > 1:
        down = gridded_motions(oscillator, contact, frequencies[::-1], steps)
        late = np.where(down.force[::-1] > force, down.unsettled[::-1], late)
        force = np.maximum(force, down.force[::-1])
    return force / motion.mean_force, late


def _peak(forces: Array) -> float:
    """Largest force of motions that were followed; nan where none was."""
    return float(np.fmax.reduce(forces))
