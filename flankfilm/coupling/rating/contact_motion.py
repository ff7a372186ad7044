"""Motions of a pair or its drive train with the laws of the loaded contact as the force of the mesh."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from base import Array
from dynamics.motion.gridded_motion import PER_OSCILLATION, gridded_motions
from flankfilm.coupling.rating.contact_laws import DEPTHS, ContactLaws, gridded

if TYPE_CHECKING:
    from flankfilm.coupling.drive.pair_drive import PairDrive
    from flankfilm.coupling.vibration.oscillator import PairOscillator

UNEQUAL = ("early", "late")
"""Laws of the pinion's base pitch that is too short, and too long."""


class Followed(NamedTuple):
    """Maximum force of a motion over the mean one, its relative error, and whether it could be followed."""

    factor: float
    error: float
    followed: bool


class FollowedSpeeds(NamedTuple):
    """The same over a sweep, of both ways and both signs the larger; the error is that of its maximum."""

    factor: Array
    error: float
    followed: bool


def followed(motion: PairOscillator | PairDrive, laws: ContactLaws, which: str, frequency: float) -> Followed:
    """Maximum force of the settled motion over the mean one; the error is what coarser steps and samples change.

    Parameters
    ----------
    motion : PairOscillator or PairDrive
    laws : ContactLaws
    which : {"even", "early", "late"}
    frequency : float
        Mesh frequency over the natural one.
    """
    at = np.array([frequency])
    whole = float(_forces(motion, laws, which, at)[0])
    error = sum(abs(float(coarse[0]) / whole - 1.0) for coarse in _coarser(motion, laws, which, at))
    return Followed(whole, error, bool(np.isfinite(whole)))


def followed_worse(motion: PairOscillator | PairDrive, laws: ContactLaws, frequency: float) -> Followed:
    """The sign of the deviation with the larger force; arguments as of `followed`."""
    at = np.array([frequency])
    forces = [float(_forces(motion, laws, which, at)[0]) for which in UNEQUAL]
    return followed(motion, laws, UNEQUAL[int(np.argmax(forces))], frequency)


def followed_speeds(motion: PairOscillator | PairDrive, laws: ContactLaws, values: Array) -> FollowedSpeeds:
    """Sweeps up and down with both signs of the deviation.

    Parameters
    ----------
    motion : PairOscillator or PairDrive
    laws : ContactLaws
    values : ndarray
        Rising mesh frequencies over the natural one.
    """
    each = [_both_ways(motion, laws, which, values) for which in UNEQUAL]
    factor = np.fmax(*each)
    worse = UNEQUAL[int(np.argmax([np.nanmax(forces) for forces in each]))]
    peak = float(np.nanmax(factor))
    error = sum(
        abs(float(np.nanmax(coarse)) / peak - 1.0) for coarse in _coarser(motion, laws, worse, values)
    )
    return FollowedSpeeds(factor, error, bool(np.isfinite(each).all()))


def _coarser(
    motion: PairOscillator | PairDrive, laws: ContactLaws, which: str, values: Array
) -> tuple[Array, ...]:
    """Forces with half as many steps in time, forces, positions and depths, each alone."""
    return (
        _both_ways(motion, laws, which, values, steps=0.5 * PER_OSCILLATION),
        _both_ways(motion, laws.fewer_forces(), which, values),
        _both_ways(motion, laws.fewer_positions(), which, values),
        _both_ways(motion, laws, which, values, depths=DEPTHS // 2),
    )


def _both_ways(
    motion: PairOscillator | PairDrive,
    laws: ContactLaws,
    which: str,
    values: Array,
    steps: float = PER_OSCILLATION,
    depths: int = DEPTHS,
) -> Array:
    """Maximum force over the mean one of sweeps up and down, the larger; one way alone for one value."""
    up = _forces(motion, laws, which, values, steps, depths)
    if values.size == 1:
        return up
    return np.fmax(up, _forces(motion, laws, which, values[::-1], steps, depths)[::-1])


def _forces(
    motion: PairOscillator | PairDrive,
    laws: ContactLaws,
    which: str,
    values: Array,
    steps: float = PER_OSCILLATION,
    depths: int = DEPTHS,
) -> Array:
    """Maximum forces over the mean one at frequencies in their order."""
    contact = gridded(laws, which, motion, depths)
    return gridded_motions(motion.oscillator, contact, values.tolist(), steps).force / motion.mean_force
