"""Root stress over the face in scenes, with shafts, films, unequal widths and contacts that move."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import pytest

from flankfilm.building.preflight import refuse
from flankfilm.files.cache import Cache
from flankfilm.products import root_stress
from flankfilm.products.root_stress import ROOT_STRESS
from flankfilm.runs.dataset import results_dataset
from flankfilm.scene import parse_scene
from flankfilm.stages.computed import Computed
from flankfilm.stages.engine import Engine
from flankfilm.stages.mesh import DRY_CYCLE, FILM, MESH, PAIR
from flankfilm.studies.outputs import OUTPUTS
from tests.flankfilm.scenes import ishikawa

SCENE = "tolerance = 0.05\n" + (
    ishikawa("Roots", "root-stress")
    .replace('model = "ishikawa"\npairs = "independent"\n', "")
    .replace("teeth = 36", "teeth = 20")
    .replace("teeth = 40", "teeth = 30")
    .replace("width_mm = 40", "width_mm = 20")
    .replace("Nm = 600", "Nm = 100")
)
CELLS = 'cells = 8\nface_model = "walls"\n'
ALIGNED = f"[alignment]\nin_plane_um = 20\n{CELLS}"
SHAFTS = (
    "[shafts.pinion]\nsegments = [{length_mm = 200, diameter_mm = 25}]\ngear_position_mm = 50\n"
    "bearings = [{position_mm = 5, stiffness_N_per_m = 5e8}, "
    "{position_mm = 195, stiffness_N_per_m = 5e8}]\n"
    f"[alignment]\n{CELLS}"
)
OIL = (
    "[lubricant]\nviscosity_Pa_s = 0.075\npressure_viscosity_per_GPa = 19.6\ntemperature_C = 80\n"
    '[film]\nmodel = "dowson"\n'
)
WET = SCENE.replace('["root-stress"]', '["film", "root-stress"]').replace(
    "pinion_torque_Nm = 100", "pinion_torque_Nm = 100\npinion_speed_rpm = 2000"
)
PLASTIC = (
    SCENE.replace("[material]", "[material.pinion]")
    .replace("Nm = 100", "Nm = 4")
    .replace(
        "[operating]",
        "[material.wheel]\nyoungs_modulus_GPa = 3\npoisson_ratio = 0.4\n[operating]",
    )
)
UNEQUAL = SCENE.replace("teeth = 30", "teeth = 30, face_width_mm = 22, face_offset_mm = 1")


def ran(text: str) -> Engine:
    scene = parse_scene(text)
    refuse(scene)
    engine = Engine(scene, Cache(None))
    for stage in (PAIR, DRY_CYCLE, MESH, ROOT_STRESS):
        engine[stage]
    return engine


COMBINED = {
    "contacts that move": PLASTIC + ALIGNED,
    "shafts": SCENE + SHAFTS,
    "unequal widths": UNEQUAL + ALIGNED,
    "shafts, films, unequal widths": WET.replace("teeth = 30", "teeth = 30, face_width_mm = 22")
    + SHAFTS
    + OIL,
}


@pytest.mark.long
@pytest.mark.slow
@pytest.mark.parametrize("name", COMBINED)
def test_root_stress_over_the_face_with_what_else_varies_the_load(name):
    engine = ran(COMBINED[name])
    found, face = engine[ROOT_STRESS], engine[MESH].contact.face
    values: Mapping[str, Any] = {one.name: engine[one] for one in (PAIR, DRY_CYCLE, ROOT_STRESS)}
    data = results_dataset(Computed(engine.scene, values))
    part = root_stress.section(found, data)
    for gear in ("pinion", "wheel"):
        over = getattr(found.stress, gear).face
        # the end that the axes close, or the shaft's bending, has the greatest stress
        assert np.argmax(over.cycle_tension) < 0.5 * len(over.cycle_tension)
        assert 1.02 < over.over_even < face.greatest_face_load_factor
        assert 0.0 < over.tension_error < 0.1
        assert float(data[f"root_face_{gear}_over_even"]) == over.over_even
        assert OUTPUTS[f"root_over_even_{gear}"].value(engine) == over.over_even
    said = part.notes[1]
    assert ("bending and twist of the shafts" in said) == ("shafts" in name)
    assert ("what overhangs bear" in said) == ("unequal" in name)
    assert engine[MESH].contact.moving_contact == ("move" in name)
    if "films" in name:
        assert engine[FILM].over_face is not None
