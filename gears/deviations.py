"""Deviations of real flanks from the involute: profile curves and pitches, as gaps along the line of action."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from base import Array, Fault, Faults


def _numbers(values: ArrayLike) -> tuple[float, ...]:
    return tuple(float(value) for value in np.atleast_1d(np.asarray(values, dtype=float)).ravel())


def _check_finite(found: Faults, where: str, values: tuple[float, ...]) -> None:
    if not all(math.isfinite(value) for value in values):
        found.add(where, "not finite", "must be finite numbers (m)", "leave out points without a value")


@dataclass(frozen=True)
class ProfileDeviation:
    """Deviation of all flanks of a gear from the involute, a curve over the flank.

    Between its points the curve is the monotone piecewise cubic of Fritsch and Carlson (SIAM J. Numer.
    Anal. 17, 1980, doi:10.1137/0717021), with one continuous derivative and without overshoot; outside them
    it keeps the value of the nearest end.

    Parameters
    ----------
    rho : (n,) sequence
        Curvature radii of the flank, growing [m].
    material : (n,) sequence
        Material in excess of the involute, normal to the flank [m]: negative where some is missing.
    """

    rho: tuple[float, ...]  # m
    material: tuple[float, ...]  # m

    def __post_init__(self) -> None:
        """Keep the points as plain numbers, so that equal curves compare equal."""
        object.__setattr__(self, "rho", _numbers(self.rho))
        object.__setattr__(self, "material", _numbers(self.material))

    @classmethod
    def over_roll_angle(
        cls, base_radius: float, roll_angle: ArrayLike, material: ArrayLike
    ) -> ProfileDeviation:
        """Curve given over the roll angle xi [rad], rho = r_b xi."""
        return cls(_numbers(base_radius * np.asarray(roll_angle, dtype=float)), _numbers(material))

    def __repr__(self) -> str:
        """One line: how many points, and where."""
        if not self.rho:
            return "ProfileDeviation(no points)"
        ends = f"rho {1e3 * self.rho[0]:.6g} to {1e3 * self.rho[-1]:.6g} mm"
        return f"ProfileDeviation({len(self.rho)} points, {ends})"

    def faults(self, where: str = "profile") -> tuple[Fault, ...]:
        """All faults of the points, empty when there are none."""
        found = Faults()
        _check_finite(found, f"{where}.rho", self.rho)
        _check_finite(found, f"{where}.material", self.material)
        if len(self.rho) != len(self.material) or len(self.rho) < 2:
            points = f"{len(self.rho)} and {len(self.material)} points"
            found.add(where, points, "must be as many radii as values, at least 2", "give pairs")
        if not found.found and not np.all(np.diff(self.rho) > 0):
            remedy = "sort the points and leave out doubles"
            found.add(f"{where}.rho", "not growing", "must be growing curvature radii", remedy)
        return tuple(found.found)

    def at(self, rho: float | Array) -> Array:
        """Excess of material at curvature radii `rho` [m], an array like it [m]."""
        x, y = np.array(self.rho), np.array(self.material)
        width, rise = np.diff(x), np.diff(y) / np.diff(x)
        slope = np.concatenate([rise[:1], np.zeros(len(x) - 2), rise[-1:]])
        same = np.flatnonzero(rise[:-1] * rise[1:] > 0)
        left = 2 * width[same + 1] + width[same]
        right = width[same + 1] + 2 * width[same]
        slope[same + 1] = (left + right) / (left / rise[same] + right / rise[same + 1])
        place = np.clip(np.asarray(rho, dtype=float), x[0], x[-1])
        cell = np.clip(np.searchsorted(x, place, side="right") - 1, 0, len(x) - 2)
        t = (place - x[cell]) / width[cell]
        ends = y[cell] * (1 + 2 * t) * (1 - t) ** 2 + y[cell + 1] * t**2 * (3 - 2 * t)
        bend = slope[cell] * t * (1 - t) ** 2 - slope[cell + 1] * t**2 * (1 - t)
        return np.asarray(ends + width[cell] * bend)


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
        object.__setattr__(self, "cumulative", _numbers(self.cumulative))

    @classmethod
    def from_single(cls, single: ArrayLike) -> PitchDeviations:
        """From single pitch deviations f_p (z,) [m], value i of the pitch from tooth i - 1 to tooth i.

        Around the gear they must add up to nothing; their mean, an error of measurement, is taken off, so
        that equal deviations of all pitches cancel. Tooth 0 gets the cumulative deviation 0.
        """
        pitches = np.asarray(single, dtype=float).ravel()
        summed = np.cumsum(pitches - pitches.mean()) if pitches.size else pitches
        return cls(_numbers(summed - summed[0]) if pitches.size else ())

    def __repr__(self) -> str:
        """One line: how many teeth, and how far their flanks lie apart."""
        spread = max(self.cumulative, default=0.0) - min(self.cumulative, default=0.0)
        return f"PitchDeviations({len(self.cumulative)} teeth, total {1e6 * spread:.4g} um)"

    @property
    def single(self) -> Array:
        """Single pitch deviations (z,) [m], value i of the pitch from tooth i - 1 to tooth i."""
        values = np.array(self.cumulative)
        return np.asarray(values - np.roll(values, 1))

    def faults(self, where: str, teeth: int) -> tuple[Fault, ...]:
        """All faults of the values for a gear of so many teeth, empty when there are none."""
        found = Faults()
        _check_finite(found, where, self.cumulative)
        if len(self.cumulative) != teeth:
            count = f"{len(self.cumulative)} values"
            found.add(where, count, f"must be {teeth}, one for each tooth", "give every tooth's")
        return tuple(found.found)


@dataclass(frozen=True)
class GearDeviations:
    """Deviations of one gear.

    Parameters
    ----------
    profile : ProfileDeviation or None
        Of all flanks alike.
    pitch : PitchDeviations or None
        Of each tooth.
    """

    profile: ProfileDeviation | None = None
    pitch: PitchDeviations | None = None

    def faults(self, where: str, teeth: int) -> tuple[Fault, ...]:
        """All faults for a gear of so many teeth, empty when there are none."""
        profile = () if self.profile is None else self.profile.faults(f"{where}.profile")
        pitch = () if self.pitch is None else self.pitch.faults(f"{where}.pitch", teeth)
        return (*profile, *pitch)

    def excess(self, rho: Array) -> Array:
        """Excess of material at curvature radii [m], an array like `rho` [m]."""
        return np.zeros_like(rho) if self.profile is None else self.profile.at(rho)

    def late(self, tooth: Array) -> Array:
        """Cumulative pitch deviations of teeth, numbers of any size, an array like `tooth` [m]."""
        if self.pitch is None:
            return np.zeros(np.shape(tooth))
        values = np.array(self.pitch.cumulative)
        return np.asarray(values[np.asarray(tooth) % len(values)])
