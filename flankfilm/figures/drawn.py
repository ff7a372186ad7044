"""What pictures show beside the curves: outlines, path of contact, velocities, stress near the mesh, portraits."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from base import Array, quantity, record

if TYPE_CHECKING:
    from collections.abc import Sequence

    from fem.fields import GearField
    from flankfilm.coupling.motion import Portrait
    from gears import GearPair

__all__ = ["NearMesh", "Outlines", "Path", "Portraits", "near_mesh", "outlines", "path", "portraits"]

OUTLINE = 12
"""Points of each part of a tooth's outline: straight sides between them do not show."""

STATIONS = 81
"""Points of the path of contact at which velocities are given, both ends included."""

PICTURED = 2.7
"""Half-width of the pictured part of the mesh, in pitches."""


@record
class Outlines:
    """Both gears as closed polygons, with a pair of teeth at the pitch point."""

    pinion: NDArray[np.float32] = quantity("m", "outline of the pinion", "node_pinion axis", shown="mm")
    wheel: NDArray[np.float32] = quantity("m", "outline of the wheel", "node_wheel axis", shown="mm")
    centre: Array = quantity("m", "axes of pinion and wheel", "gear axis", shown="mm")


@record
class Path:
    """Path of contact: its points by name and place, curvature and velocities of the flanks along it."""

    point: tuple[str, ...] = quantity("", "points of the path of contact", "point")
    point_rho1: Array = quantity("m", "curvature radius of the pinion's flank there", "point", shown="mm")
    point_place: Array = quantity("m", "place in the frame of the outlines", "point axis", shown="mm")
    rho1: Array = quantity("m", "curvature radius of the pinion's flank", "station", shown="mm")
    rho2: Array = quantity("m", "curvature radius of the wheel's flank", "station", shown="mm")
    radius: Array = quantity("m", "radius of relative curvature", "station", shown="mm")
    entrainment: Array | None = quantity("m/s", "entrainment, (u1 + u2)/2", "station", default=None)
    sliding: Array | None = quantity("m/s", "sliding, u1 - u2", "station", default=None)


@record
class NearMesh:
    """Stress of both gears around the pitch point as linear triangles, in a frame whose origin is the pinion's axis."""

    point: Array = quantity("m", "unloaded place", "node axis", shown="mm")
    von_mises: NDArray[np.float32] = quantity("Pa", "von Mises stress", "node", shown="MPa")
    triangles: NDArray[np.int32] = quantity("1", "numbers of the nodes of each triangle", "triangle corner")
    centre: Array = quantity("m", "pitch point", "axis", shown="mm")
    reach: float = quantity("m", "half-width of the pictured part", shown="mm")


@record
class Portraits:
    """Settled motions one after another; ``of_sample`` and ``of_point`` say which one an entry belongs to."""

    frequency: Array = quantity("1", "mesh over natural frequency", "portrait")
    direction: Array = quantity("", "sweep that met the motion", "portrait")
    motion: Array = quantity("", "motion n-p-q", "portrait")
    of_sample: Array = quantity("1", "portrait of the sample", "sample")
    displacement: Array = quantity("1", "displacement X", "sample")
    velocity: Array = quantity("1", "velocity dX/dτ", "sample")
    of_point: Array = quantity("1", "portrait of the point", "point")
    section: Array = quantity("1", "displacement and velocity at tau = 0", "point state")


def outlines(pair: GearPair) -> Outlines:
    """Draw both gears with a pair of teeth at the pitch point."""
    from gears.polygon import outline

    placed = pair.placement(pair.points.C)
    pinion, wheel = (
        place(outline(tooth, points_per_part=OUTLINE)).astype(np.float32)
        for place, tooth in zip((placed.pinion, placed.wheel), pair.teeth_profiles, strict=True)
    )
    return Outlines(pinion, wheel, np.array([np.zeros(2), placed.wheel_centre]))


def path(pair: GearPair, speed: float | None = None) -> Path:
    """Follow the path of contact from A to E.

    Parameters
    ----------
    pair : GearPair
    speed : float or None
        Of the pinion [rad/s]; no velocities without it.
    """
    names = tuple("ABCDE")
    rho1 = np.array([getattr(pair.points, name) for name in names])
    along = pair.path_of_contact(n=STATIONS)
    return Path(
        point=names,
        point_rho1=rho1,
        point_place=np.array([pair.placement(rho).contact_point for rho in rho1]),
        rho1=along.rho1,
        rho2=along.rho2,
        radius=along.radius,
        entrainment=None if speed is None else along.entrainment(speed),
        sliding=None if speed is None else along.sliding(speed),
    )


def near_mesh(pair: GearPair, fields: tuple[GearField, GearField]) -> NearMesh:
    """Cut out what a picture of the mesh shows of the stress in both gears."""
    focus = pair.placement(pair.points.C).contact_point
    reach = PICTURED * np.pi * pair.module
    parts = [_near(field, focus, reach) for field in fields]
    first = np.cumsum([0, *(len(points) for points, _, _ in parts)])[:-1]
    return NearMesh(
        point=np.concatenate([points for points, _, _ in parts]),
        von_mises=np.concatenate([stress for _, stress, _ in parts]),
        triangles=np.concatenate([cells + start for (_, _, cells), start in zip(parts, first, strict=True)]),
        centre=focus,
        reach=reach,
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


def portraits(motions: Sequence[Portrait]) -> Portraits:
    """Gather settled motions, at least one."""
    order = np.arange(len(motions))
    return Portraits(
        frequency=np.array([motion.frequency for motion in motions]),
        direction=np.array([motion.direction for motion in motions]),
        motion=np.array([motion.label for motion in motions]),
        of_sample=np.repeat(order, [motion.displacement.size for motion in motions]),
        displacement=np.concatenate([motion.displacement for motion in motions]),
        velocity=np.concatenate([motion.velocity for motion in motions]),
        of_point=np.repeat(order, [len(motion.section) for motion in motions]),
        section=np.concatenate([motion.section for motion in motions]),
    )
