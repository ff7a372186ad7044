"""Stiffness and transmission error over torque."""

from __future__ import annotations

from typing import TYPE_CHECKING

from flankfilm import coupling
from flankfilm.figures.reading import Pictures, read
from flankfilm.products.product import CurveTable, Product, record_of, section_of, wanting
from flankfilm.report.page import Part, Table, pictures
from flankfilm.report.text import number, percent
from flankfilm.stages.engine import Engine, stage
from flankfilm.stages.mesh import COMPLIANCE, DRY_CYCLE, FACE_GEARS, TEETH, loaded_teeth

if TYPE_CHECKING:
    import xarray as xr

    from flankfilm.coupling import TorqueCurves

PICTURES: Pictures = {"over_torque": "torque_transmission_error"}


@stage("torques", "mesh cycles over torque", TEETH, COMPLIANCE, FACE_GEARS, DRY_CYCLE)
def TORQUES(run: Engine) -> coupling.TorqueCurves:
    """Mesh cycles at the scene's torques from one compliance."""
    torques = run.scene.operating.torques_Nm if run.scene.operating else ()
    return coupling.torque_curves(loaded_teeth(run, by_elements=True), torques, run[DRY_CYCLE].position.size)


def section(stage: TorqueCurves, results: xr.Dataset) -> Part:
    """Stiffness and transmission error over torque."""
    names = ("secant_stiffness", "tangent_stiffness", "transmission_error", "harmonic_1")
    curves = [read(results, f"torque_{name}", per_face=name.endswith("stiffness")) for name in names]
    shown = [read(results, "torque"), *curves]
    cells = zip(*([number(value, 5) for value in reading.values.tolist()] for reading in shown), strict=True)
    errors = {"stiffness": stage.error, "peak to peak": stage.range_error}
    caption = "Largest numerical errors: " + ", ".join(f"{n} {percent(e)}" for n, e in errors.items()) + "."
    table = Table(tuple(reading.label for reading in shown), tuple(cells), caption)
    drawn = pictures(results, PICTURES)
    notes = (f"Left out: {stage.message}",) if stage.message else ()
    orders = stage.transmission_error_harmonic
    waves = [read(results, f"torque_transmission_error_harmonic_{order}") for order in orders]
    rows = zip(
        *([number(value, 4) for value in reading.values.tolist()] for reading in (shown[0], *waves)),
        strict=True,
    )
    heads = (shown[0].label, *(waves[0].named(f"harmonic {order}") for order in orders))
    off = read(results, "torque_harmonics_error")
    caption = f"Amplitudes of the transmission error's harmonics, ± {number(float(off.values.max()), 2)} {off.unit}."
    tables = (table, Table(heads, tuple(rows), caption))
    return Part("torques", "Torque", figures=drawn, tables=tables, notes=notes)


PRODUCT = Product(
    name="torques",
    goals=wanting("torques", TORQUES),
    variables=record_of("torque", TORQUES),
    solved={"torque": TORQUES},
    tables={"torques": CurveTable("torque", "torque", axis="torque")},
    pictures=PICTURES,
    sections=section_of(TORQUES, section),
)
