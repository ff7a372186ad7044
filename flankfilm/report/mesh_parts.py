"""Sections of the report about geometry, stiffness, load share and fields."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from flankfilm import figures
from flankfilm.figures.reading import read_figure, travel
from flankfilm.report.page import Headline, Part, Table, picture
from flankfilm.report.text import number, percent

if TYPE_CHECKING:
    from collections.abc import Sequence

    import xarray as xr

    from flankfilm.coupling import LoadedFields, MeshCycle, SinglePairs
    from gears import GearPair

OF_EACH = ("reference_radii", "base_radii", "root_radii", "form_radii", "tip_radii", "bore_radii")
"""Figures of both gears."""

OF_THE_PAIR = {
    "module": 4,
    "face_width": 4,
    "working_centre_distance": 7,
    "working_pressure_angle": 6,
    "base_pitch": 6,
    "contact_ratio": 5,
    "backlash": 4,
}
"""Figures of the pair, with their digits."""


def geometry(pair: GearPair, results: xr.Dataset) -> Part:
    """Geometry with drawing and table."""
    gears, teeth = (pair.pinion, pair.wheel), pair.teeth_profiles
    radii = [read_figure(pair, name) for name in OF_EACH]
    rows = (
        ("teeth", *(str(gear.teeth) for gear in gears)),
        ("profile shift [modules]", *(number(gear.profile_shift) for gear in gears)),
        *((radius.label, *(number(value, 6) for value in radius.values)) for radius in radii),
        ("undercut", *("yes" if tooth.undercut else "no" for tooth in teeth)),
    )
    known = [(read_figure(pair, name), digits) for name, digits in OF_THE_PAIR.items()]
    common = (
        *((figure.label, number(float(figure.values), digits)) for figure, digits in known),
        ("path of contact A to E [mm]", number(float(travel(results, "path_point_rho1")[-1]), 5)),
    )
    captions = {
        figures.gears_in_mesh: "The pair in mesh at the pitch point, with the path of contact A to E.",
        figures.kinematics: "Curvature radii and velocities of the flanks along the path of contact; no sliding at C.",
    }
    return Part(
        "geometry",
        "Geometry",
        figures=tuple(picture(draw, results, caption) for draw, caption in captions.items()),
        tables=(Table(("", "pinion", "wheel"), rows), Table(("pair", ""), common)),
    )


def stiffness(
    single: SinglePairs | None,
    cycles: Sequence[MeshCycle],
    changes: Sequence[str],
    face_width: float,
    results: xr.Dataset,
) -> Part:
    """Stiffness of all models on one axis, load share and transmission error.

    Parameters
    ----------
    single : SinglePairs or None
    cycles : sequence of MeshCycle
        Of all models, the one that counts first.
    changes : sequence of str
        Notes about what was chosen and what the film changes.
    face_width : float
        [m]
    results : xarray.Dataset
    """
    captions = {
        figures.mesh_stiffness: "Mesh stiffness (secant) over two base pitches, all models on one axis.",
        figures.load_share: f"Load share of a pair: {cycles[0].label}.",
        figures.transmission_error: "Deflection along the line of action.",
    }
    tables = [_cycles(cycles, face_width)]
    if single is not None:
        caption = (
            "Stiffness of one pair of teeth along the path of contact. Closed forms have no hub wind-up."
        )
        captions = {figures.single_pairs: caption, **captions}
        tables.append(iso_table(single.iso))
    notes = (
        *changes,
        "The error of a closed form against the real tooth is unknown until it is compared with finite "
        "elements; the column shows numerical error alone.",
    )
    drawn = tuple(picture(draw, results, caption) for draw, caption in captions.items())
    return Part("stiffness", "Mesh stiffness", figures=drawn, tables=tuple(tables), notes=notes)


def _cycles(cycles: Sequence[MeshCycle], face_width: float) -> Table:
    """Means, range and error of each model's mesh cycle."""
    rows = []
    for cycle in cycles:
        secant, tangent, curve = (
            read_figure(cycle, name, face_width)
            for name in ("mean_secant_stiffness", "mean_stiffness", "secant_stiffness")
        )
        error = read_figure(cycle, "transmission_error_range")
        rows.append(
            (
                cycle.label,
                number(float(secant.values), 5),
                number(float(tangent.values), 5),
                f"{curve.values.min():.4g} to {curve.values.max():.4g}",
                number(float(error.values), 4),
                percent(cycle.mean_error),
            )
        )
    heads = ("model", secant.label, tangent.label, "range of secant", error.label, "numerical error")
    return Table(heads, tuple(rows))


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
    caption = (
        "Von Mises stress with a pair at the pitch point. The scale leaves out the highest 0.3 % of the pictured "
        "area, which lies under the contacts."
    )
    note = (
        f"Largest von Mises stress, under the contact: {number(1e-6 * peak)} MPa. The file mesh_cycle.pvd holds the "
        "mesh cycle for ParaView; colour by von_mises_Pa."
    )
    drawn = picture(figures.tooth_stress, results, caption)
    return Part("fields", "Loaded teeth", figures=(drawn,), notes=(note,))


def headlines(cycle: MeshCycle, face_width: float) -> list[Headline]:
    """Numbers for the page's head."""
    notes = {
        "mean_secant_stiffness": f"error {percent(cycle.mean_error)}, {cycle.label}",
        "mean_stiffness": "for small vibration",
    }
    found = []
    for name, note in notes.items():
        k = read_figure(cycle, name, face_width)
        found.append(Headline(k.meaning, f"{float(k.values):.4g}", note, k.unit))
    error = read_figure(cycle, "transmission_error_range")
    return [
        *found,
        Headline("loaded transmission error", f"{float(error.values):.3g}", "peak to peak", error.unit),
    ]
