"""Proof that two gears mesh: their generated flanks rolled together without the law of the path."""

from __future__ import annotations

import math

import numpy as np

from base import Array, quantity, record
from base.results import EXACT
from gears.pair.gear_pair import GearPair
from gears.tooth.errors import GeometryError
from gears.tooth.polygon import tooth_side
from gears.tooth.profile import ToothProfile
from gears.tooth.rotation import mirrored, turned

_NEIGHBOURS = np.arange(-3, 4)  # teeth on either side that can come near the mate
_GRID = 33
_ZOOMS = 9


@record
class MeshingCheck:
    """What was found when the gears were rolled together."""

    no_error = EXACT

    angle_deviation: float = quantity(
        "1",
        "largest deviation of the wheel's angle from the constant ratio between A and E, over the wheel's turn there",
    )
    back_clearance: float = quantity(
        "m",
        "smallest clearance of the unloaded flanks along the line of action over a mesh cycle",
        shown="um",
    )
    tip_clearances: tuple[float, float] = quantity(
        "m",
        "smallest distance of each gear's tip from its mate's fillets and root circle, negative inside the material",
        "gear",
        shown="um",
    )
    overlap: float = quantity(
        "m",
        "deepest penetration of the outlines over a mesh cycle along the circumference, "
        "rounding where nothing interferes",
        shown="um",
    )

    headline = ("angle_deviation", "back_clearance", "overlap")


def check_meshing(pair: GearPair, positions: int = 21) -> MeshingCheck:
    """Roll the generated teeth of a pair together and measure what happens.

    For a set of angles of the pinion the wheel is turned until a flank touches: every point of the pinion's
    flank lies at some radius r2 from the wheel's axis, and the wheel angle at which the wheel's flank passes
    through that point follows from the tooth's half angle at r2; the smallest of these angles is the one at
    which the flanks touch. Neither the line of action nor a law of gearing enters. Tip relief is left out.

    Parameters
    ----------
    pair : GearPair
        The gears.
    positions : int
        Angles of the pinion, equally spaced over A..E and over one mesh cycle.

    Returns
    -------
    MeshingCheck
        Deviation of the transmitted angle, clearances, overlap.

    Examples
    --------
    >>> from gears import Gear, GearPair
    >>> pair = GearPair(Gear(36), Gear(40), module=2e-3, face_width=40e-3)
    >>> check_meshing(pair).angle_deviation < 1e-9
    True
    """
    if positions < 2:
        raise GeometryError.at("positions", positions, "must be at least 2", "raise it")
    points, (first, second) = pair.points, pair.teeth_profiles
    middle = pair.placement(points.C).pinion_angle
    start, end = (points.A - points.C) / first.base_radius, (points.E - points.C) / first.base_radius
    path = np.linspace(start, end, positions)
    wheel = np.array([_touching_angle(pair, middle + turn) for turn in path])
    expected = wheel[0] - (path - path[0]) * first.teeth / second.teeth
    deviation = float(np.max(np.abs(wheel - expected)) / abs(expected[-1] - expected[0]))
    cycle = middle + np.linspace(0.0, first.pitch_angle, positions)
    leading = middle + start  # a tooth that touches at A; all others follow by whole pitches
    reference = _touching_angle(pair, leading)
    angles = [(turn, reference - (turn - leading) * first.teeth / second.teeth) for turn in cycle]
    return MeshingCheck(
        angle_deviation=deviation,
        back_clearance=min(_back_clearance(pair, *angle) for angle in angles),
        tip_clearances=(
            min(_tip_clearance(_seen_by_mate(pair, 0, *angle), second) for angle in angles),
            min(_tip_clearance(_seen_by_mate(pair, 1, *angle), first) for angle in angles),
        ),
        overlap=max(
            _overlap(_seen_by_mate(pair, gear, *angle, whole=True), mate)
            for angle in angles
            for gear, mate in enumerate((second, first))
        ),
    )


def _wheel_angles(pair: GearPair, points: Array, side: float) -> Array:
    """Wheel angles, less pi, at which its flank on one side passes through points.

    `side` is -1 for the left-hand flank and 1 for the right-hand one. Points that its flank cannot reach give
    an angle that never counts.
    """
    wheel = pair.teeth_profiles[1]
    x, y = points[..., 0], pair.working_centre_distance - points[..., 1]
    radius = np.hypot(x, y)
    reached = (radius >= wheel.form_radius * (1.0 - 1e-12)) & (
        radius <= wheel.flank_end_radius * (1.0 + 1e-12)
    )
    angle = side * wheel.half_angle(radius) - np.arctan2(-x, y)
    return np.where(reached, angle, -side * np.inf)


