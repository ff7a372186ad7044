"""Live answers are the digits of a run, of the newest scene alone; nothing is left running."""

from __future__ import annotations

import math
import queue
import time
from pathlib import Path

import numpy as np
import pytest

from flankfilm.app import live
from flankfilm.app.checking import Place, checked
from flankfilm.app.contact import KnownGears, answerable, has_roots
from flankfilm.app.document import Document
from flankfilm.app.live import LOST, Live
from flankfilm.app.live_child import Newest, answer
from flankfilm.files.cache import Cache
from flankfilm.products.root_stress import ROOT_STRESS
from flankfilm.report import stiffness_parts
from flankfilm.scene import parse_scene
from flankfilm.scene.reader import read_scene
from flankfilm.stages.engine import Engine
from flankfilm.stages.mesh import DRY_CYCLE

ROOT = Path(__file__).parents[3]
HERE = Place(ROOT, ROOT)
SCENE = """
wants = ["stiffness"]
tolerance = 0.05
[pair]
module_mm = 2.0
face_width_mm = 40.0
pinion = { teeth = 23, bore_mm = 20, tip_relief = { amount_um = 8, length_mm = 2 } }
wheel = { teeth = 25, bore_mm = 20 }
backlash_um = 50
[material]
youngs_modulus_GPa = 206
poisson_ratio = 0.3
[operating]
pinion_torque_Nm = 200
"""
ECHO = """import sys, json
for line in sys.stdin:
    number = json.loads(line)["number"]
    for kind in ("begun", "curves"):
        print(json.dumps({"number": number, "kind": kind, "seconds": 0.0}), flush=True)
"""
STUCK = """import sys, json, time
for line in sys.stdin:
    number = json.loads(line)["number"]
    print(json.dumps({"number": number, "kind": "begun", "seconds": 0.0}), flush=True)
    if number % 2 == 0:
        print(json.dumps({"number": number, "kind": "curves", "seconds": 0.0}), flush=True)
    else:
        time.sleep(60)
"""


def asked(text: str, newer=lambda: False) -> list[dict]:
    messages: list[dict] = []
    answer(
        {"number": 1, "text": text, "root": str(ROOT), "folder": str(ROOT)},
        messages.append,
        newer,
        KnownGears(),
    )
    return messages


@pytest.fixture(scope="module")
def alone() -> tuple[dict, ...]:
    """Messages of the scene by a child that knows no gears."""
    return tuple(asked(SCENE))


@pytest.fixture(scope="module")
def engine() -> Engine:
    return Engine(parse_scene(SCENE), Cache(None))


def test_curves_and_figures_are_those_of_a_run_digit_by_digit(alone, engine):
    drawn, told, _ = alone
    run = engine[DRY_CYCLE]
    assert drawn["position"] == run.position.tolist()
    lines = {curve["name"]: curve["lines"] for curve in drawn["curves"]}
    lag = (run.transmission_error / 1e-6).tolist()
    assert lines["transmission_error"] == (tuple(lag),)
    per_face = 1e-9 / engine.scene.pair.face_width_mm * 1e3  # N/m to N/(mm um)
    for name in ("stiffness", "secant_stiffness"):
        np.testing.assert_allclose(lines[name], [per_face * getattr(run, name)], rtol=1e-14)
    pressures = [value for line in lines["hertz_pressure"] for value in line if value is not None]
    assert max(pressures) == pytest.approx(1e-6 * np.nanmax(run.contact.hertz_pressure), rel=1e-14)
    share = np.array([[math.nan if v is None else v for v in line] for line in lines["load_share"]])
    np.testing.assert_allclose(np.nansum(share, axis=0), 1.0, rtol=1e-9)
    of_run = [tuple(v if v > 0 else None for v in column) for column in run.load_share.T.tolist()]
    assert lines["load_share"] == tuple(line for line in of_run if any(line))
    figures = [(figure["text"], figure["unit"]) for figure in told["figures"]]
    assert figures[:3] == [
        (one.text, one.unit) for one in stiffness_parts.headlines(run, engine.scene.pair.face_width_mm / 1e3)
    ]
    assert all("±" in figure["error"] for figure in told["figures"][:3])
    assert all(curve["error"] for curve in drawn["curves"])


def test_gears_that_are_known_change_no_digit(alone):
    known, told = KnownGears(), []
    for torque in (150, 200, 250, 200):
        text = SCENE.replace("= 200", f"= {torque}")
        request = {"number": torque, "text": text, "root": str(ROOT), "folder": str(ROOT)}
        answer(request, told.append, lambda: False, known)
    drawn, figures, rooted = alone
    for message in (told[3], told[9]):
        assert message["curves"] == drawn["curves"]
    for message in (told[4], told[10]):
        assert message["figures"] == figures["figures"]
    for message in (told[5], told[11]):
        assert (message["curve"], message["figures"]) == (rooted["curve"], rooted["figures"])


