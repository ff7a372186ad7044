"""Orders of the motion at the operating speed, with sidebands of a revolution."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from base import InputError
from flankfilm import coupling
from flankfilm.building.pair import pinion_torque
from flankfilm.figures.reading import Pictures
from flankfilm.output.drives import carrying
from flankfilm.products.output import Named, outputs_from
from flankfilm.products.product import CurveTable, Product, section_of, wanting, when
from flankfilm.report.page import Part, Table, pictures, said
from flankfilm.report.text import counted, number, percent
from flankfilm.stages.drives import DRIVE, moving
from flankfilm.stages.engine import Engine, stage
from flankfilm.stages.excitation import REVOLUTION_ERROR
from flankfilm.stages.motion import SCALING

if TYPE_CHECKING:
    import xarray as xr

LISTED = 12
"""Lines that a table lists; the data files hold all."""

PICTURES: Pictures = {"spectrum": "spectrum_force"}


@stage(
    "spectrum",
    "orders of the motion at the speed, with sidebands of a revolution",
    "operating dynamics",
    SCALING,
    DRIVE,
    REVOLUTION_ERROR,
    kept="dynamics flankfilm gears",
)
def SPECTRUM(run: Engine) -> coupling.MotionSpectrum:
    """Spectrum of the motion at the scene's speed; over a revolution where teeth differ."""
    motion = moving(run)
    error = None if motion.scales is None else run[REVOLUTION_ERROR]
    if error is not None and pinion_torque(run.scene) < 0.0:
        allowed = "must be positive for a spectrum with deviations of single teeth, which are those of the front flanks"
        raise InputError.at(
            "operating.pinion_torque_Nm", "negative", allowed, "leave spectrum out, or the pitches"
        )
    return coupling.mesh_spectrum(motion, error)


def section(stage: coupling.MotionSpectrum, results: xr.Dataset) -> Part:
    """Draw the orders of the motion, and list the largest lines."""
    from flankfilm.figures.motion import rpm_text, scale  # which loads matplotlib

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
    drawn = pictures(results, PICTURES)
    return Part(
        "spectrum", "Orders of the motion", figures=drawn, tables=(Table(heads, rows),), notes=tuple(notes)
    )


def outputs() -> tuple[Named, ...]:
    """Numbers that a study can ask for."""
    of_lines = outputs_from(lambda engine: engine[SPECTRUM], coupling.MotionSpectrum, "spectrum")
    return (of_lines("sidebands"),)


PRODUCT = Product(
    name="spectrum",
    goals=wanting("spectrum", SPECTRUM),
    variables=when(SPECTRUM, lambda lines: [carrying("spectrum", lines)]),
    solved={"spectrum": SPECTRUM},
    tables={"spectrum": CurveTable("spectrum", "force", axis="line")},
    pictures=PICTURES,
    sections=section_of(SPECTRUM, section),
    outputs=outputs,
)
