"""Tooth profiles as files: points in CSV, drawings in DXF."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from flankfilm.dataset import write_csv, write_text

if TYPE_CHECKING:
    from gears.contour import Contour


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
    vertices = [
        (point, segment.bulge)
        for segment in contour.segments
        for point in (segment.points[:1] if segment.angle else segment.points[:-1])
    ]
    said = ("millimetres", f"chord error at most {1e6 * contour.tolerance:g} um, arcs exact", *remarks)
    groups: list[tuple[int, str]] = [(999, _ascii(text)) for text in said]
    groups += [(0, "SECTION"), (2, "HEADER"), (9, "$ACADVER"), (1, "AC1009"), (0, "ENDSEC")]
    groups += [(0, "SECTION"), (2, "ENTITIES")]
    groups += [(0, "POLYLINE"), (8, "CONTOUR"), (66, "1"), *_at(0.0, 0.0), (70, "1")]
    for (x, y), bulge in vertices:
        groups += [(0, "VERTEX"), (8, "CONTOUR"), *_at(1e3 * x, 1e3 * y)]
        if bulge:
            groups.append((42, f"{bulge:.15g}"))
    groups += [(0, "SEQEND"), (8, "CONTOUR")]
    if contour.bore_radius is not None:
        groups += [(0, "CIRCLE"), (8, "BORE"), *_at(0.0, 0.0), (40, f"{1e3 * contour.bore_radius:.12g}")]
    groups += [(0, "ENDSEC"), (0, "EOF")]
    write_text(path, "".join(f"{code:>3}\n{value}\n" for code, value in groups))
    return len(vertices)


def _at(x: float, y: float) -> tuple[tuple[int, str], ...]:
    return (10, f"{x:.12f}"), (20, f"{y:.12f}"), (30, "0.0")


def _ascii(text: str) -> str:
    """One line that any reader of release 12 takes."""
    return "".join(c if c.isascii() and c.isprintable() else "?" for c in text)[:255]
