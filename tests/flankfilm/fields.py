"""A small run with fields for ParaView, which pictures and pages of the loaded teeth are drawn from."""

from __future__ import annotations

from pathlib import Path

from fem.fields.vtk import write_vtk_series
from flankfilm.files.cache import Cache
from flankfilm.runs.dataset import results_dataset, write_data
from flankfilm.scene import parse_scene
from flankfilm.stages.computed import Computed
from flankfilm.stages.engine import Engine
from flankfilm.stages.mesh import COMPLIANCE, DRY_CYCLE, FIELDS, MESH, PAIR

SCENE = """
title = "A pair <b> that turns"
wants = ["stiffness", "vtk"]
tolerance = 0.05
[pair]
module_mm = 2.0
face_width_mm = 40.0
pinion = { teeth = 23, bore_mm = 20 }
wheel = { teeth = 25, bore_mm = 20 }
[material]
youngs_modulus_GPa = 206
poisson_ratio = 0.3
[operating]
pinion_torque_Nm = 300
[film]
model = "none"
"""


def write_run(folder: Path) -> Path:
    """Write results and three positions for ParaView."""
    engine = Engine(parse_scene(SCENE), Cache(None))
    for stage in (DRY_CYCLE, MESH, FIELDS):
        engine[stage]
    write_data(folder, results_dataset(Computed(engine.scene, engine.results())))
    write_vtk_series(folder, engine[PAIR], engine[MESH].contact, engine[COMPLIANCE], (0, 40, 80))
    return folder
