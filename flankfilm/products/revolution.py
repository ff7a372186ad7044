"""Transmission error tooth by tooth, over the teeth that a scene follows."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

import fem
from base.results import figures
from flankfilm import coupling
from flankfilm.figures.reading import Pictures, read
from flankfilm.output.variables import of_record
from flankfilm.products.product import CurveTable, Product, section_of, wanting, when
from flankfilm.report.page import Part, Table, pictures
from flankfilm.report.text import number, percent
from flankfilm.stages.engine import Engine, stage
from flankfilm.stages.mesh import COMPLIANCE, FACE_GEARS, TEETH, loaded_teeth

if TYPE_CHECKING:
    import xarray as xr

PICTURES: Pictures = {"revolution": "revolution_transmission_error"}


@stage("revolution", "mesh cycle tooth by tooth", TEETH, COMPLIANCE, FACE_GEARS)
def REVOLUTION(run: Engine) -> fem.MeshCycle:
    """Mesh cycle tooth by tooth, with the deviations of each."""
    operating = run.scene.operating
    assert operating is not None
    teeth = loaded_teeth(run, by_elements=True, every_tooth=True)
    return coupling.revolution(teeth, operating.pitches, operating.first_teeth)


def variables(cycle: fem.MeshCycle) -> Iterator[xr.Dataset]:
    """Curves alone: what follows from arcs is not looked for over a revolution."""
    from gears.sharing.mesh_figures import MeshFigures

    known = [name for name in figures(type(cycle)) if name not in vars(MeshFigures)]
    yield of_record("revolution", cycle, known)


def section(cycle: fem.MeshCycle, results: xr.Dataset) -> Part:
    """Transmission error tooth by tooth."""
    drawn = pictures(results, PICTURES)
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


PRODUCT = Product(
    name="revolution",
    goals=wanting("revolution", REVOLUTION),
    variables=when(REVOLUTION, variables),
    solved={"revolution": REVOLUTION},
    tables={
        "revolution": CurveTable(
            "revolution",
            "position",
            ("position", "transmission_error", "unloaded_transmission_error", "secant_stiffness"),
        )
    },
    pictures=PICTURES,
    sections=section_of(REVOLUTION, section),
)
