"""Section of the report about the load along the lines of contact of a helical pair."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from flankfilm.figures.reading import Pictures, read_figure
from flankfilm.output.uncertainty import uncertainty
from flankfilm.report.face_parts import rows_of_shafts
from flankfilm.report.page import Headline, Part, Table, pictures, said
from flankfilm.report.text import number, percent, plus_minus

if TYPE_CHECKING:
    import xarray as xr

    import fem

PICTURES: Pictures = {"line_load_map": "dry_lines_line_load", "load_centre": "dry_lines_load_centre"}

NONE = "-"
"""Unit of what has none, as readings have it."""

HEADLINES = ("greatest_line_load_factor", "greatest_line_load")


def lines(loads: fem.LineLoads, results: xr.Dataset, tip_edges: bool) -> Part:
    """Maps of the flanks, and what the lines carry at most; whether tip edges may touch beyond the path is said."""
    return Part(
        "lines",
        "Load along the lines of contact",
        figures=pictures(results, PICTURES),
        tables=(Table(("over the mesh cycle", "value"), tuple(_rows(loads))),),
        notes=(said("lines", contact=said("lines_beyond_path" if tip_edges else "lines_held_to_path")),),
    )


def headlines(loads: fem.LineLoads) -> Iterator[Headline]:
    """Numbers for the page's head."""
    for name in HEADLINES:
        shown = read_figure(loads, name)
        unit = "" if shown.unit == NONE else shown.unit
        value = number(float(shown.values))
        yield Headline(shown.meaning, value, unit=unit, uncertainty=uncertainty(loads, name))


def _rows(loads: fem.LineLoads) -> Iterator[tuple[str, str]]:
    for name, error in (
        ("greatest_line_load_factor", loads.error),
        ("greatest_line_load", loads.line_load_error),
    ):
        shown = read_figure(loads, name)
        unit = "" if shown.unit == NONE else f" {shown.unit}"
        yield shown.meaning, f"{number(float(shown.values))}{unit} {plus_minus(error)}"
    pressure = read_figure(loads, "hertz_pressure")
    yield f"maximum {pressure.meaning}", f"{number(float(np.nanmax(pressure.values)))} {pressure.unit}"
    axial = read_figure(loads, "axial_force")
    yield axial.meaning, f"{number(float(axial.values))} {axial.unit}"
    centre = read_figure(loads, "load_centre")
    ends = " to ".join(number(float(end), 3) for end in (centre.values.min(), centre.values.max()))
    off = number(1e3 * loads.centre_error, 2)
    yield centre.meaning, f"{ends} {centre.unit}, ± {off} {centre.unit}"
    moment = read_figure(loads, "tilting_moment")
    for name, values in zip(("pinion", "wheel"), moment.values, strict=True):
        ends = " to ".join(number(float(end), 3) for end in (values.min(), values.max()))
        yield f"tilting moment on the {name}", f"{ends} {moment.unit}"
    yield "contact pattern: part of the lines in contact", percent(loads.contact_pattern, 3)
    yield from rows_of_shafts(loads)
