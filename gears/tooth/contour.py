"""Contour of a gear or of some of its teeth: arcs exactly, other curves by chords of a stated error."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from base import Array, Faults
from gears.tooth.errors import GeometryError
from gears.tooth.profile import ToothProfile
from gears.tooth.rotation import mirrored, polar, turned

FINEST = 1e-10
"""Smallest chord error [m]; a thousandth of what the best machines hold."""

MOST_POINTS = 5_000_000
"""Points of one contour above which a coarser tolerance is asked for."""


@dataclass(frozen=True, eq=False)
class Segment:
    """A piece of a contour: one arc about the gear's axis, or a chain of chords.

    Parameters
    ----------
    part : str
        ``root``, ``fillet``, ``flank``, ``chamfer``, ``land``, ``side`` or ``bore``.
    points : (n, 2) array
        Points on the exact curve, in the sense of the contour [m]; the two ends of an arc.
    angle : float
        Angle of the arc about the origin, positive anticlockwise [rad]; 0 for chords.
    """

    part: str
    points: Array  # m
    angle: float = 0.0  # rad

    @property
    def bulge(self) -> float:
        """Tangent of a quarter of the arc's angle, as drawing files have it; 0 for chords."""
        return math.tan(0.25 * self.angle)

    def turned(self, angle: float) -> Segment:
        """Segment turned anticlockwise about the origin by `angle` [rad]."""
        return replace(self, points=turned(self.points, angle))

    def opposite(self) -> Segment:
        """Mirror image on the other side of the tooth, in the sense of the contour."""
        return replace(self, points=mirrored(self.points[::-1]))

    def sampled(self, tolerance: float) -> Array:
        """Points (n, 2) whose chords keep within `tolerance` [m] of the segment."""
        if self.angle == 0.0:
            return self.points
        radius = float(np.hypot(*self.points[0]))
        step = 2.0 * math.acos(max(1.0 - tolerance / radius, -1.0))
        count = max(1, math.ceil(abs(self.angle) / step))
        start = math.atan2(self.points[0, 1], self.points[0, 0])
        along = start + self.angle * np.linspace(0.0, 1.0, count + 1)
        points = radius * np.stack((np.cos(along), np.sin(along)), axis=-1)
        points[[0, -1]] = self.points
        return np.asarray(points)


@dataclass(frozen=True, eq=False)
class Contour:
    """A closed contour, anticlockwise.

    Parameters
    ----------
    segments : tuple of Segment
        Each begins where the one before it ends; the last ends where the first begins.
    bore_radius : float or None
        Radius of the bore as a separate contour [m]; None where it is part of the segments.
    tolerance : float
        Largest distance of a chord from its curve [m].
    """

    segments: tuple[Segment, ...]
    bore_radius: float | None  # m
    tolerance: float  # m

    def polygon(self) -> tuple[Array, tuple[str, ...]]:
        """Closed polygon within the tolerance, arcs by chords too.

        Returns
        -------
        ((n, 2) array, tuple of str)
            Points, the last equal to the first [m]; the part that each point begins.
        """
        pieces = [segment.sampled(self.tolerance)[:-1] for segment in self.segments]
        parts = [s.part for s, piece in zip(self.segments, pieces, strict=True) for _ in piece]
        points = np.concatenate([*pieces, pieces[0][:1]])
        return points, (*parts, parts[0])


