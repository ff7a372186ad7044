"""Further mesh cycles of a scene: at several torques, and tooth by tooth over the teeth that it follows."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

import fem
from base.results import figures
from flankfilm import coupling
from flankfilm.figures.reading import Pictures, read
from flankfilm.output.variables import of_record
from flankfilm.products.product import CurveTable, Product, record_of, section_of, wanting, when
from flankfilm.report.page import Part, Table, pictures
from flankfilm.report.text import number, percent
from flankfilm.stages.engine import Engine, stage
from flankfilm.stages.mesh import COMPLIANCE, DRY_CYCLE, FACE_GEARS, TEETH, loaded_teeth

if TYPE_CHECKING:
    import xarray as xr

    from flankfilm.coupling import TorqueCurves

OF_TORQUES: Pictures = {"over_torque": "torque_transmission_error"}


@stage("torques", "mesh cycles over torque", TEETH, COMPLIANCE, FACE_GEARS, DRY_CYCLE)
def TORQUES(run: Engine) -> coupling.TorqueCurves:
    """Mesh cycles at the scene's torques from one compliance."""
    torques = run.scene.operating.torques_Nm if run.scene.operating else ()
    return coupling.torque_curves(loaded_teeth(run, by_elements=True), torques, run[DRY_CYCLE].position.size)


def over_torque(stage: TorqueCurves, results: xr.Dataset) -> Part:
    """Stiffness and transmission error over torque."""
    names = ("secant_stiffness", "tangent_stiffness", "transmission_error", "harmonic_1")
    curves = [read(results, f"torque_{name}", per_face=name.endswith("stiffness")) for name in names]
    shown = [read(results, "torque"), *curves]
    cells = zip(*([number(value, 5) for value in reading.values.tolist()] for reading in shown), strict=True)
    errors = {"stiffness": stage.error, "peak to peak": stage.range_error}
    caption = "Largest numerical errors: " + ", ".join(f"{n} {percent(e)}" for n, e in errors.items()) + "."
    table = Table(tuple(reading.label for reading in shown), tuple(cells), caption)
    drawn = pictures(results, OF_TORQUES)
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


OVER_TORQUE = Product(
    name="torques",
    goals=wanting("torques", TORQUES),
    variables=record_of("torque", TORQUES),
    solved={"torque": TORQUES},
    tables={"torques": CurveTable("torque", "torque", axis="torque")},
    pictures=OF_TORQUES,
    sections=section_of(TORQUES, over_torque),
)


OF_REVOLUTION: Pictures = {"revolution": "revolution_transmission_error"}


@stage("revolution", "mesh cycle tooth by tooth", TEETH, COMPLIANCE, FACE_GEARS)
def REVOLUTION(run: Engine) -> fem.MeshCycle:
    """Mesh cycle tooth by tooth, with the deviations of each."""
    operating = run.scene.operating
    assert operating is not None
    teeth = loaded_teeth(run, by_elements=True, every_tooth=True)
    return coupling.revolution(teeth, operating.pitches, operating.first_teeth)


def over_revolution(cycle: fem.MeshCycle) -> Iterator[xr.Dataset]:
    """Curves alone: what follows from arcs is not looked for over a revolution."""
    from gears.sharing.mesh_figures import MeshFigures

    known = [name for name in figures(type(cycle)) if name not in vars(MeshFigures)]
    yield of_record("revolution", cycle, known)


def tooth_by_tooth(cycle: fem.MeshCycle, results: xr.Dataset) -> Part:
    """Transmission error tooth by tooth."""
    drawn = pictures(results, OF_REVOLUTION)
    curves = {
        "under load": read(results, "revolution_transmission_error"),
        "without load": read(results, "revolution_unloaded_transmission_error"),
    }
    rows = tuple((label, number(float(np.ptp(curve.values)))) for label, curve in curves.items())
    caption = (
        f"Numerical error of the mesh: {percent(cycle.error)}; extremes are taken at the positions drawn."
    )
    table = Table(("transmission error", curves["under load"].named("peak to peak")), rows, caption)
    return Part("revolution", "Revolution", figures=drawn, tables=(table,), notes=(cycle.message,))


TOOTH_BY_TOOTH = Product(
    name="revolution",
    goals=wanting("revolution", REVOLUTION),
    variables=when(REVOLUTION, over_revolution),
    solved={"revolution": REVOLUTION},
    tables={
        "revolution": CurveTable(
            "revolution",
            "position",
            ("position", "transmission_error", "unloaded_transmission_error", "secant_stiffness"),
        )
    },
    pictures=OF_REVOLUTION,
    sections=section_of(REVOLUTION, tooth_by_tooth),
)
