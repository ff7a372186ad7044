"""Flanks that differ over profile and face together: a table over both, measured or prescribed."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import product

import numpy as np
from numpy.typing import ArrayLike

from base import Array, Fault, Faults, Integers, Limit
from gears.tooth.flank_curves import FORMS, MATERIAL, check_finite, numbers

__all__ = ["Topography"]

POINTS = Limit(2, 1000, remedy="thin out the table", whole=True)
"""How many curvature radii, and how many places along the face, a table may have."""

DIRECTIONS = {"rho": "radii", "z": "places"}
"""Directions of a table, and what its places are called."""


@dataclass(frozen=True, repr=False)
class Topography:
    r"""Deviation of a gear's flanks over profile and face, the same on every tooth: a table in points.

    ``linear`` is bilinear between its points. ``smooth`` is bicubic (Hermite), with the slopes of parabolas through
    three neighbouring points: it has one continuous derivative, gives tables of quadratic surfaces back exactly, and
    is of third order in the distances. Unlike the curves of `LeadTrace` it may overshoot beside a step.
    Outside its points the surface keeps the value of the nearest edge.

    Parameters
    ----------
    rho : (n,) sequence
        Curvature radii of the flank, growing, 2 to 1000 of them [m]; of a diameter d it is
        :math:`\rho = \sqrt{d^2/4 - r_b^2}`.
    z : (k,) sequence
        Places along the face, growing, 0 at the middle of the gear's own face, 2 to 1000 of them [m].
    material : (n, k) sequence
        Material in excess of the involute, normal to the flank in the transverse plane, -1 to 1 mm [m]: negative where
        some is missing.
    form : {"smooth", "linear"}
        What is between the points.

    Examples
    --------
    >>> corner = Topography([8e-3, 18e-3], [-0.02, 0.02], [[0.0, 0.0], [0.0, -10e-6]], form="linear")
    >>> float(corner.at(18e-3, 0.0))
    -5e-06
    >>> corner
    Topography(2 x 2 points, rho 8 to 18 mm, z -20 to 20 mm)
    """

    rho: tuple[float, ...]  # m
    z: tuple[float, ...]  # m
    material: tuple[tuple[float, ...], ...]  # m
    form: str = "smooth"

    def __post_init__(self) -> None:
        """Keep the points as plain numbers, so that equal tables compare equal."""
        for name in DIRECTIONS:
            object.__setattr__(self, name, numbers(getattr(self, name)))
        rows: Sequence[ArrayLike] = self.material
        object.__setattr__(self, "material", tuple(numbers(row) for row in rows))

    def __repr__(self) -> str:
        """One line: how many points, and where."""
        if not self.rho or not self.z:
            return "Topography(no points)"
        ends = (
            f"{name} {1e3 * places[0]:.6g} to {1e3 * places[-1]:.6g} mm"
            for name, places in (("rho", self.rho), ("z", self.z))
        )
        return f"Topography({len(self.rho)} x {len(self.z)} points, {', '.join(ends)})"

    def at(self, rho: float | Array, z: float | Array) -> Array:
        """Material in excess at curvature radii and places along the face [m]; arrays broadcast [m]."""
        over, along = (
            _weights(np.array(places), np.asarray(at, dtype=float), self.form)
            for places, at in ((self.rho, rho), (self.z, z))
        )
        material: Array = np.array(0.0)
        for (row, of_row), (column, of_column) in product(over, along):
            weights = [first * second for first in of_row for second in of_column]
            for weight, table in zip(weights, self._tables, strict=True):
                material = material + weight * table[row, column]
        return np.asarray(material)

    @cached_property
    def _tables(self) -> tuple[Array, ...]:
        """Values; of a smooth surface also their slopes by z, by rho, and by both."""
        values = np.array(self.material)
        if self.form == "linear":
            return (values,)
        by_rho = _slopes(values, np.array(self.rho), 0)
        by_z, by_both = (_slopes(each, np.array(self.z), 1) for each in (values, by_rho))
        return values, by_z, by_rho, by_both

    def faults(self, path: str = "topography") -> tuple[Fault, ...]:
        """All faults of the table, empty when there are none."""
        collector = Faults()
        for name, called in DIRECTIONS.items():
            places = getattr(self, name)
            check_finite(collector, f"{path}.{name}", places)
            collector.number(f"{path}.{name}", len(places), POINTS)
            if all(map(math.isfinite, places)) and not np.all(np.diff(places) > 0.0):
                remedy = "sort the table and leave out doubles"
                collector.add(f"{path}.{name}", "not growing", f"must be growing {called}", remedy)
        heights = tuple(height for row in self.material for height in row)
        check_finite(collector, f"{path}.material", heights)
        if {len(row) for row in self.material} != {len(self.z)} or len(self.material) != len(self.rho):
            allowed = (
                f"must have a row for each of {len(self.rho)} rho and a column for each of {len(self.z)} z"
            )
            value = f"{len(self.material)} rows, {len(heights)} values"
            collector.add(f"{path}.material", value, allowed, "give the table as rows over the profile")
        if finite := [height for height in heights if math.isfinite(height)]:
            collector.number(f"{path}.material", max(finite, key=abs), MATERIAL)
        collector.choice(f"{path}.form", self.form, FORMS)
        return tuple(collector.found)

    def apart(self, path: str, span: tuple[float, float], face_width: float) -> tuple[Fault, ...]:
        """Faults of a table that meets nothing of a gear's active profile or of its face.

        Parameters
        ----------
        path : str
        span : (float, float)
            Curvature radii at the ends of the active profile [m].
        face_width : float
            Of the gear [m].
        """
        collector, half = Faults(), 0.5 * face_width
        ends = {"rho": (span, "the active profile"), "z": ((-half, half), "the face")}
        for name, ((low, high), called) in ends.items():
            places = getattr(self, name)
            if places[-1] <= low or places[0] >= high:
                value = f"{places[0]:.6g} to {places[-1]:.6g} m"
                allowed = f"must meet {called}, {low:.6g} to {high:.6g} m"
                collector.add(
                    f"{path}.{name}", value, allowed, "check the unit and where places are counted from"
                )
        return tuple(collector.found)


def _slopes(values: Array, places: Array, axis: int) -> Array:
    """Slopes at points along an axis: of parabolas through three of them, or of the line through two."""
    if len(places) > 2:
        return np.asarray(np.gradient(values, places, axis=axis, edge_order=2))
    return np.asarray(np.gradient(values, places, axis=axis, edge_order=1))


def _weights(places: Array, at: Array, form: str) -> tuple[tuple[Integers, tuple[Array, ...]], ...]:
    """Both neighbours of places, each with the weight of its value and, of cubics, of its slope."""
    inside = np.clip(at, places[0], places[-1])
    cell = np.clip(np.searchsorted(places, inside, side="right") - 1, 0, len(places) - 2)
    width = places[cell + 1] - places[cell]
    t = (inside - places[cell]) / width
    if form == "linear":
        return (cell, (1.0 - t,)), (cell + 1, (t,))
    return (
        (cell, ((1.0 + 2.0 * t) * (1.0 - t) ** 2, width * t * (1.0 - t) ** 2)),
        (cell + 1, (t**2 * (3.0 - 2.0 * t), -width * t**2 * (1.0 - t))),
    )
