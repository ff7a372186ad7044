"""Arguments of a drive train: matrices, vectors, and forces that a free rotation would follow without end."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from base import Array, Faults, InputError
from dynamics.model.drive_coordinates import Coordinates

UNBALANCED = 1e-9  # of the root of F' M^-1 F, along a free rotation
MATRICES = ("mass", "damping", "stiffness")


def refuse_unbalanced(at: Coordinates, name: str, force: Array) -> None:
    """Refuse a force, by name, that turns what nothing holds."""
    free = float(np.linalg.norm(at.drift @ force))
    held = at.push @ force
    if free > UNBALANCED * math.hypot(free, *(held / math.sqrt(at.gain)).tolist()):
        allowed = "must balance over a rotation that nothing holds"
        remedy = (
            "moments of motor and load are in the ratio of their speeds; or hold the train by a stiffness"
        )
        raise InputError.at(name, force.tolist(), allowed, remedy)


def checked_array(faults: Faults, name: str, entries: npt.ArrayLike, shape: tuple[int, ...] | None) -> Array:
    """Finite numbers of a shape, of one dimension if there is none, that nobody can change; faults are noted."""
    try:
        values = np.array(entries, dtype=np.float64)
    except (TypeError, ValueError):
        values = np.full((), np.nan)
    fits = values.ndim == 1 and len(values) > 0 if shape is None else values.shape == shape
    if not fits or not np.all(np.isfinite(values)):
        wanted = "(n,)" if shape is None else str(shape)
        remedy = (
            "one row and one column for each freedom" if name in MATRICES else "one number for each freedom"
        )
        faults.add(name, entries, f"must be finite numbers of shape {wanted}", remedy)
        values = np.zeros(shape or (1,))
    values.flags.writeable = False
    return values


def symmetric(faults: Faults, mass: Array) -> Array:
    """The mass without the rounding of its two halves; a fault is noted where they differ by more."""
    if np.max(np.abs(mass - mass.T)) > 1e-12 * np.max(np.abs(mass)):
        faults.add("mass", mass.tolist(), "must be symmetric", "take the mean with its transpose")
    halves = np.asarray(0.5 * (mass + mass.T))
    halves.flags.writeable = False
    return halves
