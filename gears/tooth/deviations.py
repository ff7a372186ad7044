"""Deviations of real flanks from the involute: profile curves, pitches and wear, as gaps along the line of action."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TypeVar

import numpy as np
from numpy.typing import ArrayLike

from base import Array, Fault, Faults, Integers
from gears.tooth.flank_curves import (
    FlankCurve,
    ProfileDeviation,
    WearDepth,
    check_finite,
    mean_curve,
    numbers,
)

__all__ = ["GearDeviations", "PitchDeviations"]


@dataclass(frozen=True)
class PitchDeviations:
    """Pitch deviations of the loaded flanks of a gear's teeth (ISO 1328-1).

    Teeth are numbered in the order in which they come into mesh. A value is positive where the flank stands
    farther from the flank of tooth 0 than it should, in the sense of the numbers: it comes into mesh later.
    Arcs are measured at the reference circle in the transverse plane; along the line of action they count
    cos alpha times.

    Parameters
    ----------
    cumulative : (z,) sequence
        Cumulative (index) pitch deviation of each tooth's flank [m]. The same constant on all teeth is a turn
        of the gear, and shifts the transmission error by that.

    Examples
    --------
    >>> PitchDeviations.from_single([2e-6, -1e-6, -1e-6]).cumulative
    (0.0, -1e-06, -2e-06)
    """

    cumulative: tuple[float, ...]  # m

    def __post_init__(self) -> None:
        """Keep plain numbers, so that equal deviations compare equal."""
        object.__setattr__(self, "cumulative", numbers(self.cumulative))

    @classmethod
    def from_single(cls, single: ArrayLike) -> PitchDeviations:
        """From single pitch deviations f_p (z,) [m], value i of the pitch from tooth i - 1 to tooth i.

        Around the gear they must add up to nothing; their mean, an error of measurement, is taken off, so
        that equal deviations of all pitches cancel. Tooth 0 gets the cumulative deviation 0.
        """
        pitches = np.asarray(single, dtype=float).ravel()
        summed = np.cumsum(pitches - pitches.mean()) if pitches.size else pitches
        return cls(numbers(summed - summed[0]) if pitches.size else ())

    def __repr__(self) -> str:
        """One line: how many teeth, and how far their flanks lie apart."""
        spread = max(self.cumulative, default=0.0) - min(self.cumulative, default=0.0)
        return f"PitchDeviations({len(self.cumulative)} teeth, total {1e6 * spread:.4g} um)"

    @property
    def single(self) -> Array:
        """Single pitch deviations (z,) [m], value i of the pitch from tooth i - 1 to tooth i."""
        values = np.array(self.cumulative)
        return np.asarray(values - np.roll(values, 1))

    def faults(self, path: str, teeth: int) -> tuple[Fault, ...]:
        """All faults of the values for a gear of so many teeth, empty when there are none."""
        collector = Faults()
        check_finite(collector, path, self.cumulative)
        if len(self.cumulative) != teeth:
            count = f"{len(self.cumulative)} values"
            collector.add(path, count, f"must be {teeth}, one for each tooth", "give every tooth's")
        return tuple(collector.found)


C = TypeVar("C", ProfileDeviation, WearDepth)


@dataclass(frozen=True)
class GearDeviations:
    """Deviations of one gear.

    Parameters
    ----------
    profile : ProfileDeviation, sequence of ProfileDeviation, or None
        Of all flanks alike, or a trace of each tooth's loaded flank, in the order in which teeth come into mesh.
    pitch : PitchDeviations or None
        Of each tooth.
    wear : WearDepth, sequence of WearDepth, or None
        Of all flanks alike, or of each tooth's.

    Notes
    -----
    Curves of each tooth are taken apart into the mean of the gear, at the points of the trace that has most, and
    what each tooth has beyond it. A mesh cycle of one base pitch knows the mean alone (`mean`). Where the flanks on the
    other side of the teeth bear too, they are taken to be as these.
    """

    profile: ProfileDeviation | Sequence[ProfileDeviation] | None = None
    pitch: PitchDeviations | None = None
    wear: WearDepth | Sequence[WearDepth] | None = None

    def __post_init__(self) -> None:
        """Keep traces as a tuple, so that equal deviations compare equal."""
        for name in ("profile", "wear"):
            curves = getattr(self, name)
            if isinstance(curves, Sequence):
                object.__setattr__(self, name, tuple(curves))

    def faults(self, path: str, teeth: int) -> tuple[Fault, ...]:
        """All faults for a gear of so many teeth, empty when there are none."""
        collector = Faults()
        for name in ("profile", "wear"):
            curves = getattr(self, name)
            if isinstance(curves, tuple) and len(curves) != teeth:
                count, remedy = f"{len(curves)} curves", "give every tooth's, or one for all"
                collector.add(f"{path}.{name}", count, f"must be {teeth}, one for each tooth", remedy)
            for number, curve in enumerate(_listed(curves)):
                at = f"[{number}]" if isinstance(curves, tuple) else ""
                collector.extend(curve.faults(f"{path}.{name}{at}"))
        collector.extend(() if self.pitch is None else self.pitch.faults(f"{path}.pitch", teeth))
        return tuple(collector.found)

    @property
    def curved(self) -> bool:
        """Whether there is any curve over the flanks."""
        return self.profile is not None or self.wear is not None

    @property
    def every_tooth_alike(self) -> bool:
        """Whether all teeth have the same flanks at equal pitches."""
        return self.pitch is None and not isinstance(self.profile, tuple) and not isinstance(self.wear, tuple)

    @cached_property
    def profiles_alike(self) -> bool:
        """Whether all teeth have the same flanks."""
        return all(len(set(_listed(curves))) <= 1 for curves in (self.profile, self.wear))

    @cached_property
    def mean(self) -> GearDeviations:
        """Curves that stand for all teeth, without pitch deviations."""
        return replace(self, profile=_mean(self.profile), pitch=None, wear=_mean(self.wear))

    def corners(self, most: int) -> Array:
        """Curvature radii of the points of profiles, and of those of wear, each where they are at most so many."""
        radii = []
        for curves in (self.profile, self.wear):
            points = np.unique([rho for curve in _listed(curves) for rho in curve.rho])
            radii.append(points if len(points) <= most else points[:0])
        return np.concatenate(radii)

    def kinks(self, most: int) -> Array:
        """Curvature radii of the points of profiles and wear that straight lines join, each where at most so many."""
        radii = [np.zeros(0)]
        for curves in (self.profile, self.wear):
            points = np.unique(
                [rho for curve in _listed(curves) if curve.form == "linear" for rho in curve.rho]
            )
            radii.append(points if len(points) <= most else points[:0])
        return np.concatenate(radii)

    def excess(self, rho: Array) -> Array:
        """Excess of material at curvature radii, the mean of all teeth, an array like `rho` [m]."""
        mean, material = self.mean, np.zeros_like(rho)
        if isinstance(mean.profile, ProfileDeviation):
            material = material + mean.profile.at(rho)
        if isinstance(mean.wear, WearDepth):
            material = material - mean.wear.at(rho)
        return np.asarray(material)

    def of_tooth(self, tooth: Integers, rho: Array) -> Array:
        """Excess of material of single teeth beyond the mean of all.

        Parameters
        ----------
        tooth : array of int
            Numbers of any size.
        rho : array
            Curvature radii [m]; of a shape that broadcasts with `tooth`.

        Returns
        -------
        array
            Of the shape of both together [m].
        """
        tooth, rho = np.broadcast_arrays(np.asarray(tooth), rho)
        material = np.zeros(tooth.shape)
        mean = self.mean
        for sign, each, common in ((1.0, self.profile, mean.profile), (-1.0, self.wear, mean.wear)):
            if not isinstance(each, tuple):
                continue
            assert isinstance(common, ProfileDeviation | WearDepth)
            material -= sign * common.at(rho)
            number = tooth % len(each)
            for k in np.unique(number).tolist():
                here = number == k
                material[here] += sign * each[k].at(rho[here])
        return material

    def late(self, tooth: Array) -> Array:
        """Cumulative pitch deviations of teeth, numbers of any size, an array like `tooth` [m]."""
        if self.pitch is None:
            return np.zeros(np.shape(tooth))
        values = np.array(self.pitch.cumulative)
        return np.asarray(values[np.asarray(tooth) % len(values)])


def _listed(curves: FlankCurve | Sequence[FlankCurve] | None) -> tuple[FlankCurve, ...]:
    """One curve or several as a tuple."""
    if curves is None:
        return ()
    return tuple(curves) if isinstance(curves, Sequence) else (curves,)


def _mean(curves: C | Sequence[C] | None) -> C | None:
    return mean_curve(curves) if isinstance(curves, Sequence) else curves
