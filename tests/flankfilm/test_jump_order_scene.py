"""The order of a scene's series by its jumps: asked for, handed on, and said."""

from __future__ import annotations

from types import SimpleNamespace

import pytest

from flankfilm import coupling
from flankfilm.files.cache import Cache
from flankfilm.plan.decisions import decisions
from flankfilm.products.diagram import DIAGRAM
from flankfilm.scene import parse_scene
from flankfilm.stages.engine import Engine
from flankfilm.stages.mesh import FILM
from flankfilm.stages.motion import BRANCHES, FOURIER, SCALING
from tests.flankfilm.scenes import PAIR_WITH_BACKLASH

SCENE = f"""
wants = ["film", "diagram"]
tolerance = 0.03
{PAIR_WITH_BACKLASH}
[operating]
pinion_torque_Nm = 600
pinion_speed_rpm = 2000

[lubricant]
viscosity_Pa_s = 0.075
pressure_viscosity_per_GPa = 19.6
density_kg_per_m3 = 910

[film]
model = "dowson"

[stiffness]
model = "potential-energy"
pairs = "independent"

[dynamics]
fourier_order = "auto"
error_amplitude_um = 5
diagram = {{ frequency = [0.84, 0.92], max_period = 1, searches = 1 }}
"""


def jump(error: float) -> coupling.Jump:
    return coupling.Jump(0.9, True, "1-1-0", {"stiffness": 0.0, "truncation": error, "flow": 0.0}, 0.9)


def test_the_order_that_jumps_need_is_that_of_the_series_the_motion_and_the_decision(monkeypatch):
    asked = []

    def settled(motion_of, series, tolerance, **options):
        asked.append((motion_of(series).oscillator.stiffness.order, series, tolerance, options))
        diagram = SimpleNamespace(jumps=(jump(0.004),), missed=())
        return SimpleNamespace(order=series.order + 2, tried=((series.order, 0.07),), diagram=diagram)

    monkeypatch.setattr(coupling, "jumps_to_tolerance", settled)
    run = Engine(parse_scene(SCENE), Cache(None))
    found = run[FOURIER]
    ((order, first, tolerance, options),) = asked
    assert (order, tolerance) == (first.order, 0.03)
    assert options == {"speed": None, "frequency": (0.84, 0.92), "searches": 1, "max_period": 1}
    assert found.order == first.order + 2 == run[SCALING].oscillator.stiffness.order
    assert found.cycle is first.cycle
    assert found.mean == pytest.approx(run[FILM].mean_secant_stiffness, rel=1e-9)
    assert run[DIAGRAM] is run[BRANCHES].diagram
    last = decisions(run.results())[-1]
    assert last.choice == str(found.order)
    assert "jump speeds err by up to 0.4 %" in last.reason
    assert f"with order {first.order} by up to 7 %" in last.reason


def test_an_order_of_one_s_own_stays_and_no_jumps_are_asked_for_it(monkeypatch):
    monkeypatch.setattr(coupling, "jumps_to_tolerance", None)
    monkeypatch.setattr(
        coupling,
        "jump_speeds",
        lambda motion, **options: SimpleNamespace(
            jumps=(jump(float("inf")),),
            missed=(coupling.MissedJump(0.85, True, "1-1-0", 0.002),),
            longer_order=8,
        ),
    )
    run = Engine(parse_scene(SCENE.replace('"auto"', "1")), Cache(None))
    assert run[FOURIER].order == 1
    assert run[DIAGRAM].jumps
    reason = decisions(run.results())[-1].reason
    assert (
        "jump speeds err by an unknown amount, 1 more with 8 harmonics, over up to 0.2 % of the speed"
        in reason
    )


@pytest.mark.slow
def test_jumps_of_a_lubricated_mesh_are_as_exact_as_the_scene_asks():
    run = Engine(parse_scene(SCENE.replace("0.03", "0.012")), Cache(None))
    found = run[DIAGRAM]
    assert found.jumps
    assert all(one.error <= 0.012 for one in found.jumps)
    assert run[FOURIER].order > 1
