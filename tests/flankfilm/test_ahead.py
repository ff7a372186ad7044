"""What a helper does while a scene is computed is what would be done afterwards, and begins when it can."""

from __future__ import annotations

from dataclasses import replace

import pytest

from base import SolverError
from flankfilm.files.cache import Cache
from flankfilm.processes.assistant import Assistant
from flankfilm.runs.ahead import Ahead
from flankfilm.runs.report import Shown, draw, draw_pair
from flankfilm.runs.run_scene import run_scene
from flankfilm.scene import Scene, parse_scene
from flankfilm.stages.computed import Computed
from flankfilm.stages.engine import Engine, Stage
from flankfilm.stages.mesh import COMPLIANCE, HEAT, PAIR
from flankfilm.stages.vtk import factorise
from tests.flankfilm.scenes import ishikawa

WORN = """
[pair.wheel.wear]
diameter_mm = [77.2, 80.0, 83.9]
depth_um = [14.0, 1.5, 9.0]
[heat]
pinion_temperature_C = 90
wheel_temperature_C = 70
housing_temperature_C = 60
housing_expansion_per_K = 2.3e-5
"""


def worn() -> Scene:
    """A pair whose flanks are drawn, and which grows by heat."""
    text = ishikawa("worn", "geometry", "report").replace("ishikawa", "fem").replace("independent", "coupled")
    return parse_scene(text.replace("wheel = { teeth = 40 }", "backlash_um = 80\nwheel.teeth = 40") + WORN)


def as_seen(shown: Shown) -> Shown:
    """The same with drawings for phones as text."""
    parts = tuple(
        replace(
            part,
            figures=tuple(replace(figure, redraw=None, caption=figure.narrow) for figure in part.figures),
        )
        for part in shown.parts
    )
    return replace(shown, parts=parts)


def test_the_geometry_is_shown_from_its_own_stages_as_from_all():
    run = run_scene(worn(), None, use_cache=False)
    values = {stage.name: run.values[stage.name] for stage in (PAIR, HEAT)}
    early, whole = draw_pair(Computed(run.scene, values)), draw(run, Assistant())
    assert [part.anchor for part in early.parts] == ["geometry", "heat", "flanks"]
    assert early.head == whole.head
    assert as_seen(early).parts == as_seen(whole).parts[:3]
    assert [part.anchor for part in draw(run, Assistant(), early).parts] == [
        part.anchor for part in whole.parts
    ]


def test_the_geometry_is_drawn_once_all_of_its_stages_are_there(tmp_path):
    engine = Engine(worn(), Cache(None))
    ahead = Ahead(engine, Assistant(), tmp_path)
    engine.on_end = ahead.ended
    _ = engine[PAIR]
    assert ahead.of_pair is None
    _ = engine[HEAT]
    assert ahead.of_pair is not None
    assert ahead.helper.result(ahead.of_pair).head is not None


def test_a_promised_result_is_taken_once_and_a_fault_in_it_is_that_of_its_stage():
    def compute(run: Engine) -> int:
        raise AssertionError("it is computed elsewhere")

    def fail() -> int:
        raise SolverError("no field; refine")

    given, failed = (Stage(name, name, compute, lambda scene: {}) for name in ("given", "failed"))
    ended = []
    engine = Engine(worn(), Cache(None), on_end=ended.append)
    calls = iter([7])
    engine.promise(given, lambda: next(calls))
    engine.promise(failed, fail)
    assert engine[given] == engine[given] == 7
    with pytest.raises(SolverError, match="no field"):
        _ = engine[failed]
    assert list(engine.failures) == ["failed"]
    assert ended == [given]


@pytest.mark.parametrize(("helix", "begun"), [("", 1), ("helix_angle_deg = 15.0\n", 0)])
def test_gears_are_factorised_ahead_for_fields_of_the_plane_alone(tmp_path, helix, begun):
    text = ishikawa("spur", "stiffness", "vtk").replace("ishikawa", "fem").replace("independent", "coupled")
    engine = Engine(parse_scene(text.replace("[pair]\n", f"[pair]\n{helix}", 1)), Cache(None))
    set_ahead: list[object] = []

    class Noted(Assistant):
        def submit(self, work, *arguments):
            set_ahead.append(work)
            return super().submit(work, *arguments)

    engine.on_end = Ahead(engine, Noted(), tmp_path).ended
    _ = engine[COMPLIANCE]
    assert set_ahead.count(factorise) == begun