def contour(
    profile: ToothProfile, teeth: int | None = None, tolerance: float = 1e-6, relief: bool = True
) -> Contour:
    """Contour of a whole gear, or of some of its teeth with the body down to the bore.

    Points lie on the exact curves; they are spaced such that all chords of a curve have about the same
    distance from it, s^2 / (8 rho) (s chord, rho radius of curvature), which takes the fewest.

    Parameters
    ----------
    profile : ToothProfile
        The tooth.
    teeth : int or None
        Number of teeth about +y; None takes the whole gear, with its bore as a circle.
    tolerance : float
        Largest distance of a chord from its curve [m], 1e-10 m to a tenth of the module.
    relief : bool
        Whether tip relief is part of the flank.

    Returns
    -------
    Contour
        Closed.

    Raises
    ------
    GeometryError
        If `teeth` or `tolerance` is out of range, or the relief leaves no flank or no land.
    """
    _check(profile, teeth, tolerance)
    tooth = _tooth(profile, tolerance, relief)
    pitch, root = profile.pitch_angle, profile.root_radius
    gap = pitch - 2.0 * profile.root_half_angle
    count = profile.teeth if teeth is None else teeth
    if count * sum(len(segment.points) for segment in tooth) > MOST_POINTS:
        allowed = "must give at most 5 million points"
        raise GeometryError.at("tolerance", f"{tolerance:g}", allowed, "take a coarser tolerance")
    whole = count == profile.teeth
    first = 0.0 if whole else -0.5 * (count - 1) * pitch
    segments: list[Segment] = []
    for index in range(count):
        turn = first + index * pitch
        segments += [segment.turned(turn) for segment in tooth]
        if gap > 1e-12 and (whole or index < count - 1):
            segments.append(_arc("root", root, -profile.root_half_angle, gap).turned(turn))
    if not whole:
        segments += _body(profile, 0.5 * count * pitch, 0.5 * gap)
    return Contour(_closed(segments), profile.bore_radius if whole else None, tolerance)


def _check(profile: ToothProfile, teeth: int | None, tolerance: float) -> None:
    coarsest = 0.1 * profile.module
    with Faults(GeometryError) as faults:
        if teeth is not None and not 1 <= teeth <= profile.teeth:
            faults.add(
                "teeth", teeth, f"must be 1 to {profile.teeth}, or None", "take teeth that the gear has"
            )
        if not FINEST <= tolerance <= coarsest:
            allowed = f"must be at least {FINEST:g} and at most {coarsest:g} m"
            faults.add("tolerance", tolerance, allowed, "give it in metres (1 um is 1e-6)")


def _tooth(profile: ToothProfile, tolerance: float, relief: bool) -> list[Segment]:
    """Segments from foot to foot of one tooth about +y."""
    right = [Segment("fillet", chords(profile.fillet, 0.0, 1.0, tolerance))]
    right += [Segment("flank", points) for points in _flank(profile, tolerance, relief)]
    end = right[-1].points[-1]
    land = math.atan2(end[0], end[1])
    if profile.flank_end_radius < profile.tip_radius:
        # the chamfer keeps its 45 deg: it turns with the end of the flank that the relief moves
        moved = float(profile.half_angle(profile.flank_end_radius)) - land
        land = profile.tip_half_angle - moved
        right.append(Segment("chamfer", np.stack((end, polar(profile.tip_radius, land)))))
    if land <= 0.0:
        raise GeometryError.at("tip_relief.amount", "", "must leave a top land", "relieve less")
    top = _arc("land", profile.tip_radius, land, 2.0 * land)
    return [*right, top, *(segment.opposite() for segment in reversed(right))]


def _flank(profile: ToothProfile, tolerance: float, relief: bool) -> list[Array]:
    """Chords of the right-hand flank; in two pieces where a relief starts with a kink."""
    start, end = profile.flank_rho
    tip_relief = profile.tip_relief
    if tip_relief is None or not relief or tip_relief.amount == 0.0:
        return [chords(profile.involute, start, end, tolerance)]
    steepest = tip_relief.amount / tip_relief.length * (2.0 if tip_relief.form == "parabolic" else 1.0)
    if steepest >= 0.5:
        allowed = "must be less than half the length of the relief (a quarter if parabolic)"
        raise GeometryError.at("tip_relief.amount", f"{tip_relief.amount:g}", allowed, "relieve less")

    def relieved(rho: float | Array) -> Array:
        depth = np.asarray(profile.relief(rho))
        return np.asarray(profile.involute(rho) - depth[..., None] * profile.normal(rho))

    # the radius of a relieved point is hypot(r_b, rho - relief): go on to the circle where the flank ends
    reach = end
    for _ in range(60):
        reach = end + float(profile.relief(reach))
    kink = max(end - tip_relief.length, start)
    pieces = [chords(relieved, kink, reach, tolerance)]
    return pieces if kink == start else [chords(profile.involute, start, kink, tolerance), *pieces]


