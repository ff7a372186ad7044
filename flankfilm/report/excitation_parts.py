"""Sections of the report about the unloaded transmission error and about the orders of the motion."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from flankfilm.figures.motion import rpm_text, scale
from flankfilm.report.page import Part, Table, pictures, said
from flankfilm.report.text import counted, number, percent

if TYPE_CHECKING:
    import xarray as xr

    from flankfilm.coupling import ErrorSeries, MotionSpectrum

LISTED = 12
"""Harmonics and lines that a table lists; the data files hold all."""


def excitation(stage: ErrorSeries, results: xr.Dataset) -> Part:
    """Harmonics of the unloaded transmission error."""
    rows = tuple(
        (str(j), number(1e6 * e), f"{np.degrees(phase):.2f}")
        for j, (e, phase) in enumerate(zip(stage.amplitude[:LISTED], stage.phase, strict=False), start=1)
    )
    table = Table(("harmonic", "amplitude [µm]", "phase [deg]"), rows)
    omitted = stage.motion_left
    motion = "" if omitted is None else said("excitation_motion", left=percent(omitted))
    meshes = counted(stage.meshes, "base pitch", "base pitches")
    notes = [
        said("excitation", order=stage.order, meshes=meshes, left=percent(stage.remainder), motion=motion),
        said("phases"),
        *([] if stage.converged else [stage.message]),
    ]
    text = f"{stage.source[:1].upper()}{stage.source[1:]}, peak to peak {number(1e6 * stage.range)} µm."
    drawn = pictures(results, "excitation")
    return Part("excitation", "Unloaded transmission error", (text,), drawn, (table,), tuple(notes))


def spectrum(stage: MotionSpectrum, results: xr.Dataset) -> Part:
    """Draw the orders of the motion, and list the largest lines."""
    force, length = scale(results, "force"), scale(results, "length")
    largest = np.argsort(-np.nan_to_num(stage.displacement), kind="stable")[:LISTED]
    rows = tuple(
        (
            f"{stage.order[k]:.6g}",
            number(float(force.values) * float(stage.force[k])),
            number(float(length.values) * float(stage.displacement[k])),
        )
        for k in sorted(largest.tolist())
    )
    heads = ("mesh order", force.named("force, amplitude"), length.named("displacement, amplitude"))
    meshes = counted(stage.meshes, "mesh", "meshes")
    notes = [
        said(
            "spectrum",
            speed=rpm_text(results),
            motion=stage.motion,
            meshes=meshes,
            part=percent(stage.sidebands),
            error=percent(stage.error),
        )
    ]
    if stage.error_left_out is not None:
        orders = float(stage.error_order[-1])
        notes.append(said("spectrum_revolution", orders=orders, left=percent(stage.error_left_out)))
    notes += [] if stage.converged else [stage.message]
    drawn = pictures(results, "spectrum")
    return Part(
        "spectrum", "Orders of the motion", figures=drawn, tables=(Table(heads, rows),), notes=tuple(notes)
    )
