"""How pairs and closed forms show themselves in a notebook: plain HTML with a small drawing."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from html import escape
from typing import TYPE_CHECKING

import numpy as np

from base import Array

if TYPE_CHECKING:
    from gears.closed_form.record import ClosedForm
    from gears.pair.gear_pair import GearPair

_CELL = 'style="text-align: right; padding: 0.1em 0.8em"'
_HEAD = 'style="text-align: left; padding: 0.1em 0.8em; font-weight: normal"'


def table(head: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """HTML table: a row's first cell names it; texts are escaped.

    Parameters
    ----------
    head : sequence of str
        Names of the columns; empty for a table without.
    rows : iterable of sequence of str
        Texts.
    """
    lines = ['<table style="border-collapse: collapse">']
    if head:
        lines.append("<tr>" + "".join(f"<th {_CELL}>{escape(cell)}</th>" for cell in head) + "</tr>")
    for first, *rest in rows:
        cells = "".join(f"<td {_CELL}>{escape(cell)}</td>" for cell in rest)
        lines.append(f"<tr><th {_HEAD}>{escape(first)}</th>{cells}</tr>")
    return "".join([*lines, "</table>"])


def pair_html(pair: GearPair) -> str:
    """Key data of a pair and a drawing of its mesh at the pitch point."""
    teeth = pair.teeth_profiles
    gear_rows = [
        ("teeth", "", *(f"{tooth.teeth}" for tooth in teeth)),
        ("profile shift", "", f"{pair.pinion.profile_shift:g}", f"{pair.wheel.profile_shift:g}"),
        *(
            (f"{name} diameter", "mm", *(f"{2e3 * getattr(tooth, f'{name}_radius'):.4f}" for tooth in teeth))
            for name in ("tip", "reference", "base", "root", "bore")
        ),
    ]
    common = [
        ("module", f"{1e3 * pair.module:g} mm"),
        ("face width", f"{1e3 * pair.face_width:g} mm"),
        ("centre distance", f"{1e3 * pair.working_centre_distance:.4f} mm"),
        ("working pressure angle", f"{math.degrees(pair.working_pressure_angle):.4f} deg"),
        ("contact ratio", f"{pair.contact_ratio:.4f}"),
        ("normal backlash", f"{1e6 * pair.backlash + 0.0:.1f} µm"),
    ]
    data = table(("", "", "pinion", "wheel"), gear_rows) + table((), common)
    if pair.helix_angle:
        common.insert(1, ("helix angle", f"{math.degrees(pair.helix_angle):.6g} deg"))
        common.append(("overlap ratio", f"{pair.overlap_ratio:.4f}"))
    return f'<div style="display: flex; gap: 1em; flex-wrap: wrap"><div>{data}</div>{_drawing(pair)}</div>'


def closed_form_html(result: ClosedForm) -> str:
    """Stiffness of a closed form and the shares of its parts, at the ends and in the middle of the path."""
    total = np.atleast_1d(result.compliance)
    shown = sorted({0, total.size // 2, total.size - 1})
    names = [f"point {index + 1} of {total.size}" for index in shown]
    stiffness = np.atleast_1d(result.stiffness)
    rows = [("stiffness [N/m]", *(f"{stiffness[i]:.4g}" for i in shown))]
    for part, compliance in result.parts.items():
        share = 100.0 * np.broadcast_to(compliance, total.shape) / total
        rows.append((f"{part} [% of the deflection]", *(f"{share[i]:.1f}" for i in shown)))
    return f"<p>{escape(result.model)}, one pair of teeth; model error unknown</p>" + table(
        ("", *names), rows
    )


def _drawing(pair: GearPair) -> str:
    """Vector picture of both gears about the pitch point."""
    from gears.tooth.polygon import outline

    placed = pair.placement(pair.points.C)
    centre = placed.contact_point
    reach = 4.0 * pair.module
    shapes = []
    axes = (np.zeros(2), placed.wheel_centre)
    for place, axis, profile, colour in zip(
        (placed.pinion, placed.wheel), axes, pair.teeth_profiles, ("#4477aa", "#cc7733"), strict=True
    ):
        path = _path((place(outline(profile, None, 8)) - centre) / reach, (axis - centre) / reach)
        style = f'fill="{colour}" fill-opacity="0.3" stroke="{colour}" stroke-width="0.012"'
        shapes.append(f'<path d="{path}" {style}/>')
    name = escape(f"{pair.pinion.teeth} and {pair.wheel.teeth} teeth in mesh", quote=True)
    return f'<svg role="img" aria-label="{name}" viewBox="-1 -1 2 2" width="220" height="220">{"".join(shapes)}</svg>'


def _path(points: Array, axis: Array) -> str:
    """Outline as path data; teeth far outside the picture are cut off along lines to the axis."""
    ring = points[:-1]
    near = np.hypot(*ring.T) < 2.5
    if not near.all():
        start = int(np.flatnonzero(near & ~np.roll(near, 1))[0])
        ring = np.concatenate((np.roll(ring, -start, axis=0)[np.roll(near, -start)], [axis]))
    return "M" + " ".join(f"{x:.3f},{-y:.3f}" for x, y in ring) + "Z"
