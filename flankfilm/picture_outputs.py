"""What pictures need beside the curves: geometry, names of models, profiles, portraits, stress near the mesh."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from flankfilm.dataset import Quantity

if TYPE_CHECKING:
    from fem.fields import GearField
    from flankfilm.coupling import (
        FilmAlongPath,
        LoadedFields,
        LubricatedCycle,
        MeshCycle,
        MeshSeries,
        SpeedSweep,
    )
    from gears import GearPair

OUTLINE = 12
"""Points of each part of a tooth's outline: straight sides between them do not show."""

STATIONS = 81
"""Points of the path of contact at which velocities are given, both ends included."""

PICTURED = 2.7
"""Half-width of the pictured part of the mesh, in pitches."""


def picture_quantities(values: Mapping[str, Any], speed: float | None) -> dict[str, Quantity]:
    """Variables of the stages at hand.

    Parameters
    ----------
    values : mapping
        Stage name to result.
    speed : float or None
        Of the pinion [rad/s].
    """
    found: dict[str, Quantity] = {}
    if (pair := values.get("pair")) is not None:
        found |= geometry_quantities(pair) | _kinematics(pair, speed)
    if (dry := values.get("dry cycle")) is not None:
        found["dry_model"] = Quantity((), dry.label, "1", "model of the mesh cycle without film")
    if others := values.get("other cycles"):
        found |= _compared(others, "other", "by the other models")
    if (film := values.get("film")) is not None:
        found["lubricated_model"] = Quantity((), film.label, "1", "model of the mesh cycle with film")
        found |= _profiles(film.film)
        if film.otherwise:
            found |= _compared(_starved_cycles(film), "held", "with films that differ in what is held")
    if (fourier := values.get("fourier")) is not None and fourier.fit is not None:
        found |= _series(fourier)
    if (sweep := values.get("sweep")) is not None:
        found |= _portraits(sweep)
    if (fields := values.get("fields")) is not None and pair is not None:
        found |= _fields(fields, pair)
    return found


def geometry_quantities(pair: GearPair) -> dict[str, Quantity]:
    """Variables of the pair: widths, points of the path, and outlines."""
    names = tuple("ABCDE")
    rho1 = [getattr(pair.points, name) for name in names]
    along = ("path_point",)
    placed = pair.placement(pair.points.C)
    return {
        **_outlines(pair),
        "gear_centre": Quantity(
            ("gear", "axis"), [np.zeros(2), placed.wheel_centre], "m", "axes of pinion and wheel"
        ),
        "base_radius": Quantity(("gear",), pair.base_radii, "m", "radius of the base circle"),
        "bore_radius": Quantity(("gear",), pair.bore_radii, "m", "radius of the bore"),
        "module": Quantity((), pair.module, "m", "module"),
        "face_width": Quantity((), pair.face_width, "m", "face width"),
        "base_pitch": Quantity((), pair.base_pitch, "m", "base pitch"),
        "contact_ratio": Quantity((), pair.contact_ratio, "1", "contact ratio"),
        "path_point_name": Quantity(along, np.asarray(names), "1", "points of the path of contact"),
        "path_point_rho1": Quantity(along, rho1, "m", "curvature radius of the pinion's flank there"),
        "path_point_place": Quantity(
            (*along, "axis"),
            [pair.placement(rho).contact_point for rho in rho1],
            "m",
            "place in the frame of the outlines",
        ),
    }


def _kinematics(pair: GearPair, speed: float | None) -> dict[str, Quantity]:
    """Curvature radii, and velocities of the flanks against the contact, from A to E."""
    path, along = pair.path_of_contact(n=STATIONS), ("path_station",)
    found = {
        "kinematic_rho1": Quantity(along, path.rho1, "m", "curvature radius of the pinion's flank"),
        "kinematic_rho2": Quantity(along, path.rho2, "m", "curvature radius of the wheel's flank"),
        "kinematic_radius": Quantity(along, path.radius, "m", "reduced curvature radius of both flanks"),
    }
    if speed is None:
        return found
    entrainment, sliding = path.entrainment(speed), path.sliding(speed)
    return found | {
        "kinematic_entrainment": Quantity(
            along, entrainment, "m/s", "(u1 + u2)/2, mean velocity of the flanks"
        ),
        "kinematic_sliding": Quantity(along, sliding, "m/s", "u1 - u2, negative before C"),
    }


def _outlines(pair: GearPair) -> dict[str, Quantity]:
    """Both gears as closed polygons, with a pair of teeth at the pitch point."""
    from gears.polygon import outline

    placed = pair.placement(pair.points.C)
    found = {}
    for name, place, tooth in zip(
        ("pinion", "wheel"), (placed.pinion, placed.wheel), pair.teeth_profiles, strict=True
    ):
        shape = place(outline(tooth, points_per_part=OUTLINE)).astype(np.float32)
        found[f"outline_{name}"] = Quantity(
            (f"outline_node_{name}", "axis"), shape, "m", f"outline of the {name}, a pair of teeth at C"
        )
    return found


def _compared(cycles: Sequence[MeshCycle], prefix: str, told: str) -> dict[str, Quantity]:
    """Mesh cycles of several models beside each other; all have the same positions."""
    each = (prefix, f"{prefix}_position")
    return {
        f"{prefix}_model": Quantity(each[:1], np.array([c.label for c in cycles]), "1", f"mesh cycle {told}"),
        f"{prefix}_phase": Quantity(
            each, [c.position for c in cycles], "1", "travel after a pair is at A, over the base pitch"
        ),
        f"{prefix}_secant_stiffness": Quantity(
            each, [c.secant_stiffness for c in cycles], "N/m", f"force over deflection, {told}"
        ),
        f"{prefix}_tangent_stiffness": Quantity(
            each, [c.stiffness for c in cycles], "N/m", f"slope of force over deflection, {told}"
        ),
        f"{prefix}_transmission_error": Quantity(
            each, [c.transmission_error for c in cycles], "m", f"deflection, {told}"
        ),
    }


