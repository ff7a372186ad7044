"""Curves over a flank, in points: measured profiles and leads, and the depth of wear."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import ClassVar, Self, TypeVar

import numpy as np
from numpy.typing import ArrayLike

from base import Array, Fault, Faults, Limit

__all__ = ["LeadTrace", "ProfileDeviation", "WearDepth", "mean_curve", "numbers"]

FORMS = ("smooth", "linear")

MATERIAL = Limit(-1e-3, 1e-3, "m", "give the material in excess in metres")
"""What a lead may deviate by."""


def numbers(values: ArrayLike) -> tuple[float, ...]:
    """Values as plain numbers, so that equal ones compare equal."""
    return tuple(float(value) for value in np.atleast_1d(np.asarray(values, dtype=float)).ravel())


def check_finite(faults: Faults, path: str, values: tuple[float, ...]) -> None:
    """Note values that are not finite."""
    if not all(math.isfinite(value) for value in values):
        faults.add(path, "not finite", "must be finite numbers (m)", "leave out points without a value")


class PointCurve:
    """What curves through points have in common; a kind of curve names its places and its values.

    ``smooth``: the monotone piecewise cubic of Fritsch and Carlson (SIAM J. Numer. Anal. 17, 1980,
    doi:10.1137/0717021), with one continuous derivative and without overshoot. ``linear``: straight lines from
    point to point. Outside its points a curve keeps the value of the nearest end.
    """

    placed_in: ClassVar[str]
    """Field of the places."""

    called: ClassVar[str]
    """What the places are."""

    kept_in: ClassVar[str]
    """Field of the values."""

    form: str
    """What is between the points."""

    def __post_init__(self) -> None:
        """Keep the points as plain numbers, so that equal curves compare equal."""
        for name in (self.placed_in, self.kept_in):
            object.__setattr__(self, name, numbers(getattr(self, name)))

    @property
    def places(self) -> tuple[float, ...]:
        """Where the points are [m]."""
        positions: tuple[float, ...] = getattr(self, self.placed_in)
        return positions

    @property
    def values(self) -> tuple[float, ...]:
        """Values at the points [m]."""
        amounts: tuple[float, ...] = getattr(self, self.kept_in)
        return amounts

    def __repr__(self) -> str:
        """One line: how many points, and where."""
        if not self.places:
            return f"{type(self).__name__}(no points)"
        ends = f"{self.placed_in} {1e3 * self.places[0]:.6g} to {1e3 * self.places[-1]:.6g} mm"
        return f"{type(self).__name__}({len(self.places)} points, {ends})"

    def at(self, place: float | Array) -> Array:
        """Value at places [m], an array like them [m]."""
        if self.form == "linear":
            x, y = np.array(self.places), np.array(self.values)
            return np.asarray(np.interp(np.asarray(place, dtype=float), x, y))
        x, y, width, slope = _cubic(self.places, self.values)
        inside = np.clip(np.asarray(place, dtype=float), x[0], x[-1])
        cell = np.clip(np.searchsorted(x, inside, side="right") - 1, 0, len(x) - 2)
        t = (inside - x[cell]) / width[cell]
        ends = y[cell] * (1 + 2 * t) * (1 - t) ** 2 + y[cell + 1] * t**2 * (3 - 2 * t)
        bend = slope[cell] * t * (1 - t) ** 2 - slope[cell + 1] * t**2 * (1 - t)
        return np.asarray(ends + width[cell] * bend)

    def faults(self, path: str = "profile") -> tuple[Fault, ...]:
        """All faults of the points, empty when there are none."""
        collector = Faults()
        at = f"{path}.{self.placed_in}"
        check_finite(collector, at, self.places)
        check_finite(collector, f"{path}.{self.kept_in}", self.values)
        collector.choice(f"{path}.form", self.form, FORMS)
        if len(self.places) != len(self.values) or len(self.places) < 2:
            points = f"{len(self.places)} and {len(self.values)} points"
            collector.add(path, points, f"must be as many {self.called} as values, at least 2", "give pairs")
        if not collector.found and not np.all(np.diff(self.places) > 0):
            collector.add(
                at, "not growing", f"must be growing {self.called}", "sort the points and leave out doubles"
            )
        return tuple(collector.found)


@lru_cache(maxsize=64)
def _cubic(places: tuple[float, ...], values: tuple[float, ...]) -> tuple[Array, Array, Array, Array]:
    """Points of a smooth curve, their distances and its slopes at them: asked for at every step of a mesh cycle."""
    x, y = np.array(places), np.array(values)
    width, rise = np.diff(x), np.diff(y) / np.diff(x)
    slope = np.concatenate([rise[:1], np.zeros(len(x) - 2), rise[-1:]])
    same = np.flatnonzero(rise[:-1] * rise[1:] > 0)
    left = 2 * width[same + 1] + width[same]
    right = width[same + 1] + 2 * width[same]
    slope[same + 1] = (left + right) / (left / rise[same] + right / rise[same + 1])
    return x, y, width, slope


@dataclass(frozen=True, repr=False)
class FlankCurve(PointCurve):
    """A curve over the curvature radius of a flank, from root to tip."""

    placed_in = "rho"
    called = "radii"

    rho: tuple[float, ...]  # m


@dataclass(frozen=True, repr=False)
class ProfileDeviation(FlankCurve):
    """Deviation of a flank from the involute, a curve over the flank.

    Between its points the curve is smooth, without overshoot (Fritsch and Carlson, SIAM J. Numer. Anal. 17, 1980,
    doi:10.1137/0717021), or straight; outside them it keeps the value of the nearest end.

    Parameters
    ----------
    rho : (n,) sequence
        Curvature radii of the flank, growing [m].
    material : (n,) sequence
        Material in excess of the involute, normal to the flank [m]: negative where some is missing.
    form : {"smooth", "linear"}
        Monotone cubic with one continuous derivative, or straight lines from point to point.
    """

    kept_in = "material"

    material: tuple[float, ...] = ()  # m
    form: str = "smooth"

    @classmethod
    def over_roll_angle(
        cls, base_radius: float, roll_angle: ArrayLike, material: ArrayLike, form: str = "smooth"
    ) -> Self:
        """Curve given over the roll angle xi [rad], rho = r_b xi."""
        return cls(numbers(base_radius * np.asarray(roll_angle, dtype=float)), numbers(material), form)


@dataclass(frozen=True, repr=False)
class WearDepth(FlankCurve):
    """Depth to which a flank is worn, a curve over the flank: material removed, on top of relief and deviations.

    Parameters
    ----------
    rho : (n,) sequence
        Curvature radii of the flank, growing [m].
    depth : (n,) sequence
        Material removed normal to the flank, at least 0 [m]. Outside the points the depth of the nearest end.
    form : {"smooth", "linear"}
        As of `ProfileDeviation`.

    Examples
    --------
    >>> worn = WearDepth([8e-3, 11e-3, 17e-3], [20e-6, 0.0, 10e-6], form="linear")
    >>> float(worn.at(9.5e-3))
    1e-05
    """

    kept_in = "depth"

    depth: tuple[float, ...] = ()  # m
    form: str = "smooth"

    def faults(self, path: str = "wear") -> tuple[Fault, ...]:
        """All faults of the points, empty when there are none."""
        curve_faults = super().faults(path)
        if not (least := [depth for depth in self.depth if depth < 0.0]):
            return curve_faults
        remedy = "wear removes material; give what is in excess as a profile deviation"
        return (*curve_faults, Fault(f"{path}.depth", f"{min(least):g} m", "must be at least 0 m", remedy))


@dataclass(frozen=True, repr=False)
class LeadTrace(PointCurve):
    """Measured lead of a gear's flanks: a curve along the face, the same on every tooth.

    Parameters
    ----------
    z : (n,) sequence
        Places along the face, growing, 0 at the middle of the gear's own face [m]. Towards the positive end a
        positive `Lead.slope` removes material.
    material : (n,) sequence
        Material in excess of the straight lead, normal to the flank [m]: negative where some is missing.
    form : {"smooth", "linear"}
        As of `ProfileDeviation`.

    Examples
    --------
    >>> trace = LeadTrace([-0.02, 0.0, 0.02], [-6e-6, 0.0, -10e-6], form="linear")
    >>> float(trace.at(0.01))
    -5e-06
    """

    placed_in = "z"
    called = "places"
    kept_in = "material"

    z: tuple[float, ...]  # m
    material: tuple[float, ...] = ()  # m
    form: str = "smooth"

    def faults(self, path: str = "trace") -> tuple[Fault, ...]:
        """All faults of the points, empty when there are none."""
        collector = Faults()
        collector.extend(super().faults(path))
        if not collector.found:
            collector.number(f"{path}.material", max(self.material, key=abs), MATERIAL)
        return tuple(collector.found)


C = TypeVar("C", ProfileDeviation, WearDepth)


def mean_curve(curves: Sequence[C]) -> C:
    """Mean of curves at the points of the one that has most, the first of several.

    The mean of equal curves is that curve, to the last digit.
    """
    model = max(curves, key=lambda curve: len(curve.rho))
    points = np.array(model.rho)
    start = model.at(points)
    apart = np.mean([curve.at(points) - start for curve in curves], axis=0)
    form = model.form if all(curve.form == model.form for curve in curves) else "smooth"
    return type(model)(model.rho, numbers(start + apart), form)
