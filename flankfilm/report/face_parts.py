"""Section of the report about the load over the face."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from flankfilm.coupling.mesh.face_models import LABELS
from flankfilm.figures.reading import Pictures, read_figure
from flankfilm.output.uncertainty import uncertainty
from flankfilm.report.page import Headline, Part, Table, pictures, said
from flankfilm.report.text import number, percent, plus_minus

if TYPE_CHECKING:
    import xarray as xr

    import fem
    from flankfilm.coupling import FaceLoadModels

GREATEST = "maximum face-load factor"

MODELS: Pictures = {"line_load_models": "face_models_line_load"}
PICTURES: Pictures = {"flank_map": "dry_face_travel", "face_load_factor": "dry_face_travel", **MODELS}


def face(loads: fem.FaceLoads, models: FaceLoadModels | None, results: xr.Dataset) -> Part:
    """Flank maps, the face-load factor along the path, and other models beside it."""
    drawn = pictures(results, PICTURES, model=LABELS[loads.setting.model])
    tables, notes = [_bears(loads)], [said("face")]
    if models is not None:
        tables.append(models_table(models))
        notes += _failing(models)
    return Part("face", "Load over the face", (_made_of(loads),), drawn, tuple(tables), tuple(notes))


def beside(models: FaceLoadModels, results: xr.Dataset) -> Part:
    """Other models of the load over the face alone, for a verification."""
    drawn = pictures(results, MODELS)
    tables, notes = (models_table(models),), tuple(_failing(models))
    return Part("face", "Load over the face", figures=drawn, tables=tables, notes=notes)


def headlines(loads: fem.FaceLoads) -> list[Headline]:
    """Numbers for the page's head."""
    load = read_figure(loads, "greatest_line_load")
    factor = number(loads.greatest_face_load_factor)
    note = f"{LABELS[loads.setting.model]}, {loads.setting.cells} cells"
    of_factor, of_load = (
        uncertainty(loads, name) for name in ("greatest_face_load_factor", "greatest_line_load")
    )
    return [
        Headline(GREATEST, factor, note, uncertainty=of_factor),
        Headline(load.meaning, number(float(load.values)), unit=load.unit, uncertainty=of_load),
    ]


def _made_of(loads: fem.FaceLoads) -> str:
    """Causes of the variation of the load."""
    setting, parts = loads.setting, []
    for name, lead in zip(("pinion", "wheel"), setting.leads, strict=True):
        for what, value in (
            ("crowning", lead.crowning),
            ("lead slope", lead.slope),
            ("end relief", lead.end_relief),
            ("flank twist", lead.twist),
        ):
            if value:
                parts.append(f"{what} of the {name} {number(1e6 * value)} µm")
        if lead.trace is not None:
            low, high = min(lead.trace.material), max(lead.trace.material)
            parts.append(
                f"measured lead of the {name}, {number(1e6 * low)} to {number(1e6 * high)} µm of material"
            )
        if lead.topography is not None:
            heights = [height for row in lead.topography.material for height in row]
            low, high = min(heights), max(heights)
            parts.append(
                f"topography of the {name}, {number(1e6 * low)} to {number(1e6 * high)} µm of material"
            )
    for plane, value in (("in", setting.alignment.in_plane), ("across", setting.alignment.out_of_plane)):
        if value:
            parts.append(f"axes {number(1e6 * value)} µm out of parallel {plane} the plane of action")
    bent = [
        name for name, shaft in zip(("pinion", "wheel"), setting.shafts, strict=True) if shaft is not None
    ]
    if bent:
        parts.append(
            f"bending and twist of the shaft of {' and '.join(f'the {name}' for name in bent)} under the load"
        )
    made = "; ".join(parts) or "straight leads and parallel axes, so that only the ends cause variation"
    return said("face_made_of", made=made, cells=setting.cells, model=LABELS[setting.model])


def _bears(loads: fem.FaceLoads) -> Table:
    """Maximum values over path and face, and the contact pattern."""
    return Table(("over path and face", "value"), tuple(_rows(loads)))


