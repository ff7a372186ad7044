"""Outline of a tooth or a gear as a polygon, for drawings and for checks of interference."""

from __future__ import annotations

import math

import numpy as np

from base import Array, Faults
from gears.tooth.errors import GeometryError
from gears.tooth.profile import ToothProfile
from gears.tooth.rotation import mirrored, polar, turned


def tooth_side(profile: ToothProfile, points_per_part: int = 24, relief_scale: float = 0.0) -> Array:
    """Points of the right-hand side of a tooth, from the middle of the gap to the middle of the top land.

    Parameters
    ----------
    profile : ToothProfile
        The tooth.
    points_per_part : int
        Points on each of root arc, fillet, flank, chamfer and top land.
    relief_scale : float
        Factor by which tip relief is drawn: 0 leaves it out, 1 is true, 100 makes it visible.

    Returns
    -------
    (n, 2) array
        Points in the tooth's own frame [m].
    """
    parameter = np.linspace(0.0, 1.0, points_per_part)
    rho = np.linspace(*profile.flank_rho, points_per_part)
    flank = profile.involute(rho) - relief_scale * profile.relief(rho)[:, None] * profile.normal(rho)
    parts = [
        _arc(profile.root_radius, 0.5 * profile.pitch_angle, profile.root_half_angle, points_per_part),
        profile.fillet(parameter),
        flank,
    ]
    land = math.atan2(flank[-1, 0], flank[-1, 1])
    if profile.flank_end_radius < profile.tip_radius:
        parts.append(profile.chamfer(parameter))
        land = profile.tip_half_angle
    parts.append(_arc(profile.tip_radius, land, 0.0, points_per_part))
    side = np.concatenate(parts)
    moved = np.linalg.norm(np.diff(side, axis=0), axis=1) > 1e-12 * profile.module
    return np.asarray(side[np.concatenate(([True], moved))])


def outline(
    profile: ToothProfile, teeth: int | None = None, points_per_part: int = 24, relief_scale: float = 0.0
) -> Array:
    """Return the closed polygon of a gear, or of some of its teeth with the body down to the bore.

    Parameters
    ----------
    profile : ToothProfile
        The tooth.
    teeth : int or None
        Number of teeth about +y; None takes the whole gear, without its bore.
    points_per_part : int
        Points on each of root arc, fillet, flank, chamfer and top land.
    relief_scale : float
        Factor by which tip relief is drawn; see `tooth_side`.

    Returns
    -------
    (n, 2) array
        Points anticlockwise, the last equal to the first [m]; with an even number of teeth a gap is at +y.

    Raises
    ------
    GeometryError
        If `teeth` is not between 1 and the gear's, or a part has fewer than two points.

    Examples
    --------
    >>> from gears import Gear, GearPair
    >>> pair = GearPair(Gear(36), Gear(40), module=2e-3, face_width=40e-3)
    >>> outline(pair.teeth_profiles[0], teeth=1, points_per_part=8).shape
    (66, 2)
    """
    count = profile.teeth if teeth is None else teeth
    with Faults(GeometryError) as faults:
        if not 1 <= count <= profile.teeth:
            faults.add(
                "teeth", count, f"must be 1 to {profile.teeth}, or None", "draw teeth that the gear has"
            )
        if points_per_part < 2:
            faults.add("points_per_part", points_per_part, "must be at least 2", "raise it")
    right = tooth_side(profile, points_per_part, relief_scale)
    # the middle of the land and one of the two gap middles belong to both sides or to the next tooth
    tooth = np.concatenate((right, mirrored(right[-2:0:-1])))
    first = 0.0 if teeth is None else -0.5 * (count - 1) * profile.pitch_angle
    parts = [turned(tooth, first + i * profile.pitch_angle) for i in range(count)]
    if teeth is not None:
        half = 0.5 * count * profile.pitch_angle
        parts.append(_arc(profile.root_radius, -half, -half, 1))
        parts.append(_arc(profile.bore_radius, -half, half, max(2, points_per_part * count)))
    ring = np.concatenate(parts)
    return np.concatenate((ring, ring[:1]))


def _arc(radius: float, start: float, end: float, points: int) -> Array:
    """Points of an arc between polar angles measured from +y towards +x."""
    return polar(radius, np.linspace(start, end, points))
