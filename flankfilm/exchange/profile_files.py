"""Tooth profiles as files: points in CSV, drawings in DXF."""

from __future__ import annotations

from io import StringIO
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from flankfilm.output.files import write_csv, write_text

if TYPE_CHECKING:
    from gears.tooth.contour import Contour


def write_points(path: Path, contour: Contour) -> int:
    """Write a contour as a closed polygon: columns part, x_mm, y_mm; return the number of points."""
    points, parts = contour.polygon()
    x, y = 1e3 * points.T
    write_csv(path, {"part": np.asarray(parts), "x_mm": x, "y_mm": y})
    return len(parts)


def write_drawing(path: Path, contour: Contour, remarks: tuple[str, ...] = ()) -> int:
    """Write a contour as a drawing (DXF, release 12, ASCII, millimetres); return the number of vertices.

    One closed polyline on the layer CONTOUR; its arcs are exact, as bulges of their vertices. The bore of a
    whole gear is a circle on the layer BORE.

    Parameters
    ----------
    path : Path
    contour : Contour
    remarks : tuple of str
        Comments at the head of the file.
    """
    from ezdxf.addons.r12writer import r12writer

    vertices = [
        (1e3 * x, 1e3 * y, segment.bulge)
        for segment in contour.segments
        for x, y in (segment.points[:1] if segment.angle else segment.points[:-1]).tolist()
    ]
    said = ("millimetres", f"chord error at most {1e6 * contour.tolerance:g} um, arcs exact", *remarks)
    text = StringIO()
    text.writelines(f"999\n{_ascii(remark)}\n" for remark in said)
    with r12writer(text, fixed_tables=True) as drawing:
        drawing.add_polyline_2d(vertices, format="xyb", closed=True, layer="CONTOUR")
        if contour.bore_radius is not None:
            drawing.add_circle((0.0, 0.0), 1e3 * contour.bore_radius, layer="BORE")
    write_text(path, text.getvalue())
    return len(vertices)


def _ascii(text: str) -> str:
    """One line that any reader of release 12 takes."""
    return "".join(c if c.isascii() and c.isprintable() else "?" for c in text)[:255]