def _rows(loads: fem.FaceLoads) -> Iterator[tuple[str, str]]:
    off, factor = plus_minus(loads.error), loads.face_load_factor
    yield GREATEST, f"{number(loads.greatest_face_load_factor)} {off}"
    yield "mean of the face-load factor over the cycle", f"{number(float(factor.mean()))} {off}"
    load = read_figure(loads, "greatest_line_load")
    *_, cell = np.unravel_index(np.argmax(loads.line_load), loads.line_load.shape)
    yield load.meaning, f"{number(float(load.values))} {load.unit} {plus_minus(loads.line_load_error)}"
    at = f"{number(1e3 * float(loads.face_position[cell]), 3)} mm"
    yield "its place on the face, from the middle", at
    pressure = read_figure(loads, "hertz_pressure")
    yield f"maximum {pressure.meaning}", f"{number(float(np.nanmax(pressure.values)))} {pressure.unit}"
    yield "contact pattern: part of the face in contact", percent(loads.contact_pattern, 3)
    yield from rows_of_shafts(loads)


def rows_of_shafts(loads: fem.FaceLoads | fem.LineLoads) -> Iterator[tuple[str, str]]:
    """Deflection and tilt of shafts, and their parts of the transmission error; nothing for rigid shafts."""
    if loads.shaft_deflection is None or loads.shaft_misalignment is None:
        return
    if loads.shaft_error is None or loads.tilt_error is None:
        return
    errors = plus_minus(loads.shaft_error), plus_minus(loads.tilt_error)
    for gear, name in enumerate(("pinion", "wheel")):
        for what, values, off in (
            ("deflection along the line of action", loads.shaft_deflection[gear], errors[0]),
            ("misalignment over the face", loads.shaft_misalignment[gear], errors[1]),
        ):
            if np.any(values):
                size = number(1e6 * float(values[np.argmax(np.abs(values))]))
                yield f"maximum {what} by the shaft of the {name}", f"{size} µm {off}"
    parts = loads.shaft_transmission_error, loads.tilt_transmission_error
    for name, part, off in zip(("shafts", "shafts' tilt"), parts, errors, strict=True):
        if part is not None:
            ends = " to ".join(number(1e6 * float(end)) for end in (part.min(), part.max()))
            yield f"part of the transmission error by the {name}", f"{ends} µm {off}"


def models_table(models: FaceLoadModels) -> Table:
    """Factors by every model, and the difference of its line load from that of the first model."""
    columns = zip(
        models.model,
        models.face_load_factor,
        models.face_load_factor_error,
        models.pitch_point_factor,
        models.factor_difference,
        1e-3 * models.greatest_line_load,
        models.line_load_difference,
        strict=True,
    )
    rows = tuple(
        (
            label,
            f"{number(whole)} {plus_minus(error)}" if np.isfinite(error) else number(whole),
            number(at_c),
            _signed(off) if label != models.model[0] else "-",
            number(load),
            percent(apart) if apart else "-",
        )
        for label, whole, error, at_c, off, load, apart in columns
    )
    heads = (
        "model",
        "maximum face-load factor",
        "at the pitch point",
        "differs from the first",
        "maximum line load [N/mm]",
        "line load differs from the first, root mean square",
    )
    return Table(heads, rows, "± is the numerical error only; the error of the model is not included.")


def _failing(models: FaceLoadModels) -> Iterator[str]:
    """Differences of slices and ISO 6336-1 from the first model, in numbers."""
    off = dict(zip(models.model, models.factor_difference, strict=True))
    first, (slices, iso) = models.model[0], (LABELS["slices"], models.model[-1])
    yield said("face_slices", off=_signed(off[slices]), first=first)
    if models.iso_fault:
        yield f"ISO 6336-1 gives no result: {models.iso_fault}"
    else:
        slope = number(1e6 * abs(models.misalignment), 3)
        yield said(
            "face_iso", off=_signed(off[iso]), first=first, misalignment=slope, left_out=models.iso_left_out
        )


def _signed(part: float) -> str:
    return f"{100 * part:+.1f} %"
