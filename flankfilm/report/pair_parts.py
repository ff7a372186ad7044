"""Sections of the report about the geometry of the pair and its growth by heat; the geometry on the terminal."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from base.results import quantities
from flankfilm.figures.reading import Pictures, read, read_figure, travel
from flankfilm.output.geometry import Row, geometry_rows
from flankfilm.report.page import Drawing, Headline, Part, Table, pictures, said
from flankfilm.report.text import number

if TYPE_CHECKING:
    import xarray as xr

    from gears import GearPair, WarmPair

DECIMALS = {"mm": 4, "µm": 2, "um": 2, "N": 1, "N m": 2}
"""Lengths: to a tenth of a micrometre; deviations: to a hundredth; forces: to 0.1 N; other figures: five decimals."""

OF_BLANKS = ("pair_rim_thicknesses", "pair_web_thicknesses")
"""Figures that are left out for gears that are discs."""

HEADLINES = ("contact_ratio", "working_centre_distance", "working_pressure_angle", "backlash")
"""Figures of the pair for the head of a page without any others."""

IN_MESH: Pictures = {"gears_in_mesh": "outline_pinion"}
PATH: Pictures = {"kinematics": "path_rho2"}
LINES: Pictures = {"lines_of_contact": "contact_lines_length"}


def headlines(pair: GearPair) -> list[Headline]:
    """Numbers for the page's head."""
    readings = (read_figure(pair, name) for name in HEADLINES)
    note = "closed form, exact to rounding"
    return [
        Headline(
            reading.meaning,
            number(float(reading.values), 6),
            note,
            "" if reading.unit == "-" else reading.unit,
        )
        for reading in readings
    ]


def geometry(pair: GearPair, results: xr.Dataset) -> Part:
    """Geometry with tables; the pair in mesh is drawn in the page's head."""
    rows = _rows(results)
    undercut = ("yes" if tooth.undercut else "no" for tooth in pair.teeth_profiles)
    cells = [(read(results, row.name).label, *_cells(row)) for row in rows]
    path = ("path of contact A to E [mm]", *_aligned("mm", [float(travel(results, "path_point_rho1")[-1])]))
    common = (*(row for row in cells if len(row) == 2), path)
    of_gears = (*(row for row in cells if len(row) == 3), ("undercut", *undercut))
    drawn = pictures(results, {**PATH, **LINES})
    tables = [Table(("pair", ""), common), Table(("", "pinion", "wheel"), of_gears)]
    note = (
        "Thicknesses, span and size over pins include the thinning of the teeth; spans and pins touch near d + 2 x m, "
        "on the involute below any tip relief."
    )
    notes = [note]
    if pair.helix_angle:
        tables.append(_length_harmonics(results))
        pinion, wheel = ("right", "left") if pair.helix_angle > 0.0 else ("left", "right")
        notes.append(said("of_helix", pinion=pinion, wheel=wheel))
    return Part("geometry", "Geometry", figures=drawn, tables=tuple(tables), notes=tuple(notes), seen=0)


def _length_harmonics(results: xr.Dataset) -> Table:
    """Harmonics of the total length of the lines of contact."""
    orders, amplitudes = (read(results, f"contact_lines_{name}") for name in ("harmonic", "harmonics"))
    rows = zip(
        map(str, orders.values.tolist()), (number(a, 4) for a in amplitudes.values.tolist()), strict=True
    )
    return Table(("harmonic of the total length of the lines of contact", "over the mean"), tuple(rows))


def drawing(results: xr.Dataset) -> Drawing:
    """Drawing of the pair in mesh, for the page's head."""
    return replace(pictures(results, IN_MESH)[0], redraw=None)


def printed(results: xr.Dataset) -> list[str]:
    """Lines for the terminal: figures of the pair, then those of pinion and wheel beside each other."""
    rows = [(" ".join(read(results, row.name).label.split()), _cells(row)) for row in _rows(results)]
    wide = max((len(name) for name, _ in rows), default=0)
    return [f"{name:<{wide}}" + "".join(f"{cell:>12}" for cell in cells) for name, cells in rows]


def _rows(results: xr.Dataset) -> list[Row]:
    """Figures of the pair; those of rims and webs where a gear has one."""
    webs = results.get(OF_BLANKS[1])
    discs = webs is not None and np.allclose(webs, results["pair_face_width"], rtol=1e-12)
    return [row for row in geometry_rows(results) if not (discs and row.name in OF_BLANKS)]


def _cells(row: Row) -> tuple[str, ...]:
    return _aligned(row.unit, row.values)


def _aligned(unit: str, values: Sequence[float]) -> tuple[str, ...]:
    """Numbers of one row with the same decimals, as few as show all of them."""
    # z: what rounds to 0 has no sign
    texts = [f"{value:z.{DECIMALS.get(unit, 5)}f}" if math.isfinite(value) else "-" for value in values]
    spare = min((len(text) - len(text.rstrip("0")) for text in texts if text != "-"), default=0)
    return tuple((text[: len(text) - spare] if text != "-" else text).rstrip(".") for text in texts)


def heat(warm: WarmPair) -> Part:
    """Cold and warm backlash, pressure angle and base pitches."""
    names = [quantity.name for quantity in quantities(warm).values()]
    readings = [read_figure(warm, name) for name in names]
    rows = tuple((figure.label, number(float(figure.values), 6)) for figure in readings)
    note = (
        "All other figures are of the gears expanded to their temperatures. Unequal base pitches act as a gap that "
        "increases along the path of contact, in the loaded contact by finite elements of coupled pairs."
    )
    return Part("heat", "Thermal expansion", notes=(note,), tables=(Table(("pair", ""), rows),))
