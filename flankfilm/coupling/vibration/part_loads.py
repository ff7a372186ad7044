"""What bearings, shafts and couplings of a drive train carry, as figures of a record: names, and values by part."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np

from base import Array

PARTS = {"bearing": ("bearing_force", "N"), "shaft": ("shaft_torque", "N m")}
"""What carries, its figure, and the unit of that; shafts are shafts and couplings."""


class Carrying(Protocol):
    """Record of what the parts of a train carry; without names of any on rigid shafts."""

    @property
    def bearings(self) -> tuple[str, ...]:
        """Names, in the order of their forces."""

    @property
    def shafts(self) -> tuple[str, ...]:
        """Names of shafts and couplings, in the order of their torques."""


@dataclass(frozen=True, eq=False)
class DriveOutput:
    """What a part of the train carries: linear in the state.

    Attributes
    ----------
    name : str
        Such as "pinion bearing 1", "wheel shaft" or "wheel coupling".
    unit : str
        N or N m.
    displacement, speed : ndarray, shape (n,)
        Factors on the oscillator's displacements and speeds.
    """

    name: str
    unit: str
    displacement: Array
    speed: Array

    def of(self, states: Array) -> Array:
        """Values at states (k, 2 n) of the oscillator."""
        n = len(self.displacement)
        return np.asarray(states[:, :n] @ self.displacement + states[:, n:] @ self.speed)


def part_figures(
    outputs: Sequence[DriveOutput], values: Mapping[str, Array | Mapping[str, Array]]
) -> dict[str, Any]:
    """Names of bearings and of shafts and couplings, and what they carry, as fields of a record.

    Parameters
    ----------
    outputs : sequence of DriveOutput
    values : mapping
        Ending of a figure's name to its values, shape (..., outputs), perhaps by direction of the speed.

    Examples
    --------
    >>> from flankfilm.coupling import DriveOutput
    >>> none = np.zeros(1)
    >>> outputs = [DriveOutput("pinion shaft", "N m", none, none), DriveOutput("pinion bearing 1", "N", none, none)]
    >>> part_figures(outputs, {"_swing": np.array([[1.0, 2.0]])})["bearing_force_swing"]
    array([[2.]])
    """
    fields: dict[str, Any] = {}
    for part, (figure, unit) in PARTS.items():
        kept = [i for i, output in enumerate(outputs) if output.unit == unit]
        fields[f"{part}s"] = tuple(outputs[i].name for i in kept)
        for ending, loads in values.items():
            fields[f"{figure}{ending}"] = (
                {way: load[..., kept] for way, load in loads.items()}
                if isinstance(loads, Mapping)
                else loads[..., kept]
            )
    return fields


def greatest(values: Array | Mapping[str, Array]) -> float | None:
    """Largest of all values, perhaps of both directions, that are finite; None without any."""
    each = list(values.values()) if isinstance(values, Mapping) else [values]
    known = np.concatenate([figures[np.isfinite(figures)] for figures in each])
    return float(known.max()) if known.size else None


def output_rows(outputs: Sequence[DriveOutput], size: int) -> Array:
    """Factors of all outputs on a state of so many numbers, one row each."""
    rows = [np.concatenate([output.displacement, output.speed]) for output in outputs]
    return np.array(rows).reshape(-1, size)
