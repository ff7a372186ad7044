"""Drawing of the teeth in mesh at any position: outlines that turn, and the contacts on the line of action."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

import gears
from base import Array
from gears.tooth.polygon import outline

__all__ = ["Drawing", "drawing"]

POINTS = 10
"""Points of each part of a tooth's outline."""

SEEN = 2.6
"""Half-width of what is drawn, in transverse pitches."""

REACH = 2.0
"""Where outlines end, over that half-width: a base pitch of motion brings no end into view."""

MICROMETRES = 4
"""Decimals of a coordinate in mm: a tenth of a micrometre."""


@dataclass(frozen=True)
class Drawing:
    """Both gears with a pair of teeth at the start A of the path, in mm; the pinion's axis is the origin.

    Attributes
    ----------
    pinion, wheel : tuple of (float, float)
        Outlines of the teeth that a base pitch of motion brings into view, in the common frame.
    centre : (float, float)
        Axis of the wheel.
    turn : (float, float)
        Angles by which pinion and wheel turn in one base pitch [deg], anticlockwise positive.
    start, end : (float, float)
        Ends A and E of the path of contact.
    pitch : float
        Base pitch [mm].
    box : (float, float, float, float)
        What is seen: left, bottom, width, height [mm].
    """

    pinion: tuple[tuple[float, float], ...]
    wheel: tuple[tuple[float, float], ...]
    centre: tuple[float, float]
    turn: tuple[float, float]
    start: tuple[float, float]
    end: tuple[float, float]
    pitch: float
    box: tuple[float, float, float, float]


def drawing(pair: gears.GearPair) -> Drawing:
    """Draw a pair; of a helical one the transverse section at mid-face.

    Parameters
    ----------
    pair : gears.GearPair

    Examples
    --------
    >>> from gears import Gear, GearPair
    >>> drawn = drawing(GearPair(Gear(36), Gear(40), module=2e-3, face_width=40e-3))
    >>> drawn.turn, drawn.centre
    ((10.0, -9.0), (0.0, 76.0))
    """
    at_start, at_end = pair.placement(pair.points.A), pair.placement(pair.points.E)
    first, second = pair.teeth_profiles
    teeth = (pair.pinion.teeth, pair.wheel.teeth)
    pitch = 2.0 * math.pi * first.base_radius / teeth[0]
    middle = pair.placement(pair.points.C).contact_point
    wide = SEEN * math.pi * pair.transverse_module
    tall = 0.62 * wide
    outlines = [
        _near(place(outline(profile, points_per_part=POINTS)), middle, REACH * wide, centre)
        for place, profile, centre in (
            (at_start.pinion, first, np.zeros(2)),
            (at_start.wheel, second, at_start.wheel_centre),
        )
    ]
    left, bottom, width, height = (
        round(1e3 * float(v), MICROMETRES)
        for v in (middle[0] - wide, middle[1] - tall, 2.0 * wide, 2.0 * tall)
    )
    return Drawing(
        pinion=_in_mm(outlines[0]),
        wheel=_in_mm(outlines[1]),
        centre=_point(at_start.wheel_centre),
        turn=(360.0 / teeth[0], -360.0 / teeth[1]),
        start=_point(at_start.contact_point),
        end=_point(at_end.contact_point),
        pitch=round(1e3 * pitch, MICROMETRES),
        box=(left, bottom, width, height),
    )


def _near(points: Array, middle: Array, reach: float, centre: Array) -> Array:
    """The run of a closed outline's points that are near a place, and the axis, which closes it; all where all are."""
    distance = np.linalg.norm(points[:-1] - middle, axis=1)
    half = len(distance) // 2
    around = np.roll(
        np.arange(len(distance)), half - int(np.argmin(distance))
    )  # the nearest one in the middle
    away = np.flatnonzero(distance[around] > reach)
    if not away.size:
        return points
    first = np.max(away[away < half], initial=-1) + 1
    last = np.min(away[away > half], initial=len(around))
    return np.vstack([points[around[first:last]], centre])


def _in_mm(points: Array) -> tuple[tuple[float, float], ...]:
    return tuple((x, y) for x, y in (np.round(1e3 * points, MICROMETRES) + 0.0).tolist())


def _point(point: Array) -> tuple[float, float]:
    x, y = (round(1e3 * float(value), MICROMETRES) + 0.0 for value in point)
    return x, y
