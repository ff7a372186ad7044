"""What pictures show beside the curves: outlines, path of contact, velocities, stress near the mesh, portraits."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from base import Array, Figure, Quantity
from base.results import EXACT
from flankfilm.output.variables import figure_of

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from fem.fields.stress_fields import GearField
    from flankfilm.coupling.speeds.speed_sweep import Portrait
    from gears import GearPair

__all__ = ["SLIDING", "lines_of_contact", "near_mesh", "outlines", "path", "points", "portraits"]

OUTLINE = 12
"""Points of each part of a tooth's outline: straight sides between them do not show."""

STATIONS = 81
"""Points of the path of contact at which velocities are given, both ends included."""

CYCLE = 201
"""Positions of the mesh cycle at which the lines of contact are measured, both ends included."""

SHOWN = (0.0, 0.25, 0.5, 0.75)
"""Positions [base pitches] at which lines of contact are drawn."""

ORDERS = 5
"""Harmonics of their total length."""

PICTURED = 2.7
"""Half-width of the pictured part of the mesh, in pitches."""


INDICATIVE = "not estimated; cells next to a contact are marked indicative in the files for ParaView"

SLIDING = Figure("m/s", "sliding, u1 - u2", ("station",), no_error=EXACT)
"""Sliding of the flanks along the path of contact."""


def outlines(pair: GearPair) -> tuple[Quantity, ...]:
    """Draw both gears as closed polygons, with a pair of teeth at the pitch point."""
    from gears.tooth.polygon import outline

    placed = pair.placement(pair.points.C)
    pinion, wheel = (
        place(outline(tooth, points_per_part=OUTLINE)).astype(np.float32)
        for place, tooth in zip((placed.pinion, placed.wheel), pair.teeth_profiles, strict=True)
    )
    centres = np.array([np.zeros(2), placed.wheel_centre])
    return (
        figure_of(
            "pinion", "m", "outline of the pinion", "node_pinion axis", pinion, shown="mm", no_error=EXACT
        ),
        figure_of("wheel", "m", "outline of the wheel", "node_wheel axis", wheel, shown="mm", no_error=EXACT),
        figure_of(
            "centre", "m", "axes of pinion and wheel", "gear axis", centres, shown="mm", no_error=EXACT
        ),
    )


def points(pair: GearPair) -> Iterator[Quantity]:
    """Points of the path of contact, in the frame of the outlines."""
    rho1 = np.array([getattr(pair.points, name) for name in "ABCDE"])
    places = np.array([pair.placement(rho).contact_point for rho in rho1])
    meaning = "curvature radius of the pinion's flank there"
    yield figure_of("point", "", "points of the path of contact", "point", tuple("ABCDE"))
    yield figure_of("point_rho1", "m", meaning, "point", rho1, shown="mm", no_error=EXACT)
    yield figure_of(
        "point_place",
        "m",
        "place in the frame of the outlines",
        "point axis",
        places,
        shown="mm",
        no_error=EXACT,
    )


def path(pair: GearPair, speed: float | None = None) -> Iterator[Quantity]:
    """Follow the path of contact from A to E: its points, and curvature and velocities of the flanks along it.

    Parameters
    ----------
    pair : GearPair
    speed : float or None
        Of the pinion [rad/s]; no velocities without it.
    """
    along = pair.path_of_contact(n=STATIONS)
    yield from points(pair)
    for name, meaning in (
        ("rho1", "curvature radius of the pinion's flank"),
        ("rho2", "curvature radius of the wheel's flank"),
        ("radius", "radius of relative curvature"),
    ):
        yield figure_of(name, "m", meaning, "station", getattr(along, name), shown="mm", no_error=EXACT)
    sliding = np.stack(along.specific_sliding, axis=-1)
    yield figure_of("specific_sliding", "1", "specific sliding", "station gear", sliding, no_error=EXACT)
    if speed is not None:
        mean = along.entrainment(speed)
        yield figure_of("entrainment", "m/s", "entrainment, (u1 + u2)/2", "station", mean, no_error=EXACT)
        yield Quantity("sliding", SLIDING, along.sliding(speed))