def _starved_cycles(film: LubricatedCycle) -> tuple[MeshCycle, ...]:
    """Mesh with a starved film as it is, flooded, and with the other of meniscus and layer held."""
    label = f"this film, {film.film.supply.replace('-', ' ')} held"
    return (replace(film, label=label), *film.otherwise.values())


def _profiles(film: FilmAlongPath) -> dict[str, Quantity]:
    """Pressure and film through the contacts at points of the path, each on its own grid."""
    found: dict[str, Quantity] = {}
    for name, solved in film.profiles.items():
        at, through = f"film_profile_{name}", (f"film_node_{name}",)
        said = f"through the contact at {name}"
        found |= {
            f"{at}_x": Quantity(through, solved.x, "m", f"distance from the line of centres, {said}"),
            f"{at}_pressure": Quantity(through, solved.pressure, "Pa", f"pressure {said}"),
            f"{at}_thickness": Quantity(through, solved.thickness, "m", f"film thickness {said}"),
            f"{at}_half_width": Quantity(
                (), solved.contact.half_width, "m", f"half-width of the dry contact at {name}"
            ),
        }
    return found


def _series(fourier: MeshSeries) -> dict[str, Quantity]:
    """Which stiffness the series is of, the series of the other one, and all harmonics of the samples."""
    assert fourier.fit is not None
    found = {
        "fourier_kind": Quantity((), fourier.kind, "1", "stiffness that the series is of"),
        "sampled_harmonic": Quantity(
            ("sampled_order",),
            fourier.fit.harmonics,
            "1",
            "harmonics 1, 2, ... of the samples over their mean",
        ),
    }
    if fourier.other is not None:
        series = fourier.other.stiffness
        other = "tangent" if fourier.kind == "secant" else "secant"
        found |= {
            "fourier_other_mean": Quantity((), series.mean, "N/m", f"mean of the {other} stiffness"),
            "fourier_other_amplitude": Quantity(
                ("harmonic",), series.amplitudes, "N/m", f"amplitude of the {other} stiffness"
            ),
            "fourier_other_phase": Quantity(("harmonic",), series.phases, "rad", "phase; tau = 0 at A"),
        }
    return found


def _portraits(sweep: SpeedSweep) -> dict[str, Quantity]:
    """Settled motions one after another; ``portrait_of_...`` says which one a sample belongs to."""
    found = {"half_backlash": Quantity((), sweep.half_backlash, "1", "half the backlash D")}
    motions = sweep.portraits
    if not motions:
        return found
    sample, point, each = ("portrait_sample",), ("portrait_point", "state"), ("portrait",)
    order = np.arange(len(motions))
    return found | {
        "portrait_frequency": Quantity(
            each, [m.frequency for m in motions], "1", "mesh over natural frequency"
        ),
        "portrait_direction": Quantity(
            each, np.array([m.direction for m in motions]), "1", "sweep that met the motion"
        ),
        "portrait_motion": Quantity(each, np.array([m.label for m in motions]), "1", "motion n-p-q"),
        "portrait_of_sample": Quantity(
            sample, np.repeat(order, [m.displacement.size for m in motions]), "1", "portrait of the sample"
        ),
        "portrait_displacement": Quantity(
            sample, np.concatenate([m.displacement for m in motions]), "1", "displacement X"
        ),
        "portrait_velocity": Quantity(
            sample, np.concatenate([m.velocity for m in motions]), "1", "velocity dX/dtau"
        ),
        "portrait_of_point": Quantity(
            point[:1], np.repeat(order, [len(m.section) for m in motions]), "1", "portrait of the point"
        ),
        "portrait_section": Quantity(
            point, np.concatenate([m.section for m in motions]), "1", "displacement and velocity at tau = 0"
        ),
    }


def _fields(stage: LoadedFields, pair: GearPair) -> dict[str, Quantity]:
    """Von Mises stress of both gears around C as linear triangles: what a picture of the mesh needs."""
    focus = pair.placement(pair.points.C).contact_point
    reach = PICTURED * np.pi * pair.module
    parts = [_near(field, focus, reach) for field in (stage.pinion, stage.wheel)]
    first = np.cumsum([0, *(len(points) for points, _, _ in parts)])[:-1]
    corners = ("field_triangle", "field_corner")
    return {
        "field_point": Quantity(
            ("field_node", "field_axis"),
            np.concatenate([points for points, _, _ in parts]),
            "m",
            "unloaded place, pinion's axis at the origin",
        ),
        "field_von_mises": Quantity(
            ("field_node",), np.concatenate([stress for _, stress, _ in parts]), "Pa", "von Mises stress"
        ),
        "field_triangles": Quantity(
            corners,
            np.concatenate([cells + start for (_, _, cells), start in zip(parts, first, strict=True)]),
            "1",
            "numbers of the nodes of each triangle",
        ),
        "field_centre": Quantity(("field_axis",), focus, "m", "pitch point"),
        "field_reach": Quantity((), reach, "m", "half-width of the pictured part"),
    }


def _near(
    field: GearField, focus: NDArray[np.float64], reach: float
) -> tuple[NDArray[np.float64], NDArray[np.float32], NDArray[np.int32]]:
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
