"""Scenes that want a run-up or a map over speed and torque: variables, pictures, report, faults."""

from __future__ import annotations

import pytest

from base import InputError
from flankfilm import figures
from flankfilm.files.cache import Cache
from flankfilm.runs.run_scene import run_scene
from flankfilm.scene import parse_scene
from flankfilm.stages.engine import Engine
from flankfilm.studies.outputs import OUTPUTS
from tests.flankfilm.scenes import ARTICLE
from tests.flankfilm.shown import part_of

HEAD = ARTICLE.replace("pinion_torque_Nm = 600", "pinion_torque_Nm = 600\ntorques_Nm = [300, 600]")
SCENE = f"""
wants = ["run-up", "dynamic-map"]
tolerance = 0.02
{HEAD}
[stiffness]
model = "potential-energy"
[dynamics]
error_amplitude_um = [5, 1]
sweep = {{ speed_rpm = [3000, 12000], points = 6 }}
run_up = {{ speed_rpm = [3000, 4000], periods = 320 }}
"""


def test_run_up_and_map_of_a_scene():
    found = run_scene(parse_scene(SCENE), None)
    data = found.dataset
    assert found.failures == ()
    assert data.dynamic_map_factor.shape == (2, 6)
    assert data.dynamic_map_torque.values.tolist() == [300.0, 600.0]
    assert data.run_up_force_factor_up.size == 20
    assert data.run_up_order_force_down.shape == (20, 96)
    for draw in (figures.run_up, figures.waterfall, figures.dynamic_map):
        assert draw(data).axes
    for name in ("run-up", "dynamic-map"):
        part = part_of(found, name)
        assert part.figures
        assert part.tables[0].rows
    engine = Engine(parse_scene(SCENE), Cache(None))
    engine._values.update(found.values)
    assert OUTPUTS["greatest_map_factor"].value(engine) == float(data.dynamic_map_factor.max())
    assert OUTPUTS["greatest_run_up_factor"].value(engine) > 1.0


@pytest.mark.slow
def test_films_soften_the_mesh_of_run_up_and_map():
    """The series is that of teeth and films in series, so that resonance moves by the root of the mean stiffness."""
    film = SCENE + '[film]\nmodel = "dowson"\n'
    dry, wet = (run_scene(parse_scene(text), None) for text in (SCENE + '[film]\nmodel = "none"\n', film))
    assert dry.failures == wet.failures == ()
    means = [run.values["fourier"].mean for run in (dry, wet)]
    assert means[1] < means[0]
    for at, torque in enumerate((300.0, 600.0)):
        assert wet.dataset.dynamic_map_torque.values[at] == torque
        assert wet.dataset.dynamic_map_resonance.values[at] < dry.dataset.dynamic_map_resonance.values[at]
    moved = float(wet.dataset.dynamic_map_resonance[1] / dry.dataset.dynamic_map_resonance[1])
    assert moved == pytest.approx((means[1] / means[0]) ** 0.5, rel=1e-9)
    speeds = [run.dataset.run_up_frequency_up.values for run in (dry, wet)]
    assert speeds[1] / speeds[0] == pytest.approx((means[0] / means[1]) ** 0.5, rel=1e-6)


@pytest.mark.parametrize(
    ("old", "new", "where"),
    [
        ("run_up = {", "# run_up = {", "dynamics.run_up"),
        ("torques_Nm", "# torques_Nm", "operating.torques_Nm"),
        ("sweep = {", "# sweep = {", "dynamics.sweep.speed_rpm"),
        ("periods = 320", "periods = 320, seconds = 1", "dynamics.run_up"),
        ("periods = 320", "periods = 3", "dynamics.run_up.periods"),
    ],
)
def test_faults_name_what_is_missing(old: str, new: str, where: str):
    with pytest.raises(InputError) as caught:
        parse_scene(SCENE.replace(old, new))
    assert where in {fault.where for fault in caught.value.faults}