def lines_of_contact(pair: GearPair) -> Iterator[Quantity]:
    """Follow the lines of contact of a helical pair: their total length, and where they lie at some positions."""
    from gears import contact_lines

    lines, position, orders = contact_lines(pair), np.linspace(0.0, 1.0, CYCLE), np.arange(1, ORDERS + 1)
    middle = "position of mid-face, base pitches from A"
    yield figure_of("position", "1", middle, "position", position, no_error=EXACT)
    length = lines.length(position)
    yield figure_of(
        "length", "m", "total length of the lines of contact", "position", length, shown="mm", no_error=EXACT
    )
    yield figure_of("harmonic", "1", "order of the mesh", "harmonic", orders, no_error=EXACT)
    over_mean = "amplitude of the total length of the lines of contact over its mean"
    yield figure_of("harmonics", "1", over_mean, "harmonic", lines.harmonics(ORDERS), no_error=EXACT)
    segments = [(at, *ends) for at in SHOWN for ends in zip(*lines.segments(at), strict=True)]
    at, travel, along = (np.array(part) for part in zip(*segments, strict=True))
    # a right-handed pinion is turned on at larger z, where it touches nearer to E
    hand = math.copysign(1.0, pair.helix_angle)
    yield figure_of("shown_position", "1", "position of a line that is drawn", "line", at, no_error=EXACT)
    for name, meaning, values in (
        ("shown_travel", "travel of its ends along the path of contact, from A", pair.base_pitch * travel),
        ("shown_face", "place of its ends along the face, from mid-face", hand * pair.face_width * along),
    ):
        yield figure_of(name, "m", meaning, "line end", values, shown="mm", no_error=EXACT)


def near_mesh(pair: GearPair, fields: tuple[GearField, GearField]) -> tuple[Quantity, ...]:
    """Cut out the stress of both gears around the pitch point, in a frame whose origin is the pinion's axis."""
    focus = pair.placement(pair.points.C).contact_point
    reach = PICTURED * np.pi * pair.module
    points, stresses, cells = zip(*(_near(field, focus, reach) for field in fields), strict=True)
    corners = np.concatenate([cells[0], cells[1] + len(points[0])])
    stress = np.concatenate(stresses)
    return (
        figure_of(
            "point", "m", "unloaded place", "node axis", np.concatenate(points), shown="mm", no_error=EXACT
        ),
        figure_of("von_mises", "Pa", "von Mises stress", "node", stress, shown="MPa", no_error=INDICATIVE),
        figure_of(
            "triangles",
            "1",
            "numbers of the nodes of each triangle",
            "triangle corner",
            corners,
            no_error=EXACT,
        ),
        figure_of("centre", "m", "pitch point", "axis", focus, shown="mm", no_error=EXACT),
        figure_of("reach", "m", "half-width of the pictured part", "", reach, shown="mm", no_error=EXACT),
    )


def _near(
    field: GearField, focus: Array, reach: float
) -> tuple[Array, NDArray[np.float32], NDArray[np.int32]]:
    """Points, stress and linear triangles of the part of a gear that is pictured."""
    near = np.linalg.norm(field.points[field.cells[:, 0]] - focus, axis=1) < 1.6 * reach
    a, b, c, ab, bc, ca = field.cells[near].T
    # second-order triangles split into four linear ones at their mid-side nodes
    quarters = ((a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca))
    corners = np.concatenate([np.column_stack(part) for part in quarters])
    used, numbers = np.unique(corners, return_inverse=True)
    return (
        field.points[used],
        field.von_mises_Pa[used].astype(np.float32),
        numbers.reshape(-1, 3).astype(np.int32),
    )


def portraits(motions: Sequence[Portrait]) -> tuple[Quantity, ...]:
    """Gather settled motions, at least one; ``of_sample`` and ``of_point`` say which one an entry belongs to."""
    order = np.arange(len(motions))
    of_sample = np.repeat(order, [motion.displacement.size for motion in motions])
    of_point = np.repeat(order, [len(motion.section) for motion in motions])

    def each(name: str) -> Array:
        return np.array([getattr(motion, name) for motion in motions])

    def all_of(name: str) -> Array:
        return np.concatenate([getattr(motion, name) for motion in motions])

    return (
        figure_of("frequency", "1", "mesh over natural frequency", "portrait", each("frequency")),
        figure_of("direction", "", "sweep that met the motion", "portrait", each("direction")),
        figure_of("motion", "", "motion n-p-q", "portrait", each("label")),
        figure_of("of_sample", "1", "portrait of the sample", "sample", of_sample, no_error=EXACT),
        figure_of("displacement", "1", "displacement X", "sample", all_of("displacement")),
        figure_of("velocity", "1", "velocity dX/dτ", "sample", all_of("velocity")),
        figure_of("of_point", "1", "portrait of the point", "point", of_point, no_error=EXACT),
        figure_of("section", "1", "displacement and velocity at tau = 0", "point state", all_of("section")),
    )