def test_root_stress_follows_digit_by_digit_as_of_a_run(alone, engine):
    drawn, _, rooted = alone
    stress = engine[ROOT_STRESS].stress
    assert drawn["roots"]
    assert rooted["curve"]["lines"] == tuple(
        tuple((1e-6 * gear.tension_Pa.max(axis=1)).tolist()) for gear in (stress.pinion, stress.wheel)
    )
    (maxima,) = rooted["figures"]
    largest = " and ".join(f"{1e-6 * gear.greatest_tension_Pa:.4g}" for gear in (stress.pinion, stress.wheel))
    assert (maxima["text"], maxima["unit"]) == (largest, "MPa")
    assert maxima["error"].startswith("±")


def test_root_stress_is_left_out_where_it_is_not_known_at_once():
    messages = asked(SCENE.replace("200\n", '200\n[stiffness]\nmodel = "weber-banaschek"\n'))
    assert [message["kind"] for message in messages] == ["curves", "figures"]
    assert not messages[0]["roots"]
    for name in ("helical", "face_width"):
        assert not has_roots(Engine(read_scene(ROOT / "examples" / f"{name}.toml"), Cache(None)))
    assert has_roots(Engine(read_scene(ROOT / "examples" / "article.toml"), Cache(None)))


def test_a_newer_scene_ends_the_older_one_between_two_steps():
    assert asked(SCENE, lambda: True) == []
    seen = iter([False, True])
    assert [message["kind"] for message in asked(SCENE, lambda: next(seen))] == ["curves"]


def test_a_scene_with_faults_or_without_a_contact_has_no_curves():
    (told,) = asked(SCENE.replace("[material]", "# "))
    assert (told["kind"], told["text"]) == ("fault", "")  # the fault stands beside its key
    (told,) = asked(SCENE.replace('"stiffness"', '"geometry"').partition("[operating]")[0])
    assert "[operating]" in told["text"]


def test_why_there_is_no_contact():
    assert answerable(parse_scene(SCENE)) == ""
    given = '[stiffness]\nmodel = "given"\nmean_N_per_m = 1e9\namplitudes = [0.1]\nphases_deg = [0]\n'
    assert "given" in answerable(checked(Document(SCENE + given), HERE).scene)


def test_requests_that_wait_are_lost_to_the_newest():
    newest = Newest()
    for number in range(5):
        newest.put({"number": number})
    assert newest.waits
    assert newest.take() == {"number": 4}
    assert not newest.waits
    newest.put(None)
    assert newest.take() is None


@pytest.fixture
def child(monkeypatch):
    """Live answers of a stub."""
    opened = []

    def made(code: str, patience: float) -> tuple[Live, queue.Queue]:
        monkeypatch.setattr(live, "python", lambda *_: [__import__("sys").executable, "-c", code])
        messages: queue.Queue = queue.Queue()
        opened.append(Live(messages.put, patience))
        return opened[-1], messages

    yield made
    for one in opened:
        one.close()
        assert one.process is None


def test_answers_have_the_number_of_the_newest_scene(child):
    asking, messages = child(ECHO, 30.0)
    for _ in range(20):
        last = asking.ask(Document(SCENE), HERE)
    until = time.monotonic() + 20.0
    while time.monotonic() < until:
        message = messages.get(timeout=20.0)
        if message["number"] == last:
            break
    assert message == {"number": 20, "kind": "curves", "seconds": 0.0}
    asking.forget()
    with pytest.raises(queue.Empty):
        messages.get(timeout=0.2)


def test_an_answer_for_an_older_scene_is_dropped(child):
    late = ECHO.replace(
        "for kind in", "for number in (number - 1, number + 1, number):\n      for kind in"
    ).replace("        print", "          print")
    asking, messages = child(late, 30.0)
    for _ in range(3):
        number = asking.ask(Document(SCENE), HERE)
        assert messages.get(timeout=20.0)["number"] == number
    asking.forget()
    assert messages.empty()


def test_a_process_that_is_stuck_at_an_older_scene_is_started_anew(child):
    asking, messages = child(STUCK, 0.3)
    asking.ask(Document(SCENE), HERE)
    while not asking._begun:
        time.sleep(0.01)
    stuck = asking.process
    asking.ask(Document(SCENE.replace("teeth = 25", "teeth = 26")), HERE)
    assert messages.get(timeout=20.0)["number"] == 2
    assert asking.process != stuck


def test_a_process_that_solves_the_same_gears_is_waited_for(child):
    asking, messages = child(STUCK.replace("60", "2"), 0.2)
    asking.ask(Document(SCENE), HERE)
    while not asking._begun:
        time.sleep(0.01)
    solving = asking.process
    asking.ask(Document(SCENE.replace("= 200", "= 210")), HERE)
    assert messages.get(timeout=20.0)["number"] == 2
    assert asking.process == solving


def test_a_process_that_has_died_is_told_and_started_anew(child):
    asking, messages = child("import sys; sys.stdin.readline(); sys.exit(9)", 30.0)
    asking.ask(Document(SCENE), HERE)
    assert messages.get(timeout=20.0)["text"] == LOST
    asking.ask(Document(SCENE), HERE)
    assert messages.get(timeout=20.0)["number"] == 2
