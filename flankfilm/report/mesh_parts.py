"""Sections of the report about geometry, stiffness, load share and fields."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from flankfilm import figures
from flankfilm.report.page import Headline, Part, Table, picture
from flankfilm.report.text import number, percent

if TYPE_CHECKING:
    from collections.abc import Mapping

    import xarray as xr

    from flankfilm.coupling import LoadedFields, MeshCycle, SinglePairs
    from gears import GearPair


def geometry(pair: GearPair, results: xr.Dataset) -> Part:
    """Geometry with drawing and table."""
    rows = [
        ("teeth", *(str(g.teeth) for g in (pair.pinion, pair.wheel))),
        ("profile shift [modules]", *(number(g.profile_shift) for g in (pair.pinion, pair.wheel))),
        *(
            (name, *(number(1e3 * r, 6) for r in radii))
            for name, radii in (
                ("reference radius [mm]", pair.reference_radii),
                ("base radius [mm]", pair.base_radii),
                ("root radius [mm]", pair.root_radii),
                ("form radius [mm]", pair.form_radii),
                ("tip radius [mm]", pair.tip_radii),
                ("bore radius [mm]", pair.bore_radii),
            )
        ),
        ("undercut", *("yes" if tooth.undercut else "no" for tooth in pair.teeth_profiles)),
    ]
    common = [
        ("module [mm]", number(1e3 * pair.module)),
        ("face width [mm]", number(1e3 * pair.face_width)),
        ("axis distance [mm]", number(1e3 * pair.working_centre_distance, 7)),
        ("working pressure angle [deg]", number(math.degrees(pair.working_pressure_angle), 6)),
        ("base pitch [mm]", number(1e3 * pair.base_pitch, 6)),
        ("contact ratio", number(pair.contact_ratio, 5)),
        ("normal backlash [µm]", number(1e6 * pair.backlash)),
        ("path of contact A to E [mm]", number(1e3 * (pair.points.E - pair.points.A), 5)),
    ]
    return Part(
        "geometry",
        "Geometry",
        figures=(
            picture(
                figures.gears_in_mesh,
                results,
                "The pair in mesh at the pitch point, with the path of contact A to E.",
            ),
            picture(
                figures.kinematics,
                results,
                "Curvature radii and velocities of the flanks along the path of contact; no sliding at C.",
            ),
        ),
        tables=(
            Table(("", "pinion", "wheel"), tuple(rows)),
            Table(("pair", ""), tuple(common)),
        ),
    )


def stiffness(
    single: SinglePairs | None,
    cycles: list[MeshCycle],
    changes: Mapping[str, float],
    note: str,
    results: xr.Dataset,
) -> Part:
    """Stiffness of all models on one axis, load share and transmission error."""
    captions = {
        figures.mesh_stiffness: "Mesh stiffness (secant) over two base pitches, all models on one axis.",
        figures.load_share: f"Load share of a pair: {cycles[0].label}.",
        figures.transmission_error: "Deflection along the line of action.",
    }
    drawn = [picture(draw, results, caption) for draw, caption in captions.items()]
    if single is not None:
        caption = (
            "Stiffness of one pair of teeth along the path of contact. Closed forms have no hub wind-up."
        )
        drawn.insert(0, picture(figures.single_pairs, results, caption))
    scale = 1e-9 / float(results["face_width"])
    rows = tuple(
        (
            cycle.label,
            number(scale * cycle.mean_secant_stiffness, 5),
            number(scale * cycle.mean_stiffness, 5),
            f"{scale * cycle.secant_stiffness.min():.4g} to {scale * cycle.secant_stiffness.max():.4g}",
            number(1e6 * cycle.transmission_error_range, 4),
            percent(cycle.mean_error),
        )
        for cycle in cycles
    )
    heads = (
        "model",
        "mean secant [N/(mm µm)]",
        "mean tangent [N/(mm µm)]",
        "range of secant",
        "transmission error, peak to peak [µm]",
        "numerical error",
    )
    tables = [Table(heads, rows)]
    if single is not None:
        tables.append(iso_table(single.iso))
    notes = [note] if note else []
    notes += [
        f"The film changes the mean {kind} stiffness by {100 * value:+.2f} %."
        for kind, value in changes.items()
    ]
    notes.append(
        "The error of a closed form against the real tooth is unknown until it is compared with finite "
        "elements; the column shows numerical error alone."
    )
    return Part("stiffness", "Mesh stiffness", figures=tuple(drawn), tables=tuple(tables), notes=tuple(notes))


def iso_table(iso: Any) -> Table:
    """Mean stiffnesses by ISO 6336-1."""
    rows = (
        ("theoretical single stiffness c'th", number(iso.c_th, 5)),
        ("single stiffness c'", number(iso.c_prime, 5)),
        ("mesh stiffness c_gamma", number(iso.c_gamma, 5)),
    )
    return Table(("ISO 6336-1", "N/(mm µm)"), rows)


def fields(stage: LoadedFields, results: xr.Dataset) -> Part:
    """Picture of the loaded teeth."""
    peak = max(float(np.nanmax(field.von_mises_Pa)) for field in (stage.pinion, stage.wheel))
    return Part(
        "fields",
        "Loaded teeth",
        figures=(
            picture(
                figures.tooth_stress,
                results,
                "Von Mises stress with a pair at the pitch point. The scale leaves out the highest 0.3 % of the "
                "pictured area, which lies under the contacts.",
            ),
        ),
        notes=(
            f"Largest von Mises stress, under the contact: {number(1e-6 * peak)} MPa. The file mesh_cycle.pvd "
            "holds the mesh cycle for ParaView; colour by von_mises_Pa.",
        ),
    )


def headlines(cycle: MeshCycle, face_width: float) -> list[Headline]:
    """Numbers for the page's head."""
    scale = 1e-9 / face_width
    return [
        Headline(
            "mean mesh stiffness (secant)",
            f"{scale * cycle.mean_secant_stiffness:.4g}",
            f"error {percent(cycle.mean_error)}, {cycle.label}",
            "N/(mm µm)",
        ),
        Headline(
            "mean mesh stiffness (tangent)",
            f"{scale * cycle.mean_stiffness:.4g}",
            "for small vibration",
            "N/(mm µm)",
        ),
        Headline(
            "loaded transmission error", f"{1e6 * cycle.transmission_error_range:.3g}", "peak to peak", "µm"
        ),
    ]
