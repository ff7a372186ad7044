"""Where a tip meets the other gear's flank outside the path of contact: gaps, points, levers, exact.

Before A the wheel's tip meets the pinion's flank, after E the pinion's tip the wheel's flank. Everything is
written for one of the two, gear 2 with the tip and gear 1 with the flank; the other follows by exchange of the
gears. A gap is the rotation of gear 1 until its involute meets the point, times r_b1; that is the distance
along the normal of flank 1.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, pi, sin, sqrt, tan
from typing import TYPE_CHECKING

import numpy as np

from base import Array

if TYPE_CHECKING:
    from gears import GearPair, ToothProfile

__all__ = [
    "TipRound",
    "chamfer_gap",
    "chamfer_length",
    "corner_angle",
    "gap_at",
    "lever_ratio",
    "opening",
    "opening_at",
    "tip_round",
    "unloaded_gap",
]


def unloaded_gap(
    base_radii: tuple[float, float],
    line: float,
    rho1: Array,
    rho2: Array,
    along: Array | float = 0.0,
    out: Array | float = 0.0,
) -> tuple[Array, Array]:
    """Gap between the flank of gear 1 and points of gear 2, and where it would close.

    The gears stand so that their (unlimited) involutes touch at ``rho1`` of the line of action.

    Parameters
    ----------
    base_radii : (float, float)
        r_b1, r_b2 [m]
    line : float
        rho1 + rho2 on the line of action [m].
    rho1 : (n,) array
        Positions [m].
    rho2 : (k,) array
        Curvature radii of the points on flank 2 [m].
    along, out : (k,) arrays or float
        Shift of the points from flank 2, along its tangent towards the tip and along its outward normal [m].

    Returns
    -------
    gap : (n, k) array
        Rotation of gear 1 until its flank meets the point, times r_b1 [m].
    touched_rho : (n, k) array
        Curvature radius of flank 1 there [m].
    """
    return gap_at(base_radii, line, rho1[:, None], rho2, along, out)


def gap_at(
    base_radii: tuple[float, float],
    line: float,
    rho1: Array,
    rho2: Array,
    along: Array | float = 0.0,
    out: Array | float = 0.0,
) -> tuple[Array, Array]:
    """As ``unloaded_gap`` for separate points at every position: arrays of one shape."""
    r1, r2 = base_radii
    # line of action along x, gear 1's tangent point at the origin, axes at (0, -r1) and (line, r2); all is written as
    # differences from where the involutes touch, so that small gaps keep their digits
    turn = (rho2 - (line - rho1)) / r2
    s, less = np.sin(turn), 2 * np.sin(0.5 * turn) ** 2
    c = 1.0 - less
    x = (line - rho1) * less + r2 * ((s - turn) + turn * less) + along * s - out * c
    y = r2 * less - rho2 * s - along * c - out * s
    farther = x * (2 * rho1 + x) + y * (2 * r1 + y)
    touched_rho = np.sqrt(np.maximum(rho1**2 + farther, 0.0))
    rolled = np.maximum(farther, -(rho1**2)) / (touched_rho + rho1)
    turned = np.arctan2(rho1 * y - r1 * x, rho1 * (rho1 + x) + r1 * (r1 + y))
    return rolled - r1 * (np.arctan2(r1 * rolled, r1**2 + touched_rho * rho1) + turned), touched_rho


def opening(
    base_radii: tuple[float, float], line: float, rho1: Array, touched_rho: Array, rho2: Array
) -> Array:
    """Angle between the normals of flank 1 at ``touched_rho`` and of flank 2 at ``rho2`` (n, k) [rad].

    Zero on the line of action. Outside the path it is positive at the tip of gear 2: the flanks open away from
    the corner, and a force that stands on flank 1 leans from the normal of flank 2 away from the tip.

    Parameters
    ----------
    base_radii : (float, float)
        r_b1, r_b2 [m]
    line : float
        rho1 + rho2 on the line of action [m].
    rho1 : (n,) array
        Positions [m].
    touched_rho : (n, k) array
        Curvature radii of flank 1 [m].
    rho2 : (k,) array
        Curvature radii of flank 2 [m].
    """
    return opening_at(base_radii, line, rho1[:, None], touched_rho, rho2)


def opening_at(
    base_radii: tuple[float, float], line: float, rho1: Array, touched_rho: Array, rho2: Array
) -> Array:
    """As ``opening`` for separate points at every position: arrays of one shape."""
    r1, r2 = base_radii
    turned: Array = (touched_rho - rho1) / r1 - (rho2 - (line - rho1)) / r2
    return turned


def lever_ratio(pair: GearPair, touched_rho: Array, rho1: Array, corner: int = 0) -> Array:
    """Lever of a flank's normal about the axis of the other gear, over that gear's base radius.

    Parameters
    ----------
    pair : gears.GearPair
    touched_rho : (n,) array
        Curvature radii of the touched flank [m].
    rho1 : (n,) array
        Positions: where the unlimited involutes touch on the line of action [m].
    corner : {0, 1}
        The other gear, whose tip touches: 0 the pinion, 1 the wheel.
    """
    own, touched = pair.base_radii[corner], pair.base_radii[1 - corner]
    line = pair.line_of_action
    turn = (touched_rho - (rho1 if corner == 1 else line - rho1)) / touched
    return np.asarray(((own + touched) * np.cos(turn) - line * np.sin(turn) - touched) / own)


def tangent_arm(base_radius: Array | float, rho: Array, lever: Array) -> Array:
    """Distance from the foot of a gear's axis on the normal to the contact [m]; rho where the normal is the involute's.

    By it and the speed of turning the surface moves along the tangent, and friction turns the gear.

    Parameters
    ----------
    base_radius : float or array
        [m]
    rho : array
        Curvature radius where the gear is touched [m], by which it is the base radius away from the axis.
    lever : array
        Of the normal about the axis, over the base radius.
    """
    return np.asarray(np.sqrt(np.maximum(base_radius**2 * (1.0 - lever**2) + rho**2, 0.0)))


def corner_angle(profile: ToothProfile) -> float:
    """Interior angle between the flank's end and what follows it, chamfer or top land [rad]."""
    end = profile.flank_rho[1]
    point, normal = profile.involute(end), profile.normal(end)
    if profile.flank_end_radius < profile.tip_radius:
        start, stop = profile.chamfer(np.array([0.0, 1.0]))
        beyond = stop - start
    else:
        beyond = np.array([-point[1], point[0]])  # the top land's circle, towards the centre line
    tangent = np.array([-normal[1], normal[0]])  # towards the tip
    turn = np.arctan2(-beyond @ normal, beyond @ tangent)
    return float(pi - turn)


