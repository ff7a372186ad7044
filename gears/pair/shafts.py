"""Shafts of gears: steps, bearings as springs, where gear and torque sit."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from base import Array, Faults, Limit
from gears.tooth.material import LIMITS, STEEL, Material

SEGMENT = {
    "length": Limit.above(0.0, 100.0, "m", "give the length of the step"),
    "diameter": Limit.above(0.0, 10.0, "m", "give the outer diameter"),
    "bore": Limit(0.0, 10.0, "m", "0 for a solid shaft"),
}
BEARING = {
    "position": Limit(0.0, 1e4, "m", "count from the left end of the shaft"),
    "stiffness": Limit.above(0.0, 1e13, "N/m", "give the radial stiffness, 1e8 to 1e9 for rolling bearings"),
    "damping": Limit(0.0, 1e9, "N s/m", "give the radial damping, or leave it out"),
    "axial_stiffness": Limit(0.0, 1e13, "N/m", "0 for a bearing that is free to slide"),
}

SAME = 1e-9
"""Distance of two places over the shaft's length below which they are one: sums of steps are rounded."""


@dataclass(frozen=True)
class ShaftSegment:
    """Step of a shaft.

    Parameters
    ----------
    length, diameter : float
        [m].
    bore : float
        Diameter of the bore [m].
    """

    length: float  # m
    diameter: float  # m
    bore: float = 0.0  # m

    @property
    def area(self) -> float:
        """Of the cross-section [m2]."""
        return math.pi / 4.0 * (self.diameter**2 - self.bore**2)

    @property
    def second_moment(self) -> float:
        """Second moment of area for bending, I [m4]; the polar one is 2 I."""
        return math.pi / 64.0 * (self.diameter**4 - self.bore**4)


@dataclass(frozen=True)
class Bearing:
    """Bearing: springs to ground across and along the shaft, and a damper across it.

    Parameters
    ----------
    position : float
        From the left end of the shaft [m].
    stiffness : float
        Radial [N/m].
    damping : float
        Radial [N s/m].
    axial_stiffness : float
        [N/m]; one bearing of a shaft holds it against the axial force of helical gears.
    """

    position: float  # m
    stiffness: float  # N/m
    damping: float = 0.0  # N s/m
    axial_stiffness: float = 0.0  # N/m


@dataclass(frozen=True)
class Shaft:
    """Shaft of steps on bearings, with a gear and a place where the torque comes in or leaves.

    Parameters
    ----------
    segments : tuple of ShaftSegment
        Steps from the left end on.
    bearings : tuple of Bearing
        At least two.
    gear_position : float
        Middle of the gear's face, from the left end [m]; beyond the bearings where the gear overhangs.
    torque_position : float
        Where motor or load is coupled, from the left end [m].
    material : Material
        Steel unless given.

    Raises
    ------
    InputError
        With every fault found.

    Examples
    --------
    >>> shaft = Shaft((ShaftSegment(0.2, 0.03),), (Bearing(0.02, 3e8), Bearing(0.18, 3e8)), 0.1, 0.0)
    >>> shaft.length
    0.2
    """

    segments: tuple[ShaftSegment, ...]
    bearings: tuple[Bearing, ...]
    gear_position: float  # m
    torque_position: float  # m
    material: Material = STEEL

    def __post_init__(self) -> None:
        """Check; every fault is listed."""
        object.__setattr__(self, "segments", tuple(self.segments))
        object.__setattr__(self, "bearings", tuple(self.bearings))
        with Faults() as faults:
            faults.fields(self.material, LIMITS, "material.")
            for i, segment in enumerate(self.segments):
                faults.fields(segment, SEGMENT, f"segments[{i}].")
                if not segment.bore < segment.diameter:
                    allowed = f"must be less than the diameter, {segment.diameter:.6g} m"
                    faults.add(f"segments[{i}].bore", segment.bore, allowed, "0 for a solid shaft")
            if not self.segments:
                faults.add("segments", "none", "must be at least one", "give the steps of the shaft")
            for i, bearing in enumerate(self.bearings):
                faults.fields(bearing, BEARING, f"bearings[{i}].")
            if len({bearing.position for bearing in self.bearings}) < 2:
                allowed = "must be at least two at different positions"
                faults.add(
                    "bearings", f"{len(self.bearings)} bearings", allowed, "one alone lets the shaft tilt"
                )
            if self.segments and all(SEGMENT["length"].holds(segment.length) for segment in self.segments):
                within = Limit(0.0, self.length, "m", "count from the left end of the shaft")
                for i, bearing in enumerate(self.bearings):
                    if BEARING["position"].holds(bearing.position):
                        faults.number(f"bearings[{i}].position", bearing.position, within)
                for name in ("gear_position", "torque_position"):
                    faults.number(name, getattr(self, name), within)

    @property
    def length(self) -> float:
        """Of all steps [m]."""
        return math.fsum(segment.length for segment in self.segments)

    @property
    def places(self) -> Array:
        """Ends of the steps, bearings, gear and torque, each once, from the left [m]."""
        ends = np.concatenate([[0.0], np.cumsum([segment.length for segment in self.segments])])
        ends[-1] = self.length
        marks = [self.gear_position, self.torque_position, *(bearing.position for bearing in self.bearings)]
        distinct = np.unique(np.concatenate([ends, marks]))
        return np.asarray(distinct[np.append(True, np.diff(distinct) > SAME * self.length)])

    def segment_at(self, position: float) -> ShaftSegment:
        """Step that holds a place inside it."""
        end = 0.0
        for segment in self.segments:
            end += segment.length
            if position < end:
                return segment
        return self.segments[-1]