def chords(curve: Callable[[Array], Array], start: float, end: float, tolerance: float) -> Array:
    """Fewest points on a smooth curve whose chords keep within a tolerance of it, nearly.

    Equal shares of the integral of the square root of curvature along the curve make all chords equally
    wrong; their number is raised until points between them confirm the tolerance.

    Parameters
    ----------
    curve : callable
        Points (n, 2) for parameters (n,).
    start, end : float
        Parameters of its ends.
    tolerance : float
        Largest distance of a chord from the curve [m].

    Returns
    -------
    (n, 2) array
        Points, both ends included [m].
    """
    fine = np.linspace(start, end, 4097)
    steps = np.diff(curve(fine), axis=0)
    length = np.hypot(steps[:, 0], steps[:, 1])
    heading = np.unwrap(np.arctan2(steps[:, 1], steps[:, 0]))
    bend = np.abs(np.gradient(heading))
    share = np.concatenate(([0.0], np.cumsum(np.sqrt(bend * length) + 1e-12 * length)))
    count = max(1, math.ceil(share[-1] / math.sqrt(8.0 * tolerance)))
    while True:
        at = np.interp(np.linspace(0.0, share[-1], count + 1), share, fine)
        at[[0, -1]] = start, end
        points = curve(at)
        if _deviation(curve, at, points) <= tolerance:
            return points
        count += 1 + count // 16


def _deviation(curve: Callable[[Array], Array], at: Array, points: Array) -> float:
    """Largest distance of points between the chords' ends from the chords [m]."""
    chord = np.diff(points, axis=0)
    unit = chord / np.hypot(chord[:, 0], chord[:, 1])[:, None]
    worst = 0.0
    for share in (0.2, 0.35, 0.5, 0.65, 0.8):
        between = curve(at[:-1] + share * np.diff(at)) - points[:-1]
        worst = max(worst, float(np.max(np.abs(unit[:, 0] * between[:, 1] - unit[:, 1] * between[:, 0]))))
    return worst


def _body(profile: ToothProfile, half: float, gap: float) -> list[Segment]:
    """Close some teeth over the body: half gaps, sides and bore; `half` is half the sector's angle."""
    closing = []
    if gap > 1e-12:
        closing.append(_arc("root", profile.root_radius, -half + gap, gap))
    inner = polar(profile.bore_radius, -half), polar(profile.bore_radius, half)
    outer = polar(profile.root_radius, -half), polar(profile.root_radius, half)
    closing.append(Segment("side", np.stack((outer[0], inner[0]))))
    closing.append(Segment("bore", np.stack(inner), angle=-2.0 * half))
    closing.append(Segment("side", np.stack((inner[1], outer[1]))))
    if gap > 1e-12:
        closing.append(_arc("root", profile.root_radius, half, gap))
    return closing


def _closed(segments: list[Segment]) -> tuple[Segment, ...]:
    """Segments whose ends are the same points to the last digit."""
    joined = []
    for index, segment in enumerate(segments):
        points = segment.points.copy()
        points[0] = segments[index - 1].points[-1]
        joined.append(replace(segment, points=points))
    return tuple(joined)


def _arc(part: str, radius: float, start: float, angle: float) -> Segment:
    """Anticlockwise arc from the polar angle `start`, which is measured from +y towards +x."""
    ends = np.stack((polar(radius, start), polar(radius, start - angle)))
    return Segment(part, ends, angle)