def _extremum(pair: GearPair, pinion_angle: float, side: float) -> float:
    """Wheel angle, less pi, at which the flanks on one side touch; inf if they cannot."""
    profile = pair.teeth_profiles[0]
    low, high = profile.flank_rho
    for _ in range(_ZOOMS):
        rho = np.linspace(low, high, _GRID)
        flank = profile.involute(rho)
        points = turned(flank if side > 0 else mirrored(flank), pinion_angle)
        angles = -side * _wheel_angles(pair, points, side)
        best = int(np.argmin(angles))
        low, high = rho[max(best - 1, 0)], rho[min(best + 1, _GRID - 1)]
    return -side * float(angles[best])


def _touching_angle(pair: GearPair, pinion_angle: float) -> float:
    """Wheel angle, less pi, at which the loaded, left-hand flanks touch."""
    return _extremum(pair, pinion_angle, -1.0)


def _back_clearance(pair: GearPair, pinion_angle: float, wheel_angle: float) -> float:
    """Clearance of the right-hand flanks along the line of action, over the teeth near the mesh [m]."""
    first, second = pair.teeth_profiles
    gaps = []
    for tooth in _NEIGHBOURS:
        touching = _extremum(pair, pinion_angle + float(tooth) * first.pitch_angle, 1.0)
        if math.isfinite(touching):
            # the tooth of the wheel that the pinion's tooth has at its back
            standing = wheel_angle + (1.0 - float(tooth)) * second.pitch_angle
            gaps.append((standing - touching) * second.base_radius)
    return min(gaps, default=math.inf)


def _sides(profile: ToothProfile, whole: bool) -> Array:
    """Both sides of the teeth near the mesh, (teeth, n, 2); only their tips unless `whole`."""
    side = tooth_side(profile, 33)
    if not whole:
        side = side[np.hypot(side[:, 0], side[:, 1]) >= profile.flank_end_radius * (1.0 - 1e-12)]
    sides = np.concatenate((side, mirrored(side)))
    return np.stack([turned(sides, tooth * profile.pitch_angle) for tooth in _NEIGHBOURS])


def _seen_by_mate(
    pair: GearPair, gear: int, pinion_angle: float, wheel_angle: float, whole: bool = False
) -> Array:
    """Teeth of a gear, 0 the pinion, near the mesh, in the frame of a tooth of its mate."""
    angles = pinion_angle, wheel_angle + math.pi
    axis = np.array([0.0, (-1.0, 1.0)[gear] * pair.working_centre_distance])
    points = turned(_sides(pair.teeth_profiles[gear], whole), angles[gear]) + axis
    return turned(points, -angles[1 - gear])


def _near(points: Array, profile: ToothProfile) -> tuple[Array, Array]:
    """Radius of the points inside the tip circle, and polar angle from the centre line of the nearest tooth."""
    radius = np.hypot(points[..., 0], points[..., 1])
    angle = np.arctan2(points[..., 0], points[..., 1])
    pitch = profile.pitch_angle
    near = radius < profile.tip_radius
    return radius[near], np.abs(angle - pitch * np.round(angle / pitch))[near]


def _overlap(points: Array, profile: ToothProfile) -> float:
    """Deepest penetration of points into a gear [m]; negative if all stand clear, -inf if none is near."""
    radius, angle = _near(points, profile)
    if radius.size == 0:
        return -math.inf
    along = radius * (profile.boundary_angle(radius) - angle)
    return float(np.max(np.where(radius < profile.root_radius, profile.root_radius - radius, along)))


def _tip_clearance(points: Array, profile: ToothProfile) -> float:
    """Signed distance of points from the fillets and the root circle of a gear [m]."""
    radius, angle = _near(points, profile)
    if radius.size == 0:
        return math.inf
    place = radius[:, None] * np.stack((np.sin(angle), np.cos(angle)), axis=-1)
    curve = profile.fillet(np.linspace(0.0, 1.0, 257))
    step = np.diff(curve, axis=0)
    from_start = place[:, None, :] - curve[:-1]
    along = np.clip((from_start * step).sum(-1) / (step * step).sum(-1), 0.0, 1.0)
    distance = np.linalg.norm(from_start - along[..., None] * step, axis=-1).min(axis=-1)
    over_root = angle >= profile.root_half_angle
    distance = np.where(over_root, np.minimum(distance, np.abs(radius - profile.root_radius)), distance)
    inside = (radius < profile.form_radius) & (angle < profile.boundary_angle(radius))
    return float(np.min(np.where(inside, -distance, distance)))