@dataclass(frozen=True)
class TipRound:
    """A tip edge rounded by an arc that is tangent to the flank and to what follows it.

    Attributes
    ----------
    radius : float
        Of the arc [m]; 0 is the sharp corner.
    start : float
        Distance of its start from the corner of interior angle 2 beta that it rounds, r/tan(beta) [m].
    rho : float
        Curvature radius at which the involute ends [m].
    """

    radius: float
    start: float
    rho: float

    def offset(self, distance: Array) -> tuple[Array, Array]:
        """Shift of the arc's points from its start: along the flank's tangent and normal [m].

        Parameters
        ----------
        distance : array
            From the sharp corner, measured along the flank's tangent, less than ``start`` [m].
        """
        along = self.start - distance
        return along, np.sqrt(self.radius**2 - along**2) - self.radius


def tip_round(profile: ToothProfile, radius: float) -> TipRound:
    """Rounding of a tooth's tip edge; radius 0 leaves the corner as it is."""
    end = profile.flank_rho[1]
    if radius == 0.0:
        return TipRound(0.0, 0.0, end)
    start = radius / tan(0.5 * corner_angle(profile))
    return TipRound(radius, start, sqrt(max(end**2 - 2 * profile.base_radius * start, 0.0)))


def chamfer_length(profile: ToothProfile) -> float:
    """Length of the chamfer's straight line [m]; 0 without one."""
    return float(np.linalg.norm(np.diff(profile.chamfer(np.array([0.0, 1.0])), axis=0)))


def chamfer_gap(pair: GearPair, corner: int, place: Array, start: float = 0.0) -> Array:
    """Minimum gap of a chamfer behind the corner, along the chamfer and at its end (n,) [m]; inf without one.

    Parameters
    ----------
    pair : gears.GearPair
    corner : {0, 1}
        The gear with the chamfer.
    place : (n,) array
        Positions by the touched flank's curvature radius on the line of action [m].
    start : float
        Length of the chamfer that a rounding has taken [m].
    """
    profile = pair.teeth_profiles[corner]
    if profile.flank_end_radius >= profile.tip_radius:
        return np.full(len(place), np.inf)
    radii = pair.base_radii if corner == 1 else pair.base_radii[::-1]
    turn = pi - corner_angle(profile)
    along = start + (chamfer_length(profile) - start) * np.linspace(0.1, 1.0, 10)
    end = np.full(len(along), profile.flank_rho[1])
    gap, _ = unloaded_gap(radii, pair.line_of_action, place, end, along * cos(turn), -along * sin(turn))
    return np.asarray(gap.min(axis=1))
